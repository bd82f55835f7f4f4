"""Builders of the verification cases: meshes, models, linear solutions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, triu
from scipy.sparse.linalg import spsolve

import umform as uf
from umform.verification.references import record, table

__all__ = ["record", "table"]

Floats = NDArray[np.float64]

#: The steel of the free bending example: N, mm, MPa, perfect plasticity.
STEEL = uf.J2(kappa=175000, mu=80770, hardening=uf.Perfect(160.0))


# Linear problems: the tangent at u = 0 --------------------------------------------------------------------------------


def stiffness(model: uf.Model, evaluation) -> csr_matrix:
    """Tangent over the free degrees of freedom, both triangles."""
    pattern = model.pattern
    K = csr_matrix((evaluation.values, pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n))
    return K + triu(K, 1).T if pattern.symmetric else K


def linear_solution(model: uf.Model, prescribed: Floats, loads: Floats | float = 0.0) -> Floats:
    """Small displacements, shape (n, 3): K u = loads with the fixed degrees of freedom at their prescribed values."""
    u = np.zeros(model.u.size)
    fixed = np.ones(u.size, dtype=bool)
    fixed[model.free] = False
    u[fixed] = np.broadcast_to(prescribed, (u.size // 3, 3)).ravel()[fixed]
    evaluation = model.evaluate(np.zeros(u.size), u)
    rhs = np.broadcast_to(loads, u.shape) - evaluation.predictor
    u[model.free] = spsolve(stiffness(model, evaluation).tocsc(), rhs[model.free])
    return u.reshape(-1, 3)


# Meshes ---------------------------------------------------------------------------------------------------------------


def extruded(points_xy: Floats, quads: NDArray[np.int_], thickness: float, cell: str = "hex8") -> uf.Mesh:
    """Flat plate of quadrilaterals at z = -+ thickness/2; with hex18 the mid-sides are straight."""
    points = [tuple(p) for p in np.asarray(points_xy, dtype=float)]
    number = {point: i for i, point in enumerate(points)}

    def node(*corners: int) -> int:
        point = tuple(np.mean([points_xy[c] for c in sorted(corners)], axis=0))
        if point not in number:
            number[point] = len(points)
            points.append(point)
        return number[point]

    faces = [list(quad) for quad in quads]
    if cell == "hex18":
        faces = [[*q, *(node(q[i], q[(i + 1) % 4]) for i in range(4)), node(*q)] for q in faces]
    flat, faces = np.array(points), np.array(faces)
    both = [np.column_stack([flat, np.full(len(flat), z)]) for z in (-0.5 * thickness, 0.5 * thickness)]
    every = np.arange(len(faces))
    return uf.Mesh(
        np.concatenate(both),
        {cell: np.hstack([faces, faces + len(flat)])},
        faces={name: np.column_stack([every, np.full(len(faces), k)]) for k, name in enumerate(("lower", "upper"))},
    )


def hemisphere(cells: int, cell: str = "hex8", *, radius: float = 10.0, thickness: float = 0.04) -> uf.Mesh:
    """Quarter of a hemisphere with an 18 degree hole.

    Sets: x0 the rim of the hole, x1 the equator, y0 in the plane y = 0, y1 in the plane x = 0.
    """

    def onto_sphere(X: Floats) -> Floats:
        polar, azimuth, r = np.radians(18 + 72 * X[:, 0]), 0.5 * np.pi * X[:, 1], radius + X[:, 2]
        ring = r * np.sin(polar)
        return np.column_stack([ring * np.cos(azimuth), ring * np.sin(azimuth), r * np.cos(polar)])

    return uf.mesh.strip(1, 1, thickness, (cells, cells), cell=cell).transformed(onto_sphere)


# Models ---------------------------------------------------------------------------------------------------------------


def pinched_hemisphere(cells: int, element: str | uf.Element, **options) -> tuple[uf.Model, list, Floats, Floats]:
    """Hemisphere of Sze et al. (2004) with its loads: model, controls (P of the whole shell), nodes of A and of B.

    The quarter carries P/2, half on the lower and half on the upper node: inward along x at B, outward along y at A.
    """
    cell = element.cell if isinstance(element, uf.Element) else uf.elements.element(element).cell
    mesh = hemisphere(cells, cell)
    model = uf.Model(mesh, element, material=uf.SVK(E=6.825e7, nu=0.3), **options)
    model.symmetry("y0", "y")
    model.symmetry("y1", "x")
    at_B, at_A = (np.intersect1d(mesh.nodes("x1"), mesh.nodes(side)) for side in ("y0", "y1"))
    model.fix(at_B[:1], "z")
    loads = [model.force(at_B, (-0.25, 0, 0), "B"), model.force(at_A, (0, 0.25, 0), "A")]
    return model, loads, at_A, at_B


def free_bending(
    cells: tuple[int, int], element: str | uf.Element, points: int | str, **options
) -> tuple[uf.Model, object]:
    """The free bending example (reference/free_bending.csv says what is known of it): model, control of the punch."""
    cell = element.cell if isinstance(element, uf.Element) else uf.elements.element(element).cell
    mesh = uf.mesh.strip(60, 10, 1, cells, cell=cell)
    model = uf.Model(mesh, element, material=STEEL, **{"thickness_points": 5, **options})
    model.symmetry("x0", "x")
    model.fix(np.intersect1d(mesh.nodes("x0_lower"), mesh.nodes("y0")), "y")
    punch = model.prescribe("x0_lower", "z", "punch")
    model.contact("lower", uf.Cylinder((25, 0, -20.5), "y", 20.0), penalty=100.0, points=points, name="cylinder")
    return model, punch
