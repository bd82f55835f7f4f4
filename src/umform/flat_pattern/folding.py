"""A flat pattern folded again, from its flat lines, angles and radii alone, and its distance from the part."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from umform.flat_pattern.unfold import BendMap, PlaneMap, Unfolded

Floats = NDArray[np.float64]


def folded_points(flat: Unfolded) -> tuple[Floats, Floats]:
    """Points on the edges of all faces: folded from the flat pattern, and those of the part, both (n, 3).

    Each patch takes the motion of the one before; a bend rolls its strip up about a line at its first tangent line.
    """
    motions: dict[int, tuple[Floats, Floats]] = {0: (np.eye(3), np.zeros(3))}
    folded, drawn = list[Floats](), list[Floats]()
    for place, lay in flat.maps.items():  # in the order in which they were reached
        if place:
            parent = flat.parents[place]
            motions[place] = _after(flat.maps[parent], motions[parent], lay)
        turn, shift = motions[place]
        for k in flat.skin.patches[place].edges:
            x = flat.skin.solid.edges[k].points
            y = lay(x)
            local = _rolled(lay, y) if isinstance(lay, BendMap) else np.column_stack([y, np.zeros(len(y))])
            folded.append(local @ turn.T + shift)
            drawn.append(x)
    return np.concatenate(folded), np.concatenate(drawn)


def largest_distance(flat: Unfolded) -> float:
    """Largest distance between the folded pattern and the part, the base laid on the base."""
    folded, drawn = folded_points(flat)
    base = flat.maps[0]
    assert isinstance(base, PlaneMap)
    axes = np.vstack([base.axes, np.cross(base.axes[0], base.axes[1])])
    local = (drawn - base.origin) @ axes.T
    return float(np.linalg.norm(folded - local, axis=1).max())


def _after(before: PlaneMap | BendMap, motion: tuple[Floats, Floats], lay: PlaneMap | BendMap) -> tuple[Floats, Floats]:
    """Motion of a patch whose neighbour was moved: at the end of a bend it is turned by the angle of the bend."""
    del lay
    if isinstance(before, PlaneMap):
        return motion
    turn, shift = motion
    axis = np.append(before.along, 0.0)
    ends = before.at[None] + before.allowance.length * before.across[None]
    rolled = _rolled(before, ends)[0]
    across = np.append(before.across, 0.0)
    up = np.array([0.0, 0.0, 1.0 if before.up else -1.0])
    c, s = math.cos(before.angle), math.sin(before.angle)
    local = np.outer(axis, axis) + np.outer(c * across + s * up, across) + np.outer(c * up - s * across, up)
    return turn @ local, turn @ (rolled - local @ np.append(ends[0], 0.0)) + shift


def _rolled(lay: BendMap, y: Floats) -> Floats:
    """Flat points (n, 2) of a bend rolled up, in the frame of the flat pattern (n, 3)."""
    way = y - lay.at
    s, share = way @ lay.along, way @ lay.across / lay.allowance.length
    radius = lay.inside_radius + (0.0 if lay.up else lay.thickness)
    angle = share * lay.angle
    flat = lay.at + s[:, None] * lay.along + (radius * np.sin(angle))[:, None] * lay.across
    height = radius * (1.0 - np.cos(angle)) * (1.0 if lay.up else -1.0)
    return np.column_stack([flat, height])
