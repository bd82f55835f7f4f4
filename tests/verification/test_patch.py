"""Patch tests on the plate of MacNeal & Harder: who passes what, and how large the known failures are.

The fields are small and the material linear, so each test is one linear solution with the tangent at u = 0. The four
outer points are prescribed on both faces, the inner nodes are found. Stress on the faces, where a field has any, is put
on as a traction. A field counts as passed only if both the displacements and the energy are right: an element with
thickness locking finds the displacements of bending and yet is too stiff.
"""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.boundary import traction_forces

from .cases import extruded, linear_solution, record, stiffness

PLATE = record("patch_test_plate.json")
POINTS = np.array(list(PLATE["points_xy"].values()))
NUMBER = {int(name): i for i, name in enumerate(PLATE["points_xy"])}
E, NU = PLATE["E"], PLATE["nu"]
MATERIAL = uf.SVK(E=E, nu=NU)
STRAIN = 1e-3

#: Round-off grows steeply with length / thickness: the table is for a plate ten times as thick as that of the
#: reference, where 1e-10 can be asked of everything that passes.
THICKNESS = 10 * PLATE["thickness"]

# Each pair is (error of the displacements, error of the energy), 0 where exact: errors of the
# displacements relative to the largest displacement of the field, errors of the energy relative to the exact one.
EXACT = (0.0, 0.0)

#: THE TABLE. Tying of E_33 and the order in t change nothing in it.
WHO_PASSES_WHAT = {
    # element, thickness modes: membrane, bending, thickness stress, shear xz, shear yz
    ("DISP3D", None): (EXACT, (0.12, 35.0), EXACT, EXACT, EXACT),
    ("DISP3DEAS", 1): (EXACT, (0.12, 35.0), EXACT, EXACT, EXACT),
    ("DISP3DEAS", 4): (EXACT, (0.12, 35.0), EXACT, EXACT, EXACT),
    ("ANS3DEAS", 1): (EXACT, (1.0e-3, 1.1e-2), EXACT, (0.89, 0.91), (12.0, 13.0)),
    ("ANS3DEAS", 4): (EXACT, EXACT, EXACT, (0.95, 0.98), (12.0, 13.0)),
    ("EAS3DEAS", 1): (EXACT, (1.0e-3, 1.1e-2), EXACT, (0.89, 0.91), (12.0, 13.0)),
    ("EAS3DEAS", 4): (EXACT, EXACT, EXACT, (0.95, 0.98), (12.0, 13.0)),
    ("DISP9K3D", None): (EXACT, (0.0, 0.174), EXACT, EXACT, EXACT),
    ("DISP9K3DEAS", 1): (EXACT, (4.7e-4, 1.1e-2), EXACT, EXACT, EXACT),
    ("DISP9K3DEAS", 4): (EXACT, EXACT, EXACT, EXACT, EXACT),
    ("DISP9K3DEAS", 9): (EXACT, EXACT, EXACT, EXACT, EXACT),
    ("MI9K3DEAS", 1): ((8.9e-3, -6.1e-4), (6.8e-4, 1.1e-2), EXACT, EXACT, EXACT),
    ("MI9K3DEAS", 4): ((8.9e-3, -6.1e-4), (1.9e-4, -3.6e-4), EXACT, EXACT, EXACT),
    ("MI9K3DEAS", 9): ((8.9e-3, -6.1e-4), (2.0e-4, -3.7e-4), EXACT, EXACT, EXACT),
    ("MI9K3DEAS with E_12 compatible", 1): (EXACT, (7.3e-4, 1.1e-2), EXACT, EXACT, EXACT),
    ("MI9K3DEAS with E_12 compatible", 4): (EXACT, EXACT, EXACT, EXACT, EXACT),
    ("MI9K3DEAS with E_12 compatible", 9): (EXACT, EXACT, EXACT, EXACT, EXACT),
}
FIELDS = ("membrane", "bending", "thickness", "shear xz", "shear yz")


def gradient(field: str) -> np.ndarray:
    """Constant displacement gradient, symmetric, with stress in the plane, through the thickness or in shear alone."""
    A = np.zeros((3, 3))
    if field == "membrane":
        A[:2, :2] = [[1, 0.5], [0.5, 1]]
        A[2, 2] = -NU / (1 - NU) * 2
    elif field == "thickness":
        A = np.diag([-NU, -NU, 1.0])
    else:
        i = {"shear xz": 0, "shear yz": 1}[field]
        A[i, 2] = A[2, i] = 0.5
    return STRAIN * A


