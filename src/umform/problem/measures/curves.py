"""Measures that are curves: sections, springback of a hat, draw-in, ears."""

from __future__ import annotations

from functools import partial
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.mesh import Ids, Mesh
from umform.model import Model
from umform.problem.measures.base import FORMED, RELEASED, Formed, Measured, MeasurePart, Row, in_states
from umform.problem.measures.hat import halves
from umform.problem.notes import Discriminator, Field, Tag
from umform.problem.parts import Positive, Vector
from umform.problem.selection import Selection, nodes_of
from umform.report.symmetry import mirrors_of_blank
from umform.results.forming import NUMBER_OF_EARS, Section, UBendAngles, draw_in, ear_profile, section
from umform.results.forming.sections import columns, horizontal
from umform.results.forming.u_bend import HEIGHTS, crossing

Floats = NDArray[np.float64]

#: Least part of the circle that the rim of a cup covers, in degrees.
_AROUND = 40.0

_Three = tuple[Positive, Positive, Positive]


class Cut(MeasurePart):
    """Plane of a section in the undeformed sheet."""

    point: Vector | None = None
    """A point of the plane in the undeformed sheet; default: in the planes of symmetry, else in the middle."""
    normal: Vector = (0.0, 1.0, 0.0)
    """Normal of the plane, in the plane of the blank; default: along y."""

    def check(self, model: Model, *, released: bool) -> None:
        """Refuse a plane that does not cut the sheet."""
        self._cut(model, np.zeros_like(model.mesh.points))

    def _cut(self, model: Model, u: Floats) -> Section:
        mesh, through = model.mesh, self.point
        if through is None:
            middle = 0.5 * (mesh.points.min(axis=0) + mesh.points.max(axis=0))
            at = {plane.axis: plane.at for plane in mirrors_of_blank(model)}
            through = (at.get(0, middle[0]), at.get(1, middle[1]), at.get(2, middle[2]))
        horizontal(self.normal)  # refuses a plane along the sheet
        return section(mesh, u, through, self.normal)

    def _cuts(self, part: Formed) -> dict[str, Section]:
        return {state: self._cut(part.model, part.from_blank(state)) for state in part.states}


class SectionCurve(Cut):
    """A section of the part in the tools and released."""

    numbers = ("length of the mid-surface", "largest displacement by the release")

    kind: Literal["section"]

    def take(self, name: str, part: Formed) -> Measured:
        """Both skins in each state, and how far the release moves them."""
        cuts, unit = self._cuts(part), part.units.length
        rows = [in_states("length of the mid-surface", unit, **{state: cut.length for state, cut in cuts.items()})]
        if RELEASED in cuts:
            moved = np.linalg.norm(cuts[RELEASED].middle - cuts[FORMED].middle, axis=1)
            rows.append(in_states("largest displacement by the release", unit, released=float(moved.max())))
        return Measured(rows, columns(cuts), partial(section_drawn, cuts, self.normal, unit), _CAPTION)


_CAPTION = "Section of the part at the end of forming and, if it is released, out of the tools."


class Springback(Cut):
    """Angles and side-wall radius of a hat section as NUMISHEET 93 defines them."""

    numbers = ("theta1", "theta2", "radius of the wall")

    kind: Literal["springback"]
    heights: _Three = HEIGHTS
    """Heights above the bottom at which the wall is measured, rising; by default 15, 35 and 55, as in NUMISHEET 93."""

    def check(self, model: Model, *, released: bool) -> None:
        """Refuse a plane that does not cut the sheet, and heights that do not rise."""
        super().check(model, released=released)
        if not self.heights[0] < self.heights[1] < self.heights[2]:
            raise InvalidValue(
                "the heights at which the wall is measured rise from the bottom",
                where="heights",
                value=", ".join(f"{height:g}" for height in self.heights),
                cause="another order, or a height twice",
                remedy=f"heights = {sorted(set(self.heights))}" if len(set(self.heights)) == 3 else "three heights",
            )

    def take(self, name: str, part: Formed) -> Measured:
        """Both angles and the radius in each state; of a whole hat, those of both of its sides."""
        cuts, along = self._cuts(part), horizontal(self.normal)
        found: dict[str, dict[str, UBendAngles]] = {}
        wall: list[Floats] = []
        for state, cut in cuts.items():
            for half in halves(cut, along, part.planes_of_blank):
                found.setdefault(half.side, {})[state] = half.angles(self.heights, state)
                if state == part.last:
                    wall += [half.place(crossing(half.line, height)) for height in self.heights]
        rows = [row for side, states in found.items() for row in _angle_rows(states, side, part.units.length)]
        first = next(iter(found.values()))[part.last]
        title = f"{first} {part.units.length}".rstrip()
        draw = partial(section_drawn, cuts, self.normal, part.units.length, np.array(wall), title=title)
        caption = f"{_CAPTION} Heights of the points of the wall: {', '.join(f'{h:g}' for h in self.heights)}."
        return Measured(rows, columns(cuts), draw, caption)


