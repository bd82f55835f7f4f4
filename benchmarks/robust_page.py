"""The page of the robust rate: the table by kind, and each failure with its explanation."""

from __future__ import annotations

import hashlib
import json
import textwrap
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from jobs import COUNT, job

EXPLANATIONS = Path(__file__).with_name("robust_failures.toml")
GOAL, HANGS = 0.995, ("hang", "out of time")

_PAGE = """# How many jobs finish

{count} random jobs resemble those of users: bends with the metals, dies and punches of a workshop, to a stroke or to
an angle; strips over cylinders; strips between tools with drawn sections; plates under balls, plungers and rings.
Elements, penalties, contact points and multipliers are random. A job has finished if all its steps are complete and
forces and energies balance. The number of a job defines it completely.

```console
python benchmarks/robust.py --page docs/robust-rate.md     # or: make robust
python benchmarks/robust.py --job 117
```

{rate:.1%} finish; the goal is {goal:.1%} and no job that hangs: {verdict}.

{table}

Evaluations are those of residual and tangent. "Thrown away" are those of failed attempts of Newton's method.

## Jobs that do not finish

{failures}

## Jobs that jump

Jobs: {jumps}. The stable path ends, as in perfect plasticity it may, and the sheet jumps to the next stable state, of
which the run warns ([attempts](attempts.md)).
"""

_Outcomes = Sequence[Mapping[str, Any]]


def explanations() -> dict[int, str]:
    """Why jobs fail, by their numbers.

    Raises
    ------
    SystemExit
        If they are of other jobs than those that are drawn now.
    """
    stored, now = tomllib.loads(EXPLANATIONS.read_text(encoding="utf-8")), drawn()
    if stored["drawn"] != now:
        raise SystemExit(
            f"{EXPLANATIONS.name}: jobs are drawn in another way since: look at all failures again; now '{now}'"
        )
    return {int(number): text for number, text in stored["failures"].items()}


def drawn() -> str:
    """Digest of all jobs."""
    text = json.dumps([job(number).keys for number in range(COUNT)], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def check(outcomes: _Outcomes, known: Mapping[int, str]) -> None:
    """Refuse failures that nobody has explained, and explanations of jobs that arrive.

    Raises
    ------
    SystemExit
        With the numbers of both.
    """
    failed = {one["number"] for one in outcomes if one["outcome"] != "arrived"}
    missing, stale = sorted(failed - set(known)), sorted(set(known) - failed)
    if missing or stale:
        raise SystemExit(
            f"{EXPLANATIONS.name}: no explanation of the jobs {missing}; jobs {stale} arrive or were not run: "
            "look at each with --job NUMBER"
        )


def rate(outcomes: _Outcomes) -> float:
    """Share of the jobs that arrived."""
    return sum(one["outcome"] == "arrived" for one in outcomes) / len(outcomes)


def table(outcomes: _Outcomes) -> str:
    """Jobs of each kind and how they ended, in Markdown."""
    kinds = list(dict.fromkeys(one["kind"] for one in outcomes))
    rows = [
        "| jobs | number | finished | CPU s, median | CPU s, most | evaluations | thrown away |",
        "|---" + "|---:" * 6 + "|",
    ]
    for kind in [*kinds, "all"]:
        of_kind = [one for one in outcomes if kind in (one["kind"], "all")]
        seconds, evaluations = sorted(one["CPU s"] for one in of_kind), sum(one["evaluations"] for one in of_kind)
        thrown = sum(one["evaluations"] * one["share thrown away"] for one in of_kind)
        rows.append(
            f"| {kind} | {len(of_kind)} | {rate(of_kind):.1%} | {seconds[len(seconds) // 2]:.1f} | {seconds[-1]:.1f} | "
            f"{evaluations} | {thrown / max(1, evaluations):.0%} |"
        )
    return "\n".join(rows)


def failures(outcomes: _Outcomes) -> str:
    """A line for each job that did not arrive."""
    return "\n".join(
        f"job {one['number']}, {one['kind']}: {one['outcome']}; {one['reason']}; {one['evaluations']} evaluations, "
        f"{one['share thrown away']:.0%} thrown away"
        for one in outcomes
        if one["outcome"] != "arrived"
    )


def page(outcomes: _Outcomes) -> str:
    """The page, whose failures are all explained."""
    known = explanations()
    check(outcomes, known)
    share, hangs = rate(outcomes), any(one["outcome"] in HANGS for one in outcomes)
    explained = [
        _item(f"**Job {one['number']}**, {one['kind']}, {one['outcome']}: {known[one['number']].strip()}")
        for one in outcomes
        if one["outcome"] != "arrived"
    ]
    return _PAGE.format(
        count=len(outcomes),
        rate=share,
        goal=GOAL,
        verdict="met" if share >= GOAL and not hangs else "missed",
        table=table(outcomes),
        failures="\n".join(explained or ["All finish."]),
        jumps=", ".join(str(one["number"]) for one in outcomes if one.get("jumps")) or "none",
    )


def _item(text: str) -> str:
    """An item of a list, in lines of the length of the house."""
    return textwrap.fill(text, 120, initial_indent="* ", subsequent_indent="  ", break_on_hyphens=False)
