"""Laws see their points: axes that follow the rolling direction, size of the cell, step."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue
from umform.history_variables import named
from umform.materials import Points, UserLaw, check_law
from umform.mesh import Mesh, strip
from umform.model import Model
from umform.results.fields import point_fields

#: Five times as stiff along e_1 as across, and a shear modulus of its own.
ORTHOTROPIC = np.diag([500.0, 100.0, 150.0, 60.0, 40.0, 50.0])
ORTHOTROPIC[:3, :3] += 40.0
ELEMENTS = ["DISP3D", "ANS3DEAS", "EAS3DEAS", "MI9K3DEAS"]
TURNS = {"hex8": [1, 2, 3, 0], "hex18": [1, 2, 3, 0, 5, 6, 7, 4, 8]}


def orthotropic(E, state):
    return E @ ORTHOTROPIC, np.tile(ORTHOTROPIC, (len(E), 1, 1)), state


def cell_of(element):
    return "hex18" if "9K" in element else "hex8"


def sheet(element, turned=False, build=None):
    """A distorted sheet; turned: the same cells with G_1 along y, and in another order."""
    mesh = build.jittered(strip(4.0, 3.0, 0.3, (4, 3), cell=cell_of(element)), 0.15, normal=0.02)
    if not turned:
        return mesh
    face = np.array(TURNS[mesh.cell])
    cells = mesh.connectivity[:, np.concatenate([face, face + len(face)])][::-1]
    return Mesh(mesh.points, {mesh.cell: np.ascontiguousarray(cells)}, mesh.sets)


def strained(mesh, rng):
    return (rng.normal(size=mesh.points.shape) * (0.02, 0.02, 0.004)).ravel()


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("rolling", [(1.0, 0.0, 0.0), (0.3, -2.0, 0.4)])
def test_an_orthotropic_law_does_not_see_the_numbering(build, rng, element, rolling):
    meshes = [sheet(element, turned, build) for turned in (False, True)]
    u = strained(meshes[0], rng)
    law = UserLaw(orthotropic)
    one, other = (Model(mesh, element, material=law, rolling=rolling) for mesh in meshes)
    for model in (one, other):
        model.fix("x0")
    f, g = one.evaluate(u).residual, other.evaluate(u).residual
    np.testing.assert_allclose(g, f, atol=1e-11 * np.abs(f).max())
    E, S = (values.mean(axis=1) for values in one.bodies.only.block.point_fields(u)[:2])
    E2, S2 = (values.mean(axis=1)[::-1] for values in other.bodies.only.block.point_fields(u)[:2])
    np.testing.assert_allclose(E2, E, atol=1e-9 * np.abs(E).max())
    np.testing.assert_allclose(S2, S, atol=1e-9 * np.abs(S).max())
    without = Model(meshes[1], element, material=law)
    without.fix("x0")
    assert np.abs(without.evaluate(u).residual - f).max() > 0.01 * np.abs(f).max()


def test_a_run_does_not_see_the_numbering(build):
    forces = []
    for turned in (False, True):
        model = Model(sheet("ANS3DEAS", turned, build), "ANS3DEAS", material=UserLaw(orthotropic), rolling=(1, 1, 0))
        model.fix("x0")
        pull = model.prescribe("x1", "x", "pull")
        forces.append(solve(model, Move(pull, 0.4, steps=2), frames=0, progress=False)["pull_force"])
    np.testing.assert_allclose(forces[1], forces[0], rtol=1e-8)


@pytest.mark.parametrize("element", ELEMENTS)
def test_tangent_with_a_rolling_direction_is_the_derivative_of_the_force(build, element):
    one = build.one_element(element, UserLaw(orthotropic), rolling=(0.6, 0.8, 0.2))
    u = one.displacement()
    K, _ = one(u)
    du = one.rng.normal(size=u.size)
    assert build.relative_error(K @ du, build.central_difference(lambda v: one(v)[1], u, du)) < 1e-7
    assert (K == K.T).all()


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("law", ["svk", "neo-hooke", "j2"])
def test_an_isotropic_law_does_not_see_the_rolling_direction(build, materials, rng, element, law):
    mesh = sheet(element, build=build)
    u = strained(mesh, rng)
    found = []
    for rolling in (None, (0.2, 1.0, 0.0)):
        model = Model(mesh, element, material=materials[law], rolling=rolling)
        model.fix("x0")
        evaluation = model.evaluate(u)
        assert evaluation.failed == -1
        found.append(evaluation)
    for name in ("residual", "values"):
        a, b = (getattr(one, name) for one in found)
        np.testing.assert_allclose(b, a, atol=1e-9 * np.abs(a).max())


def test_the_frame_is_the_projection_of_the_rolling_direction(build, rng):
    mesh = sheet("ANS3DEAS", build=build)
    rolling = rng.normal(size=(len(mesh.connectivity), 3)) * (1.0, 1.0, 0.2)
    model = Model(mesh, "ANS3DEAS", material=mt.SVK(E=1.0, nu=0.3), rolling=rolling)
    frame = model.bodies.only.block.point_fields(model.u)[2]
    np.testing.assert_allclose(frame @ np.swapaxes(frame, -1, -2), np.broadcast_to(np.eye(3), frame.shape), atol=1e-13)
    bare = Model(mesh, "ANS3DEAS", material=model.bodies.only.material).bodies.only.block.point_fields(model.u)[2]
    np.testing.assert_allclose(frame[:, :, 2], bare[:, :, 2], atol=1e-14)
    for cell, direction in enumerate(rolling):
        normal = frame[cell, :, 2]
        projected = direction - (normal @ direction)[:, None] * normal
        projected /= np.linalg.norm(projected, axis=1, keepdims=True)
        np.testing.assert_allclose(frame[cell, :, 0], projected, atol=1e-13)


@pytest.mark.parametrize(
    ("rolling", "message"),
    [
        ((0, 0, 1), "stands on the sheet in cell 0"),
        ((0, 0, 0), "must have a length"),
        ((1, np.nan, 0), "must have a length"),
        ((1, 0), "one vector, or one for each cell"),
        (np.ones((5, 3)), "one vector, or one for each cell"),
    ],
)
def test_a_rolling_direction_that_is_none_is_refused(rolling, message):
    with pytest.raises(InvalidValue, match=message):
        model = Model(strip(2.0, 1.0, 0.1, (2, 1)), "ANS3DEAS", material=mt.SVK(E=1.0, nu=0.3), rolling=rolling)
        model.evaluate(model.u)


def test_a_law_sees_axes_size_and_step(build):
    seen = []

    def curious(E, state, points):
        seen.append(points)
        return orthotropic(E, state)

    mesh = strip(4.0, 2.0, 0.1, (2, 1))
    model = Model(mesh, "DISP3D", material=UserLaw(curious), rolling=(0, 1, 0))
    model.fix("x0")
    model.system.time = 0.125  # the last increment ended at 0
    model.evaluate(model.u)
    frame = model.bodies.only.block.point_fields(model.u)[2]
    assert len(seen) == 4
    assert [points.step for points in seen] == [0.125, 0.125, 0.0, 0.0]  # no time passes while fields are formed
    for cell, points in enumerate(seen[:2]):
        assert isinstance(points, Points)
        np.testing.assert_allclose(points.axes, frame[cell], atol=1e-15)
        np.testing.assert_allclose(points.axes[:, 0], np.tile((0.0, 1.0, 0.0), (len(frame[cell]), 1)), atol=1e-15)
        assert points.size == pytest.approx(2.0)


def test_fields_have_the_part_of_a_stress_that_the_history_keeps():
    """Kelvin and Voigt: at a step of zero, the stress by the rate is that of the last increment."""
    state = {"before": 6, "viscous": 6}

    def kelvin(strain, history, points):
        before, viscous = named(history, state).values()
        rate = 5.0 / points.step if points.step else 0.0
        viscous = rate * (strain - before) if points.step else viscous
        tangent = np.diag([100.0, 100.0, 100.0, 50.0, 50.0, 50.0]) + rate * np.eye(6)
        elastic = strain * (100.0, 100.0, 100.0, 50.0, 50.0, 50.0)
        return elastic + viscous, np.broadcast_to(tangent, (len(strain), 6, 6)), np.hstack([strain, viscous])

    model = Model(strip(4.0, 2.0, 0.1, (2, 1)), "DISP3D", material=UserLaw(kelvin, state=state))
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    model.fix("lower", "z")
    pull = model.prescribe("x1", "x", "pull")
    result = solve(model, Move(pull, 0.04, steps=4))
    stretch, strain = 1.01, 0.01 + 0.5 * 0.01**2
    stress = point_fields(model).stress("pk2", "local")[..., 0]
    assert result["pull_force"][-1] == pytest.approx(0.2 * stretch * stress.mean(), rel=1e-9)
    assert stress.min() > 100.0 * strain + 5.0 * 0.99 * 0.01


def test_check_law_gives_a_law_the_global_axes(rng):
    def curious(E, state, points):
        assert points.axes.shape == (len(E), 3, 3)
        assert (points.axes == np.eye(3)).all()
        return orthotropic(E, state)

    assert check_law(UserLaw(curious), 0.1 * rng.normal(size=(4, 6))) < 1e-7


def test_a_default_value_is_no_question_for_the_points():
    def scaled(E, state, factor=2.0):
        return factor * E, np.tile(factor * np.eye(6), (len(E), 1, 1)), state

    assert not UserLaw(scaled).sees_points
    assert UserLaw(scaled).law().respond(np.ones((1, 6)), np.zeros((1, 0)))[0][0, 0] == 2.0


def test_check_law_at_a_step_a_size_and_axes():
    """A viscous law whose tangent is right at any step, and one that forgot it."""
    seen = []

    def viscous(strain, history, points, *, forgets=False):
        seen.append((points.step, points.size, points.axes.copy()))
        rate = (strain - history) / points.step
        factor = 100.0 * points.size
        tangent = (factor + (7.0 if forgets else 7.0 / points.step)) * np.eye(6)
        return factor * strain + 7.0 * rate, np.broadcast_to(tangent, (len(strain), 6, 6)), strain

    E = np.full((2, 6), 0.01)
    law = UserLaw(viscous, state={"before": 6}, name="viscous")
    assert check_law(law, E, time_step=0.01, size=3.0, axes=np.eye(3)[::-1]) < 1e-7
    step, size, axes = seen[0]
    assert (step, size) == (0.01, 3.0)
    np.testing.assert_array_equal(axes, [np.eye(3)[::-1]] * 2)
    wrong = UserLaw(lambda E, state, points: viscous(E, state, points, forgets=True), state={"before": 6}, name="wrong")
    assert check_law(wrong, E) < 1e-7  # at the step 1 they are the same
    assert check_law(wrong, E, time_step=0.01) > 0.5
