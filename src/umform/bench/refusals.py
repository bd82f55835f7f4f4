"""Errors in parts, for the page to put into words."""

from __future__ import annotations

from typing import Any

from umform.errors import UmformError
from umform.problem.errors import DeckError


def problems_of(error: UmformError) -> list[dict[str, Any]]:
    """All errors of a form, each in parts."""
    return [_parts(one) for one in getattr(error, "errors", [error])[:20]]


def said(error: UmformError) -> dict[str, Any]:
    """An error in parts."""
    if isinstance(error, DeckError) and len(error.errors) > 1:
        return {**_parts(error), "all": [_parts(one) for one in error.errors[:50]]}
    return _parts(error)


def _parts(error: UmformError) -> dict[str, Any]:
    value = "" if error.value is None else str(error.value)[:200]
    parts = {"what": error.what, "where": error.where, "value": value, "cause": error.cause, "remedy": error.remedy}
    return {"kind": "refused", "id": error.id, **{name: str(text)[:2000] for name, text in parts.items()}}
