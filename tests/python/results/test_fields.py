"""Fields against closed forms: stress in uniform finite strain, thickness, plastic strain."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import polar

from umform import materials as mt
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue
from umform.mesh import strip
from umform.model import Model
from umform.results import fields

KAPPA, MU = 175e3, 80.77e3
LAW = mt.NeoHooke(kappa=KAPPA, mu=MU)
F = np.array([[1.2, 0.15, -0.1], [0.05, 0.9, 0.2], [0.1, -0.05, 1.1]])
PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]


def voigt(tensor):
    return np.stack([tensor[..., i, j] for i, j in PAIRS], axis=-1)


def cauchy(gradient):
    """Neo-Hooke in the form sigma = (mu (b - 1) + lambda ln J 1) / J."""
    J = np.linalg.det(gradient)
    lame = KAPPA - 2 / 3 * MU
    return (MU * (gradient @ gradient.T - np.eye(3)) + lame * math.log(J) * np.eye(3)) / J


def uniform(build, element, gradient, layers=2):
    """A model in a uniform deformation; displacement elements on a distorted mesh, the others on boxes."""
    cell = "hex18" if "9K" in element else "hex8"
    made = strip(3.0, 2.0, 0.4, (2, 2), cell=cell, layers=layers)
    if not element.endswith("EAS"):
        made = build.jittered(made, 0.15)
    model = Model(made, element, material=LAW)
    u = (made.points @ gradient.T - made.points).ravel()
    evaluation = model.evaluate(u)
    assert evaluation.failed == -1
    model.system.commit(evaluation)
    return model


@pytest.mark.parametrize("element", ["DISP3D", "ANS3DEAS", "EAS3DEAS", "DISP9K3D", "MI9K3DEAS"])
def test_stresses_in_uniform_finite_strain(build, element):
    at = fields.point_fields(uniform(build, element, F))
    sigma, J, F_inv = cauchy(F), np.linalg.det(F), np.linalg.inv(F)
    pk2 = J * F_inv @ sigma @ F_inv.T
    R, _ = polar(F)
    scale = np.abs(sigma).max()
    local = at.frame  # rows e_1, e_2, e_3
    np.testing.assert_allclose(at.F, np.broadcast_to(F, at.F.shape), atol=1e-13)
    np.testing.assert_allclose(local @ np.swapaxes(local, -1, -2), np.broadcast_to(np.eye(3), at.F.shape), atol=1e-14)
    np.testing.assert_allclose(local[..., 2, :], np.broadcast_to([0, 0, 1.0], local[..., 2, :].shape), atol=1e-14)

    def check(kind, frame, expected):
        np.testing.assert_allclose(
            at.stress(kind, frame), np.broadcast_to(voigt(expected), at.S.shape), atol=1e-11 * scale
        )

    check("cauchy", "global", sigma)
    check("pk2", "global", pk2)
    check("pk2", "local", local @ pk2 @ np.swapaxes(local, -1, -2))
    check("cauchy", "local", local @ (R.T @ sigma @ R) @ np.swapaxes(local, -1, -2))
    strain = local @ (0.5 * (F.T @ F - np.eye(3))) @ np.swapaxes(local, -1, -2)
    np.testing.assert_allclose(at.E, voigt(strain) * [1, 1, 1, 2, 2, 2], atol=1e-13)
    np.testing.assert_allclose(at.cell_average(at.stress()), np.broadcast_to(voigt(sigma), (8, 6)), atol=1e-11 * scale)
    assert at.volume.sum() == pytest.approx(3.0 * 2.0 * 0.4, rel=1e-13)
    assert at.eqps is None


@pytest.mark.parametrize("element", ["ANS3DEAS", "MI9K3DEAS"])
def test_a_rigid_rotation_leaves_local_stresses_and_turns_global_ones(build, rotation, element):
    one = fields.point_fields(uniform(build, element, F))
    other = fields.point_fields(uniform(build, element, rotation @ F))
    scale = np.abs(one.S).max()
    for kind, frame in (("cauchy", "local"), ("pk2", "local"), ("pk2", "global")):
        np.testing.assert_allclose(other.stress(kind, frame), one.stress(kind, frame), atol=1e-11 * scale)
    turned = voigt(rotation @ cauchy(F) @ rotation.T)
    np.testing.assert_allclose(other.stress(), np.broadcast_to(turned, one.S.shape), atol=1e-11 * scale)


def test_cauchy_stress_of_a_bar_in_tension(build):
    """Force over the current area, with an element whose thickness strain is enhanced."""
    material = mt.J2(kappa=175000.0, mu=80770.0, hardening=mt.Linear(160.0, 500.0))
    model, pull = build.bar(material=material)
    result = solve(model, Move(pull, 0.2, steps=10), frames=0)
    at = fields.point_fields(model)
    x = model.positions
    area = np.ptp(x[:, 1]) * np.ptp(x[:, 2])
    sigma = at.stress()
    np.testing.assert_allclose(sigma[..., 0], result["pull_force"][-1] / area, rtol=1e-8)
    np.testing.assert_allclose(sigma[..., 1:], 0.0, atol=1e-5)
    np.testing.assert_allclose(at.eqps, 0.1811284, atol=5e-8)
    last = fields.thickness_change(model)
    np.testing.assert_allclose(last, np.ptp(x[:, 2]) / 0.4 - 1, rtol=1e-9)
    assert (last < -0.05).all()


def test_unknown_kinds_and_frames_are_refused(build):
    at = fields.point_fields(uniform(build, "ANS3DEAS", np.eye(3)))
    for kind, frame in (("kirchhoff", "global"), ("cauchy", "here")):
        with pytest.raises(InvalidValue):
            at.stress(kind, frame)


@pytest.mark.parametrize("cell", ["DISP3D", "DISP9K3D"])
@pytest.mark.parametrize("layers", [1, 2])
def test_thickness_is_measured_along_the_normal(build, rotation, cell, layers):
    stretch = np.diag([1.0, 1.0, 1.1])
    shear = np.array([[1.0, 0, 0.7], [0, 1, -0.3], [0, 0, 1]])
    cases = {
        "stretch": (stretch, 0.1),
        "shear": (shear, 0.0),
        "rotation": (rotation, 0.0),
        "all": (F, 1 / np.linalg.norm(np.linalg.inv(F).T[:, 2]) - 1),
    }
    for gradient, expected in cases.values():
        model = uniform(build, cell, gradient, layers)
        np.testing.assert_allclose(fields.thickness_change(model), expected, atol=1e-12)
        np.testing.assert_allclose(fields.thickness(model), 0.4 / layers * (1 + expected), atol=1e-12)


def test_frames_hold_reactions_and_fields(build):
    case = build.free_bending((8, 1))
    result = solve(case.model, Move(case.punch, -1.0, steps=2), frames=2)
    frame = result.frames[-1]
    nodes, cells = len(case.model.mesh.points), len(case.model.mesh.connectivity)
    assert {name: values.shape for name, values in frame.points.items()} == {
        "displacement": (nodes, 3),
        "reaction": (nodes, 3),
        "thickness_change": (nodes,),
        "contact_pressure": (nodes,),
        "contact_gap": (nodes,),
    }
    assert all(len(values) == cells for values in frame.cells.values())
    assert "plastic_strain_max" in frame.cells
    total = frame.points["reaction"].sum(axis=0)
    np.testing.assert_allclose(total[2], result["punch_force"][-1], rtol=1e-9)
    free = frame.points["reaction"].ravel()[case.model.system.free]
    assert (free == 0).all()


def von_mises(stress):
    sigma = stress[..., [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
    deviator = sigma - np.trace(sigma, axis1=-2, axis2=-1)[..., None, None] / 3 * np.eye(3)
    return np.sqrt(1.5 * (deviator**2).sum(axis=(-2, -1)))


@pytest.mark.parametrize(("element", "rolling"), [("ANS3DEAS", None), ("MI9K3DEAS", (0.6, 0.8, 0.0))])
def test_fields_of_cells_are_means_and_largest_values_of_their_points(build, element, rolling):
    """Seven cells, which fill no register, unevenly plastic."""
    cell = "hex18" if "9K" in element else "hex8"
    made = build.jittered(strip(7.0, 1.0, 0.5, (7, 1), cell=cell), 0.1)
    model = Model(made, element, material=mt.J2(E=210e3, nu=0.3, hardening=mt.Linear(160.0, 500.0)), rolling=rolling)
    model.fix("x0")
    end = model.prescribe("x1_lower", "z", name="end")
    cells = solve(model, Move(end, to=1.0, steps=4), frames=1).frames[-1].cells
    at = fields.point_fields(model)
    eqps = at.eqps
    assert (eqps.max(axis=1) > 0).any() and np.ptp(eqps, axis=1).max() > 1e-4
    expected = {
        "stress_cauchy": at.cell_average(at.stress()),
        "stress_cauchy_local": at.cell_average(at.stress(frame="local")),
        "stress_pk2": at.cell_average(at.stress("pk2")),
        "stress_pk2_local": at.cell_average(at.stress("pk2", "local")),
        "stress_von_mises": von_mises(at.stress()).max(axis=1),
        "plastic_strain_mean": at.cell_average(eqps),
        "plastic_strain_max": eqps.max(axis=1),
    }
    assert list(cells) == [*expected, *(["rolling"] if rolling else [])]
    for name, values in expected.items():
        np.testing.assert_allclose(cells[name], values, rtol=1e-12, atol=1e-12 * np.abs(values).max(), err_msg=name)


def test_a_plastic_frame_has_the_yield_stress_as_its_von_mises_stress(build):
    """Cauchy and Kirchhoff stress differ by det F, which is that of a small elastic strain."""
    material = mt.J2(kappa=175000.0, mu=80770.0, hardening=mt.Linear(160.0, 500.0))
    model, pull = build.bar(material=material)
    frame = solve(model, Move(pull, 0.2, steps=10), frames=1).frames[-1]
    flow = 160.0 + 500.0 * frame.cells["plastic_strain_max"]
    np.testing.assert_allclose(frame.cells["stress_von_mises"], flow, rtol=2e-3)


@pytest.mark.parametrize("element", ["ANS3DEAS", "DISP3D", "MI9K3DEAS"])
def test_positions_of_the_points(build, element):
    """Their weights are those of the volume and its first moments; a motion of the nodes is that of the points."""
    made = build.jittered(strip(3.0, 2.0, 0.4, (3, 2), cell="hex18" if "9K" in element else "hex8"), 0.15)
    model = Model(made, element, material=mt.J2(E=206e3, nu=0.3, hardening=mt.Linear(200.0, 1000.0)))
    turn = np.array([[1.1, 0.2, 0.0], [-0.1, 0.95, 0.05], [0.02, 0.0, 1.0]])
    model.u = (made.points @ turn.T + [1.0, 2.0, 3.0] - made.points).ravel()
    at = fields.point_fields(model)
    assert at.X.shape == at.x.shape == (*at.volume.shape, 3)
    np.testing.assert_allclose(at.x, at.X @ turn.T + [1.0, 2.0, 3.0], atol=1e-12)
    points = made.points[made.connectivity]
    low, high = points.min(axis=1, keepdims=True), points.max(axis=1, keepdims=True)
    assert ((low < at.X) & (high > at.X)).all()


def test_positions_run_as_the_points_do():
    """F of a deformation by x^2 and y^2 differs from point to point: that of each is the derivative at its position."""
    made = strip(2.0, 2.0, 0.4, (1, 1), cell="hex18")
    model = Model(made, "DISP9K3D", material=mt.SVK(E=206e3, nu=0.3))
    X = made.points
    model.u = np.column_stack([0.05 * X[:, 0] ** 2, 0.08 * X[:, 1] ** 2, 0.1 * X[:, 2] * X[:, 0]]).ravel()
    at = fields.point_fields(model)
    np.testing.assert_allclose(at.F[..., 0, 0], 1.0 + 0.1 * at.X[..., 0], atol=1e-12)
    np.testing.assert_allclose(at.F[..., 1, 1], 1.0 + 0.16 * at.X[..., 1], atol=1e-12)
    np.testing.assert_allclose(at.F[..., 2, 0], 0.1 * at.X[..., 2], atol=1e-12)
    model = Model(strip(2.0, 2.0, 0.4, (1, 1)), "DISP3D", material=mt.SVK(E=206e3, nu=0.3))
    X = model.mesh.points
    model.u = np.column_stack([0.05 * X[:, 0] * X[:, 1], 0.02 * X[:, 1] * X[:, 2], 0.0 * X[:, 0]]).ravel()
    at = fields.point_fields(model)
    np.testing.assert_allclose(at.F[..., 0, 0], 1.0 + 0.05 * at.X[..., 1], atol=1e-12)
    np.testing.assert_allclose(at.F[..., 0, 1], 0.05 * at.X[..., 0], atol=1e-12)
    np.testing.assert_allclose(at.F[..., 1, 1], 1.0 + 0.02 * at.X[..., 2], atol=1e-12)
