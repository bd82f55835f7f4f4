"""Flat blanks with any outline of lines and arcs, and holes: quadrilaterals by gmsh (the extra ``mesh``)."""

from __future__ import annotations

import ctypes
import math
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, MeshError
from umform.mesh.blanks import order_of, stacked
from umform.mesh.curves import Closed, check_curves
from umform.mesh.generators import Layers
from umform.mesh.mesh import Floats, Mesh
from umform.mesh.neighbours import Whole
from umform.spec import check_arguments
from umform.spec.types import Positive

#: Types of quadrilaterals and of triangles in gmsh, by the order of the nodes.
_QUADS, _TRIANGLES = {1: 3, 2: 10}, (2, 9)
_Point = tuple[float, float]
#: Largest angle of an arc of a curve that an element spans, and the growth of the sizes away from arcs and short lines.
_SPAN, _GROWTH = math.radians(30.0), 0.5

#: Largest number of meshes until sizes are met.
_ROUNDS = 15


@runtime_checkable
class Refinable(Protocol):
    """Sizes that know whether a mesh meets them: :class:`umform.surfaces.ToolSizes`."""

    def __call__(self, x: float, y: float) -> float:
        """Size at a place."""

    def refined(self, mesh: Mesh) -> Refinable | None:
        """Smaller sizes where the elements of a mesh are too large; None if there are none."""


def blank(
    outline: Closed,
    thickness: Positive,
    size: Positive | Callable[[float, float], float],
    *,
    holes: Sequence[Closed] = (),
    cell: str = "hex8",
    layers: Layers = 1,
) -> Mesh:
    """Flat blank of any outline, mid-surface at z = 0.

    Parameters
    ----------
    outline : Profile
        Closed curve of lines and arcs in x and y.
    thickness : float
        Along z.
    size : float or callable
        Length of the sides of elements, or a function (x, y) -> length. It is smaller where an element would span more
        than 30 degrees of an arc, or be longer than a line or an arc of the outline or of a hole. gmsh misses sizes by
        a factor of up to 1.5 (it recombines triangles, then halves the quadrilaterals);
        :class:`umform.surfaces.ToolSizes` are refined until the elements of the mesh meet them.
    holes : sequence of Profile
        Closed curves inside of it.
    cell : {"hex8", "hex18"}
        Cell type.
    layers : int
        Elements through the thickness.

    Returns
    -------
    Mesh
        With face sets ``lower`` and ``upper``, and node sets ``rim`` (the outline), ``edge_0``, ``edge_1``, ... (its
        segments), ``hole_0``, ...; each also with ``_lower`` and ``_upper``.

    Raises
    ------
    InvalidValue
        If a curve is open, a number is out of range, or gmsh is not installed.
    MeshError
        If curves meet, a hole lies outside of the outline or in another one, or gmsh finds no mesh of quadrilaterals.
    """
    check_arguments(blank, thickness=thickness, size=size, layers=layers)
    for k, curve in enumerate((outline, *holes)):
        if not curve.closed:
            raise InvalidValue(
                "the outline of a blank and its holes are closed",
                where="blank",
                value=f"hole {k - 1}" if k else "the outline",
                cause="closed = false, or a drawing whose ends do not meet",
                remedy="let the last line end where the first one begins",
            )
    check_curves(outline, holes)
    for _ in range(_ROUNDS):
        made = _blank(outline, thickness, size, holes, cell, layers)
        if not isinstance(size, Refinable) or (smaller := size.refined(made)) is None:
            break
        size = smaller
    return made


def _blank(
    outline: Closed,
    thickness: float,
    size: float | Callable[[float, float], float],
    holes: Sequence[Closed],
    cell: str,
    layers: int,
) -> Mesh:
    """The blank of :func:`blank` for sizes that are not refined."""
    order = order_of(cell)
    with _gmsh() as gmsh:
        edges = [_loop(gmsh, curve) for curve in (outline, *holes)]
        gmsh.model.geo.addPlaneSurface([loop for loop, _ in edges])
        gmsh.model.geo.synchronize()
        segments = [segment for curve in (outline, *holes) for segment in curve.segments]
        points, quads, ids = _meshed(gmsh, _Near(size, segments), order)
        on = {f"edge_{k}": _nodes_on(gmsh, tags, ids) for k, tags in enumerate(edges[0][1])}
        on["rim"] = np.any(list(on.values()), axis=0)
        for k, (_, tags) in enumerate(edges[1:]):
            on[f"hole_{k}"] = np.any([_nodes_on(gmsh, part, ids) for part in tags], axis=0)
    return stacked(points, quads, thickness, layers, on, cell)


