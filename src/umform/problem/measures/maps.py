"""Measures that are maps over the part: distance from a tool, from its gauge, fields of forming."""

from __future__ import annotations

from functools import partial
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.mesh import Mesh
from umform.model import Model
from umform.problem.measures.base import FORMED, RELEASED, Formed, Measured, MeasurePart, in_states
from umform.problem.notes import Field
from umform.problem.parts import Name, Positive, Vector
from umform.report.symmetry import with_images
from umform.results.forming import Laid, distance_from, forming_fields, lay_by_best_fit, lay_on_three_points

Floats = NDArray[np.float64]


class Distance(MeasurePart):
    """Distance of the part from a tool where it stands, and after the release where it stood last."""

    numbers = ("least distance", "largest distance", "mean distance")

    kind: Literal["distance"]
    tool: Name
    """Name of the tool; a tool that no contact has stands where the deck puts it."""
    within: Positive | None = None
    """Larger distances are left out of the numbers, and have the last colour of the picture."""

    fit: bool = False
    """Lay the released part by the best fit into its shape at the end of forming; by default it lies where its supports
    hold it."""

    def take(self, name: str, part: Formed) -> Measured:
        """Signed distance at all nodes in each state, of the side of the sheet that is nearer to the tool."""
        from umform.report.part_pictures import coloured, of_unit

        mesh, unit = part.model.mesh, part.units.length
        rows_of = {FORMED: part.row, RELEASED: part.row + 1}
        found = {state: self._distance(part, rows_of[state], part.places(state)) for state in part.states}
        for frame in part.result.frames:
            x = mesh.points + frame.points["displacement"]
            frame.points[field_of(name)] = self._distance(part, frame.number, x)
        near = {state: d[d <= (self.within or np.inf)] for state, d in found.items()}
        rows = [
            in_states(what, unit, **{state: float(number(d)) if len(d) else None for state, d in near.items()})
            for what, number in (("least distance", np.min), ("largest distance", np.max), ("mean distance", np.mean))
        ]
        last, limits = found[part.last], None
        if self.within is not None:
            limits = (min(float(last.min()), 0.0), min(float(last.max()), self.within))
        shape, label = part.shape(part.last, distance=last), of_unit(f"distance from {self.tool}", unit)
        caption = f"Distance of the part ({part.last}) from {self.tool}, where it stands at the end of forming."
        return Measured(rows, _table(mesh, found), partial(coloured, shape, "distance", label, limits), caption)

    def _distance(self, part: Formed, row: int, x: Floats) -> Floats:
        """Distance in a row of the history; beyond the end of forming the tool stays, and the part may be laid."""
        if row > part.row and self.fit:
            gauge = with_images(part.places(FORMED), part.planes)
            x = lay_by_best_fit(with_images(x, part.planes), gauge).points[: len(x)]
        tool = part.tool(self.tool)
        if tool is None:
            distance: Floats = part.problem.tools[self.tool].kernel().gap(np.ascontiguousarray(x))[0]
        else:
            distance = distance_from(tool, x, part.result.rows[min(row, part.row)])
        return _nearer_side(part.model.mesh, distance)


