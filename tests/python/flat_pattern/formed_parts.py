"""Triangulated formed parts with known blanks."""

from __future__ import annotations

import numpy as np


def grid(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles of a grid of points (k, m, 3)."""
    k, m, _ = points.shape
    at = np.arange(k * m).reshape(k, m)
    a, b, c, d = at[:-1, :-1].ravel(), at[:-1, 1:].ravel(), at[1:, 1:].ravel(), at[1:, :-1].ravel()
    return points.reshape(-1, 3), np.concatenate([np.stack([a, d, c], 1), np.stack([a, c, b], 1)])


def cylinder(angle: float = 2.0, radius: float = 20.0, length: float = 30.0, cells: tuple[int, int] = (20, 10)):
    """Part of a cylinder about y."""
    a, y = np.meshgrid(
        np.linspace(-0.5 * angle, 0.5 * angle, cells[0] + 1), np.linspace(0.0, length, cells[1] + 1), indexing="ij"
    )
    return grid(np.stack([radius * np.sin(a), y, radius * np.cos(a)], axis=-1))
