"""The goal of ``umform bend``: an angle, a stroke, a force, or a table of strokes."""

from __future__ import annotations

import math

from umform.cli.metal import numbers
from umform.errors import InvalidValue

#: Largest number of rows of a table: each row is an unloading.
_MOST_ROWS = 1000


def check_goal(
    angle: float | None,
    stroke: float | None,
    table: str | None,
    angles: str | None,
    force: float | None,
    travel: float | None,
) -> None:
    """Refuse a bend without a goal, with both stroke and angle, or with two tables."""
    if force is not None or travel is not None:
        raise InvalidValue(
            "a force or a way beyond the bottom is one of bottoming",
            where="--force-per-metre, --travel",
            remedy="--bottoming beside it",
        )
    if table is not None and angles is not None:
        raise InvalidValue(
            "a bend has one table",
            where="--table, --angles",
            cause="both are given",
            remedy="--table 4:6:0.5 over strokes, or --angles 90:150:15 over angles",
        )
    both = angle is not None and stroke is not None
    if both or (angle, stroke, table, angles) == (None,) * 4:
        raise InvalidValue(
            "give the stroke or the angle, one of them",
            where="umform bend",
            cause="both are given" if both else "none of them is given, and no table",
            remedy="--angle 90 looks for the stroke, --stroke 6 bends to it, --table 4:6:0.5 to several strokes, "
            "--angles 90:150:15 to several angles",
        )


def check_length(length: float | None) -> None:
    """Refuse a bend length that is not positive and finite."""
    if length is not None and not 0.0 < length < math.inf:
        raise InvalidValue(
            "a bend length must be positive and finite",
            where="--length",
            value=length,
            cause="a sign, or a missing value",
            remedy="the length of the bend line in mm, such as 1000",
        )


def check_no_goal(option: str, *goals: object) -> None:
    """Refuse a goal of a single bend together with an option that defines goals."""
    if any(goal is not None and goal is not False for goal in goals):
        raise InvalidValue(
            "the bends of a file have angles and strokes of their own",
            where=option,
            cause="--angle, --stroke, --table, --angles, --bottoming, --budget, --print-deck or --find beside it",
            remedy=f"leave them out, or {option}",
        )


def check_budgeted(processes: int, budget: bool) -> None:
    """Refuse a number of runs at a time without an error budget, whose runs alone are independent."""
    if not budget:
        raise InvalidValue(
            "only the runs of an error budget go side by side",
            where="--processes",
            value=processes,
            cause="--budget is missing",
            remedy="--budget beside it, or leave it out",
        )


def check_flat_only(flat_only: bool) -> None:
    """Refuse the option of outside dimensions without their file."""
    if flat_only:
        raise InvalidValue(
            "the outside dimensions of a part stand in a file",
            where="--flat-only",
            cause="--sequence is missing",
            remedy="--sequence part.toml --flat-only; a single bend has its deduction among its results",
        )


def check_measured(*goals: object) -> None:
    """Refuse goals beside what was measured at a stroke."""
    if any(goal is not None and goal is not False for goal in goals):
        raise InvalidValue(
            "numbers of a measured bend are sought at its stroke, without other goals and studies",
            where="--find",
            cause="--angle, --table, --angles, --force-per-metre, --budget, --derive, --scatter, --want, "
            "--print-deck, --all or --timing beside it",
            remedy="--stroke 6.1 --find strength=400:700 --quantity angle=91.6+-.1; find the stroke of the next bend "
            "with the corrected metal",
        )


def check_press(
    angle: float | None,
    table: str | None,
    angles: str | None,
    budget: bool,
    stroke: float | None,
    force: float | None,
    travel: float | None,
) -> None:
    """Refuse bottoming without exactly one goal, or with options that it does not support."""
    if [stroke, force, travel].count(None) != 2:
        raise InvalidValue(
            "give the force of bottoming, the way beyond the bottom, or the stroke: one of them",
            where="--bottoming",
            remedy="--force-per-metre 400, or --travel 0.05",
        )
    if angle is not None or table is not None or angles is not None or budget:
        raise InvalidValue(
            "bottoming has no search for an angle, no table and no budget",
            where="--bottoming",
            cause="--angle, --table, --angles or --budget beside it",
            remedy="the angle is about that of the die; leave them out",
        )


def strokes_of(text: str) -> list[float]:
    """Strokes of first:last:step, including the last one."""
    first, last, step = numbers(text, ":", 3, "--table", "first:last:step as 4:6:0.5")
    if not 0.0 < first <= last < math.inf or not 0.0 < step < math.inf:
        raise InvalidValue(
            "a table goes from a positive stroke up to a larger one, in positive steps",
            where="--table",
            value=text,
            cause="a sign, the two exchanged, or a number that is not finite",
            remedy="first:last:step as 4:6:0.5",
        )
    if not last - first < _MOST_ROWS * step:
        raise InvalidValue(
            f"a table has at most {_MOST_ROWS} strokes",
            where="--table",
            value=text,
            cause="the number of strokes in place of the step between them, or a step of another unit",
            remedy="first:last:step as 4:6:0.5",
        )
    return [first + number * step for number in range(int((last - first) / step + 1e-9) + 1)]
