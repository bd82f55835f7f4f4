"""A layer of quadrilaterals between the stacks well inside of a line, and the line. docs/theory, eqs. (1.28)-(1.31)"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import MeshError
from umform.mesh.fitted.places import Places, located
from umform.mesh.fitted.sheet import Sheet
from umform.mesh.fitted.smoothing import corners_of, onto, sines, smoothed
from umform.mesh.neighbours import connected

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]
Mask = NDArray[np.bool_]
#: Signed distance (n,), negative inside, and unit normal (n, 2) at places (n, 2).
Line = Callable[[Floats], tuple[Floats, Floats]]

#: Least distance of the inner stacks from the line, relative to the local size: least width of the layer. eq. (1.28)
_CLEAR = 0.35
#: Least sine of the angles of a quadrilateral: from 15 to 165 degrees; and that from which nothing is smoothed.
_LEAST_SINE, _GOOD_SINE = 0.2588, 0.64
#: Moves below this part of the local size are left out.
_STILL = 0.02
#: Rounds in which stacks are left out, or moves are taken back.
_ROUNDS = 30


@dataclass(frozen=True)
class Layer:
    """The quadrilaterals that remain, and those of the layer.

    Attributes
    ----------
    inner : ndarray of int
        Stacks of the sheet that stay.
    quads : ndarray of int, shape (inner + layer, 4)
        Fibres of all quadrilaterals; those of the sheet keep their numbers, new ones follow.
    new : int
        Number of new fibres.
    moved : ndarray of int
        Fibres that have other places: moved ones of the sheet, and new ones.
    places : Places
        Those of the moved ones in the sheet.
    parents : ndarray of int, shape (inner + layer,)
        Stack of the sheet in which the centre of each quadrilateral lies.
    missed : int
        Number of sides of the new edge that follow stacks of the sheet.
    """

    inner: Numbers
    quads: Numbers
    new: int
    moved: Numbers
    places: Places
    parents: Numbers
    missed: int


def fitted_layer(sheet: Sheet, x: Floats, kept: Mask, line: Line) -> Layer:
    """Replace the stacks near a line by a layer that ends on it.

    Parameters
    ----------
    sheet : Sheet
        The whole sheet.
    x : ndarray, shape (fibres, 2)
        Middles of the fibres in the plane of the line.
    kept : ndarray of bool, shape (stacks,)
        Stacks whose centres are inside.
    line : callable
        Signed distance and normal.

    Raises
    ------
    MeshError
        If no stacks are far enough inside, or the sheet is steep in the plane of the line.
    """
    turn = np.sign(np.median(sines(x, sheet.quads[kept])))
    if turn < 0.0:
        x = x * np.array([-1.0, 1.0])
        line = _mirrored(line)
    distance = line(x)[0]
    size = _sizes(sheet, x)
    inside = (distance <= -_CLEAR * size)[sheet.quads].all(axis=1) & kept
    inside = _whole(sheet, inside)
    if inside.sum() == 0:
        raise MeshError("the elements are too large for an edge on the line", value=f"{int(kept.sum())} remain")
    near = np.zeros(len(x), dtype=bool)
    near[sheet.quads[(np.abs(distance) <= 2.0 * size)[sheet.quads].any(axis=1)]] = True
    band = near[sheet.quads].any(axis=1)
    if (sines(x, sheet.quads[band]) <= 0.05).any():
        raise MeshError("the sheet is steep in the view of the line", value=f"{int(band.sum())} stacks around it")
    made = _attached(sheet, x, inside, line)
    return _finished(sheet, x, size, made, line)


@dataclass(frozen=True)
class _Attached:
    """The layer before smoothing: inner stacks, quadrilaterals of the layer, places, fibres of its inner side."""

    inner: Numbers
    layer: Numbers
    x: Floats
    chain: Numbers
    ends: Mask


def _attached(sheet: Sheet, x: Floats, inside: Mask, line: Line) -> _Attached:
    """A quadrilateral on each side between inner stacks and others; its outer corners on the line. eq. (1.29)"""
    edges = sheet.edge_stacks[0]
    stacks, side = np.nonzero(_cut_sides(sheet, inside))
    first, second = sheet.quads[stacks, side], sheet.quads[stacks, (side + 1) % 4]
    chain = np.unique([first, second])
    at_rim = np.zeros(len(x), dtype=bool)
    at_rim[edges[sheet.rim]] = True
    ends = at_rim[chain]
    outer = onto(x[chain], line)
    for k in np.flatnonzero(ends).tolist():
        outer[k] = _along_rim(sheet, x, int(chain[k]), inside, line)
    new = len(x) + np.arange(len(chain))
    of = np.full(len(x), -1)
    of[chain] = new
    layer = np.empty((len(stacks), 4), dtype=np.int64)
    row = np.arange(len(stacks))
    for k, fibres in enumerate((of[first], of[second], second, first)):
        layer[row, (side + k) % 4] = fibres
    return _Attached(np.flatnonzero(inside), layer, np.concatenate([x, outer]), chain, ends)


def _finished(sheet: Sheet, x: Floats, size: Floats, made: _Attached, line: Line) -> Layer:
    """Smooth the layer where it has to be, and leave out what stays bad."""
    count, inner = len(x), sheet.quads[made.inner]
    quads = np.concatenate([inner, made.layer])
    at = made.x
    if sines(at, made.layer).min() < _GOOD_SINE:
        at = _smooth(sheet, x, made, line)
    moves = np.linalg.norm(at[:count] - x, axis=1)
    at[:count][moves < _STILL * size] = x[moves < _STILL * size]
    good = np.ones(len(quads), dtype=bool)
    for _ in range(_ROUNDS):
        bad = sines(at, quads) < np.minimum(_LEAST_SINE, _before(sheet, x, made))
        bad[good & ~bad] = False
        if not (bad & good).any():
            break
        back = quads[bad & good]
        back = np.unique(back[back < count])
        moved_back = back[np.linalg.norm(at[back] - x[back], axis=1) > 0.0]
        if len(moved_back):
            at[moved_back] = x[moved_back]
        else:
            good[len(inner) :] &= ~bad[len(inner) :]
    missed = int((~good).sum())
    if 2 * missed > len(made.layer):
        raise MeshError("elements that end on the line would be too bad", value=f"{missed} of {len(made.layer)}")
    quads = quads[good]
    used = np.unique(quads)
    fresh = used[used >= count]
    number = np.arange(len(at))
    number[fresh] = count + np.arange(len(fresh))
    moved_old = np.flatnonzero(np.linalg.norm(at[:count] - x, axis=1) > 0.0)
    moved = np.concatenate([np.intersect1d(moved_old, used), fresh])
    places = located(at[moved], x, sheet.quads)
    own = np.where(good[: len(inner)])[0]
    centres = located(at[quads[len(own) :]].mean(axis=1), x, sheet.quads).quad
    parents = np.concatenate([made.inner[own], centres])
    return Layer(made.inner[own], number[quads], len(fresh), number[moved], places, parents, missed)


def _before(sheet: Sheet, x: Floats, made: _Attached) -> Floats:
    """Sines of the angles that are allowed: inner stacks need not become better than they were."""
    return np.concatenate([0.9 * sines(x, sheet.quads[made.inner]), np.full(len(made.layer), 1.0)])


def _smooth(sheet: Sheet, x: Floats, made: _Attached, line: Line) -> Floats:
    """Places after smoothing of the layer and of the two next rings of fibres."""
    count = len(x)
    inner = sheet.quads[made.inner]
    ring = np.zeros(len(made.x), dtype=bool)
    ring[made.chain] = True
    ring[inner[ring[inner].any(axis=1)]] = True
    around = inner[ring[inner].any(axis=1)]
    quads = np.concatenate([around, made.layer])
    free = ring.copy()
    free[count:] = ~made.ends
    edges = sheet.edge_stacks[0][sheet.rim]
    free[:count][np.unique(edges)] = False
    slides = count + np.flatnonzero(~made.ends)
    parents = located(made.x[quads].mean(axis=1), x, sheet.quads).quad
    a = corners_of(x, sheet.quads[parents])[0]
    map_of = np.stack([0.5 * (a[:, 0] - a[:, 2]), 0.5 * (a[:, 1] - a[:, 3])], axis=2)
    metric: Floats = np.asarray(np.linalg.inv(map_of), dtype=float)
    return smoothed(made.x, quads, metric, free, slides, line)


def _mirrored(line: Line) -> Line:
    mirror = np.array([-1.0, 1.0])

    def there(x: Floats) -> tuple[Floats, Floats]:
        distance, normal = line(x * mirror)
        return distance, normal * mirror

    return there


def _sizes(sheet: Sheet, x: Floats) -> Floats:
    """Mean length of the sides at each fibre."""
    a = corners_of(x, sheet.quads)[0]
    length = np.linalg.norm(a, axis=2)
    mean = 0.5 * (length + np.roll(length, 1, axis=1))
    sums = np.bincount(sheet.quads.ravel(), mean.ravel(), len(x))
    return np.asarray(sums / np.maximum(np.bincount(sheet.quads.ravel(), minlength=len(x)), 1))


def _cut_sides(sheet: Sheet, inside: Mask) -> Mask:
    """Sides of inner stacks that others share, shape (stacks, 4)."""
    edges, number = sheet.edge_stacks
    inner = np.bincount(number[inside].ravel(), minlength=len(edges))
    sides: Mask = inside[:, None] & (inner == 1)[number] & ~sheet.rim[number]
    return sides


def _whole(sheet: Sheet, inside: Mask) -> Mask:
    """Inner stacks without teeth, places where they meet in a fibre only, and small pieces."""
    inside = inside.copy()
    edges, _ = sheet.edge_stacks
    for _ in range(_ROUNDS):
        sides = _cut_sides(sheet, inside)
        teeth = sides.sum(axis=1) >= 3
        ends = np.stack([sheet.quads, np.roll(sheet.quads, -1, axis=1)], axis=2)[sides]
        pinched = np.bincount(ends.ravel(), minlength=len(sheet.nodes)) > 2
        out = teeth | (pinched[sheet.quads].any(axis=1) & inside)
        if not out.any():
            break
        inside &= ~out
    cells = np.flatnonzero(inside)
    if len(cells) == 0:
        return inside
    links = np.stack([np.repeat(np.arange(len(cells)), 4), len(cells) + sheet.edge_stacks[1][cells].ravel()], axis=1)
    piece = connected(len(cells) + len(edges), links)[: len(cells)]
    inside[cells[piece != np.bincount(piece).argmax()]] = False
    return inside


def _along_rim(sheet: Sheet, x: Floats, start: int, inside: Mask, line: Line) -> Floats:
    """Where the rim that leaves the inner stacks at a fibre meets the line. eq. (1.29)"""
    edges, number = sheet.edge_stacks
    outer = np.zeros(len(edges), dtype=bool)
    outer[number[~inside]] = True
    outer[number[inside]] = False
    rim = edges[sheet.rim & outer]
    at, seen = start, {start}
    for _ in range(len(rim) + 1):
        ahead = [int(n) for n in rim[(rim == at).any(axis=1)].ravel() if int(n) not in seen]
        if not ahead:
            break
        there = ahead[0]
        if line(x[[there]])[0][0] >= 0.0:
            low, high = 0.0, 1.0
            for _ in range(60):
                mid = 0.5 * (low + high)
                beyond = line(x[[at]] + mid * (x[[there]] - x[[at]]))[0][0] >= 0.0
                low, high = (low, mid) if beyond else (mid, high)
            return np.asarray(x[at] + high * (x[there] - x[at]))
        seen.add(there)
        at = there
    raise MeshError("the line does not meet the edge of the sheet", value=f"({x[start][0]:.4g}, {x[start][1]:.4g})")
