"""A part by its outside dimensions: flanges and angles as a drawing has them; flat length and bend lines from them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import accumulate, pairwise
from typing import ClassVar, Literal

from umform.errors import InvalidValue
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.spec import MOST_BENDS, TOOLS, Bend, BendSequence, Bodies
from umform.spec import check_fields
from umform.spec.types import Degrees


@dataclass(frozen=True)
class OutsideBend:
    """One bend of a part by its outside dimensions."""

    angle: Degrees
    """Angle between the legs after unloading."""
    line: int | None = None
    """Number of its bend line from the left; without it, that in the order of bending."""
    direction: Literal["up", "down"] = "up"
    """Direction of the legs; for down the part is turned over."""
    tools: Mapping[str, float] = field(default_factory=dict)
    """Tools of this bend that differ from those of the sequence."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "tools", dict(self.tools))
        check_fields(self)


@dataclass(frozen=True)
class OutsidePart:
    """Flanges by their outside lengths from left to right, and the bends between them in the order of bending.

    The outside length of a flange ends where the lines of the outer faces meet; with ``acute="tangent"``, that of a
    bend below 90 degrees at the tangent across the bend, as DIN 6935 measures it.
    """

    groups: ClassVar = {"flanges": "Part"}
    """Group of the parameters from each of these on."""

    flanges: tuple[float, ...]
    """Outside lengths in mm, from left to right."""
    bends: tuple[OutsideBend, ...]
    """Bends, in order of bending."""
    acute: Literal["apex", "tangent"] = "apex"
    """End of the flanges at bends below 90 degrees; where the outer faces meet, or the tangent of DIN 6935."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "flanges", tuple(self.flanges))
        object.__setattr__(self, "bends", tuple(self.bends))
        check_fields(self)
        _check(self)

    @property
    def lines(self) -> tuple[int, ...]:
        """Number of the bend line of each bend, counted from the left, in order of bending."""
        return tuple(number if bend.line is None else bend.line for number, bend in enumerate(self.bends, start=1))

    def flat(self, deductions: Sequence[float]) -> tuple[float, tuple[float, ...]]:
        """Flat length, and the positions of the bend lines in order of bending. eq. (5.93)

        Parameters
        ----------
        deductions : sequence of float
            Bend deductions in mm, in order of bending.

        Returns
        -------
        tuple of float and tuple
            Lengths in mm from the left end of the flat strip.

        Examples
        --------
        >>> angle = OutsidePart((50.0, 50.0), (OutsideBend(90.0),))
        >>> angle.flat([3.9])
        (96.1, (48.05,))
        """
        of_line = dict(zip(self.lines, deductions, strict=True))
        sums = list(accumulate(self.flanges))
        place, before = {}, 0.0
        for line in range(1, len(self.flanges)):
            place[line] = sums[line - 1] - before - 0.5 * of_line[line]
            before += of_line[line]
        return sums[-1] - before, tuple(place[line] for line in self.lines)

    def sequence(
        self, deductions: Sequence[float], sheet: AirBending | None = None, bodies: Bodies | None = None
    ) -> BendSequence:
        """The bends of the flat strip.

        Parameters
        ----------
        deductions : sequence of float
            Bend deductions in mm, in order of bending.
        sheet : AirBending, optional
            Sheet and default tools.
        bodies : Bodies, optional
            Bodies of the tools.

        Raises
        ------
        InvalidValue
            If a flange is too short for its deductions or for the die.
        """
        length, places = self.flat(deductions)
        of_line = dict(zip(self.lines, places, strict=True))
        ends = [0.0, *(of_line[line] for line in range(1, len(self.flanges))), length]
        for number, (left, right) in enumerate(pairwise(ends), start=1):
            if left >= right:
                raise InvalidValue(
                    "a flange is shorter than its bends take",
                    where=f"flange {number}",
                    value=self.flanges[number - 1],
                    cause="an inside dimension, or another unit",
                    remedy="outside dimensions in mm",
                )
        bends = tuple(
            Bend(place, bend.angle, direction=bend.direction, tools=bend.tools)
            for place, bend in zip(places, self.bends, strict=True)
        )
        return BendSequence(length, bends, sheet or AirBending(), bodies or Bodies())


def _check(part: OutsidePart) -> None:
    """Refuse flanges and bends that do not belong together, and tools that no bend has.

    Raises
    ------
    InvalidValue
    """
    count = len(part.bends)
    if not 1 <= count <= MOST_BENDS:
        raise InvalidValue(
            f"a part has 1 to {MOST_BENDS} bends",
            where="bends",
            value=count,
            cause="no bend, or bends of several parts",
            remedy="bends of one part",
        )
    if len(part.flanges) != count + 1:
        raise InvalidValue(
            "a part has one flange more than bends",
            where="flanges",
            value=f"{len(part.flanges)} flanges, {count} bends",
            cause="a flange or a bend was left out",
            remedy=f"{count + 1} outside lengths from left to right",
        )
    for number, flange in enumerate(part.flanges, start=1):
        if not (math.isfinite(flange) and flange > 0.0):
            raise InvalidValue(
                "the outside length of a flange must be positive and finite",
                where=f"flange {number}",
                value=flange,
                cause="a sign, or a missing value",
                remedy="in mm, such as 30",
            )
    if sorted(part.lines) != list(range(1, count + 1)):
        raise InvalidValue(
            "each bend line is bent once",
            where="bends",
            value=", ".join(map(str, part.lines)),
            cause="a number of a bend line is there twice, or counted from 0",
            remedy=f"the numbers 1 to {count} from the left, each once",
        )
    unknown = sorted({name for bend in part.bends for name in bend.tools} - set(TOOLS))
    if unknown:
        raise InvalidValue(
            "this is no size of the tools of a bend",
            where="bends",
            value=", ".join(unknown),
            remedy="one of " + ", ".join(TOOLS),
        )
