"""Hinges on the mid-line and prescribed mid-lines: elimination, pairs, reactions, and runs that use them."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move, Release
from umform.errors import InvalidValue, NoConvergence, RigidBodyMotion
from umform.mesh import strip
from umform.mesh.generators import grid
from umform.model import Model
from umform.model.supports.axes import turned
from umform.model.supports.ties import node_pairs
from umform.surfaces import Plane

ELASTIC = mt.SVK(E=1e4, nu=0.0)
TIGHT = NewtonOptions(residual=1e-12)


def hinged_strip(cells=(6, 2), element="ANS3DEAS", material=ELASTIC, **options):
    """Hinged at x0, on rollers under its mid-line at x1, in plane strain."""
    cell = "hex18" if "9K" in element else "hex8"
    model = Model(strip(10.0, 1.0, 0.2, cells, cell=cell), element, material=material, **options)
    model.hinge("x0", "xz")
    model.hinge("x1", "z")
    for side in ("y0", "y1"):
        model.symmetry(side, "y")
    return model


def transformation(model):
    """T, column by column."""
    return np.stack([model.system.extend(unit) for unit in np.eye(model.system.pattern.n)], axis=1)


def untied(model):
    """The same model without its ties."""
    other = Model(model.mesh, model.bodies.only.element, material=model.bodies.only.material)
    other.supports.fixed = model.supports.fixed.copy()
    for control in model.controls:
        other.controls.add(control)
    return other


# Elimination ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("element", ["ANS3DEAS", "MI9K3DEAS"])
@pytest.mark.parametrize("pressure", [False, True], ids=["symmetric", "unsymmetric"])
def test_entries_are_those_of_the_dense_product(element, pressure, build, rng):
    model = hinged_strip((3, 1), element)
    if pressure:
        model.pressure("upper").value = 30.0
    u = 0.02 * rng.normal(size=model.u.size)
    found = model.evaluate(u)
    other = untied(model)
    full = other.evaluate(u)
    T, K = transformation(model), build.dense(other.system.pattern, full.values)
    np.testing.assert_allclose(T.T @ T, np.eye(model.system.pattern.n), atol=1e-15)
    assert model.system.pattern.symmetric is not pressure
    assert model.system.pattern.n == other.system.pattern.n - sum(len(tie.dofs) for tie in model.supports.ties)
    expected = T[other.system.free].T @ K @ T[other.system.free]
    assert np.abs(expected - expected.T).max() > 1e-6 or not pressure
    np.testing.assert_allclose(build.dense(model.system.pattern, found.values), expected, atol=1e-13 * np.abs(K).max())
    np.testing.assert_array_equal(found.residual, full.residual)
    np.testing.assert_allclose(model.system.restrict(full.residual), T.T @ full.residual, atol=1e-12 * np.abs(K).max())


def test_the_tangent_of_a_tied_model_is_the_derivative_of_its_residual(build, rng):
    model = hinged_strip((3, 1), "DISP3D", mt.NeoHooke(E=1e4, nu=0.3))
    u, x = model.system.extend(0.02 * rng.normal(size=model.system.pattern.n)), rng.normal(size=model.system.pattern.n)
    slope = build.central_difference(
        lambda v: model.system.restrict(model.evaluate(v).residual), u, model.system.extend(x), 1e-6
    )
    assert build.relative_error(build.dense(model.system.pattern, model.evaluate(u).values) @ x, slope) < 1e-7


def test_a_model_without_ties_pays_nothing(build):
    model, _ = build.bar()
    assembly = model.system._assembly()
    values = np.zeros(assembly.entries)
    assert assembly.reduce(values) is values
    assert model.system.pattern.n == len(model.system.free)


# Pairs and refusals -----------------------------------------------------------------------------------------


def test_the_outermost_nodes_of_a_stack_are_a_pair():
    mesh = grid([0, 1, 2], [0, 1], [0, 1, 2, 4])
    pairs = node_pairs(mesh, "x0")
    below, above = mesh.points[pairs.T]
    np.testing.assert_array_equal(below[:, :2], above[:, :2])
    assert set(below[:, 2]) == {0.0}
    assert set(above[:, 2]) == {4.0}
    assert len(pairs) == 2


@pytest.mark.parametrize("nodes", ["x0_lower", lambda x, y, z: z > 0, [0]])
def test_a_set_of_one_face_has_no_pairs(nodes):
    model = Model(strip(10.0, 1.0, 0.2, (4, 1)), material=ELASTIC)
    with pytest.raises(InvalidValue, match="no partner"):
        model.hinge(nodes)


@pytest.mark.parametrize(
    "first",
    [
        lambda m: m.fix("x0_upper", "z"),
        lambda m: m.prescribe("x0", "z"),
        lambda m: m.hinge("x0", "xz"),
        lambda m: m.prescribe_midline("x0", "z"),
    ],
    ids=["fixed", "prescribed", "hinged", "driven"],
)
def test_a_tie_of_a_node_that_is_spoken_for_is_refused(first):
    model = Model(strip(10.0, 1.0, 0.2, (4, 1)), material=ELASTIC)
    first(model)
    for second in (lambda: model.hinge("x0", "z"), lambda: model.prescribe_midline("x0", "z")):
        with pytest.raises(InvalidValue, match="prescribed twice"):
            second()
    assert len(model.supports.ties) <= 2


def test_a_tied_node_can_be_neither_fixed_nor_prescribed():
    model = Model(strip(10.0, 1.0, 0.2, (4, 1)), material=ELASTIC)
    model.hinge("x0", "z")
    with pytest.raises(InvalidValue, match="by hinge and by fix or symmetry"):
        model.fix("x0_lower", "z")
    with pytest.raises(InvalidValue, match="by hinge and by push"):
        model.prescribe("x0_lower", "z", "push")
    model.symmetry("x0", "y")  # another direction


def held_first(model):
    model.symmetry("y0", "y")
    model.hinge("x0", "xyz")


def hinged_first(model):
    model.hinge("x0", "xyz")
    model.symmetry("y0", "y")


@pytest.mark.parametrize("hold", [held_first, hinged_first])
def test_a_hinge_goes_with_a_plane_of_symmetry_that_holds_both_nodes(hold):
    """The same state as with the hinge on the other nodes only, whichever support comes first."""

    def pulled(supports):
        model = Model(strip(10.0, 1.0, 0.2, (4, 2)), material=ELASTIC)
        supports(model)
        model.hinge("x1", "z")
        solve(model, Move(model.force("x1", (1.0, 0.0, 0.0)), 5.0, steps=1), progress=False)
        return model

    def apart(model):
        model.symmetry("y0", "y")
        model.hinge("x0", "xz")
        model.hinge(np.setdiff1d(model.mesh.nodes("x0"), model.mesh.nodes("y0")), "y")

    model, other = pulled(hold), pulled(apart)
    assert sum(len(tie.dofs) for tie in model.supports.ties) == sum(len(tie.dofs) for tie in other.supports.ties)
    np.testing.assert_allclose(model.u, other.u, rtol=0.0, atol=1e-12 * np.abs(other.u).max())
    assert np.abs(model.u).max() > 0.0


@pytest.mark.parametrize("axes", [None, turned("x", "y")], ids=["global", "local"])
def test_a_hinge_leaves_nodes_where_a_support_holds_them_now(axes):
    model = Model(strip(10.0, 1.0, 0.2, (4, 1)), material=ELASTIC)
    model.fix("x0")
    solve(model, Move(model.force("x1", (0.0, 0.0, 1.0)), to=0.01, steps=2), progress=False)
    before = model.u.copy()
    model.fix("x1", "x", here=True)
    model.hinge("x1", "x", here=True, axes=axes)
    held = 3 * model.mesh.nodes("x1")
    assert np.ptp(before[held]) > 0.02  # the section is turned
    np.testing.assert_allclose(model.supports.prescribed()[held], before[held], rtol=1e-12)


def test_a_hinge_beside_one_node_that_is_held_says_what_to_do():
    model = Model(strip(10.0, 1.0, 0.2, (4, 1)), material=ELASTIC)
    model.fix("x0_upper", "z")
    with pytest.raises(InvalidValue, match="if its partner is fixed too"):
        model.hinge("x0", "z")


def test_the_rotation_about_a_hinge_is_seen():
    model = Model(strip(10.0, 1.0, 0.2, (4, 1)), material=ELASTIC)
    model.hinge("x0")
    with pytest.raises(RigidBodyMotion, match="in 1 way") as caught:
        model.system.check()
    assert "rotation about y" in str(caught.value)
    model.hinge("x1", "z")
    model.system.check()


# Mechanics --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("element", "cells"), [("ANS3DEAS", 32), ("MI9K3DEAS", 8)])
def test_a_hinged_strip_sags_as_a_beam(element, cells):
    """Dead load q on L = 10, E I = 1e4 0.2^3 / 12: 5 q L^4 / (384 E I), and shear by 6/5 q L^2 / (8 G A)."""
    model = hinged_strip((cells, 1), element)
    q = 1e-6
    load = model.loads.body_force((0.0, 0.0, -q / 0.2))
    result = solve(model, Move(load, 1.0, steps=1), options=TIGHT)
    middle = model.mesh.nodes(lambda x, y, z: np.abs(x - (x.min() + 5.0)) < 1e-6)
    sag = -model.u.reshape(-1, 3)[middle, 2].mean()
    expected = 5 * q * 1e4 / (384 * 1e4 * 0.2**3 / 12) + 1.2 * q * 100 / (8 * 5e3 * 0.2)
    assert sag == pytest.approx(expected, rel=2e-3)
    # Both nodes of a hinge carry the same force, half of the load goes to each edge, and nothing is left elsewhere.
    reaction = result.frames[-1].points["reaction"]
    for edge in ("x0", "x1"):
        lower, upper = node_pairs(model.mesh, edge).T
        np.testing.assert_allclose(reaction[lower, 2], reaction[upper, 2], atol=1e-12 * q)
        assert reaction[model.mesh.nodes(edge), 2].sum() == pytest.approx(5 * q, rel=1e-9)
    assert not model.supports.constrained()[3 * model.mesh.nodes("x1") + 2].any()


def test_a_driven_mid_line_is_the_load_that_its_force_says():
    """A clamped strip lifted by its mid-line, and the same strip under that force, half of it on each face."""

    def clamped():
        model = Model(strip(10.0, 1.0, 0.2, (8, 1)), material=ELASTIC)
        model.fix("x0")
        return model

    driven, loaded = clamped(), clamped()
    lift = driven.prescribe_midline("x1", "z", "lift")
    result = solve(driven, Move(lift, 3.0, steps=6), options=TIGHT, frames=0)
    lower, upper = node_pairs(driven.mesh, "x1").T
    u = driven.u.reshape(-1, 3)
    np.testing.assert_allclose(0.5 * (u[lower, 2] + u[upper, 2]), 3.0, rtol=1e-14)
    assert np.ptp(u[driven.mesh.nodes("x1"), 2]) > 0.001  # the section turns
    nodal = driven.evaluate(driven.u).residual.reshape(-1, 3)
    forces = [loaded.force([node], (0.0, 0.0, nodal[node, 2])) for node in driven.mesh.nodes("x1")]
    solve(loaded, Move(forces, [1.0] * len(forces), steps=6), options=TIGHT, frames=0)
    np.testing.assert_allclose(loaded.u, driven.u, atol=1e-8)
    assert result["lift_force"][-1] == pytest.approx(nodal[driven.mesh.nodes("x1"), 2].sum(), rel=1e-12)


@pytest.mark.parametrize(
    "options", [NewtonOptions(), NewtonOptions(line_search=True), NewtonOptions(extrapolate=False)]
)
def test_newton_converges_alike_with_ties_whatever_its_options(options):
    model = hinged_strip()
    pull = model.prescribe_midline("x1", "x", "pull")
    push = model.pressure("lower", "push")
    result = solve(model, Move([pull, push], [-0.5, 0.02], steps=8), options=options, frames=0)
    assert result["iterations"].max() <= 8
    assert (
        np.abs(model.system.restrict(model.evaluate(model.u).residual)).max() < 1e-8 * abs(result["pull_force"]).max()
    )
    reference = hinged_strip()
    controls = [reference.prescribe_midline("x1", "x", "pull"), reference.pressure("lower", "push")]
    solve(reference, Move(controls, [-0.5, 0.02], steps=8), options=TIGHT, frames=0)
    np.testing.assert_allclose(model.u, reference.u, atol=1e-6)


def test_a_tied_plastic_strip_is_released_and_repeats_from_a_snapshot():
    law = mt.J2(kappa=175e3, mu=80770.0, hardening=mt.Linear(160.0, 500.0))
    model = Model(strip(20.0, 2.0, 1.0, (8, 1)), material=law)
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    model.hinge("x1", "z")
    punch = model.prescribe("x0_lower", "z", "punch")
    solve(model, Move(punch, -1.0, steps=4), frames=0)
    saved = model.system.snapshot()
    steps = [Move(punch, -2.0, steps=4), Release(punch)]
    first = solve(model, steps, frames=0)
    assert abs(first["punch_force"][-1]) < 1e-6 * np.abs(first["punch_force"]).max()
    assert punch.value < -0.1
    model.system.restore(saved)
    second = solve(model, steps, frames=0)
    np.testing.assert_array_equal(first["punch_force"], second["punch_force"])


def test_contact_on_a_hinged_strip():
    model = hinged_strip((10, 1))
    contact = model.contact("upper", Plane((0.0, 0.0, 0.1), "-z"), penalty=1e3, points=2, name="plate")
    down = model.drive(contact, "-z", "down")
    result = solve(model, Move(down, 0.02, steps=4), frames=0)
    evaluation = model.evaluate(model.u)
    assert evaluation.active.any()
    reaction = sum(evaluation.residual.reshape(-1, 3)[model.mesh.nodes(e), 2].sum() for e in ("x0", "x1"))
    assert reaction > 0.1
    assert reaction == pytest.approx(result["plate_fz"][-1], rel=1e-8)  # of the sheet on the plate: up, too


def test_a_failed_increment_of_a_tied_model_leaves_its_state(same_state):
    model = hinged_strip()
    pull = model.prescribe_midline("x1", "x", "pull")
    solve(model, Move(pull, 0.1, steps=2), frames=0)
    before = model.system.snapshot()
    with pytest.raises(NoConvergence):
        solve(model, Move(pull, -3.0, steps=1, cuts=0), options=NewtonOptions(max_iterations=1), frames=0)
    assert same_state(model.system.snapshot(), before)
