"""The state of a formed part on meshes that other programs have: shells of four nodes, or layers of solids of eight.

The forces and moments of a section are those of umform: the stress at the new points is interpolated, and gets a
constant and a linear part through the thickness that restore them. docs/other-programs.md
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.errors import InvalidValue
from umform.io.states.state import AXES, FormedState
from umform.mesh import FACE_NODES
from umform.model import Body, Model
from umform.results.fields import PointFields, body_fields

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Quadrilaterals of a face with four and with nine nodes, and its middle nodes where they are vertices.
_QUADS = {4: [[0, 1, 2, 3]], 9: [[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]]}
_FIRST, _SECOND = (np.array(axes) for axes in zip(*AXES, strict=True))
Points = Literal[1, 8]
Rule = Literal["gauss", "even"]


@dataclass(frozen=True)
class _Grid:
    """Where a cell of umform is evaluated: places in the surface, heights over each of them.

    Attributes
    ----------
    places : ndarray, shape (places, 2)
        Natural coordinates r, s.
    reach : float
        Values are means over squares of this half-width around the places; 0: values at the places.
    heights : ndarray, shape (heights,)
        Natural coordinates t.
    weights, moments : ndarray, shape (heights,)
        Weights of the heights for forces and for moments, in the rule of the other program.
    curved : bool
        Whether an area of the section follows the height, as in solids; the sections of a shell have one area.
    """

    places: Floats
    reach: float
    heights: Floats
    weights: Floats
    moments: Floats
    curved: bool


def formed_shells(model: Model, points: int, units: str = "", rule: Rule = "gauss") -> FormedState:
    """Shells of four nodes on the middle surface, with points through the thickness.

    A cell with nine nodes in a face becomes four flat shells.

    Parameters
    ----------
    model : Model
        A model in a converged state.
    points : int
        Points through the thickness, 2 to 20.
    units : str
        For the head of the file.
    rule : {"gauss", "even"}
        Gauss points; or evenly spaced from face to face, with the weights of a stress that is linear between them.

    Raises
    ------
    InvalidValue
        If the model was not solved, or has layers of cells, which are no shell.
    """
    if points not in range(2, 21):
        raise InvalidValue(
            "a shell has 2 to 20 points through the thickness",
            where="points",
            value=points,
            cause="a fraction, or the points of all layers",
            remedy="5",
        )
    _refuse_virgin(model)
    lower, upper = np.split(model.mesh.connectivity.astype(np.int64), 2, axis=1)
    if np.intersect1d(lower, upper).size:
        raise InvalidValue(
            "cells stacked through the thickness are no shell",
            where="shells",
            cause="the upper nodes of some cells are lower nodes of others",
            remedy="write solids instead",
        )
    x = model.positions
    quads = np.array(_QUADS[lower.shape[1]])
    t, w, moments = shell_rule(points, rule)
    corners = FACE_NODES[: lower.shape[1]][quads]
    grid = _Grid(corners.mean(axis=1), _half_width(quads), t, w, moments, curved=False)
    stress, strain, plastic, _ = _on_grid(model, grid)
    used, cells = np.unique(lower[:, quads].reshape(-1, 4), return_inverse=True)
    partner = np.zeros(len(x), dtype=np.int64)
    partner[lower] = upper
    director = x[partner[used]] - x[used]
    cells = cells.reshape(-1, 4)
    middle = 0.5 * (x[used] + x[partner[used]])
    sides = middle[cells]
    normal = np.cross(sides[:, 2] - sides[:, 0], sides[:, 3] - sides[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return FormedState(
        points=middle,
        cells=cells,
        parts=np.repeat(_parts(model), len(quads)),
        stress=stress.reshape(-1, points, 6),
        plastic=plastic.reshape(-1, points),
        strain=strain.reshape(-1, points, 6),
        thickness=np.einsum("eqk,ek->eq", director[cells], normal),
        heights=t,
        units=units,
    )


def shell_rule(points: int, rule: Rule) -> tuple[Floats, Floats, Floats]:
    """Heights of the points of a shell from -1 to 1, and their weights for forces and for moments."""
    if rule == "gauss":
        t, w = map(np.asarray, _core.gauss(points))
        return t, w, w * t
    t, size = np.linspace(-1.0, 1.0, points), 2.0 / (points - 1)
    weights, moments = np.full(points, size), size * t
    weights[[0, -1]] *= 0.5
    moments[[0, -1]] = np.array([-1.0, 1.0]) * (size / 2.0 - size**2 / 6.0)
    return t, weights, moments


def formed_solids(model: Model, layers: int, points: Points = 1, units: str = "") -> FormedState:
    """Solids of eight nodes in layers through each cell.

    A cell with nine nodes in a face becomes four stacks.

    Parameters
    ----------
    model : Model
        A model in a converged state.
    layers : int
        Layers through each cell, 1 to 40.
    points : {1, 8}
        Points of a solid: its centre, or 2 x 2 x 2 Gauss points.
    units : str
        For the head of the file.

    Raises
    ------
    InvalidValue
        If the model was not solved.
    """
    if layers not in range(1, 41):
        raise InvalidValue(
            "a cell is cut into 1 to 40 layers of solids",
            where="layers",
            value=layers,
            cause="a fraction, or points in place of layers",
            remedy="4",
        )
    _refuse_virgin(model)
    nodes = model.mesh.connectivity.astype(np.int64)
    half = nodes.shape[1] // 2
    quads = np.array(_QUADS[half])
    x = model.positions
    each = 1 if points == 1 else 2
    own, share = _core.gauss(each)
    edges = np.linspace(-1.0, 1.0, layers + 1)
    heights = (0.5 * (edges[1:] + edges[:-1])[:, None] + np.asarray(own) / layers).ravel()
    weights = np.tile(np.asarray(share) / layers, layers)
    s, r = (a.ravel() for a in np.meshgrid(own, own, indexing="ij"))
    corners = FACE_NODES[:half][quads]
    shape = np.stack([(1 + a * r) * (1 + b * s) / 4 for a, b in FACE_NODES[:4]], axis=1)
    places = np.einsum("pa,kai->kpi", shape, corners).reshape(-1, 2)
    reach = _half_width(quads) if points == 1 else 0.0
    grid = _Grid(places, reach, heights, weights, weights * heights, curved=True)
    stress, _, plastic, history = _on_grid(model, grid)
    cells, count = len(nodes), len(quads)

    def of_solids(values: Floats) -> Floats:
        """(cells, stacks, places, layers, heights) as (solids, points)."""
        split = values.reshape(cells, count, each**2, layers, each, *values.shape[3:])
        turned = np.moveaxis(split, (3, 4), (2, 3))
        out: Floats = turned.reshape(cells * count * layers, each**3, *values.shape[3:])
        return out

    points_of, solids = _layered(x, nodes, quads, layers)
    found = of_solids(history).mean(axis=1) if history is not None else None
    return FormedState(
        points=points_of,
        cells=solids,
        parts=np.repeat(_parts(model), count * layers),
        stress=of_solids(stress),
        plastic=of_solids(plastic),
        history=found,
        variables=dict(model.bodies.only.block.history_variables) if history is not None else {},
        units=units,
    )


def _layered(x: Floats, nodes: Ids, quads: Ids, layers: int) -> tuple[Floats, Ids]:
    """Nodes and solids between lower and upper faces; a node of a face that two cells share is one node."""
    half = nodes.shape[1] // 2
    pairs = np.stack([nodes[:, :half], nodes[:, half:]], axis=-1)[:, quads].reshape(-1, 2)
    fibres, of = np.unique(pairs, axis=0, return_inverse=True)
    between = np.linspace(0.0, 1.0, layers + 1)[1:-1]
    ends, number = np.unique(fibres, return_inverse=True)
    inner = (1.0 - between)[:, None] * x[fibres[:, :1]] + between[:, None] * x[fibres[:, 1:]]
    number = number.reshape(-1, 2)
    inside = len(ends) + np.arange(len(fibres) * (layers - 1)).reshape(len(fibres), layers - 1)
    ladder = np.concatenate([number[:, :1], inside, number[:, 1:]], axis=1)
    columns = ladder[of.reshape(-1, 4)]
    solids = np.concatenate([columns[:, :, :-1], columns[:, :, 1:]], axis=1)
    return np.concatenate([x[ends], inner.reshape(-1, 3)]), np.moveaxis(solids, 2, 1).reshape(-1, 8)


def _on_grid(model: Model, grid: _Grid) -> tuple[Floats, Floats, Floats, Floats | None]:
    """Stress, logarithmic strain, plastic strain and state variables on the grid, arrays (cells, places, heights, ...).

    State variables of one body only: laws differ in them.
    """
    size = (len(model.mesh.connectivity), len(grid.places), len(grid.heights))
    stress, strain, plastic = np.zeros((*size, 6)), np.zeros((*size, 6)), np.zeros(size)
    history = None
    for body in model.bodies:
        on = _Interpolated(body, model.positions, model.u, grid)
        stress[body.cells], strain[body.cells], plastic[body.cells] = on.stress(), on.strain(), on.plastic()
        if len(model.bodies) == 1 and any(body.block.history_variables.values()):
            history = on.at(body.block.state)
    return stress, strain, plastic, history


class _Interpolated:
    """Fields of a body at the points of a grid, in the frames of its deformed cells."""

    def __init__(self, body: Body, x: Floats, u: Floats, grid: _Grid) -> None:
        self.fields: PointFields = body_fields(body, u)
        self.grid = grid
        self.rule = body.element.surface_rule
        self.layers = self.fields.heights.shape[1]
        self.weights = np.broadcast_to(body.through[1], self.fields.heights.shape)
        nodes = x[body.connectivity]
        s, r = (a.ravel() for a in np.meshgrid(*(_core.gauss(n)[0] for n in self.rule[::-1]), indexing="ij"))
        heights = self.fields.heights.T.ravel()  # Layer by layer, as the points run.
        own = np.stack([np.tile(r, self.layers), np.tile(s, self.layers), heights], axis=1)
        self.here = _Geometry(nodes, own)
        k, h = len(grid.places), len(grid.heights)
        there = np.concatenate([np.repeat(grid.places, h, axis=0), np.tile(grid.heights, k)[:, None]], axis=1)
        self.there = _Geometry(nodes, there)
        flat = np.concatenate([np.stack([r, s], axis=1), np.zeros((len(r), 1))], axis=1)
        self.middle = _Geometry(nodes, flat), _Geometry(nodes, np.pad(grid.places, ((0, 0), (0, 1))))
        reach = grid.reach / math.sqrt(3.0)  # The mean of two Gauss points is exact for these polynomials.
        lagrange = [
            sum(0.5 * _lagrange(_core.gauss(n)[0], grid.places[:, axis] + way) for way in (-reach, reach))
            for axis, n in enumerate(self.rule)
        ]
        self.share = np.einsum("pi,pj->pji", *lagrange).reshape(k, -1)

    def at(self, values: Floats) -> Floats:
        """Values (cells, points, ...) on the grid: linear between the heights of a column, then between columns."""
        columns = np.stack([self.fields.at_height(values, float(t)) for t in self.grid.heights], axis=2)
        out: Floats = np.einsum("pc,ech...->eph...", self.share, columns)
        return out

    def stress(self) -> Floats:
        """Cauchy stress in global axes, with the forces and moments of the sections of umform."""
        f = self.fields
        cauchy = self.here.to_local(_matrix(f.stress("cauchy", "global")))
        # Of the compatible deformation, whose Kirchhoff stress gives the nodal forces.
        carried = np.einsum("...ik,...kl,...jl->...ij", f.F, _matrix(f.stress("pk2", "global")), f.F)
        carried = self.here.to_local(carried / np.linalg.det(f.F)[..., None, None])
        shape = (len(cauchy), self.layers, -1, 6)
        areas = self.here.areas.reshape(shape) / self.middle[0].areas[:, None]
        loads = carried.reshape(shape) * areas * self.weights.T[:, :, None]
        wanted = [
            np.einsum("pc,elci->epi", self.share, loads * power) for power in (1.0, self.fields.heights.T[:, :, None])
        ]
        found = self.at(cauchy)
        own = np.ones_like(found)
        if self.grid.curved:
            own = self.there.areas.reshape(found.shape) / self.middle[1].areas[:, :, None]
        t, rules = self.grid.heights[:, None], (self.grid.weights[:, None], self.grid.moments[:, None])
        (a, b), (d, c) = (((own * w).sum(axis=2), (own * w * t).sum(axis=2)) for w in rules)
        n, m = (goal - (own * found * w).sum(axis=2) for w, goal in zip(rules, wanted, strict=True))
        if len(self.grid.heights) == 1:
            found = found + (n / a)[:, :, None]
        else:
            det = a * c - b * d
            found = found + ((c * n - b * m) / det)[:, :, None] + ((a * m - d * n) / det)[:, :, None] * t
        return self.there.to_global(found)

    def strain(self) -> Floats:
        """Logarithmic strain ln V in global axes, shears of the tensor."""
        f = self.fields
        half_shears = f.E * np.array([1.0, 1.0, 1.0, 0.5, 0.5, 0.5])
        stretch, axes = np.linalg.eigh(np.eye(3) + 2.0 * _matrix(half_shears))
        local = np.einsum("...ik,...k,...jk->...ij", axes, 0.5 * np.log(stretch), axes)
        left, _, right = np.linalg.svd(f.F)
        turn = np.einsum("...ij,...aj->...ia", left @ right, f.frame)
        V = np.einsum("...ia,...ab,...jb->...ij", turn, local, turn)
        return self.there.to_global(self.at(self.here.to_local(V)))

    def plastic(self) -> Floats:
        """Accumulated plastic strain, within the range of its cell; zero for laws without one."""
        eqps = self.fields.eqps
        if eqps is None:
            return np.zeros((len(self.fields.E), len(self.grid.places), len(self.grid.heights)))
        least, most = (bound(eqps, axis=1)[:, None, None] for bound in (np.min, np.max))
        inside: Floats = np.clip(self.at(eqps), least, most)
        return inside


class _Geometry:
    """Base vectors, orthonormal frames and areas of sections at natural points of deformed cells.

    Attributes
    ----------
    frame : ndarray, shape (cells, points, 3, 3)
        Rows e_1 along r, e_2, and e_3 normal to the layer.
    areas : ndarray, shape (cells, points, 6)
        Areas that the components 11 22 33 12 23 13 act on, per natural area.
    """

    def __init__(self, nodes: Floats, points: Floats) -> None:
        derivatives = _core.shell_functions(nodes.shape[1], np.ascontiguousarray(points))[1]
        g = np.einsum("qia,eak->eqik", derivatives.reshape(len(points), 3, -1), nodes)
        r, s, t = g[:, :, 0], g[:, :, 1], g[:, :, 2]
        normal = np.cross(r, s)
        e3 = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
        e1 = r / np.linalg.norm(r, axis=-1, keepdims=True)
        self.frame = np.stack([e1, np.cross(e3, e1), e3], axis=2)
        across_r, across_s = (np.linalg.norm(np.cross(a, t), axis=-1) for a in (s, r))
        flat = np.linalg.norm(normal, axis=-1)
        both = np.sqrt(across_r * across_s)
        self.areas = np.stack([across_r, across_s, flat, both, across_s, across_r], axis=-1)

    def to_local(self, tensors: Floats) -> Floats:
        """Components (cells, points, 6) in the frames, of tensors (cells, points, 3, 3) in global axes."""
        local: Floats = (self.frame @ tensors @ np.swapaxes(self.frame, -1, -2))[..., _FIRST, _SECOND]
        return local

    def to_global(self, components: Floats) -> Floats:
        """Components (cells, places, heights, 6) in global axes, of those in the frames."""
        flat = _matrix(components).reshape(*self.frame.shape)
        turned: Floats = np.swapaxes(self.frame, -1, -2) @ flat @ self.frame
        return turned[..., _FIRST, _SECOND].reshape(components.shape)


def _matrix(components: Floats) -> Floats:
    """Symmetric tensors (..., 3, 3) of components (..., 6)."""
    return components[..., [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]


def _half_width(quads: Ids) -> float:
    """Half of the width of the quadrilaterals of a face in natural coordinates."""
    return 1.0 if len(quads) == 1 else 0.5


def _lagrange(nodes: Floats, at: Floats) -> Floats:
    """Lagrange polynomials of some points at others, shape (at, nodes)."""
    columns = [
        np.prod([(at - b) / (a - b) for j, b in enumerate(nodes) if j != i], axis=0) * np.ones_like(at)
        for i, a in enumerate(nodes)
    ]
    return np.stack(columns, axis=1)


def _parts(model: Model) -> Ids:
    """Number of the body of each cell, from 1."""
    parts = np.zeros(len(model.mesh.connectivity), dtype=np.int64)
    for number, body in enumerate(model.bodies, start=1):
        parts[body.cells] = number
    return parts


def _refuse_virgin(model: Model) -> None:
    if not any(body.begun for body in model.bodies) or not model.u.any():
        raise InvalidValue(
            "the model has no stresses",
            where="state of the part",
            cause="nothing has been solved with it",
            remedy="export the result of a run, or the model after it",
        )
