"""Supports in local axes: curved edges, directors in a plane, oblique rollers; elimination, reactions, refusals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from umform import cylindrical, turned
from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue, RigidBodyMotion
from umform.mesh import strip
from umform.model import Model
from umform.model.supports.ties import node_pairs
from umform.model.transfer.rigid_motion import RigidMotion

ELASTIC = mt.SVK(E=1e4, nu=0.3)
TIGHT = NewtonOptions(residual=1e-12)
RADIUS, THICKNESS = 10.0, 0.4
AROUND = cylindrical((0.0, 0.0, 0.0), "y")


def quarter(cells=(4, 3), element="ANS3DEAS", material=ELASTIC, angle=0.5 * np.pi, **options):
    """A quarter of a cylinder about y, of length 6: x0 on the plane x = 0, x1 on z = 0."""

    def around(X):
        phi, r = angle * X[:, 0], RADIUS + X[:, 2]
        return np.column_stack([r * np.sin(phi), 6.0 * X[:, 1], r * np.cos(phi)])

    cell = "hex18" if "9K" in element else "hex8"
    mesh = strip(1.0, 1.0, THICKNESS, cells, cell=cell).transformed(around)
    return Model(mesh, element, material=material, **options)


def diaphragm(model, edge="y1"):
    """Mid-line held in the plane of the diaphragm, director held against rotation about the axis."""
    model.hinge(edge, "xz")
    model.hold_director(edge, "t", axes=AROUND)


def shell(element="ANS3DEAS", **options):
    model = quarter(element=element, **options)
    model.symmetry("x0", "x")
    model.symmetry("x1", "z")
    model.symmetry("y0", "y")
    diaphragm(model)
    return model


def transformation(model):
    """T, column by column."""
    return np.stack([model.system.extend(unit) for unit in np.eye(model.system.pattern.n)], axis=1)


# Elimination ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("element", ["ANS3DEAS", "MI9K3DEAS"])
@pytest.mark.parametrize("pressure", [False, True], ids=["symmetric", "unsymmetric"])
def test_entries_are_those_of_the_dense_product(element, pressure, build, rng):
    model, other = shell(element), quarter(element=element)
    for one in (model, other):
        if pressure:
            one.pressure("upper").value = 30.0
    model.prescribe("x0_lower", "r", "push", axes=AROUND)
    u = 0.02 * rng.normal(size=model.u.size)
    found, full = model.evaluate(u), other.evaluate(u)
    assert len(other.system.free) == u.size  # nothing is held: its tangent is K
    T, K = transformation(model), build.dense(other.system.pattern, full.values)
    assert model.system.pattern.n == model.supports.unknown_count == T.shape[1]
    np.testing.assert_allclose(T.T @ T, np.eye(model.system.pattern.n), atol=1e-14)
    np.testing.assert_allclose(
        build.dense(model.system.pattern, found.values), T.T @ K @ T, atol=1e-13 * np.abs(K).max()
    )
    np.testing.assert_array_equal(found.residual, full.residual)
    np.testing.assert_allclose(model.system.restrict(full.residual), T.T @ full.residual, atol=1e-12 * np.abs(K).max())
    np.testing.assert_allclose(model.system.coefficients(model.system.extend(T[3])), T[3], atol=1e-14)


def test_unknowns_leave_what_is_held_where_it_is_and_everything_else_free():
    model = shell()
    T = transformation(model)
    lower, upper = node_pairs(model.mesh, "y1").T
    u = T.reshape(len(model.mesh.points), 3, -1)
    mean, turn = 0.5 * (u[lower] + u[upper]), u[upper] - u[lower]
    np.testing.assert_allclose(mean[:, [0, 2]], 0.0, atol=1e-15)
    tangents = AROUND.at(model.mesh.points[lower])[:, 1]
    np.testing.assert_allclose(np.einsum("nk,nkq->nq", tangents, turn), 0.0, atol=1e-15)
    # of the six of a fibre inside the edge three are left: the way along the axis, the tilt and the stretch
    inner = [k for k, node in enumerate(lower) if 0.1 < model.mesh.points[node, 0] < RADIUS - 0.5]
    both = np.concatenate([u[lower[inner[0]]], u[upper[inner[0]]]])
    assert np.linalg.matrix_rank(both) == 3


def test_the_tangent_is_the_derivative_of_the_residual(build, rng):
    model = shell("DISP3D", material=mt.NeoHooke(E=1e4, nu=0.3))
    u, x = model.system.extend(0.02 * rng.normal(size=model.system.pattern.n)), rng.normal(size=model.system.pattern.n)
    slope = build.central_difference(
        lambda v: model.system.restrict(model.evaluate(v).residual), u, model.system.extend(x), 1e-6
    )
    assert build.relative_error(build.dense(model.system.pattern, model.evaluate(u).values) @ x, slope) < 1e-7


# Mechanics --------------------------------------------------------------------------------------------------


def test_an_oblique_roller_is_a_straight_one_of_the_turned_model(rotation):
    """The same cantilever on a roller: as it is, and turned as a whole with the roller in turned axes."""

    def run(turn, hold):
        mesh = strip(10.0, 2.0, 0.5, (6, 2)).transformed(lambda X: X @ turn.T)
        model = Model(mesh, material=ELASTIC)
        model.fix("x0")
        hold(model)
        load = model.force("y1", turn @ np.array([0.3, 0.05, -0.4]))
        result = solve(model, Move(load, 1.0, steps=3), options=TIGHT)
        return model.u.reshape(-1, 3) @ turn, result.frames[-1].points["reaction"] @ turn

    u, reaction = run(np.eye(3), lambda model: model.fix("x1", "z"))
    axes = turned(*rotation.T[:2])
    for hold in (
        lambda model: model.fix("x1", "z", axes=axes),
        lambda model: model.fix("x1", normals=rotation[:, 2]),
        lambda model: model.fix("x1", normals=np.outer(np.arange(1, 7), rotation[:, 2])),
    ):
        found, forces = run(rotation, hold)
        np.testing.assert_allclose(found, u, atol=1e-9 * np.abs(u).max())
        np.testing.assert_allclose(forces, reaction, atol=1e-8 * np.abs(reaction).max())
    assert np.abs(u).max() > 0.1


def test_a_tube_that_is_widened_by_a_radial_drive_gives_back_its_energy():
    """The force of the control is the derivative of the energy by its value."""
    model = quarter(cells=(6, 1))
    model.symmetry("x0", "x")
    model.symmetry("x1", "z")
    for side in ("y0", "y1"):
        model.symmetry(side, "y")
    widen = model.prescribe("lower", "r", "widen", axes=AROUND)
    result = solve(model, Move(widen, 0.4, steps=8), options=TIGHT)
    u = model.u.reshape(-1, 3)[model.mesh.nodes("lower")]
    np.testing.assert_allclose(
        np.einsum("nk,nk->n", u, AROUND.at(model.mesh.points[model.mesh.nodes("lower")])[:, 0]), 0.4
    )
    slope = np.gradient(result["elastic_energy"], result["widen"])
    np.testing.assert_allclose(result["widen_force"][2:-2], slope[2:-2], rtol=2e-2)
    assert abs(result.balance().drift[-1]) < 1e-2
    assert result.balance().force_imbalance.max() < 1e-9
    assert result["iterations"].max() <= 6


def test_a_radial_midline_drive_moves_the_mean_and_lets_the_section_turn():
    model = quarter(cells=(4, 4))
    model.symmetry("x0", "x")
    model.symmetry("x1", "z")
    model.symmetry("y0", "y")
    widen = model.prescribe_midline("y1", "r", "widen", axes=AROUND)
    result = solve(model, Move(widen, 0.3, steps=3), options=TIGHT)
    lower, upper = node_pairs(model.mesh, "y1").T
    radial = AROUND.at(model.mesh.points[lower])[:, 0]
    u = model.u.reshape(-1, 3)
    np.testing.assert_allclose(np.einsum("nk,nk->n", 0.5 * (u[lower] + u[upper]), radial), 0.3, rtol=1e-12)
    turn = u[upper] - u[lower]
    assert np.abs(turn[:, 1]).max() > 0.01
    assert result["widen_force"][-1] > 1.0


def test_a_rigid_diaphragm_lets_the_director_tilt_and_stretch():
    """Both faces held: no tilt in the plane, a stretch. The mid-line held: the section may also turn about the axis."""

    def pinched(hold):
        model = quarter(cells=(8, 8))
        model.symmetry("x0", "x")
        model.symmetry("x1", "z")
        model.symmetry("y0", "y")
        hold(model)
        load = model.force(np.intersect1d(model.mesh.nodes("x0"), model.mesh.nodes("y0")), (0.0, 0.0, -0.5))
        solve(model, Move(load, 40.0, steps=10), progress=False)
        lower, upper = node_pairs(model.mesh, "y1").T
        director = model.positions[upper] - model.positions[lower]
        tangent = AROUND.at(model.mesh.points[lower])[:, 1]
        about_axis = np.abs(np.einsum("nk,nk->n", director, tangent)).max()
        return about_axis, np.linalg.norm(director, axis=1) / THICKNESS - 1.0, np.abs(director[:, 1]).max()

    held, stretch_held, _ = pinched(lambda model: model.fix("y1", "xz"))
    right, stretch, tilt = pinched(diaphragm)
    loose, _, _ = pinched(lambda model: model.hinge("y1", "xz"))
    assert held < 1e-12
    assert right < 1e-12
    assert loose > 1e-3
    assert tilt > 0.02
    assert np.abs(stretch).max() < 0.5 * np.abs(stretch_held).max()


def test_reactions_are_normal_to_what_is_free():
    model = shell()
    load = model.force(model.mesh.nodes("y0"), (0.0, 0.0, -0.1))
    result = solve(model, Move(load, 1.0, steps=2), options=TIGHT)
    reaction = result.frames[-1].points["reaction"]
    T = transformation(model)
    supported = np.ones(model.u.size, dtype=bool)
    supported[model.system.free] = False
    assert np.abs(T.T @ np.where(supported, reaction.ravel(), 0.0)).max() < 1e-8 * np.abs(reaction).max()
    assert result.balance().force_imbalance.max() < 1e-9


# Refusals and checks ----------------------------------------------------------------------------------------


def test_a_sector_held_around_its_axis_may_slide_along_it():
    model = quarter()
    for edge in ("y0", "y1"):
        model.fix(edge, "rt", axes=AROUND)
    with pytest.raises(RigidBodyMotion, match="in 1 way") as caught:
        model.system.check()
    assert "translation y" in str(caught.value)
    model.hinge("x0", "a", axes=AROUND)
    model.system.check()


def test_axes_of_a_part_that_has_turned_are_those_at_its_present_place():
    model = quarter()
    turn = RigidMotion.in_section(0.5 * np.pi, np.zeros(2), np.zeros(2))
    state = model.system.snapshot()
    model.system.restore(replace(state, u=turn.displacement(model.mesh.points, state.u)))
    made = (
        (model.fix("x0", "r", axes=AROUND, here=True), model.mesh.points[model.mesh.nodes("x0")]),
        (model.hinge("x1", "r", axes=AROUND, here=True), model.mesh.points[node_pairs(model.mesh, "x1")].mean(axis=1)),
    )
    for support, blank in made:
        [rows] = support.rows
        radial = turn.of(blank) * (1.0, 0.0, 1.0)
        radial /= np.linalg.norm(radial, axis=1, keepdims=True)
        motion = radial.repeat(rows.weights.shape[1] // 3, axis=0).reshape(rows.weights.shape)
        sums = (rows.weights * motion).sum(axis=1)
        np.testing.assert_allclose(sums, np.linalg.norm(rows.weights, axis=1) * np.linalg.norm(motion, axis=1))


def test_supports_that_contradict_each_other_are_refused_and_leave_nothing():
    model = quarter()
    model.prescribe("x0", "x", "pull")
    before = (model.supports.constrained(), model.supports.unknown_count, list(model.supports))
    with pytest.raises(InvalidValue, match="prescribed twice"):
        model.fix("x0", normals=(1.0, 0.0, 0.0))
    with pytest.raises(InvalidValue, match="prescribed twice"):
        model.prescribe("x0", "t", "turn", axes=AROUND)  # the tangent there is x
    assert [control.name for control in model.controls] == ["pull"]
    with pytest.raises(InvalidValue, match="taken"):
        model.prescribe("x1", "r", "pull", axes=AROUND)
    assert not model.supports.rows
    model.fix("x0", "r", axes=AROUND)  # the radius there is z
    np.testing.assert_array_equal(model.supports.constrained(), before[0])
    assert model.supports.unknown_count == before[1] - len(model.mesh.nodes("x0"))
    with pytest.raises(InvalidValue, match="prescribed twice"):
        model.prescribe("x0", "z", "lift")
    assert len(model.supports) == 1


def test_to_hold_something_twice_does_no_harm():
    model, other = quarter(), quarter()
    for one in (model, other):
        one.symmetry("x0", "x")
        one.fix("y1", "rt", axes=AROUND)
    other.hinge("y1", "rt", axes=AROUND)
    other.hold_director("y1", "t", axes=AROUND)
    other.fix("y1", "xz", axes=turned("x", "y"))
    assert model.supports.unknown_count == other.supports.unknown_count
    assert model.system.pattern.n == other.system.pattern.n


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda model: model.fix("x0", "x", axes=AROUND), "no such direction"),
        (lambda model: model.hold_director("x0", (0, 0, 1)), "no such direction"),
        (lambda model: model.hold_director("x0", 2), "no such direction"),
        (lambda model: model.fix("x0", normals=(1.0, 0.0)), "one normal"),
        (lambda model: model.fix("x0", normals=(0.0, 0.0, 0.0)), "have a length"),
        (lambda model: model.fix("x0", "r", axes=cylindrical(model.mesh.points[0], "y")), "on the axis"),
        (lambda model: model.fix("x0", "z", normals=(1.0, 0.0, 0.0)), "directions of their own"),
        (lambda model: model.fix("x0", axes=AROUND, normals=(1.0, 0.0, 0.0)), "directions of their own"),
        (lambda model: model.fix("x0", ""), "in one direction at least"),
        (lambda model: model.symmetry("x0", None), "a direction is x, y or z"),
        (lambda model: model.prescribe("x0", ["y"]), "a direction is x, y or z"),
        (lambda model: model.prescribe("x0", "rt", axes=AROUND), "prescribed in one direction"),
        (lambda model: model.prescribe("x0", "", axes=AROUND), "prescribed in one direction"),
        (lambda model: model.prescribe_midline("x0", "ra", axes=AROUND), "prescribed in one direction"),
        (lambda model: model.fix("x0", 3), "a direction is x, y or z"),
        (lambda model: model.hinge("x0", 3), "a direction is x, y or z"),
        (lambda model: model.fix("x0", "x", axes="y"), "axes of a support are local axes"),
        (lambda model: model.force("x0", "z"), "needs three components"),
        (lambda model: model.fix("x0", name="a") and model.fix("x1", name="a"), "name of a support"),
        (lambda model: turned("x", (2.0, 0.0, 0.0)), "parallel"),
        (lambda model: cylindrical((0.0, 0.0), "y"), "three finite"),
    ],
)
def test_what_makes_no_sense_is_refused(wrong, message):
    with pytest.raises(InvalidValue, match=message):
        wrong(quarter())


@pytest.mark.parametrize(
    "half",
    [
        lambda model: model.fix("x0", "xq"),
        lambda model: model.hinge("x0", "xq"),
        lambda model: (model.prescribe("x0", "z", "a"), model.fix("x0", "xyz")),
        lambda model: (model.prescribe("x0", "z", "a"), model.prescribe_midline("x1", "x", "a")),
    ],
)
def test_a_refused_support_leaves_nothing_of_itself(half):
    model = quarter()
    with pytest.raises(InvalidValue):
        half(model)
    assert not model.supports.ties
    assert not model.supports.fixed.any()
    assert not model.supports