class Gauge(MeasurePart):
    """The released part, laid as a rigid body into a gauge of its shape at the end of forming."""

    numbers = ("largest distance from the gauge", "mean distance from the gauge")

    kind: Literal["gauge"]
    points: Annotated[list[Vector], Field(min_length=3, max_length=3)] | None = None
    """Three points of the blank that the part lies on, each the nearest node; default: the best fit of all points."""

    def check(self, model: Model, *, released: bool) -> None:
        """Refuse a part that is not released, and points that are no three or lie on a line."""
        if not released:
            raise InvalidValue(
                "a part is laid into its gauge when it is released",
                where="gauge",
                cause="the last step is none of the kind release or free",
                remedy="such a step at the end, or no measure of this kind",
            )
        self._lay(model.mesh.points, model.mesh.points, model.mesh.points)

    def _lay(self, blank: Floats, part: Floats, gauge: Floats) -> Laid:
        if self.points is None:
            return lay_by_best_fit(part, gauge)
        near = [int(np.argmin(((blank - np.array(point)) ** 2).sum(axis=1))) for point in self.points]
        if len(set(near)) < 3:
            raise InvalidValue(
                "a part lies on three different points of it",
                where="points",
                value="the nearest nodes "
                + "; ".join("({:.4g}, {:.4g}, {:.4g})".format(*(blank[k] + 0.0)) for k in near),
                cause="two points within an element, or beside the sheet",
                remedy="three points of a large triangle of the blank",
            )
        return lay_on_three_points(part, gauge, near)

    def take(self, name: str, part: Formed) -> Measured:
        """Distance of each node from its place in the gauge; the whole part is laid, with its mirror images."""
        from umform.report.part_pictures import gauge_picture

        if RELEASED not in part.states:
            raise InvalidValue(
                "the part was not released: it cannot be laid into its gauge",
                where="gauge",
                cause="the run ended before its last steps",
                remedy="see the warning of the run",
            )
        mesh, unit, planes = part.model.mesh, part.units.length, part.planes
        blank, gauge = with_images(mesh.points, part.planes_of_blank), with_images(part.places(FORMED), planes)
        count = len(mesh.points)
        for frame in part.result.frames:
            distance = np.zeros(count)
            if frame.number > part.row:
                places = with_images(mesh.points + frame.points["displacement"], planes)
                distance = self._lay(blank, places, gauge).distance[:count]
            frame.points[field_of(name)] = distance
        laid = self._lay(blank, with_images(part.places(RELEASED), planes), gauge)
        rows = [
            in_states("largest distance from the gauge", unit, released=laid.largest),
            in_states("mean distance from the gauge", unit, released=float(laid.distance.mean())),
        ]
        how = "by the best fit" if self.points is None else "on three points"
        shape, shown = part.shape(RELEASED), part.shown(laid)
        caption = f"The whole part in a gauge of its shape at the end of forming: {how}."
        columns = _table(mesh, {"distance": laid.distance[:count]})
        return Measured(rows, columns, partial(gauge_picture, {how: shown}, shape, unit), caption)


class Map(MeasurePart):
    """A field of forming over the part."""

    numbers = ("largest ", "least ")

    kind: Literal["map"]
    field: Literal[
        "thinning", "wrinkling", "thickness_strain", "major_lower", "major_middle", "major_upper", "minor_lower",
        "minor_middle", "minor_upper",
    ]  # fmt: skip
    """Thinning in per cent, the indicator of wrinkling, or a logarithmic strain."""

    def take(self, name: str, part: Formed) -> Measured:
        """Its extremes in each state."""
        from umform.report.part_pictures import coloured

        mesh = part.model.mesh
        found = {state: forming_fields(mesh, u)[self.field] for state, u in part.states.items()}
        unit = "%" if self.field == "thinning" else ""
        label = self.field.replace("_", " ") + (" in %" if unit else "")
        rows = [in_states(f"{what} {self.field}", unit, **{state: float(number(f)) for state, f in found.items()})
                for what, number in (("largest", np.max), ("least", np.min))]  # fmt: skip
        middle = mesh.points[mesh.connectivity].mean(axis=1)
        columns = dict(zip("xyz", middle.T, strict=True)) | found
        shape = part.shape(part.last, **{self.field: found[part.last]})
        caption = f"{label[0].upper()}{label[1:]} of the part ({part.last})."
        return Measured(rows, columns, partial(coloured, shape, self.field, label), caption)


def field_of(name: str) -> str:
    """Name of the field of a measure in frames, reports and VTKHDF files."""
    return f"distance_{name}"


def _table(mesh: Mesh, found: dict[str, Floats]) -> dict[str, Floats]:
    """Columns: places of the nodes in the blank, and values."""
    return dict(zip("xyz", mesh.points.T, strict=True)) | found


def _nearer_side(mesh: Mesh, distance: Floats) -> Floats:
    """At each node the least value of all nodes of its fibre through the thickness."""
    lower, upper = (side.ravel() for side in np.split(mesh.connectivity, 2, axis=1))
    least = distance.copy()
    while True:  # once for each layer
        pair = np.minimum(least[lower], least[upper])
        if np.array_equal(pair, least[lower]) and np.array_equal(pair, least[upper]):
            return least
        np.minimum.at(least, lower, pair)
        np.minimum.at(least, upper, pair)
