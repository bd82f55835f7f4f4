"""The angle between the legs of a bend."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.model import Model
from umform.model.contact.encounter import sheet_thickness
from umform.problem.measures.base import FORMED, RELEASED, Formed, Measured, in_states
from umform.problem.measures.curves import Cut, section_drawn
from umform.problem.parts import Positive
from umform.report.symmetry import Mirror, mirrors_of_blank
from umform.results.forming import Leg, Section, angle_between
from umform.results.forming.sections import columns, horizontal

Floats = NDArray[np.float64]

#: Length of a leg in thicknesses: as `umform bend` measures it.
_THICKNESSES = 2.0


class Angle(Cut):
    """Angle between the two ends of a section: the legs of a bend."""

    numbers = ("angle", "springback", "bow of the legs")

    kind: Literal["angle"]
    leg: Positive | None = None
    """Length of the straight end of each leg in the undeformed sheet; default: two thicknesses, at least an element."""

    def check(self, model: Model, *, released: bool) -> None:
        """Refuse a plane that does not cut the sheet, and legs that are longer than half of it."""
        cut = self._cut(model, np.zeros_like(model.mesh.points))
        legs = self._legs(model, cut, mirrors_of_blank(model))
        whole = cut.s[-1] - cut.s[0]
        if len(legs) == 2 and self.leg is not None and self.leg > 0.5 * whole:
            raise InvalidValue(
                "the legs of a section do not overlap",
                where="leg",
                value=self.leg,
                remedy=f"less than {0.5 * whole:.4g}, half of the section",
            )

    def _legs(self, model: Model, cut: Section, planes: Sequence[Mirror]) -> list[Leg]:
        """The leg of half of a bend whose middle is in a plane of symmetry; otherwise both."""
        along = horizontal(self.normal)
        line, s = cut.line(along), cut.s
        length = self.leg or _THICKNESSES * sheet_thickness(model.mesh)
        least = 3 if model.mesh.cell == "hex18" else 2
        last = Leg.of(s, line, length, least)
        first = Leg.of(s[-1] - s[::-1], line[::-1], length, least)
        across = [plane for plane in planes if abs(along[plane.axis]) > 1.0 - 1e-9]
        if not across:
            return [first, last]
        near = abs(line[0, 0] - across[0].at) <= abs(line[-1, 0] - across[0].at)
        return [last if near else first]

    def take(self, name: str, part: Formed) -> Measured:
        """Angle in each state, springback, and how straight the legs are."""
        cuts = self._cuts(part)
        legs = {state: self._legs(part.model, cut, part.planes_of_blank) for state, cut in cuts.items()}
        angles = {state: _angle(found) for state, found in legs.items()}
        unit = part.units.length
        rows = [in_states("angle", "degrees", **angles)]
        if RELEASED in angles:
            rows.append(in_states("springback", "degrees", released=angles[RELEASED] - angles[FORMED]))
        bow = {state: max(one.deviation for one in found) for state, found in legs.items()}
        rows.append(in_states("bow of the legs", unit, **bow))
        points = np.concatenate([one.points for one in legs[part.last]])
        words = {"measured": "points of the legs", "title": f"{angles[part.last]:.2f} degrees"}
        draw = partial(section_drawn, cuts, self.normal, unit, points, **words)
        caption = "Section of the part in its states; the points are those of the legs whose lines make the angle."
        return Measured(rows, columns(cuts), draw, caption)


def _angle(legs: Sequence[Leg]) -> float:
    """Angle between two legs, or between one and its mirror image."""
    one = legs[0].direction
    return angle_between(one, one * np.array([-1.0, 1.0]) if len(legs) == 1 else legs[1].direction)
