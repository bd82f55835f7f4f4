"""Verdict on the numbers of a finished job: good, with warnings, beyond a limit, unfinished, or in collision."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

#: Misfit in standard deviations above which the corrected metal does not explain the measured bend.
_FAR = 2.0
#: The verdicts, the worst first; a job without any of them is good.
VERDICTS = ("collides", "failed", "missed", "warned")


def verdict(summary: Mapping[str, Any]) -> str:
    """One of `VERDICTS` for the summary of a finished job; empty if it is good."""
    if summary.get("collisions"):
        return "collides"
    if summary.get("unfinished"):
        return "failed"
    if any(_missed(summary)):
        return "missed"
    return "warned" if any(summary.get(name) for name in ("warnings", "coarse_mesh", "remarks")) else ""


def _missed(summary: Mapping[str, Any]) -> Iterator[bool]:
    """Numbers beyond their limits, and what the work was for but has not given."""
    lists = [summary.get(name) or () for name in ("quantities", "checks", "sizes")]
    for quantities in (*lists, *(summary.get("columns") or ())):
        yield any(one.get("missed") for one in quantities)
    yield bool(summary.get("failed"))  # bends of a table
    if "flat" in summary:
        flat = summary["flat"]
        yield bool(flat.get("bends")) and not flat.get("order")
    if "corrected" in summary:
        misfit = summary.get("misfit")
        yield misfit is None or misfit > _FAR or any(one["error"] is None for one in summary["corrected"])
