"""Error for what the folder of the bench does not have any more."""

from __future__ import annotations

from umform.errors import InvalidValue


def gone(what: str, where: str, name: str, remedy: str = "load the page again") -> InvalidValue:
    """Error for the name of a job, a part or a tool that is not there."""
    return InvalidValue(
        what,
        where=where,
        value=name[:80],
        cause="it was deleted, or belongs to another folder of the bench",
        remedy=remedy,
    )
