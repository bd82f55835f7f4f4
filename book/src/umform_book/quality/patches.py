"""Patch tests: meshes of a plate, constant states and their exact fields, and the error of an element in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.elements import element
from umform.elements.technology import Element
from umform.materials import J2, SVK, Perfect
from umform.materials.material import Material
from umform.mesh import Mesh
from umform.model import Model
from umform.model.terms.forces import body_forces, rigid_body_modes
from umform_book.linear_algebra import linear_solution
from umform_book.references import record

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: The plate of MacNeal & Harder (1985).
PLATE = record("patch_test_plate.json")
POINTS: Floats = np.array(list(PLATE["points_xy"].values()))
NUMBER = {int(name): i for i, name in enumerate(PLATE["points_xy"])}
MATERIAL = SVK(E=PLATE["E"], nu=PLATE["nu"])
#: A plastic law that never flows, for the points and the order that elements have with one.
NEVER_FLOWS = J2(E=PLATE["E"], nu=PLATE["nu"], hardening=Perfect(PLATE["E"]))
STRAIN = 1e-3
#: Round-off grows steeply with length / thickness: with a plate ten times as thick as that of the reference all
#: that pass reach 1e-10.
THICKNESS: float = 10 * PLATE["thickness"]

#: Constant states: stress in the plane, in bending, through the thickness alone, in transverse shear alone.
FIELDS = ("membrane", "bending", "thickness", "shear xz", "shear yz")


# Meshes ---------------------------------------------------------------------------------------------------------------


def extruded(points_xy: Floats, quads: ArrayLike, levels: Sequence[ArrayLike], cell: str = "hex8") -> Mesh:
    """Plate of quadrilaterals between surfaces, one layer of cells between each surface and the next.

    Parameters
    ----------
    points_xy : ndarray, shape (n, 2)
        Points of the quadrilaterals.
    quads : array_like of int, shape (m, 4)
        Their corners, counter-clockwise.
    levels : sequence of array_like
        z of each surface, from below: a number, or one for each point.
    cell : {"hex8", "hex18"}
        Cell type; with hex18 the mid-sides are straight.

    Returns
    -------
    Mesh
        With the face sets lower and upper, and the node set outer: the nodes on the lateral faces.
    """
    z = [np.broadcast_to(np.asarray(level, dtype=float), len(points_xy)) for level in levels]
    corners: Floats = np.column_stack([points_xy, *z])
    faces = np.asarray(quads, dtype=np.int64)
    if cell == "hex18":
        corners, faces = _with_mid_nodes(corners, faces)
    count, layers = len(corners), len(levels) - 1
    points = np.concatenate([np.column_stack([corners[:, :2], corners[:, 2 + k]]) for k in range(layers + 1)])
    cells = np.concatenate([np.hstack([faces + k * count, faces + (k + 1) * count]) for k in range(layers)])
    every = np.arange(len(faces))
    return Mesh(
        points,
        {cell: cells},
        {"outer": np.concatenate([_border(faces) + k * count for k in range(layers + 1)])},
        {
            "lower": np.column_stack([every, np.zeros_like(every)]),
            "upper": np.column_stack([every + (layers - 1) * len(faces), np.ones_like(every)]),
        },
    )


def _with_mid_nodes(points: Floats, quads: Ids) -> tuple[Floats, Ids]:
    """Points with the mid-sides and centres of the quadrilaterals, and these with nine nodes."""
    groups = [quads[:, [i]] for i in range(4)] + [quads[:, [i, (i + 1) % 4]] for i in range(4)] + [quads]
    number: dict[tuple[int, ...], int] = {(i,): i for i in range(len(points))}
    every = list(points)
    faces = np.empty((len(quads), 9), dtype=np.int64)
    for place, group in enumerate(groups):
        for face, corners in enumerate(group):
            key = tuple(sorted(int(c) for c in corners))
            if key not in number:
                number[key] = len(every)
                every.append(points[list(key)].mean(axis=0))
            faces[face, place] = number[key]
    return np.array(every), faces


def _border(faces: Ids) -> Ids:
    """Nodes of the edges that belong to one quadrilateral."""
    nine = faces.shape[1] == 9
    edges = np.concatenate([faces[:, [i, (i + 1) % 4, *([4 + i] if nine else [])]] for i in range(4)])
    _, which, count = np.unique(np.sort(edges[:, :2], axis=1), axis=0, return_inverse=True, return_counts=True)
    return np.unique(edges[count[which.ravel()] == 1])


def _grid(skew: float) -> tuple[Floats, Ids]:
    """3 x 2 equal rectangles or parallelograms in the place of the distorted quadrilaterals."""
    points = np.array([[0.08 * i + 3 * skew * j, 0.06 * j + skew * i] for j in range(3) for i in range(4)])
    return points, np.array(
        [[4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4] for j in range(2) for i in range(3)]
    )


def _distorted() -> tuple[Floats, Ids]:
    """The five quadrilaterals of MacNeal & Harder (1985), turned so that their area is positive."""
    quads = np.array([[NUMBER[name] for name in quad] for quad in PLATE["quads"]])
    x, y = POINTS[quads].transpose(2, 0, 1)
    area = (x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1)).sum(axis=1)
    return POINTS, np.where(area[:, None] > 0, quads, quads[:, ::-1])


def _inner(points: Floats, quads: Ids, values: Sequence[float]) -> Floats:
    """Values at the inner points, in turn; zero at the outer ones."""
    inner = np.setdiff1d(np.arange(len(points)), _border(quads))
    z = np.zeros(len(points))
    z[inner] = np.resize(values, len(inner))
    return z


def regular_plate(cell: str, thickness: float) -> Mesh:
    """Rectangles."""
    return extruded(*_grid(0.0), (-0.5 * thickness, 0.5 * thickness), cell)


def parallelogram_plate(cell: str, thickness: float) -> Mesh:
    """Equal parallelograms."""
    return extruded(*_grid(0.01), (-0.5 * thickness, 0.5 * thickness), cell)


def distorted_plate(cell: str, thickness: float) -> Mesh:
    """The quadrilaterals of MacNeal & Harder (1985)."""
    return extruded(*_distorted(), (-0.5 * thickness, 0.5 * thickness), cell)


def warped_plate(cell: str, thickness: float) -> Mesh:
    """Rectangles in plan whose inner nodes lie half a thickness above and below the plane."""
    points, quads = _grid(0.0)
    z = _inner(points, quads, (0.5 * thickness, -0.5 * thickness))
    return extruded(points, quads, (z - 0.5 * thickness, z + 0.5 * thickness), cell)


def stacked_plate(cell: str, thickness: float) -> Mesh:
    """Two layers of rectangles, parted at half the thickness."""
    return extruded(*_grid(0.0), (-0.5 * thickness, 0.0, 0.5 * thickness), cell)


def uneven_stack(cell: str, thickness: float) -> Mesh:
    """Two layers of rectangles; the inner nodes of the interface lie a fifth of the thickness above and below."""
    points, quads = _grid(0.0)
    z = _inner(points, quads, (0.2 * thickness, -0.2 * thickness))
    return extruded(points, quads, (-0.5 * thickness, z, 0.5 * thickness), cell)


MESHES: dict[str, Callable[[str, float], Mesh]] = {
    "regular": regular_plate,
    "parallelograms": parallelogram_plate,
    "distorted": distorted_plate,
    "warped": warped_plate,
    "stacked": stacked_plate,
    "uneven stack": uneven_stack,
}


def fields_on(mesh: str) -> tuple[str, ...]:
    """States that are exact solutions on a mesh: bending needs plane faces."""
    return tuple(field for field in FIELDS if not (field == "bending" and mesh == "warped"))


# States ---------------------------------------------------------------------------------------------------------------


def gradient(field: str) -> Floats:
    """Constant displacement gradient, symmetric, with stress in the plane, through the thickness or in shear alone."""
    nu = PLATE["nu"]
    A = np.zeros((3, 3))
    if field == "membrane":
        A[:2, :2] = [[1, 0.5], [0.5, 1]]
        A[2, 2] = -nu / (1 - nu) * 2
    elif field == "thickness":
        A = np.diag([-nu, -nu, 1.0])
    else:
        i = {"shear xz": 0, "shear yz": 1}[field]
        A[i, 2] = A[2, i] = 0.5
    return STRAIN * A


def bending_field(X: Floats, thickness: float) -> Floats:
    """Displacements (n, 3) of curvatures 1, 1 and twist 1/2 with free faces, where u_z is that of the mid-surface."""
    nu = PLATE["nu"]
    x, y, z = X.T
    thinning = nu / (1 - nu) * (z * z - 0.25 * thickness**2)
    return STRAIN * np.column_stack([-z * (x + y / 2), -z * (y + x / 2), (x * x + x * y + y * y) / 2 + thinning])


def stress_forces(mesh: Mesh, S: Floats) -> Floats:
    """Nodal forces (3 n,) of the tractions S n of a constant stress on the lower and upper faces. eq. (5.2)"""
    half = mesh.connectivity.shape[1] // 2
    x, w = _core.gauss(2 if half == 4 else 3)
    r, s = (a.ravel() for a in np.meshgrid(x, x, indexing="ij"))
    N, dN = _core.shell_functions(2 * half, np.column_stack([r, s, np.full(r.size, -1.0)]))
    forces = np.zeros((len(mesh.points), 3))
    for side in ("lower", "upper"):
        ids = mesh.facets(side)
        g = np.einsum("qia,eak->eqik", dN[:, :2, :half], mesh.points[ids])
        tractions = np.cross(g[:, :, 0], g[:, :, 1]) @ S
        np.add.at(forces, ids, np.einsum("q,qa,eqk->eak", np.outer(w, w).ravel(), N[:, :half], tractions))
    return forces.ravel()


def patch_model(mesh: str, name: str | Element, thickness: float = THICKNESS, **options: int | bool) -> Model:
    """Plate held at its lateral faces, with an element of the catalogue and its options."""
    return _held(mesh, element(name, **options), MATERIAL, thickness)


def plastic_patch_model(mesh: str, name: str, **options: int | bool) -> Model:
    """The same with points and order of a plastic law, which does not flow."""
    return _held(mesh, element(name, **options), NEVER_FLOWS, THICKNESS)


def _held(mesh: str, technology: Element, material: Material, thickness: float) -> Model:
    model = Model(MESHES[mesh](technology.cell, thickness), technology, material=material)
    model.fix("outer")
    return model


def patch_error(model: Model, field: str, thickness: float = THICKNESS) -> tuple[float, float]:
    """Errors of the displacements, over the largest one, and of the energy, over the exact one.

    Both must vanish: an element with thickness locking finds the displacements of bending and yet is too stiff.
    """
    E, nu = PLATE["E"], PLATE["nu"]
    X = model.mesh.points
    volume = float(body_forces(model.mesh, (0, 0, 1)).sum())
    loads: Floats | float = 0.0
    if field == "bending":
        exact = bending_field(X, thickness)
        stiff = E * thickness**2 / (12 * (1 - nu**2))
        twice_energy = STRAIN**2 * stiff * (4 - 2 * (1 - nu) * (1 - 0.25)) * volume
    else:
        A = gradient(field)
        exact = X @ A.T
        S = MATERIAL.lambda_ * np.trace(A) * np.eye(3) + 2 * MATERIAL.mu * A
        loads = stress_forces(model.mesh, S)
        twice_energy = float(np.tensordot(S, A)) * volume
    u = linear_solution(model, loads, exact)
    strained = _without_rigid_motion(X, u)
    forces = model.evaluate(np.zeros(u.size), strained).predictor
    return float(np.abs(u - exact).max() / np.abs(exact).max()), float(forces @ strained) / twice_energy - 1


def _without_rigid_motion(X: Floats, u: Floats) -> Floats:
    """Displacements (3 n,) without their rigid part, which has no energy but round-off."""
    modes = rigid_body_modes(X).T
    strained: Floats = u.ravel() - modes @ np.linalg.lstsq(modes, u.ravel(), rcond=None)[0]
    return strained