@contextmanager
def _gmsh() -> Iterator[Any]:
    """Gmsh with an empty model; a single thread makes the mesh reproducible."""
    try:
        import gmsh
    except (ImportError, OSError) as error:
        raise InvalidValue(
            "a blank of any outline needs gmsh",
            where="blank",
            cause=str(error),
            remedy="pip install 'umform[mesh]'; or disc, ring, strip, which need no extra",
        ) from error
    with _kept_handler():
        gmsh.initialize(["gmsh", "-v", "0", "-noenv"], readConfigFiles=False, interruptible=False)
    try:
        for name, value in {
            "General.Terminal": 0,
            "General.NumThreads": 1,
            "Mesh.Algorithm": 8,  # triangles that combine well to quadrilaterals
            "Mesh.RecombineAll": 1,
            "Mesh.RecombinationAlgorithm": 3,  # subdivide to quadrilaterals only
            "Mesh.MeshSizeExtendFromBoundary": 0,
            "Mesh.SecondOrderIncomplete": 0,
        }.items():
            gmsh.option.setNumber(name, value)
        gmsh.model.add("blank")
        yield gmsh
    finally:
        gmsh.finalize()


@contextmanager
def _kept_handler() -> Iterator[None]:
    """Keep the handler of SIGPIPE: Python ignores it, gmsh does not, and any pipe that closes would end the process."""
    number = getattr(signal, "SIGPIPE", None)  # Windows has none
    if number is None:
        yield
        return
    get, put = ctypes.pythonapi.PyOS_getsig, ctypes.pythonapi.PyOS_setsig  # unlike `signal`, from any thread
    get.restype = put.restype = ctypes.c_void_p
    put.argtypes = [ctypes.c_int, ctypes.c_void_p]
    before = get(int(number))
    try:
        yield
    finally:
        put(int(number), before)


def _loop(gmsh: Any, curve: Closed) -> tuple[int, list[list[int]]]:
    """A closed curve, and the gmsh lines of its segments; arcs are divided into parts of less than half a turn."""
    geo, corners, tags = gmsh.model.geo, dict[tuple[float, float], int](), list[list[int]]()

    def corner(p: Floats | _Point) -> int:
        key = (round(float(p[0]), 9), round(float(p[1]), 9))
        if key not in corners:
            corners[key] = geo.addPoint(*key, 0.0)
        return corners[key]

    for segment in curve.segments:
        centre = getattr(segment, "centre", None)
        if centre is None:
            tags.append([geo.addLine(corner(segment.start), corner(segment.end))])
            continue
        middle = geo.addPoint(*centre, 0.0)
        ends = _parts(segment)
        tags.append([geo.addCircleArc(corner(a), middle, corner(b)) for a, b in pairwise(ends)])
    return geo.addCurveLoop([tag for parts in tags for tag in parts]), tags


def _parts(arc: Any) -> list[Floats]:
    """Ends of the parts of an arc, each of a third of a turn at most."""
    centre, start = np.asarray(arc.centre, dtype=float), np.asarray(arc.start, dtype=float)
    count = math.ceil(arc.angle / (2.0 * math.pi / 3.0) - 1e-9)
    angles = math.atan2(*(start - centre)[::-1]) + arc.turn * arc.angle * np.arange(1, count) / count
    between = [centre + arc.radius * np.array([math.cos(a), math.sin(a)]) for a in angles]
    return [start, *between, np.asarray(arc.end, dtype=float)]


