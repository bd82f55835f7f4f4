"""Trimming: remove the elements on one side of a line.

The part keeps its state. The forces of the removed metal become a dead load, which the next operation reduces to zero.
docs/operations.md
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import EmptySet, InvalidValue, MeshError
from umform.mesh import Mesh
from umform.mesh.fitted.layer import fitted_layer
from umform.mesh.fitted.sheet import Sheet
from umform.mesh.part import joined_by_faces, part_of_mesh, sheets_of, stacks
from umform.model.model import Model
from umform.model.transfer.moved_state import refuse_unknown
from umform.model.transfer.part import ModelPart
from umform.surfaces import Extruded, Profile

Floats = NDArray[np.float64]

#: Coordinates of a view along an axis.
_EDGES = ("line", "elements")
_VIEWS = {"x": (1, 2), "y": (0, 2), "z": (0, 1)}
_STEP = 1e-6
#: Distance from the line that counts as zero, relative to the size of the sheet.
_ON = 1e-9
#: Largest share of the cells that stay in pieces that hang by an edge or a node: they are the teeth of a slanting cut.
_TEETH = 0.05

#: A profile, corners of an open polyline, or a function that is negative on the part.
Line = Profile | Sequence[tuple[float, float]] | Callable[[Floats, Floats], ArrayLike]


class AtItsEnd(Protocol):
    """A result of a run."""

    @property
    def model(self) -> Model:
        """Its model, at the end of the run."""


@dataclass(frozen=True)
class Trim:
    """A cut along a line.

    The elements near the line are replaced by a layer of elements that ends on it, eqs. (1.28)-(1.34). Where this is
    not possible (18-node elements, laws whose history is unknown, an energy that would change by more than 2 %), the
    edge follows elements, and the remark of the part says why. Elements stacked through the thickness are kept or
    removed together.

    Parameters
    ----------
    line : Profile, sequence of (x, y) or callable
        Lines and arcs in the view; the part is on the left of the direction of travel: the inside of a
        counter-clockwise curve, the outside of a clockwise one, which cuts a hole. The first and the last line of an
        open one extend to infinity. Or corners of such an open one; or a function of two arrays of coordinates that is
        negative on the part.
    view : {"z", "x", "y"}
        Direction of the view: the coordinates of the line are x, y; y, z; or x, z.
    formed : bool
        Whether the line is given on the formed part, or on the flat blank.
    edge : {"line", "elements"}
        Whether the new edge lies on the line, by a layer of new elements that take their state from the sheet, or
        follows edges of elements, which keep theirs.

    Raises
    ------
    InvalidValue
        If the line is invalid, or the view is no axis.

    Examples
    --------
    A part from 0 to 7.5 along x of a bent strip:

    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp = model.fix("x0")
    >>> tip = model.prescribe("x1_lower", "z", name="tip")
    >>> result = uf.solve(model, uf.Move(tip, to=-0.1, steps=2))
    >>> part = uf.Trim([(7.5, -1.0), (7.5, 2.0)]).of(result)
    >>> len(part.mesh.connectivity)
    6
    """

    line: Line
    view: str = "z"
    formed: bool = True
    edge: str = "line"

    def __post_init__(self) -> None:
        if self.edge not in _EDGES:
            raise InvalidValue(
                "the edge of a part lies on the line or follows elements",
                where="Trim, edge",
                value=self.edge,
                cause="a typing error",
                remedy='edge="line" or edge="elements"',
            )
        if self.view not in _VIEWS:
            raise InvalidValue(
                "a part is trimmed in a view along x, y or z",
                where="Trim, view",
                value=self.view,
                cause="a vector in place of an axis",
                remedy="x, y or z: turn the part before, if it lies in another direction",
            )
        if not callable(self.line):
            self._tool().kernel()

    def of(self, before: Model | AtItsEnd) -> ModelPart:
        """The remaining part of a sheet.

        Parameters
        ----------
        before : Result or Model
            A run at its end, or a model at a converged state.

        Raises
        ------
        EmptySet
            If the line does not cut the sheet, or nothing remains.
        MeshError
            If what is left is in pieces, or hangs together by edges or nodes. Cells that hang so are cut off too where
            they are few.
        """
        model = before if isinstance(before, Model) else before.model
        mesh, sheet = model.mesh, self._in_view(model)
        kept = self._kept(mesh, sheet)
        self._refuse(kept, sheet)
        part = part_of_mesh(mesh, kept)
        dropped = 0
        number = sheets_of(mesh)
        sheets = len(np.unique(number[kept]))
        if part.pieces == sheets:
            hanging = np.concatenate([_hanging(mesh, kept & (number == one)) for one in np.unique(number[kept])])
            dropped = len(hanging)
            if dropped:
                kept[hanging] = False
                part = part_of_mesh(mesh, kept)
        if part.pieces > sheets:
            raise MeshError(
                "the line leaves the part in pieces that hang together nowhere",
                where="Trim",
                value=f"{part.pieces} pieces",
                cause="a line that crosses the sheet twice, or metal beside the part that is to be cut off as well",
                remedy="trim along one line after the other, or along a closed curve around one piece",
            )
        edge = float(np.abs(self._met(sheet[part.nodes[part.mesh.nodes("cut")]])[0]).max())
        if self.edge == "elements" or edge <= _ON * float(np.ptp(sheet, axis=0).max()):
            return ModelPart.of(model, part, edge, dropped)
        if number.any():
            return ModelPart.of(model, part, edge, dropped, "there are several sheets")
        try:
            return self._fitted(model, sheet, kept, dropped)
        except MeshError as error:
            return ModelPart.of(model, part, edge, dropped, f"{error.what} ({error.value or error.where})")

    def _fitted(self, model: Model, view: Floats, kept: NDArray[np.bool_], dropped: int) -> ModelPart:
        """The part with its edge on the line."""
        refuse_unknown(model)
        sheet = Sheet.of(model.mesh)
        x = view[sheet.nodes[:, [0, -1]]].mean(axis=1)
        layer = fitted_layer(sheet, x, kept[sheet.cells[:, 0]], self._met)
        part = ModelPart.fitted(model, sheet, x, layer, 0.0, dropped)
        made = Sheet.of(part.mesh)
        there = self._in_view(part.model)[made.nodes[:, [0, -1]]].mean(axis=1)
        on = np.isin(made.nodes[:, 0], part.mesh.nodes("cut"))
        return replace(part, edge_distance=float(np.abs(self._met(there[on])[0]).max()))

    def _in_view(self, model: Model) -> Floats:
        points = model.mesh.points
        if self.formed:
            points = points + model.u.reshape(-1, 3)
        return np.ascontiguousarray(points[:, _VIEWS[self.view]])

    def _kept(self, mesh: Mesh, sheet: Floats) -> NDArray[np.bool_]:
        """Mask of the cells whose stack has its centre on the kept side."""
        stack = stacks(mesh)
        count = np.bincount(stack)
        centres = sheet[mesh.connectivity].mean(axis=1)
        means = np.stack([np.bincount(stack, centres[:, k]) / count for k in range(2)], axis=1)
        kept: NDArray[np.bool_] = (self._values(means) <= 0.0)[stack]
        return kept

    def _refuse(self, kept: NDArray[np.bool_], sheet: Floats) -> None:
        if not kept.all() and kept.any():
            return
        low, high = sheet.min(axis=0), sheet.max(axis=0)
        extent = " to ".join(f"({x:.4g}, {y:.4g})" for x, y in (low, high))
        raise EmptySet(
            "the line removes the whole sheet" if not kept.any() else "the line cuts nothing off",
            where=f"Trim in the view along {self.view}",
            value=f"the sheet lies from {extent}",
            cause="a line that misses the sheet, other coordinates, or the wrong side of the line"
            if not kept.any()
            else "a line that misses the sheet, or other coordinates",
            remedy="the part lies to the left of the direction of the line: its corners in the reverse order, or "
            "profile.reversed(), exchange the sides",
        )

    def _tool(self) -> Extruded:
        """The line as a surface: its kernel has the signed distance."""
        line = self.line
        if not isinstance(line, Profile):
            try:
                corners = np.asarray(line, dtype=float)
            except (TypeError, ValueError):
                corners = np.empty(0)
            if corners.ndim != 2 or corners.shape[1] != 2 or len(corners) < 2:
                raise InvalidValue(
                    "a line has two corners (x, y) or more",
                    where="Trim, line",
                    value=line,
                    remedy="[(x, y), (x, y)], a Profile, or a function of x and y",
                )
            line = Profile.from_corners([(float(x), float(y)) for x, y in corners], closed=False)
        return Extruded(line, x="x", y="y")

    def _values(self, xy: Floats) -> Floats:
        """Negative on the kept side; the signed distance of a line."""
        if callable(self.line):
            values = np.asarray(self.line(xy[:, 0], xy[:, 1]), dtype=float)
            if values.shape != (len(xy),) or not np.isfinite(values).all():
                raise InvalidValue(
                    "the function of a line gives a finite number for each place",
                    where="Trim, line",
                    value=f"shape {values.shape}",
                    remedy="a function of two arrays x, y that gives an array, negative where the part stays",
                )
            return values
        return self._tool().gap(np.column_stack([xy, np.zeros(len(xy))]))[0]

    def _met(self, xy: Floats) -> tuple[Floats, Floats]:
        """Distance from the line and its normal; for a function its value over its slope, to first order."""
        if not callable(self.line):
            distance, normal, _ = self._tool().gap(np.column_stack([xy, np.zeros(len(xy))]))
            return distance, normal[:, :2]
        step = _STEP * max(float(np.ptp(xy, axis=0).max()), 1e-3)
        shifts = step * np.eye(2)
        slope = np.stack([self._values(xy + s) - self._values(xy - s) for s in shifts], axis=1) / (2.0 * step)
        steep = np.maximum(np.linalg.norm(slope, axis=1), 1e-300)
        return np.asarray(self._values(xy) / steep), np.asarray(slope / steep[:, None])


def _hanging(mesh: Mesh, kept: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Cells that stay and share edges or nodes at most with the largest piece.

    Raises
    ------
    MeshError
        If these are more than teeth of the cut.
    """
    cells = np.flatnonzero(kept)
    piece = joined_by_faces(mesh, cells)
    sizes = np.bincount(piece)
    hanging: NDArray[np.int64] = cells[piece != np.argmax(sizes)]
    if len(hanging) > _TEETH * len(cells):
        raise MeshError(
            "the line leaves pieces that hang together by an edge or a node",
            where="Trim",
            value=f"{len(sizes)} pieces, {len(hanging)} of {len(cells)} elements beside the largest one",
            cause="a cut that nearly meets itself or the edge of the sheet",
            remedy="a line that stays two elements away from others, or smaller elements there",
        )
    return hanging
