"""Errors as JSON, for the page."""

from __future__ import annotations

from typing import Any

from umform.errors import UmformError
from umform.problem.errors import DeckError


def problems_of(error: UmformError) -> list[dict[str, Any]]:
    """All errors of a form as JSON."""
    return [_parts(one) for one in getattr(error, "errors", [error])[:20]]


def error_record(error: UmformError) -> dict[str, Any]:
    """An error as JSON."""
    if isinstance(error, DeckError) and len(error.errors) > 1:
        return {**_parts(error), "all": [_parts(one) for one in error.errors[:50]]}
    return _parts(error)


def _parts(error: UmformError) -> dict[str, Any]:
    value = "" if error.value is None else str(error.value)[:200]
    parts = {"what": error.what, "where": error.where, "value": value, "cause": error.cause, "remedy": error.remedy}
    return {"kind": "refused", "id": error.id, **{name: str(text)[:2000] for name, text in parts.items()}}
