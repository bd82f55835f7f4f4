"""The goal of ``umform bend``: an angle, a stroke, a force, or tables of strokes and angles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from umform.cli.bend_table import values_of
from umform.errors import InvalidValue, placed
from umform.processes.air_bending.goal import Goal, check_angle
from umform.spec import check_value, parameters

if TYPE_CHECKING:
    from umform.processes.air_bending.bend import AirBend
    from umform.processes.air_bending.brake import Brake
    from umform.processes.air_bending.measures import Measures
    from umform.processes.air_bending.spec import AirBending

#: Largest number of rows of a table: each row is an unloading.
_MOST_ROWS = 1000


@dataclass(frozen=True)
class BendGoal:
    """What is wanted of a bend.

    Attributes
    ----------
    angle, stroke, force, travel : float, optional
        Angle after springback, stroke, force per metre, way beyond the bottom: that of the bend.
    tolerance : float
        Of the angle.
    bottoming : bool
        Whether the sheet is pressed onto the die.
    strokes, angles : list of float
        Rows of the bending table before the bend.
    last_row : bool
        Whether the bend is the last row of a table of angles.
    typed : list of object
        Angle, tables and force as typed; None for those that are not.
    """

    angle: float | None
    stroke: float | None
    force: float | None
    travel: float | None
    tolerance: float
    bottoming: bool
    strokes: list[float]
    angles: list[float]
    last_row: bool
    typed: list[object]

    @classmethod
    def of(cls, given: dict[str, Any], table: str | None, angles: str | None, *, several: bool = False) -> BendGoal:
        """The goal of the options, whose values are taken out of the given ones; the stroke stays there.

        Parameters
        ----------
        given : dict of str to object
            Values by the names of the parameters.
        table, angles : str, optional
            Bending tables over strokes or angles, as typed.
        several : bool
            Whether the bends have goals of their own.
        """
        angle, force, travel, tolerance = (given.pop(name) for name in parameters(Goal))
        stroke, bottoming = given["stroke"], given["bottoming"]
        typed = [angle, table, angles, force]
        if not bottoming and not several:
            _check_alone(angle, stroke, table, angles, force, travel)
        strokes = [] if table is None else _strokes_of(table)
        wanted = [] if angles is None else sorted(set(values_of(angles, "--angles")), reverse=True)
        table_only = angle is None and stroke is None and not bottoming
        given["stroke"] = stroke
        if strokes and table_only:
            stroke = strokes[-1]
        last_row = bool(wanted) and table_only
        angle = wanted.pop() if last_row else angle
        check_value(Goal, "tolerance", tolerance)
        return cls(angle, stroke, force, travel, tolerance, bottoming, strokes, wanted, last_row, typed)

    @property
    def name(self) -> str:
        """Result for which the stroke is found; empty where it is given."""
        return "angle" if self.angle is not None else "force" if self.force is not None else ""

    @property
    def held(self) -> dict[str, str]:
        """The parameter that keeps this result in derivatives."""
        return {self.name: "stroke"} if self.name else {}

    @property
    def searched(self) -> bool:
        """Whether the stroke is not known before the run."""
        return self.stroke is None and self.travel is None

    def checked(self, case: AirBending, *, budget: bool) -> AirBending:
        """The case to the end of its bottoming; goals that the tools cannot reach are refused."""
        if self.bottoming:
            from umform.processes.air_bending.bottoming import with_travel

            self._check_bottoming(budget)
            case = case if self.travel is None else with_travel(case, self.travel)
            check_value(Goal, "force_per_metre", self.force)
        if self.strokes:
            with placed("--table", "angle", "stroke"):  # refuses a stroke beyond air bending before the first run
                longest = replace(case, stroke=self.strokes[-1])
            case = longest if case.stroke is None else case
        for option, angles in (("--angles", self.angles), (self._angle_of, [self.angle])):
            for one in angles:
                if one is not None:
                    with placed(option, "angle", "stroke"):
                        check_angle(case, one)
        return case

    @property
    def _angle_of(self) -> str:
        """Option that has the angle of the bend."""
        return "--angles" if self.last_row else "--angle"

    def rows(self, brake: Brake) -> Iterator[list[Measures]]:
        """Rows of the bending tables before the bend."""
        from umform.processes.air_bending.search import angle_table, bending_table

        if self.strokes:
            yield bending_table(brake.case, self.strokes, brake=brake)
        if self.angles:
            with placed("--angles", "angle", "stroke"):
                angles = angle_table(brake.case, self.angles, tolerance=self.tolerance, brake=brake)
            yield angles

    def bent(self, brake: Brake) -> AirBend:
        """The bend to a force, to an angle after springback, or to the stroke."""
        from umform.processes.air_bending.bottoming import press_to_force
        from umform.processes.air_bending.case import air_bending
        from umform.processes.air_bending.search import find_stroke

        if self.force is not None:
            return press_to_force(brake.case, self.force, brake=brake).bend
        if self.angle is not None:
            with placed(self._angle_of, "angle", "stroke"):
                return find_stroke(brake.case, self.angle, tolerance=self.tolerance, brake=brake).bend
        return air_bending(brake.case, brake=brake)

    def with_stroke(self, case: AirBending) -> AirBending:
        """The case with the stroke that its angle or its force needs."""
        from umform.processes.air_bending.bottoming import press_to_force
        from umform.processes.air_bending.search import find_stroke

        if self.force is not None:
            return press_to_force(case, self.force, frames=1).case
        if self.angle is not None:
            return find_stroke(case, self.angle, tolerance=self.tolerance, frames=1).case
        return case

    def _check_bottoming(self, budget: bool) -> None:
        """Refuse bottoming without exactly one goal, or with options that it does not support."""
        if [self.stroke, self.force, self.travel].count(None) != 2:
            raise InvalidValue(
                "give the force of bottoming, the way beyond the bottom, or the stroke: one of them",
                where="--bottoming",
                remedy="--force-per-metre 400, or --travel 0.05",
            )
        if self.angle is not None or self.strokes or self.angles or budget:
            raise InvalidValue(
                "bottoming has no search for an angle, no table and no budget",
                where="--bottoming",
                cause="--angle, --table, --angles or --budget beside it",
                remedy="the angle is about that of the die; leave them out",
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


def _check_alone(
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
            "a force or a travel beyond the bottom needs bottoming",
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


def _strokes_of(text: str) -> list[float]:
    """Strokes of a table in ascending order."""
    strokes = sorted(set(values_of(text, "--table")))
    if not 0.0 < strokes[0] <= strokes[-1] < math.inf:
        raise InvalidValue(
            "the strokes of a table are positive",
            where="--table",
            value=text,
            cause="a sign, or a number that is not finite",
            remedy="4,5,6 or first:last:step such as 4:6:0.5",
        )
    if len(strokes) > _MOST_ROWS:
        raise InvalidValue(
            f"a table has at most {_MOST_ROWS} strokes",
            where="--table",
            value=f"{text}: {len(strokes)}",
            cause="the number of strokes in place of the step between them, or a step of another unit",
            remedy="first:last:step as 4:6:0.5",
        )
    return strokes
