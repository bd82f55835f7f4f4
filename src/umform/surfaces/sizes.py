"""Element sizes of a flat blank from the curvature of any tools. docs/theory, eq. (5.69)"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.spec import check_arguments
from umform.spec.types import ElementTurn, NotNegative, Positive
from umform.surfaces.size_map import ToolSizes
from umform.surfaces.tool import Surface

Floats = NDArray[np.float64]

#: Steps along a line towards a tool; distance that counts as contact, relative to the size of the blank.
_STEPS, _ON = 300, 1e-6
#: How often the initial height of the lines is doubled.
_DOUBLINGS = 20
#: Lines of the map along the longer side of the blank.
_LINES = 121


def tool_sizes(
    below: Sequence[Surface],
    above: Sequence[Surface],
    box: ArrayLike,
    *,
    thickness: Positive,
    turn: ElementTurn,
    largest: Positive,
    flow: NotNegative = 0.0,
    growth: float = 1.5,
    smallest: NotNegative = 0.0,
) -> ToolSizes:
    """Element sizes of a flat blank that limit the angle of an element over the convex radii of its tools. eq. (5.69)

    The tools travel along z. Along z, each place of the blank faces one place of each tool; the largest principal
    curvature there gives the radius. It is the largest eigenvalue of the Hessian of the signed distance, averaged over
    the thickness of the sheet by differences of normals, because the curvature of triangulations is discontinuous.
    Concave radii do not count: the sheet lies on the convex radii of the other tool.

    Parameters
    ----------
    below, above : sequence of Tool
        Tools under the sheet, and over it; at any height, since only their places in x and y count.
    box : array_like, ((x, y), (x, y))
        Lowest and highest corner of the blank.
    thickness : float
        Of the sheet; half of it adds to the radius of a tool.
    turn : float
        Largest angle in degrees.
    largest : float
        Largest size of an element.
    flow : float
        Sliding distance over the tools: places nearer than this to a radius have its sizes too.
    growth : float
        Largest ratio of the sizes of neighbours farther away.
    smallest : float
        Least size of an element, for tools with sharp edges.

    Raises
    ------
    InvalidValue
        If a number is out of range, or a tool lies on the other side.

    Examples
    --------
    >>> import umform as uf
    >>> die = uf.UDie(opening=40, depth=20, shoulder_radius=5, bottom_radius=3)
    >>> sizes = uf.surfaces.tool_sizes([die], [], ((-40, 0), (40, 10)), thickness=1, turn=10, largest=4)
    >>> round(sizes(22.0, 5.0), 2)  # 10 degrees over a radius of 5.5
    0.96
    """
    low, high = _corners(box)
    check_arguments(tool_sizes, thickness=thickness, turn=turn, largest=largest, flow=flow, smallest=smallest)
    if not (growth > 1.0 and smallest <= largest):
        raise InvalidValue(
            "sizes need a growth above one, and a smallest size of at most the largest",
            where="tool_sizes",
            value=f"largest {largest:g}, growth {growth:g}, smallest {smallest:g}",
            cause="a sign, or the sizes exchanged",
            remedy="growth=1.5",
        )
    x, y = _lines(low, high)
    places = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    bend = np.zeros(len(places))
    for tools, side, name in ((below, 1.0, "below"), (above, -1.0, "above")):
        for number, tool in enumerate(tools):
            at, on = _first_met(tool, places, side, float(np.linalg.norm(high - low)), f"{name}[{number}]")
            bend[on] = np.maximum(bend[on], _curvature(tool, at, 0.5 * thickness))
    with np.errstate(divide="ignore"):
        radius = np.where(bend > 0.0, 1.0 / bend + 0.5 * thickness, np.inf)
    flat = 2.0 * math.degrees(1.0) * largest / turn  # radii that the largest size resolves
    radius[radius > flat] = np.inf
    radius = radius.reshape(len(x), len(y))
    around, size = _spread((x[1] - x[0], y[1] - y[0]), radius, math.radians(turn), flow, math.log(growth), largest)
    return ToolSizes(x, y, around, np.maximum(size, smallest), turn, smallest)


def _corners(box: ArrayLike) -> tuple[Floats, Floats]:
    corners = np.asarray(box, dtype=float)
    if corners.shape != (2, 2) or not np.isfinite(corners).all() or not (corners[0] < corners[1]).all():
        raise InvalidValue(
            "the box of a blank has a lowest and a highest corner (x, y)",
            where="tool_sizes, box",
            value=box,
            cause="the corners exchanged, or three coordinates",
            remedy="((0, 0), (100, 80))",
        )
    return corners[0], corners[1]


def _lines(low: Floats, high: Floats) -> tuple[Floats, Floats]:
    step = float((high - low).max()) / (_LINES - 1)
    counts = np.ceil((high - low) / step).astype(int) + 1
    return np.linspace(low[0], high[0], counts[0]), np.linspace(low[1], high[1], counts[1])


def _first_met(
    tool: Surface, places: Floats, side: float, reach: float, where: str
) -> tuple[Floats, NDArray[np.int64]]:
    """Heights at which lines along z first meet a tool from one side, and a mask of those that do."""
    kernel = tool.kernel()

    def gap(which: NDArray[np.int64], z: Floats) -> Floats:
        return kernel.gap(np.ascontiguousarray(np.column_stack([places[which], z])))[0]

    def level(height: float) -> Floats:
        return gap(np.arange(len(places)), np.full(len(places), side * height))

    start, end = _beyond(level, reach), _beyond(lambda depth: level(-depth), reach, endless=True)
    met, going = np.zeros(len(places), dtype=bool), np.flatnonzero(level(start) > 0.0)
    if len(going) == 0:
        raise InvalidValue(
            "a tool fills the space on the side of the sheet",
            where=f"tool_sizes, {where}",
            cause="a tool from above given as one from below or the other way round, or one turned inside out",
            remedy="below=[die], above=[punch, holder]",
        )
    z = np.full(len(places), side * start)
    for _ in range(_STEPS):  # no step is longer than the distance, so no surface is passed
        free = gap(going, z[going])
        on = free <= _ON * reach
        met[going[on]] = True
        z[going] -= side * np.maximum(free, 0.0)
        going = going[~on & (side * z[going] > -end)]
        if len(going) == 0:
            break
    which = np.flatnonzero(met)
    return np.ascontiguousarray(np.column_stack([places[which], z[which]])), which


def _beyond(level: Callable[[float], Floats], reach: float, *, endless: bool = False) -> float:
    """A height beyond a tool: distances no longer decrease beyond it, or stay zero inside an infinite tool."""
    height, near, walled = reach, level(reach), 0.0
    for _ in range(_DOUBLINGS):
        height *= 2.0
        far = level(height)
        free = far > 0.0
        stay = bool((free == (near > 0.0)).all())
        if (far >= near).all() if free.all() else endless and stay:
            return height
        if not walled and stay and free.any():
            walled = height  # between walls that may be infinite
        near = far
    return walled or height


def _curvature(tool: Surface, at: Floats, step: float) -> Floats:
    """Largest convex curvature at places on a tool: central differences of the normal along two tangents."""
    if len(at) == 0:
        return np.empty(0)
    kernel = tool.kernel()
    n = kernel.gap(at)[1]
    across = np.where(np.abs(n[:, :1]) < 0.9, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]])
    first = np.cross(n, across)
    first /= np.linalg.norm(first, axis=1)[:, None]
    tangents = np.stack([first, np.cross(n, first)], axis=1)
    matrix = np.empty((len(at), 2, 2))
    for k in range(2):
        away = step * tangents[:, k]
        ends = [kernel.gap(np.ascontiguousarray(at + sign * away))[1] for sign in (1.0, -1.0)]
        matrix[:, :, k] = np.einsum("nik,nk->ni", tangents, ends[0] - ends[1]) / (2.0 * step)
    mean = 0.5 * (matrix + matrix.transpose(0, 2, 1))
    return np.asarray(np.maximum(np.linalg.eigvalsh(np.nan_to_num(mean)).max(axis=1), 0.0))


def _spread(
    steps: tuple[float, float], radius: Floats, turn: float, flow: float, growth: float, largest: float
) -> tuple[Floats, Floats]:
    """Smallest radius within the sliding distance, and sizes that grow from there; similar radii (5 %) are merged."""
    from scipy.ndimage import distance_transform_edt  # slow to import

    around, size = radius.copy(), np.minimum(turn * radius, largest)
    bent = np.isfinite(radius)
    level = np.full(radius.shape, -1)
    level[bent] = (np.log(radius[bent] / radius[bent].min(initial=np.inf)) / math.log(1.05)).astype(int)
    for k in np.unique(level[bent]):
        least = radius[level == k].min()
        away = distance_transform_edt(level != k, sampling=steps)
        around = np.minimum(around, np.where(away <= flow, least, np.inf))
        size = np.minimum(size, turn * least + growth * np.maximum(away - flow, 0.0))
    return around, size
