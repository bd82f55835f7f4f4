"""A part after all of its bends: bends, flanges, profile."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.problem.problem import Problem
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.remarks import (
    coarse_mesh,
    extrapolated,
    of_this_mesh,
    tools_text,
    total_force,
)
from umform.processes.air_bending.sheet import studied_mesh
from umform.processes.bend_sequence.collisions import Collision
from umform.processes.bend_sequence.sides import Sides, Strip
from umform.processes.bend_sequence.spec import Bend, BendSequence
from umform.results.outcome import Outcome
from umform.results.quantity import Quantity, prefixed, quantities_of, side_by_side, table
from umform.results.studies import StudiedMesh
from umform.sheet_metals import sheet_text

Floats = NDArray[np.float64]


#: What helps against a collision.
REMEDY = "Choose another order of the bends, or other tools"


def when_and_where(bend: Bend, hit: Collision) -> str:
    """Stroke of a collision, and its place on the flat strip."""
    when = "before it is bent" if hit.stroke <= 0.0 else f"from a stroke of {hit.stroke:.4g} mm on"
    place = bend.position + (-hit.distance if bend.over else hit.distance)
    return f"{when}, at {abs(place):.3g} mm from the left end of the flat strip"


def after(deck: str) -> dict[str, str]:
    """Table of the operation before, whose deck was run in the folder of both."""
    return {"deck": deck, "state": f"results/{deck.removesuffix('.toml')}/state.h5"}


@dataclass(frozen=True)
class BendDone:
    """One bend of a part.

    Attributes
    ----------
    bend : Bend
        The bend.
    measures : Measures
        Measures as of a single bend; means of both sides where they differ.
    stroke, force : ndarray, shape (n,)
        Stroke of the punch in mm and its force per length of bend in kN/m, all converged increments.
    states : tuple of (float, Strip)
        Stroke, and the strip in the frame of the tools, for some states; the last one is after unloading.
    collisions : tuple of Collision
        Collisions with bodies of the tools.
    trials : tuple of tuple of float
        Stroke and angle of each trial, if an angle is the goal.
    warnings : tuple of str
        Warnings.
    result : Result
        History, frames and iterations.
    problem : Problem
        The bend with the stroke that it took, as a problem of its own.
    """

    bend: Bend
    measures: Measures
    stroke: Floats
    force: Floats
    states: tuple[tuple[float, Strip], ...]
    collisions: tuple[Collision, ...]
    trials: tuple[tuple[float, float], ...]
    warnings: tuple[str, ...]
    result: Result
    problem: Problem


@dataclass(frozen=True, repr=False)
class Part(Outcome):
    """A part after all of its bends.

    Attributes
    ----------
    sequence : BendSequence
        The parameters.
    bends : tuple of BendDone
        Its bends, in their order.
    bend_length : float, optional
        Length of the bends in mm for the total force; the model does not know it.
    """

    sequence: BendSequence
    bends: tuple[BendDone, ...]
    bend_length: float | None = None

    @property
    def with_strokes(self) -> BendSequence:
        """The sequence with the strokes of its bends in place of their angles."""
        done = tuple(replace(one.bend, angle=None, stroke=one.measures.stroke) for one in self.bends)
        return replace(self.sequence, bends=done)

    @property
    def strokes(self) -> dict[str, str]:
        """Paths of the strokes that were found for angles, by the names of these angles."""
        return self.sequence.strokes

    @property
    def strip(self) -> Strip:
        """The strip after the last bend, its first leg on x, in the order of the flat strip."""
        strip = Strip.of(self.bends[-1].result.model.mesh, self.bends[-1].result.model.u)
        near = strip.reference[:, 0, 0] <= self.sequence.sheet.thickness
        x = strip.middle[near]
        along = x[-1] - x[0]
        c, s = along / np.linalg.norm(along)
        return Strip(strip.reference, (strip.current - x[0]) @ np.array([[c, -s], [s, c]]), strip.order)

    @property
    def angles(self) -> list[float]:
        """Angle of each bend after the last one, in degrees."""
        return [self._sides(done.bend).angle for done in self.bends]

    @property
    def flanges(self) -> list[float]:
        """Outer lengths of the flanges from left to right: between the apices of bends, and to the ends."""
        placed = sorted((done.bend for done in self.bends), key=lambda bend: bend.position)
        sides = [self._sides(bend) for bend in placed]
        left = [side.right_leg if bend.over else side.left_leg for side, bend in zip(sides, placed, strict=True)]
        right = [side.left_leg if bend.over else side.right_leg for side, bend in zip(sides, placed, strict=True)]
        middle = self.strip.middle
        lengths = [float((middle[0] - sides[0].apex) @ left[0].direction)]
        for k in range(len(placed) - 1):
            along = right[k].direction - left[k + 1].direction
            lengths.append(float((sides[k + 1].apex - sides[k].apex) @ along / np.linalg.norm(along)))
        return [*lengths, float((middle[-1] - sides[-1].apex) @ right[-1].direction)]

    def _sides(self, bend: Bend) -> Sides:
        return self.strip.at(bend.position, over=bend.over).sides(self.sequence.zone(bend))

    def decks(self) -> dict[str, str]:
        """Decks of the bends by the names of their files: `umform run` of one after the other repeats the runs."""
        names = [f"bend{number}.toml" for number in range(1, len(self.bends) + 1)]
        befores = [None, *map(after, names)]
        return {name: done.problem.toml(before) for name, done, before in zip(names, self.bends, befores)}

    @property
    def length_balance(self) -> float:
        """Outer lengths of the flanges less the bend deductions less the flat length. eq. (5.92)"""
        return sum(self.flanges) - sum(done.measures.bend_deduction for done in self.bends) - self.sequence.length

    @property
    def title(self) -> str:
        """Heading of tables and pages."""
        sheet = self.sequence.sheet
        text = sheet_text(sheet.material, sheet.thickness)
        return f"Part of {len(self.bends)} bends: {text}, {self.sequence.length:g} mm long"

    @property
    def of_bends(self) -> dict[str, list[Quantity]]:
        """Measures of each bend by its number, and its angle after the last bend."""
        last = Quantity("angle after the last bend", "degrees", 2, name="final_angle", leading=True)
        found = {
            f"{number}": [*quantities_of(done.measures), replace(last, value=angle)]
            for number, (done, angle) in enumerate(zip(self.bends, self.angles, strict=True), start=1)
        }
        return {number: self._banded_as(number, row) for number, row in found.items()}

    def _banded_as(self, number: str, row: list[Quantity]) -> list[Quantity]:
        """Measures of a bend with their bands, which belong to their names in the list of the part."""
        before = f"bend {number}: "
        strain = next((one.value for one in row if one.name == "outer_strain"), None)
        at = studied_mesh(self.sequence.sheet, strain)
        banded = self.banded([prefixed(one, before) for one in row], at)
        own = [replace(one, band=other.band) for one, other in zip(row, banded, strict=True)]
        return of_this_mesh(self.sequence.sheet, own)

    @property
    def studied(self) -> StudiedMesh | None:
        """Mesh beside those of the studies, which are those of single bends."""
        return studied_mesh(self.sequence.sheet)

    @property
    def of_part(self) -> list[Quantity]:
        """Outer lengths of the flanges, and the length balance."""
        flanges = [
            Quantity(f"flange {number}, outer length", "mm", 3, name=f"flange {number}", value=length)
            for number, length in enumerate(self.flanges, start=1)
        ]
        balance = Quantity(
            "length balance", "mm", 4, name="length_balance", value=self.length_balance, hint="a check: near 0"
        )
        return self.banded([*flanges, balance], studied_mesh(self.sequence.sheet, process="bend sequence"))

    @property
    def quantities(self) -> list[Quantity]:
        """Those of the bends, and those of the part."""
        bends = [prefixed(one, f"bend {number}: ") for number, row in self.of_bends.items() for one in row]
        return [*bends, *self.of_part]

    @property
    def leading(self) -> list[Quantity]:
        """What the machine needs of each bend, the largest force of all, and the flanges."""
        found = {one.name: one for one in self.quantities}
        names = [f"bend {number}: {name}" for number in self.of_bends for name in ("stroke", "final_angle")]
        forces = [
            row[0] for row in ([one for one in row if one.name == "largest_force"] for row in self.of_bends.values())
        ]
        return [*map(found.__getitem__, names), max(forces, key=lambda one: one.value or 0.0), *self.of_part[:-1]]

    @property
    def main(self) -> list[str]:
        """Angles of the bends, and their springback."""
        return [f"bend {number + 1}: {name}" for name in ("angle", "springback") for number in range(len(self.bends))]

    @property
    def tables(self) -> dict[str, list[list[str]]]:
        """The bends side by side; the part."""
        return self._tables(self.of_bends)

    @property
    def short_tables(self) -> dict[str, list[list[str]]]:
        """The same with the leading numbers of the bends."""
        return self._tables({name: [one for one in row if one.leading] for name, row in self.of_bends.items()})

    def _tables(self, columns: Mapping[str, list[Quantity]]) -> dict[str, list[list[str]]]:
        header, *rows = side_by_side(columns, "bend")
        bends = [done.bend for done in self.bends]
        placed = [
            ["position", *(f"{bend.position:g}" for bend in bends), "mm"],
            ["direction", *(bend.direction for bend in bends), ""],
        ]
        return {"Bends": [header, *placed, *rows], "Part": table(self.of_part)}

    @property
    def notes(self) -> list[str]:
        """Tools of each bend, mesh, extrapolated flow curve."""
        sheet = self.sequence.sheet
        strain = max(done.measures.outer_strain for done in self.bends)
        tools = dict.fromkeys(tools_text(self.sequence.case(done.bend)) for done in self.bends)
        force = max(done.measures.largest_force for done in self.bends)
        total = [] if self.bend_length is None else [total_force(force, self.bend_length)]
        return [*tools, *coarse_mesh(sheet), *extrapolated(sheet, strain), *total]

    @property
    def stages(self) -> dict[str, Result]:
        """The runs of the bends."""
        return {f"bend {number}": done.result for number, done in enumerate(self.bends, start=1)}

    @property
    def profile(self) -> Floats:
        """Outline (n, 2) of the part: the lower face from left to right, then the upper face back."""
        return self.strip.outline

    @property
    def collisions(self) -> list[str]:
        """Collisions in words. A part that has any cannot be made in this way."""
        return [
            f"bend {number}: the part collides with the body of the {hit.tool} {when_and_where(done.bend, hit)}. The "
            "run went on as if that body were not there: the results of this bend and of those after it are invalid. "
            f"{REMEDY}"
            for number, done in enumerate(self.bends, start=1)
            for hit in done.collisions
        ]

    @property
    def warnings(self) -> list[str]:
        """Collisions, and warnings of the bends with their numbers."""
        others = [f"bend {number}: {text}" for number, done in enumerate(self.bends, start=1) for text in done.warnings]
        return [*self.collisions, *others]
