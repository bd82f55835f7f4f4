"""The page of the robust rate: the table by kind, and each failure with its explanation."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from typing import Any

from imbalance import COARSE, DEEP, DRIFTS, MISSED
from pages import item
from robust_lots import Rated

#: Outcomes that no lot may have.
NEVER = ("hang", "out of time", "wrong", "crash")

_Outcomes = Sequence[Mapping[str, Any]]


def explanations(rated: Rated) -> dict[int, str]:
    """Why jobs fail, by their numbers.

    Raises
    ------
    SystemExit
        If they are of other jobs than those that are drawn now.
    """
    stored, now = tomllib.loads(rated.explanations.read_text(encoding="utf-8")), rated.lot.drawn
    if stored["drawn"] != now:
        raise SystemExit(
            f"{rated.explanations.name}: jobs are drawn in another way since: look at all failures again; now '{now}'"
        )
    return {int(number): text for number, text in stored["failures"].items()}


def check(rated: Rated, outcomes: _Outcomes, known: Mapping[int, str]) -> None:
    """Refuse failures that nobody has explained, and explanations of jobs that arrive.

    Raises
    ------
    SystemExit
        With the numbers of both.
    """
    failed = {one["number"] for one in outcomes if one["outcome"] not in rated.good}
    missing, stale = sorted(failed - set(known)), sorted(set(known) - failed)
    if missing or stale:
        raise SystemExit(
            f"{rated.explanations.name}: no explanation of the jobs {missing}; jobs {stale} arrive or were not run: "
            "look at each with --job NUMBER"
        )


def rate(rated: Rated, outcomes: _Outcomes) -> float:
    """Share of the jobs that ended as they may."""
    return sum(one["outcome"] in rated.good for one in outcomes) / len(outcomes)


def marked(one: Mapping[str, Any]) -> bool:
    """Whether a job arrived with a number of which its run warns."""
    return one["outcome"] == "arrived" and any(
        mark in text for text in one.get("warnings", ()) for mark in (COARSE, DEEP, DRIFTS, MISSED)
    )


def table(rated: Rated, outcomes: _Outcomes) -> str:
    """Jobs of each kind and how they ended, in Markdown."""
    kinds = list(dict.fromkeys(one["kind"] for one in outcomes))
    rows = [
        "| jobs | number | finished | CPU s, median | CPU s, most | evaluations | discarded |",
        "|---" + "|---:" * 6 + "|",
    ]
    for kind in [*kinds, "all"]:
        of_kind = [one for one in outcomes if kind in (one["kind"], "all")]
        seconds, evaluations = sorted(one["CPU s"] for one in of_kind), sum(one["evaluations"] for one in of_kind)
        discarded = sum(one["evaluations"] * one["share discarded"] for one in of_kind)
        rows.append(
            f"| {kind} | {len(of_kind)} | {rate(rated, of_kind):.1%} | {seconds[len(seconds) // 2]:.1f} | "
            f"{seconds[-1]:.1f} | {evaluations} | {discarded / max(1, evaluations):.0%} |"
        )
    return "\n".join(rows)


def failures(outcomes: _Outcomes) -> str:
    """A line for each job that did not arrive."""
    return "\n".join(
        f"job {one['number']}, {one['kind']}: {one['outcome']}; {one['reason']}; {one['evaluations']} evaluations, "
        f"{one['share discarded']:.0%} discarded"
        for one in outcomes
        if one["outcome"] != "arrived"
    )


def page(rated: Rated, outcomes: _Outcomes) -> str:
    """The page, whose failures are all explained."""
    known = explanations(rated)
    check(rated, outcomes, known)
    share, never = rate(rated, outcomes), any(one["outcome"] in NEVER for one in outcomes)
    explained = [
        item(f"**Job {one['number']}**, {one['kind']}, {one['outcome']}: {known[one['number']].strip()}")
        for one in outcomes
        if one["outcome"] not in rated.good
    ]
    return rated.page.format(
        count=len(outcomes),
        rate=share,
        goal=rated.goal,
        marked=sum(map(marked, outcomes)),
        seconds=sum(one["CPU s"] for one in outcomes),
        verdict="met" if share >= rated.goal and not never else "missed",
        table=table(rated, outcomes),
        failures="\n".join(explained or ["All finish."]),
        jumps=", ".join(str(one["number"]) for one in outcomes if one.get("jumps")) or "none",
    )
