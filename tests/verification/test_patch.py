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
from umform_book.linear_algebra import linear_solution, stiffness
from umform_book.quality.patches import (
    FIELDS,
    NUMBER,
    PLATE,
    POINTS,
    bending_field,
    extruded,
    patch_error,
    patch_model,
)

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


def model_on(mesh: str, name: str, **options) -> uf.Model:
    if name.endswith("with E_12 compatible"):
        name, options = name.split()[0], {**options, "compatible_E12": True}
    return patch_model(mesh, name, **options)


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
        assert_as_in_table(patch_error(model_on("distorted", name, **options), field), expected)


@pytest.mark.parametrize("membrane_modes", [4, 5, 7])
@pytest.mark.parametrize("field", ["membrane", "bending", "thickness"])
def test_membrane_modes_do_no_harm(membrane_modes, field):
    model = model_on("distorted", "EAS3DEAS", membrane_modes=membrane_modes)
    assert_as_in_table(patch_error(model, field), EXACT)


@pytest.mark.parametrize("field", FIELDS)
@pytest.mark.parametrize("name", ["ANS3DEAS", "EAS3DEAS", "DISP9K3DEAS", "MI9K3DEAS"])
def test_parallelograms_pass_everything(name, field):
    for options in ({}, {"thickness_modes": 1}, {"thickness_order": 3, "tie_E33": True}):
        assert_as_in_table(patch_error(model_on("parallelograms", name, **options), field), EXACT)


@pytest.mark.parametrize("name", ["ANS3DEAS", "EAS3DEAS", "DISP9K3DEAS", "MI9K3DEAS with E_12 compatible"])
@pytest.mark.parametrize("options", [{}, {"thickness_order": 3, "tie_E33": True}], ids=["default", "order 3, tied"])
def test_deflections_of_the_reference(name, options):
    """The plate as it is in the literature, length/thickness = 240: round-off leaves 1e-9 ... 1e-8."""
    thickness = PLATE["thickness"]
    model = model_on("distorted", name, thickness=thickness, **options)
    u = linear_solution(model, prescribed=bending_field(model.mesh.points, thickness))
    for point, uz in PLATE["expected_uz_bending"].items():
        at = np.flatnonzero(np.abs(model.mesh.points[:, :2] - POINTS[NUMBER[int(point)]]).max(axis=1) < 1e-12)
        assert len(at) == 2
        assert u[at, 2] == pytest.approx(uz, rel=1e-6)


def test_single_thickness_mode_on_the_plate_of_the_reference():
    """One mode t: the largest error is 5e-8, 0.26 % of the deflection 1.935e-5."""
    model = model_on("distorted", "ANS3DEAS", thickness=PLATE["thickness"], thickness_modes=1)
    exact = bending_field(model.mesh.points, PLATE["thickness"])
    error = np.abs(linear_solution(model, prescribed=exact) - exact).max()
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
        mesh = extruded(corners, [[0, 1, 2, 3]], (-0.15, 0.15), element.cell)
        model = uf.Model(mesh, element, material=uf.SVK(E=1.0, nu=0.3))
        eigenvalues = np.linalg.eigvalsh(stiffness(model, model.evaluate(model.u)).toarray())
        assert (np.abs(eigenvalues) < 1e-12 * eigenvalues[-1]).sum() == 6
        assert eigenvalues[6] > 1e-5 * eigenvalues[-1]


@pytest.mark.parametrize("name", ["DISP3DEAS", "ANS3DEAS", "EAS3DEAS"])
def test_nine_thickness_modes_need_18_nodes(name):
    """With 2 x 2 Gauss points r² is a constant: nine modes are dependent, and the element says so."""
    with pytest.raises(uf.errors.InvalidValue):
        model_on("distorted", name, thickness_modes=9)
