"""Triangulated formed parts of revolution: a cup and a cap."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]


def disc(rings: int) -> tuple[Floats, Ids]:
    """Unit disc in rings, each of six points more than the one inside: points (n, 2), triangles."""
    points, first, triangles = [(0.0, 0.0)], [0], []
    for k in range(1, rings + 1):
        first.append(len(points))
        angle = 2.0 * np.pi * np.arange(6 * k) / (6 * k)
        points += [(k / rings * np.cos(a), k / rings * np.sin(a)) for a in angle]
    for k in range(1, rings + 1):
        for sector in range(6):
            for j in range(k):
                outer = [first[k] + (sector * k + j + i) % (6 * k) for i in (0, 1)]
                inner = [first[k - 1] + (sector * (k - 1) + j + i) % max(6 * (k - 1), 1) for i in (0, 1)]
                triangles.append((inner[0], *outer))
                if j < k - 1:
                    triangles.append((inner[0], outer[1], inner[1]))
    return np.array(points), np.array(triangles, dtype=np.int64)


def cup(rings: int, height: float, radius: float = 30.6, nose: float = 5.5, half: float = 0.5) -> tuple[Floats, Ids]:
    """Mid-surface of a cup of a height over all, half of the thickness below its bottom."""
    flat, triangles = disc(rings)
    r, angle = np.hypot(*flat.T), np.arctan2(flat[:, 1], flat[:, 0])
    bottom = radius - nose
    s = r * (bottom + 0.5 * np.pi * nose + height - half - nose)
    a = np.clip((s - bottom) / nose, 0.0, 0.5 * np.pi)
    out = np.where(s < bottom, s, bottom + nose * np.sin(a))
    up = nose - nose * np.cos(a) + np.maximum(s - bottom - 0.5 * np.pi * nose, 0.0)
    return np.stack([out * np.cos(angle), out * np.sin(angle), up], axis=1), triangles


def cap(rings: int, radius: float = 50.0) -> tuple[Floats, Ids, Floats]:
    """A hemisphere whose points are those of a disc that Hill's solution stretches there, and their places in it."""
    flat, triangles = disc(rings)
    x, y = flat.T
    below = 1.0 + x**2 + y**2
    return radius * np.stack([2.0 * x / below, 2.0 * y / below, 2.0 / below - 1.0], axis=1), triangles, radius * flat