class _Near:
    """Sizes that follow the lines and arcs of a blank: gmsh finds no mesh where a size is longer than its line."""

    def __init__(self, size: float | Callable[[float, float], float], segments: Sequence[Any]) -> None:
        self._size = size
        self._arcs: list[tuple[float, float, float, _Point, _Point, float, float, float]] = [
            (float(arc.centre[0]), float(arc.centre[1]), float(arc.radius), _pair(arc.start), _pair(arc.end),
             math.atan2(arc.start[1] - arc.centre[1], arc.start[0] - arc.centre[0]), float(arc.turn), float(arc.angle))
            for arc in segments
            if hasattr(arc, "centre")
        ]  # fmt: skip
        lines = [line for line in segments if not hasattr(line, "centre")]
        self._starts = np.array([line.start for line in lines], dtype=float).reshape(-1, 2)
        self._lengths = np.array([line.length for line in lines])
        self._along = np.array([line.tangents()[0] for line in lines]).reshape(-1, 2)
        self._shortest = min((line.length for line in lines), default=math.inf)

    def __call__(self, x: float, y: float) -> float:
        """Size at a point."""
        size = float(self._size(x, y)) if callable(self._size) else self._size
        for cx, cy, radius, start, end, first, turn, angle in self._arcs:
            if turn * (math.atan2(y - cy, x - cx) - first) % (2.0 * math.pi) <= angle:
                far = abs(math.hypot(x - cx, y - cy) - radius)
            else:
                far = min(math.dist((x, y), start), math.dist((x, y), end))
            size = min(size, min(_SPAN, angle) * radius + _GROWTH * far)
        if size > self._shortest:  # gmsh asks at many places
            away = np.array([x, y]) - self._starts
            along = np.clip((away * self._along).sum(axis=1), 0.0, self._lengths)
            far_off = np.hypot(*(away - along[:, None] * self._along).T)
            size = min(size, float((self._lengths + _GROWTH * far_off).min()))
        return size


def _pair(point: Any) -> _Point:
    return float(point[0]), float(point[1])


def _meshed(gmsh: Any, size: Callable[[float, float], float], order: int) -> tuple[Floats, Whole, Whole]:
    """Points (n, 2), quadrilaterals, and the number of each node of gmsh."""

    def length(dimension: int, tag: int, x: float, y: float, z: float, before: float) -> float:
        del dimension, tag, z, before
        return size(x, y)

    gmsh.model.mesh.setSizeCallback(length)
    try:
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(order)
    except Exception as error:  # gmsh raises plain exceptions
        raise MeshError(
            "gmsh finds no mesh of the blank", where="blank", cause=str(error), remedy="an outline without crossings"
        ) from error
    if any(len(gmsh.model.mesh.getElementsByType(kind)[0]) for kind in _TRIANGLES):
        raise MeshError("gmsh leaves triangles in the blank", where="blank", remedy="smaller elements")
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, corners = gmsh.model.mesh.getElementsByType(_QUADS[order])
    ids = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    raw = np.asarray(corners, dtype=np.int64).reshape(-1, 4 if order == 1 else 9)
    used = np.unique(raw)
    ids[used] = np.arange(len(used))
    place = np.empty((len(ids), 2))
    place[np.asarray(tags, dtype=np.int64)] = np.asarray(coordinates).reshape(-1, 3)[:, :2]
    points, quads = place[used], ids[raw]
    a, b, c, d = (points[quads[:, k]] for k in range(4))
    area = (c - a)[:, 0] * (d - b)[:, 1] - (c - a)[:, 1] * (d - b)[:, 0]
    turned = [0, 3, 2, 1] if order == 1 else [0, 3, 2, 1, 7, 6, 5, 4, 8]
    return points, np.where(area[:, None] < 0.0, quads[:, turned], quads), ids


def _nodes_on(gmsh: Any, tags: Sequence[int], ids: Whole) -> NDArray[np.bool_]:
    """Mask of the nodes on some gmsh lines, including their ends."""
    on = np.zeros(int(ids.max()) + 1, dtype=bool)
    for tag in tags:
        nodes = np.asarray(gmsh.model.mesh.getNodes(1, tag, includeBoundary=True)[0], dtype=np.int64)
        on[ids[nodes][ids[nodes] >= 0]] = True
    return on
