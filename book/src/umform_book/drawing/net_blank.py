"""A square cup whose flange must end on a given outline: one-step estimate, incremental run, correction, run."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.flat_pattern.net.edge import Edge
from umform.flat_pattern.net.star import Star, stretched
from umform.flat_pattern.one_step import distance_to_outline
from umform.mesh import Mesh
from umform.surfaces.stl import welded
from umform.surfaces.triangles import Triangles
from umform_book.drawing.square_cup import ALUMINIUM, FRICTION, HOLDER, THICKNESS

Floats = NDArray[np.float64]

#: Half of the side and radius of the corners of the wanted outline of the flange, mm.
HALF, CORNER = 66.0, 30.0
#: Points of the corner of the outline.
_POINTS = 13


def wanted() -> Floats:
    """A quarter of the outline, from the x-axis to the y-axis."""
    angle = np.linspace(0.0, 0.5 * math.pi, _POINTS)
    corner = HALF - CORNER + CORNER * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    side = np.linspace(0.0, HALF - CORNER, 8)[:-1]
    return np.concatenate([np.c_[np.full(7, HALF), side], corner, np.c_[side[::-1], np.full(7, HALF)]])


def whole(mesh: Mesh, u: Floats) -> tuple[Triangles, Floats]:
    """The whole formed mid-surface of a quarter, and the places of its points in the blank."""
    formed, flat = uf.mid_surface(mesh, u), uf.mid_surface(mesh, 0.0 * u).points[:, :2]
    points, places, triangles = [], [], []
    for k, (x, y) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        points.append(formed.points * [x, y, 1])
        places.append(flat * [x, y])
        turned = formed.triangles if x * y > 0 else formed.triangles[:, ::-1]
        triangles.append(turned + k * len(flat))
    all_places = np.concatenate(places)
    keys = np.round(all_places * 1e4).astype(np.int64)
    _, first, ids = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    found = Triangles(np.concatenate(points)[first], ids.ravel()[np.concatenate(triangles)])
    return found, all_places[first]


def trimmed(surface: Triangles) -> Triangles:
    """The part inside of the wanted outline."""
    quarter = wanted()
    for p, q in pairwise(quarter):
        n = np.array([q[1] - p[1], p[0] - q[0]])
        for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
            surface = surface.beyond((-n[0] * x, -n[1] * y, 0.0), (p[0] * x, p[1] * y, 0.0))
    return welded(surface.points, surface.triangles, 0.05)[0]


def estimate(mesh: Mesh, u: Floats) -> uf.BlankEstimate:
    """One-step estimate of the blank of the trimmed part."""
    part = trimmed(whole(mesh, u)[0])
    return uf.blank(part, uf.Blank(ALUMINIUM, THICKNESS, holder_force=HOLDER, friction=FRICTION))


def cut(square: Mesh, edge: Edge, outline: Floats) -> Mesh:
    """The square mesh, stretched to another outline of the blank."""
    return stretched(square, edge.star, Star.of(outline, edge.star.centre, "outline"))


def error(after: Floats) -> Floats:
    """Distance of the formed edge from the wanted outline, mm."""
    return distance_to_outline(after, wanted())