def oriented(quads: list[list[int]], points: np.ndarray) -> np.ndarray:
    """Quadrilaterals by index, turned so that their area is positive."""

    def area(quad: np.ndarray) -> float:
        x, y = points[quad].T
        return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))

    quads = np.array(quads)
    return np.array([quad if area(quad) > 0 else quad[::-1] for quad in quads])


def distorted_plate(cell: str, thickness: float) -> uf.Mesh:
    quads = [[NUMBER[name] for name in quad] for quad in PLATE["quads"]]
    return extruded(POINTS, oriented(quads, POINTS), thickness, cell)


def parallelogram_plate(cell: str, thickness: float) -> uf.Mesh:
    """3 x 2 equal parallelograms in the place of the distorted quadrilaterals."""
    points = np.array([[0.08 * i + 0.03 * j, 0.06 * j + 0.01 * i] for j in range(3) for i in range(4)])
    quads = [[4 * j + i, 4 * j + i + 1, 4 * j + i + 5, 4 * j + i + 4] for j in range(2) for i in range(3)]
    return extruded(points, np.array(quads), thickness, cell)


def outer(mesh: uf.Mesh) -> np.ndarray:
    """Nodes on the lateral faces: those of edges that belong to one quadrilateral."""
    half = mesh.connectivity.shape[1] // 2
    lower = mesh.connectivity[:, :half]
    sides = [lower[:, [i, (i + 1) % 4, *([4 + i] if half == 9 else [])]] for i in range(4)]
    edges = np.concatenate(sides)
    ends, count = np.unique(np.sort(edges[:, :2], axis=1), axis=0, return_counts=True)
    border = {tuple(pair) for pair in ends[count == 1]}
    nodes = np.unique([n for edge in edges if tuple(sorted(edge[:2])) in border for n in edge])
    return np.concatenate([nodes, nodes + len(mesh.points) // 2])


def model_on(make_mesh, name: str, thickness: float = THICKNESS, **options) -> uf.Model:
    if name.endswith("with E_12 compatible"):
        name, options = name.split()[0], {**options, "compatible_E12": True}
    element = uf.elements.element(name, **options)
    model = uf.Model(make_mesh(element.cell, thickness), element, material=MATERIAL)
    model.fix(outer(model.mesh))
    return model


def bending_field(X: np.ndarray) -> np.ndarray:
    x, y, z = X.T
    return STRAIN * np.column_stack([-z * (x + y / 2), -z * (y + x / 2), (x * x + x * y + y * y) / 2])


def patch_error(model: uf.Model, field: str, thickness: float = THICKNESS) -> tuple[float, float]:
    """Errors of displacements and energy, relative to the largest displacement and to the exact energy."""
    X = model.mesh.points
    area = float(traction_forces(model.mesh, "lower", (0, 0, 1)).sum())
    loads: np.ndarray | float = 0.0
    if field == "bending":
        exact = bending_field(X)
        stiff = E * thickness**3 / (12 * (1 - NU**2))
        twice_energy = STRAIN**2 * stiff * (4 - 2 * (1 - NU) * (1 - 0.25)) * area
    else:
        A = gradient(field)
        exact = X @ A.T
        S = MATERIAL.lambda_ * np.trace(A) * np.eye(3) + 2 * MATERIAL.mu * A
        loads = traction_forces(model.mesh, "upper", S[:, 2]) - traction_forces(model.mesh, "lower", S[:, 2])
        twice_energy = float(np.tensordot(S, A)) * area * thickness
    u = linear_solution(model, exact, loads)
    forces = model.evaluate(np.zeros(u.size), u.ravel()).predictor
    return float(np.abs(u - exact).max() / np.abs(exact).max()), float(forces @ u.ravel()) / twice_energy - 1


def assert_as_in_table(found: tuple[float, float], expected: tuple[float, float]) -> None:
    """Exact to 1e-10, or off by what the table says."""
    for value, error in zip(found, expected, strict=True):
        if error == 0.0:
            assert abs(value) < 1e-10
        else:
            assert value == pytest.approx(error, rel=0.06)


def options_of(modes: int | None) -> list[dict]:
    """With and without tying of E_33, and where there are thickness modes, order 1 and 3."""
    if modes is None:
        return [{}, {"tie_E33": True}]
    return [{"thickness_modes": modes, "thickness_order": p, "tie_E33": t} for p in (1, 3) for t in (False, True)]


@pytest.mark.parametrize("field", FIELDS)
@pytest.mark.parametrize(("name", "modes"), WHO_PASSES_WHAT)
def test_distorted_plate(name, modes, field):
    expected = WHO_PASSES_WHAT[name, modes][FIELDS.index(field)]
    for options in options_of(modes):
        assert_as_in_table(patch_error(model_on(distorted_plate, name, **options), field), expected)


@pytest.mark.parametrize("membrane_modes", [4, 5, 7])
@pytest.mark.parametrize("field", ["membrane", "bending", "thickness"])
def test_membrane_modes_do_no_harm(membrane_modes, field):
    model = model_on(distorted_plate, "EAS3DEAS", membrane_modes=membrane_modes)
    assert_as_in_table(patch_error(model, field), EXACT)


@pytest.mark.parametrize("field", FIELDS)
@pytest.mark.parametrize("name", ["ANS3DEAS", "EAS3DEAS", "DISP9K3DEAS", "MI9K3DEAS"])
def test_parallelograms_pass_everything(name, field):
    for options in ({}, {"thickness_modes": 1}, {"thickness_order": 3, "tie_E33": True}):
        assert_as_in_table(patch_error(model_on(parallelogram_plate, name, **options), field), EXACT)


@pytest.mark.parametrize("name", ["ANS3DEAS", "EAS3DEAS", "DISP9K3DEAS", "MI9K3DEAS with E_12 compatible"])
@pytest.mark.parametrize("options", [{}, {"thickness_order": 3, "tie_E33": True}], ids=["default", "order 3, tied"])
def test_deflections_of_the_reference(name, options):
    """The plate as it is in the literature, length/thickness = 240: round-off leaves 1e-9 ... 1e-8."""
    thickness = PLATE["thickness"]
    model = model_on(distorted_plate, name, thickness, **options)
    u = linear_solution(model, bending_field(model.mesh.points))
    for point, uz in PLATE["expected_uz_bending"].items():
        at = np.flatnonzero(np.abs(model.mesh.points[:, :2] - POINTS[NUMBER[int(point)]]).max(axis=1) < 1e-12)
        assert len(at) == 2
        assert u[at, 2] == pytest.approx(uz, rel=1e-6)


def test_single_thickness_mode_on_the_plate_of_the_reference():
    """One mode t: the largest error is 5e-8, 0.26 % of the deflection 1.935e-5."""
    model = model_on(distorted_plate, "ANS3DEAS", PLATE["thickness"], thickness_modes=1)
    exact = bending_field(model.mesh.points)
    error = np.abs(linear_solution(model, exact) - exact).max()
    assert error == pytest.approx(5e-8, rel=0.05)
    assert error / PLATE["expected_uz_bending"]["1"] == pytest.approx(0.0026, rel=0.05)


@pytest.mark.parametrize("name", dict.fromkeys(name for name, _ in WHO_PASSES_WHAT))
def test_six_zero_modes(name):
    """A free distorted element has its six rigid motions and no other mode without energy."""
    modes = [m for n, m in WHO_PASSES_WHAT if n == name]
    for options in (o for m in modes for o in options_of(m)):
        if name.endswith("compatible"):
            options = {**options, "compatible_E12": True}
        element = uf.elements.element(name.split()[0], **options)
        corners = np.array([[0, 0], [2.1, 0.2], [1.7, 1.6], [-0.3, 1.4]])
        mesh = extruded(corners, np.array([[0, 1, 2, 3]]), 0.3, element.cell)
        model = uf.Model(mesh, element, material=uf.SVK(E=1.0, nu=0.3))
        eigenvalues = np.linalg.eigvalsh(stiffness(model, model.evaluate(model.u)).toarray())
        assert (np.abs(eigenvalues) < 1e-12 * eigenvalues[-1]).sum() == 6
        assert eigenvalues[6] > 1e-5 * eigenvalues[-1]


@pytest.mark.parametrize("name", ["DISP3DEAS", "ANS3DEAS", "EAS3DEAS"])
def test_nine_thickness_modes_need_18_nodes(name):
    """With 2 x 2 Gauss points r² is a constant: nine modes are dependent, and the element says so."""
    with pytest.raises(uf.errors.InvalidValue):
        model_on(distorted_plate, name, thickness_modes=9)