class DrawIn(MeasurePart):
    """Outline of an edge of the blank and how far it is drawn in, at the end of forming."""

    numbers = ("draw-in, mean", "draw-in, largest", "draw-in, least", "draw-in, at ")

    kind: Literal["draw_in"]
    edge: Annotated[
        Annotated[list[Selection], Tag("several"), Field(min_length=1)] | Annotated[Selection, Tag("one")],
        Discriminator(lambda value: "several" if isinstance(value, list) else "one"),
    ] = "rim"
    """Nodes of the edge, or several selections; default: the set rim."""

    def check(self, model: Model, *, released: bool) -> None:
        """Refuse an edge without nodes, and nodes that are no edge."""
        draw_in(model.mesh, np.zeros_like(model.mesh.points), self._nodes(model.mesh))

    def _nodes(self, mesh: Mesh) -> Ids:
        chosen = self.edge if isinstance(self.edge, list) else [self.edge]
        return np.unique(np.concatenate([nodes_of(mesh, one) for one in chosen]))

    def take(self, name: str, part: Formed) -> Measured:
        """Draw-in along the edge: mean, extremes, and at the ends of an open edge."""
        from umform.report.part_pictures import outline_picture

        mesh, unit = part.model.mesh, part.units.length
        edge = draw_in(mesh, part.from_blank(FORMED), self._nodes(mesh))
        named = {"mean": edge.mean(), "largest": edge.draw_in.max(), "least": edge.draw_in.min()}
        if np.ptp(edge.draw_in) < 1e-6 * np.abs(edge.draw_in).max():
            named = {"mean": edge.mean()}  # it says all
        elif len(edge.pieces) > 1:
            for piece in edge.pieces:
                named[f"mean around {_at(edge.before[piece].mean(axis=0))} of the blank"] = edge.mean(piece)
        elif not edge.is_closed:
            for k in (0, -1):
                named[f"at {_at(edge.before[k])} of the blank"] = edge.draw_in[k]
        rows = [in_states(f"draw-in, {what}", unit, formed=float(value)) for what, value in named.items()]
        low, high = np.sort(np.ptp(edge.before, axis=0))
        caption = "Edge of the blank, and where it is at the end of forming."
        return Measured(rows, edge.columns(), partial(outline_picture, edge, unit, equal=low > 0.1 * high), caption)


class Ears(MeasurePart):
    """Ear profile of a cup about the z-axis."""

    numbers = (
        *("height, mean", "height, lowest", "height, highest"),
        *("amplitude of ", "ears count from an amplitude of", NUMBER_OF_EARS),
    )

    kind: Literal["ears"]
    rim: Selection = "rim"
    """Nodes of the edge of the blank; default: the set rim."""

    def check(self, model: Model, *, released: bool) -> None:
        """Refuse a rim that does not go around the z-axis."""
        ids = nodes_of(model.mesh, self.rim)
        x, y = model.mesh.points[ids, :2].T
        angle = np.sort(np.degrees(np.arctan2(y, x)))
        covered = 360.0 - float(np.diff(angle, append=angle[0] + 360.0).max())
        if covered < _AROUND or np.hypot(x, y).min() < 0.2 * np.hypot(x, y).max():
            raise InvalidValue(
                "the rim of a cup goes around the z-axis",
                where="rim",
                value=f"{len(ids)} nodes over {covered:.3g} degrees",
                cause="a part that is no cup, or one whose axis lies elsewhere",
                remedy="the edge of a blank about the z-axis: a quarter of it at least",
            )

    def take(self, name: str, part: Formed) -> Measured:
        """Heights over the angle: mean, extremes, amplitudes of the waves, and ears of a metal with directions."""
        from umform.report.part_pictures import ears_picture

        mesh, unit = part.model.mesh, part.units.length
        ids = nodes_of(mesh, self.rim)
        profiles = {state: ear_profile(mesh, part.from_blank(state), ids) for state in part.states}
        numbers = {state: one.heights() | one.waves() for state, one in profiles.items()}
        rows = [in_states(what, unit, **{s: row[what] for s, row in numbers.items()}) for what in numbers[part.last]]
        if any(getattr(body.material, "directional", False) for body in part.model.bodies):
            rows.append(in_states(NUMBER_OF_EARS, "", **{s: float(len(one.ears())) for s, one in profiles.items()}))
        last = profiles[part.last]
        curve, draw = {"angle": last.angle, "height": last.height}, partial(ears_picture, last, unit)
        return Measured(rows, curve, draw, "Height of the cup over the angle to the x-axis.")


def _at(place: Floats) -> str:
    x, y = place + 0.0
    return f"({x:.4g}, {y:.4g})"


def section_drawn(
    cuts: dict[str, Section], normal: Vector, unit: str, points: Floats | None = None, **words: str
) -> Any:
    """Picture of a section in its states, with measured points and words of :func:`section_picture`."""
    from umform.report.part_pictures import section_picture

    return section_picture(cuts, horizontal(normal), unit, points=points, **words)


def _angle_rows(states: dict[str, UBendAngles], side: str, unit: str) -> list[Row]:
    """Rows of one side of a hat."""
    named = (("theta1", "theta1", "degrees"), ("theta2", "theta2", "degrees"), ("radius of the wall", "radius", unit))
    return [
        in_states(quantity + side, of, **{state: getattr(angles, name) for state, angles in states.items()})
        for quantity, name, of in named
    ]
