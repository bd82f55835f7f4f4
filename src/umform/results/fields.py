"""Fields of a converged state: stress and strain at the Gauss points, thickness, contact pressure, reactions."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property, partial

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.errors import InvalidValue, NoConvergence
from umform.history_variables import columns, history_of
from umform.mesh import FACE_NODES
from umform.model import Body, Evaluation, Model
from umform.results.point_places import positions

Floats = NDArray[np.float64]

#: Index pairs of the two products of a cross product.
_NEXT, _LAST = [1, 2, 0], [2, 0, 1]

#: Fields that have means in a cell; of the last one also the maximum.
_STRESSES = ("stress_cauchy", "stress_cauchy_local", "stress_pk2", "stress_pk2_local", "stress_von_mises")


@dataclass(frozen=True)
class PointFields:
    """Fields at the Gauss points, arrays (cells, points, ...); points run through the surface, then the thickness.

    Points over one place of the surface are a column. Their number in the thickness is not their height: columns may
    have heights of their own (docs/theory, 2.10). Take :meth:`at_height`.

    Attributes
    ----------
    E, S : ndarray, shape (cells, points, 6)
        Green-Lagrange strain (engineering shears) and second Piola-Kirchhoff stress in the local frame.
    frame : ndarray, shape (cells, points, 3, 3)
        Rows: base vectors e_1, e_2, e_3 of the local frame in the reference configuration.
    F : ndarray, shape (cells, points, 3, 3)
        Compatible deformation gradient in global axes.
    volume : ndarray, shape (cells, points)
        Reference volume of a point.
    history : mapping of str to ndarray, shape (cells, points, size)
        Parts of the history of the law by their names, ``history["Cp_inv"]`` for instance.
    heights : ndarray, shape (columns, layers)
        Heights t of the points, -1 in the lower face and 1 in the upper face of a cell.
    X, x : ndarray, shape (cells, points, 3)
        Positions of the points in the undeformed sheet and now.
    """

    E: Floats
    S: Floats
    frame: Floats
    F: Floats
    volume: Floats
    history: Mapping[str, Floats]
    heights: Floats
    _place: Callable[[bool], Floats] = field(repr=False)

    @cached_property
    def X(self) -> Floats:
        """Positions in the undeformed sheet (cells, points, 3)."""
        return self._place(False)

    @cached_property
    def x(self) -> Floats:
        """Positions now (cells, points, 3)."""
        return self._place(True)

    @property
    def eqps(self) -> Floats | None:
        """Accumulated plastic strain (cells, points) of laws that name it ``eqps``; None for others."""
        part = self.history.get("eqps")
        return None if part is None else part[..., 0]

    def stress(self, kind: str = "cauchy", frame: str = "global") -> Floats:
        """Stress at the Gauss points, Voigt order 11 22 33 12 23 13.

        Parameters
        ----------
        kind : {"cauchy", "pk2"}
            Cauchy stress, pushed forward with F := R U where U^2 = 1 + 2E is the assumed and enhanced strain of the
            element and R the rotation of its compatible deformation (eqs. (3.33), (3.34)), or second Piola-Kirchhoff.
        frame : {"global", "local"}
            Global axes, or the local frame: that of the reference configuration for pk2, turned with R for cauchy.

        Returns
        -------
        ndarray, shape (cells, points, 6)
        """
        if kind not in ("cauchy", "pk2") or frame not in ("global", "local"):
            raise InvalidValue(
                "stress is cauchy or pk2, in the global or local frame",
                where="stress",
                value=f"{kind}, {frame}",
                cause="another measure of stress, or another word",
                remedy='kind="cauchy", frame="global"',
            )
        if kind == "pk2":
            return self.S if frame == "local" else self._stresses[2]
        return self._stresses[0 if frame == "local" else 1]

    @cached_property
    def _stresses(self) -> tuple[Floats, ...]:
        """Cauchy stress in the local frame, which rotates with the sheet, and in global axes; S in global axes."""
        found = _core.point_stresses(self.E, self.S, self.frame, self.F)
        return tuple(stress.reshape(self.S.shape) for stress in found)

    def at_height(self, values: Floats, height: float | str) -> Floats:
        """Values (cells, columns, ...) at one height, from values (cells, points, ...).

        Parameters
        ----------
        values : ndarray
            At all points.
        height : float, "bottom" or "top"
            t from -1 to 1; linear between the points of a column, and beyond the last.

        Raises
        ------
        InvalidValue
            If the values are not those of all points, or the height is none.
        """
        values = self._at_points(values)
        t = {"bottom": -1.0, "top": 1.0}.get(height, height) if isinstance(height, str) else height
        if not isinstance(t, int | float | np.number) or not -1.0 <= t <= 1.0:
            raise InvalidValue(
                "a height is bottom, top or a number from -1 to 1",
                where="height",
                value=height,
                cause="a length, or another word",
                remedy="0 for the middle",
            )
        columns, layers = self.heights.shape
        above = np.array([np.clip(np.searchsorted(column, t), 1, layers - 1) for column in self.heights])
        at = np.arange(columns)
        low, high = self.heights[at, above - 1], self.heights[at, above]
        share = ((t - low) / (high - low)).reshape(-1, *([1] * (values.ndim - 2)))
        stacked = values.reshape(len(values), layers, columns, *values.shape[2:])
        found: Floats = (1.0 - share) * stacked[:, above - 1, at] + share * stacked[:, above, at]
        return found

    def cell_average(self, values: Floats) -> Floats:
        """Average over the volume of each cell of values (cells, points, ...).

        Raises
        ------
        InvalidValue
            If the values are not those of all points.
        """
        values = self._at_points(values)
        weight = self.volume / self.volume.sum(axis=1, keepdims=True)
        each = math.prod(values.shape[2:])  # A rank may have no cells of a body.
        average: Floats = (weight[:, None] @ values.reshape(*weight.shape, each))[:, 0]
        return average.reshape(len(weight), *values.shape[2:])

    def _at_points(self, values: Floats | None) -> Floats:
        array = np.asarray(values)
        if array.shape[:2] != self.volume.shape:
            raise InvalidValue(
                "values at points must have shape (cells, points, ...)",
                where="PointFields",
                value="None" if values is None else array.shape,
                cause="a part of the points, values of cells, or a law without this quantity",
                remedy=f"({self.volume.shape[0]}, {self.volume.shape[1]}, ...), such as stress() or history[name]",
            )
        return array


def point_fields(model: Model) -> PointFields:
    """Fields at the Gauss points of the converged state of a model of one body."""
    return body_fields(model.bodies.only, model.u)


def body_fields(body: Body, u: Floats) -> PointFields:
    """Fields at the Gauss points of the converged state of a body, at the displacement u, shape (3 n,)."""
    E, S, frame, F, volume = body.block.point_fields(u)
    t, columns = body.through[0], int(np.prod(body.element.surface_rule))
    heights = np.broadcast_to(t, (columns, np.shape(t)[-1]))
    place = partial(positions, body, heights, np.array(u))
    return PointFields(E, S, frame, F, volume, named_history(body), heights, place)


def named_history(body: Body) -> dict[str, Floats]:
    """Parts of the converged history of a body by their names, arrays (cells, points, size)."""
    return history_of(body.block)


def cell_fields(model: Model) -> dict[str, Floats]:
    """Fields of the cells of the converged state, arrays (cells, ...); zero in bodies whose law does not have one."""
    fields: dict[str, Floats] = {}
    for body in model.bodies:
        for name, values in (_cell_fields(body, model.u) | _of_law(body, model.u)).items():
            whole = fields.setdefault(name, np.zeros((len(model.mesh.connectivity), *values.shape[1:])))
            whole[body.cells] = values
    return fields


def _cell_fields(body: Body, u: Floats) -> dict[str, Floats]:
    """Means and maxima over the cells of all bodies, as `body_fields` gives them, with less memory."""
    names = list(_STRESSES)
    eqps = columns(body.block.history_variables).get("eqps")
    if eqps is not None:
        names += ["plastic_strain_mean", "plastic_strain_max"]
    try:
        found = body.block.cell_fields(u, -1 if eqps is None else eqps.start)
    except ValueError as error:  # of a converged state
        raise NoConvergence(
            "the stresses of a converged state are beyond the law",
            where=f"body {body.name}",
            value=str(error),
            cause="constants of the material in other units, or an increment of strain that is far too large",
            remedy="look at the material; smaller increments",
        ) from error
    return dict(zip(names, found, strict=True))


def _rolling(at: PointFields) -> Floats:
    """Rolling direction of each cell in its present state, unit vectors (cells, 3): the first local axis, turned by R.

    R is the rotation of the mean deformation gradient of the cell.
    """
    left, _, right = np.linalg.svd(at.cell_average(at.F))
    axis = at.cell_average(at.frame[:, :, 0])
    turned = np.einsum("cij,cj->ci", left @ right, axis)
    direction: Floats = turned / np.linalg.norm(turned, axis=1, keepdims=True)
    return direction


def _of_law(body: Body, u: Floats) -> dict[str, Floats]:
    """Means over the cells of what a law shows of its history, and its rolling direction."""
    shown = getattr(body.material, "shown", None)
    if shown is None and body.rolling is None:
        return {}
    at = body_fields(body, u)
    parts: Mapping[str, Floats] = shown(at.history) if shown is not None else {}
    cells = {
        name: at.cell_average(values[..., 0] if values.shape[2:] == (1,) else values) for name, values in parts.items()
    }
    return cells if body.rolling is None else cells | {"rolling": _rolling(at)}


def thickness(model: Model) -> Floats:
    """Thickness of the sheet at the nodes: distance of lower and upper node along the mid-surface normal, per layer.

    Both nodes of a pair carry the value of their pair; where layers are stacked, the mean of the layers.

    Returns
    -------
    ndarray, shape (n,)
    """
    return _thickness(model, model.positions)


def thickness_change(model: Model, before: Floats | None = None) -> Floats:
    """Relative change of the thickness at the nodes, negative where the sheet has thinned; shape (n,).

    Parameters
    ----------
    model : Model
        The model.
    before : ndarray, shape (n,), optional
        The thickness of the undeformed sheet, if it is known already, see `undeformed_thickness`.
    """
    return thickness(model) / (undeformed_thickness(model) if before is None else before) - 1.0


def undeformed_thickness(model: Model) -> Floats:
    """Thickness of the undeformed sheet at the nodes; shape (n,)."""
    return _thickness(model, model.mesh.points)


@cache
def _derivatives(half: int) -> Floats:
    """Derivatives of the shape functions in the middle of each pair of nodes, shape (3 half, 2 half)."""
    at_nodes = np.concatenate([FACE_NODES[:half], np.zeros((half, 1))], axis=1)
    derivatives: Floats = _core.shell_functions(2 * half, at_nodes)[1].reshape(3 * half, 2 * half)
    return derivatives


def _thickness(model: Model, x: Floats) -> Floats:
    cells = model.mesh.connectivity
    half = cells.shape[1] // 2
    g = (_derivatives(half) @ x[cells]).reshape(len(cells), half, 3, 3)
    r, s = g[:, :, 0], g[:, :, 1]
    normal = r[..., _NEXT] * s[..., _LAST] - r[..., _LAST] * s[..., _NEXT]
    along = np.einsum("eqk,eqk->eq", g[:, :, 2], normal)
    distance = (2.0 * np.abs(along) / np.sqrt(np.einsum("eqk,eqk->eq", normal, normal))).ravel()
    shares = np.zeros((len(x), 2))  # distances, and how many
    for side in (cells[:, :half].ravel(), cells[:, half:].ravel()):
        shares[:, 0] += np.bincount(side, distance, len(x))
        shares[:, 1] += np.bincount(side, minlength=len(x))
    total, count = model.system.whole.sum_at_nodes(shares).T
    thickness: Floats = total / np.maximum(count, 1.0)
    return thickness


def contact_at_nodes(model: Model, evaluation: Evaluation | None = None) -> tuple[Floats, Floats]:
    """Contact pressure (sum over the contacts) and gap (to the nearest tool or sheet, NaN off the faces) at the nodes.

    Parameters
    ----------
    model : Model
        The model, at a converged state.
    evaluation : Evaluation, optional
        The evaluation there; default what the contacts found last.

    Returns
    -------
    pressure, gap : ndarray, shape (n,)
    """
    pressure, gap = np.zeros(len(model.mesh.points)), np.full(len(model.mesh.points), np.nan)
    for contact in model.contacts:
        found = contact.found if evaluation is None else evaluation.found[contact]
        here, distance = contact.found_at_nodes(found, model.u, model.mesh, model.system.whole.sum_at_nodes)
        pressure += here
        gap = np.fmin(gap, distance)
    for sheets in model.system.sheet_contacts:
        at = sheets.found if evaluation is None else evaluation.found[sheets]
        here, distance = sheets.found_at_nodes(at, len(pressure))
        pressure += here
        gap = np.fmin(gap, distance)
    return pressure, gap


def friction_at_nodes(model: Model, evaluation: Evaluation | None = None) -> tuple[Floats, Floats]:
    """Tangential traction of tools and sheets, and distance slid along them, at the nodes of all contact faces.

    Parameters
    ----------
    model : Model
        The model, at a converged state.
    evaluation : Evaluation, optional
        The evaluation there; default what the contacts found last.

    Returns
    -------
    traction : ndarray, shape (n, 3)
        On the reference area; zero off the faces and without friction.
    slip : ndarray, shape (n,)
        Of points that are held.
    """
    traction, slip = np.zeros((len(model.mesh.points), 3)), np.zeros(len(model.mesh.points))
    for contact in model.system.pairs_of_tools():
        if not contact.has_friction:
            continue
        found = contact.found if evaluation is None else evaluation.found[contact]
        here, way = contact.friction_at_nodes(found, model.mesh, model.system.whole.sum_at_nodes)
        traction += here
        slip = np.maximum(slip, way)
    for sheets in (one for one in model.system.sheet_contacts if one.has_friction):
        at = sheets.found if evaluation is None else evaluation.found[sheets]
        here, way = sheets.friction_at_nodes(at, len(slip))
        traction += here
        slip = np.maximum(slip, way)
    return traction, slip


def contact_pressure(model: Model) -> Floats:
    """Contact pressure at the nodes of all contact faces; shape (n,)."""
    return contact_at_nodes(model)[0]
