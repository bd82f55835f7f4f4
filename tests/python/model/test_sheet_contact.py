"""Sheets that touch: tangent, momentum, pressure, exchange of the sides."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from sheet_forces import check_tangent, forces_of

import umform as uf
from umform import _core
from umform.model.contact.sheets.faces import near_in_the_sheet


def stack(first=(5, 2), second=(5, 2), cell="hex8"):
    """Two plates on each other."""
    lower = uf.mesh.strip(10.0, 4.0, 1.0, first, cell=cell)
    upper = uf.mesh.strip(10.0, 4.0, 1.0, second, cell=cell).moved((0.0, 0.0, 1.0))
    return uf.mesh.together(a=lower, b=upper)


def model_of(mesh, turned=False, **options):
    element = "ANS3DEAS" if mesh.cell == "hex8" else "MI9K3DEAS"
    model = uf.Model(mesh, element, material=uf.SVK(E=210e3, nu=0.0))
    sides = ("lower of b", "upper of a") if turned else ("upper of a", "lower of b")
    return model, model.sheet_contact(*sides, name="stack", **options)


def wavy(mesh, size=0.02):
    """A displacement at which some points are in contact and others are not."""
    u = size * np.random.default_rng(1).standard_normal(mesh.points.shape)
    above = np.unique(mesh.connectivity[mesh.faces["lower of b"][:, 0]])
    u[above, 2] += 0.1 * np.sin(0.7 * mesh.points[above, 0]) - size
    return u.ravel()


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("options", [{"points": 3}, {"cells": 3}, {"friction": 0.2}], ids=str)
def test_the_tangent_is_the_derivative_of_the_forces(cell, options):
    mesh = stack((3, 2), (4, 3), cell)
    model, contact = model_of(mesh, **options)
    u = wavy(mesh, 0.02 if cell == "hex8" else 0.005)
    active = model.evaluate(u).found[contact].active
    assert 0.2 < active.mean() < 0.9
    check_tangent(model, contact, u, seed=2)


@pytest.mark.parametrize("options", [{"points": 3}, {"cells": 3}], ids=str)
def test_the_forces_have_no_resultant_and_no_moment(options):
    mesh = stack((5, 2), (7, 3))
    model, contact = model_of(mesh, **options)
    u = wavy(mesh)
    model.evaluate(u)
    f = forces_of(model, contact, u)[0].reshape(-1, 3)
    x = mesh.displaced(u)
    assert np.abs(f).max() > 500.0
    assert np.abs(f.sum(axis=0)).max() < 1e-12 * np.abs(f).sum()
    assert np.abs(np.cross(x, f).sum(axis=0)).max() < 1e-12 * np.abs(f).sum() * 10.0


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("options", [{"points": 3}, {"cells": 3}], ids=str)
def test_the_forces_far_from_the_origin_are_those_at_it(cell, options):
    """There the coordinates of a foot cannot be found to more digits than those of the nodes have."""
    mesh = stack((5, 2), (7, 3), cell)
    u, far = wavy(mesh, 0.02 if cell == "hex8" else 0.005), mesh.moved((3000.0, -2000.0, 1000.0))
    (here, one), (there, other) = (model_of(at, **options) for at in (mesh, far))
    here.evaluate(u)
    there.evaluate(u)
    f, g = forces_of(here, one, u)[0], forces_of(there, other, u)[0]
    assert np.abs(f - g).max() < 1e-7 * np.abs(f).max()


def between_walls(first, second, cell="hex8", turned=False, **options):
    """Two plates between flat walls, the contact, and the wall that moves."""
    model, contact = model_of(stack(first, second, cell), turned, **options)
    model.fix("lower of a", "z")
    for sheet in "ab":
        model.fix(f"x0 of {sheet}", "x")
        model.fix(f"y0 of {sheet}", "y")
    return model, contact, model.prescribe("upper of b", "z", "wall")


def pressed(first, second, cell="hex8", turned=False, way=-0.002, **options):
    """Two plates pressed on each other between flat walls, and the contact."""
    model, contact, wall = between_walls(first, second, cell, turned, **options)
    return model, contact, uf.solve(model, uf.Move(wall, way, steps=1), progress=False)


@pytest.mark.parametrize(
    ("cell", "options"), [("hex8", {"points": 2}), ("hex8", {"cells": 3}), ("hex18", {"points": 3})], ids=str
)
def test_matching_plates_have_a_uniform_pressure(cell, options):
    _, contact, result = pressed((5, 2), (5, 2), cell, **options)
    pressures = np.concatenate([side.pressure for side in contact.found.sides])
    assert np.abs(pressures / pressures.mean() - 1.0).max() < 1e-10
    assert result["wall_force"][-1] == pytest.approx(-40.0 * pressures.mean(), rel=1e-3)
    assert result["stack_fz"][-1] == pytest.approx(result["wall_force"][-1], rel=1e-9)


def test_the_sides_may_be_exchanged():
    one, other = (pressed((5, 2), (8, 3), turned=turned, cells=3)[0].u for turned in (False, True))
    assert np.abs(one - other).max() < 1e-12 * np.abs(one).max()


def rubbed(mu=0.2):
    """A small block that is pressed onto a plate and pushed along it, at a converged state with friction."""
    plate = uf.mesh.strip(10.0, 4.0, 1.0, (6, 2))
    block = uf.mesh.strip(4.0, 2.0, 1.0, (3, 2)).moved((2.1, 1.1, 1.02))
    mesh = uf.mesh.together(a=plate, b=block)
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    contact = model.sheet_contact("upper of a", "lower of b", name="block", friction=mu, points=2)
    model.fix("lower of a")
    down = model.prescribe("upper of b", "z", "down")
    along = model.prescribe("upper of b", "x", "along")
    model.fix("upper of b", "y")
    return model, contact, down, along


def test_a_block_slides_at_the_coefficient_of_friction():
    model, contact, down, along = rubbed()
    steps = [uf.Move(down, -0.022, steps=11), uf.Move(along, 3.0, steps=48)]
    result = uf.solve(model, steps, progress=False)
    assert (contact.found.status == 2).sum() > 0.9 * contact.found.active.sum() > 5
    force = np.array([result["block_fx"], result["block_fy"], result["block_fz"]])
    assert abs(force[0, -1] / force[2, -1]) == pytest.approx(0.2, rel=2e-3)
    assert result["along_force"][-1] == pytest.approx(-force[0, -1] * np.sign(-force[0, -1]), rel=1e-9)
    assert result["block_friction_work"][-1] > 0.0
    assert abs(result.balance().drift[-1]) < 0.005
    assert result["iterations"].max() <= 12


def test_a_sticking_block_keeps_its_traction():
    model, contact, down, along = rubbed()
    steps = [uf.Move(down, -0.022, steps=11), uf.Move(along, 0.0008, steps=4)]
    force = uf.solve(model, steps, progress=False)["block_fx"][-5:]
    assert (contact.found.status == 1).sum() == contact.found.active.sum() > 5
    assert np.diff(force) == pytest.approx(np.full(4, (force[-1] - force[0]) / 4.0), rel=0.01)


@pytest.mark.parametrize("law", [0.2, uf.Friction(0.2, kinetic=0.1, decay=1e-3)], ids=["constant", "falling"])
def test_the_tangent_of_friction_has_its_history(law):
    model, contact, down, along = rubbed(law)
    uf.solve(model, [uf.Move(down, -0.022, steps=2), uf.Move(along, 0.0015, steps=2)], progress=False)
    u = model.u + 5e-4 * np.random.default_rng(3).standard_normal(model.u.size)
    status = model.evaluate(u).found[contact].status
    assert (status == 1).any() and (status == 2).any()
    check_tangent(model, contact, u, seed=3, h=1e-7)


def test_the_tangent_of_points_that_touch_on_their_way():
    """Their friction is that of the way since they touched, which depends on the gap."""
    model, contact, down, _ = rubbed()
    uf.solve(model, [uf.Move(down, -0.018, steps=1)], progress=False)  # 0.002 above the plate
    above = np.unique(model.mesh.connectivity[model.mesh.faces["lower of b"][:, 0]])
    u = model.u.reshape(-1, 3) + 1e-4 * np.random.default_rng(3).standard_normal(model.mesh.points.shape)
    u[above] += [0.003, 0.001, -0.003]
    status = model.system.evaluate(u.ravel()).found[contact].status
    assert (status == 1).any() and (status == 2).any()
    check_tangent(model, contact, u.ravel(), seed=3, h=1e-7)


@pytest.mark.parametrize("options", [{"points": 2}, {"cells": 3}], ids=str)
def test_a_plate_that_is_lifted_off_leaves_its_elastic_slip_to_friction(options):
    """The energy of the penalty is gone with the contact, also where it is the work of the pressure of cells."""
    model, contact = model_of(stack((2, 2), (2, 2)), penalty=1e3, friction=0.2, **options)
    model.fix("lower of a")
    model.fix("upper of b", "y")
    down, along = model.prescribe("upper of b", "z", "down"), model.prescribe("upper of b", "x", "along")
    uf.solve(model, [uf.Move(down, -0.004, steps=4), uf.Move(along, 3e-4, steps=4)], progress=False)
    stored = contact.found.sum("stored")
    assert (contact.found.status == 1).all() and stored > 1e-4
    balance = uf.solve(model, uf.Move(down, 0.002, steps=1), progress=False).balance()
    assert balance.contact[0] > 0.1 and balance.contact[1] == pytest.approx(0.0, abs=1e-9)
    assert balance.friction[1] - balance.friction[0] == pytest.approx(stored, rel=1e-9)


def test_a_sliding_point_meets_no_step_of_its_force():
    """Over an edge between facets that are bent by 0.3, in steps of 1e-4 of their length."""
    bent = uf.mesh.strip(4.0, 2.0, 0.5, (4, 1)).transformed(
        lambda X: np.column_stack([X[:, 0], X[:, 1], X[:, 2] + 0.15 * np.abs(X[:, 0] - 2.0)])
    )
    small = uf.mesh.strip(0.2, 0.2, 0.5, (1, 1)).moved((1.9, 0.9, 0.5))
    mesh = uf.mesh.together(a=bent, b=small)
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    contact = model.sheet_contact("upper of a", "lower of b", name="edge", penalty=1e3, points=1)
    above = np.unique(mesh.connectivity[mesh.faces["lower of b"][:, 0]])
    model.system.pattern  # noqa: B018
    forces = []
    for way in np.linspace(-0.03, 0.03, 601):
        u = np.zeros((len(mesh.points), 3))
        u[above] += [way, 0.0, -0.02]
        found = model.evaluate(u.ravel()).found[contact]
        forces.append(found.sides[1].traction[0])
    forces = np.array(forces)
    steps = np.linalg.norm(np.diff(forces, axis=0), axis=1)
    assert np.linalg.norm(forces, axis=1).min() > 10.0
    assert steps.max() < 2.0 * np.median(steps)
    assert steps.max() < 1e-3 * np.linalg.norm(forces, axis=1).max()


def test_the_same_bits_with_any_number_of_threads():
    mesh = stack((24, 8), (17, 9))
    found = []
    for threads in (1, 2, 4):
        before = uf._core.threads()
        uf._core.set_threads(threads)
        try:
            model, contact = model_of(mesh, cells=3, friction=0.1)
            u = wavy(mesh)
            found.append((model.evaluate(u).values, *forces_of(model, contact, u, u)))
        finally:
            uf._core.set_threads(before)
    for other in found[1:]:
        for one, another in zip(found[0], other, strict=True):
            assert np.array_equal(one, another)


def test_a_stored_state_goes_on_to_the_same_bits():
    runs = []
    for stored in (False, True):
        model, contact, down, along = rubbed()
        uf.solve(model, [uf.Move(down, -0.022, steps=2), uf.Move(along, 0.2, steps=2)], progress=False)
        if stored:
            snapshot = model.system.snapshot()
            model, contact, down, along = rubbed()
            model.system.restore(snapshot)
        u = model.u + 1e-3
        evaluation = model.evaluate(u)
        runs.append((evaluation.residual, evaluation.values, evaluation.found[contact].status))
    for one, other in zip(*runs, strict=True):
        assert np.array_equal(one, other)


def test_sheets_that_overlap_at_the_start_are_refused():
    lower = uf.mesh.strip(10.0, 4.0, 1.0, (5, 2))
    for way in (0.7, 0.3):
        mesh = uf.mesh.together(a=lower, b=lower.moved((0.0, 0.0, way)))
        model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.0))
        model.sheet_contact("upper of a", "lower of b", name="stack")
        model.fix("lower of a")
        wall = model.prescribe("upper of b", "z", "wall")
        with pytest.raises(uf.errors.ModelError, match=rf"overlap at the start(?s:.*){1 - way:.1g} deep"):
            uf.solve(model, uf.Move(wall, -0.1, steps=1), progress=False)


def test_faces_that_look_the_same_way_are_refused():
    mesh = stack()
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.0))
    with pytest.raises(uf.errors.InvalidValue, match="look the same way"):
        model.sheet_contact("upper of a", "upper of b")
    with pytest.raises(uf.errors.InvalidValue, match="both sides"):
        model.sheet_contact("upper of a", "upper of a")


def test_a_penetration_that_is_no_contact_is_not_allowed():
    model_of(stack(), penetration=0.5)
    with pytest.raises(uf.errors.InvalidValue, match=r"(?s)stack, penetration.*0\.51.*beyond 0\.5.*0\.005, 1/200"):
        model_of(stack(), penetration=0.51)


def hairpin(flank=10.0, radius=2.0, cells=60):
    """A strip of thickness 1 that is bent by half a turn, its upper face inside; one flank is shorter."""
    strip = uf.mesh.strip(2.0 * flank - 2.3 + np.pi * radius, 2.0, 1.0, (cells, 1))

    def bent(X):
        s, y, z = X.T
        angle = np.clip((s - flank) / radius, 0.0, np.pi)
        beyond = s - flank - np.pi * radius
        x = np.where(s < flank, s, np.where(beyond > 0.0, flank - beyond, flank + (radius - z) * np.sin(angle)))
        return np.column_stack(
            [
                x,
                y,
                np.where(s < flank, z, np.where(beyond > 0.0, 2.0 * radius - z, radius - (radius - z) * np.cos(angle))),
            ]
        )

    return strip.transformed(bent)


def test_a_hairpin_closes_on_itself():
    mesh = hairpin()
    model = uf.Model(mesh, "ANS3DEAS", material=uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(500.0, 0.01, 0.2)))
    contact = model.self_contact("upper", name="inside", cells=3)
    model.fix("x0")
    model.fix("x1", "y")
    end = model.prescribe("x1", "z", "end")
    result = uf.solve(model, uf.Move(end, -3.4, steps=60), progress=False)
    assert result["inside_active"][0] == 0 and result["inside_active"][-1] > 0
    assert result["inside_penetration"].max() <= contact.allowed * 1.001
    side = contact.found.sides[0]  # the shorter flank stands with its rim on the other one
    assert (side.normal[side.status > 0, 2] < -0.8).all()
    assert (contact.found.force == 0.0).all()
    assert result["end_force"][-1] < -50.0
    assert abs(result.balance().drift[-1]) < 0.005


def test_a_penalty_grows_and_is_stored():
    model, contact, result = pressed((3, 2), (4, 2), way=-0.006, cells=3)
    assert contact.penalty > 1.5 * contact.initial_penalty
    assert result["stack_penetration"][-1] <= contact.allowed * 1.001
    snapshot = model.system.snapshot()
    model, contact, _ = pressed((3, 2), (4, 2), way=-0.0001, cells=3)
    assert contact.penalty == contact.initial_penalty
    model.system.restore(snapshot)
    assert contact.penalty > 1.5 * contact.initial_penalty
    evaluation = model.evaluate(model.u)
    free = model.system.restrict(evaluation.residual)
    assert np.linalg.norm(free) < 1e-9 * evaluation.force_scale


def test_a_penalty_that_is_set_stays():
    model, contact, wall = between_walls((3, 2), (4, 2), cells=3)
    contact.penalty = penalty = 1.5 * contact.initial_penalty
    assert contact.initial_penalty == penalty and not contact.adapts
    result = uf.solve(model, uf.Move(wall, -0.006, steps=1), progress=False)
    assert contact.penalty == penalty and result["stack_penetration"][-1] > contact.allowed


def test_neighbours_in_a_sheet_are_those_within_a_way_along_it():
    mesh = hairpin(cells=30)
    faces = mesh.face_set("upper")
    near = near_in_the_sheet(mesh, faces, faces, 2.0)
    length = (2.0 * 10.0 - 2.3 + np.pi * 2.0) / 30
    for k, rows in enumerate(near):
        assert {int(m) for m in rows} >= {m for m in range(30) if abs(m - k) * length * 1.2 < 2.0}
        assert {int(m) for m in rows} <= {m for m in range(30) if abs(m - k) * length * 0.7 < 2.0}


def test_a_thin_sheet_is_no_pair_of_its_own_faces():
    """Its faces lie closer together than to any other one, and look away from each other."""
    mesh = uf.mesh.strip(10.0, 4.0, 0.2, (5, 2))
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.0))
    contact = model.sheet_contact("upper", "lower", name="both")
    assert not model.evaluate(model.u).found[contact].active.any()


def test_a_fold_touches_only_where_it_is_sharp():
    """Two flanks near each other along the sheet: folded by 100 degrees they meet only as parts of two sheets do."""
    for degrees, way, meets in ((60.0, 8.0, False), (100.0, 8.0, False), (100.0, 0.1, True), (140.0, 8.0, True)):

        def folded(X, degrees=degrees):
            angle, s = np.radians(degrees), X[:, 0] - 3.0
            return np.column_stack(
                [np.where(s > 0.0, s * np.cos(angle), s), X[:, 1], np.where(s > 0.0, s * np.sin(angle), 0.0)]
            )

        mesh = uf.mesh.strip(6.0, 1.0, 1.0, (24, 1))
        points = folded(mesh.points)
        points[:, 2] += 0.05 * mesh.points[:, 2]  # a shear of the thickness: only facets and normals count here
        found = _core.sheet_pass(
            mesh.facets("upper"), mesh.facets("upper"), np.empty((0, 4), np.int32), [], points, (2, 2), 0, 1.0, 0.9,
            3.0,
            near_in_the_sheet(mesh, mesh.face_set("upper"), mesh.face_set("upper"), way), None, 0.0,
        )  # fmt: skip
        found.search(np.zeros(points.size), 0.0, 0.45)
        nowhere = _core.Pattern(np.full(points.size, -1, dtype=np.int32), [], False)
        found.evaluate(np.zeros(points.size), nowhere, np.zeros(points.size), None, None, None)
        assert (found.found()["facet"] >= 0).any() == meets


def test_friction_a_gap_apart_works_on_a_face_that_turns():
    """A plate is pressed into another one and sheared; the other one turns below the sticking points. eq. (4.314)"""
    lower = uf.mesh.strip(2.0, 2.0, 1.0, (1, 1))
    upper = uf.mesh.strip(1.0, 1.0, 1.0, (1, 1)).moved((0.5, 0.5, 1.0))
    mesh = uf.mesh.together(a=lower, b=upper)
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    contact = model.sheet_contact("upper of a", "lower of b", penalty=1e3, points=2, friction=0.5, slip=0.02)
    pattern = model.system._assembly().whole_pattern
    X, above, middle = mesh.points, mesh.nodes("b"), np.array([1.0, 1.0, 0.5])
    below = mesh.nodes("a")

    def at(sheared, angle):
        x, c, s = X.copy(), np.cos(angle), np.sin(angle)
        x[above] += [0.01 * sheared, 0.0, -0.1]
        x[below] = (x[below] - middle) @ np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]]) + middle
        u, f = (x - X).ravel(), np.zeros(X.size)
        for one in contact.passes:
            one.evaluate(u, pattern, f, None, None, None)
        found = model.evaluate(u).found[contact]
        contact.commit(found)
        return u, f, sum(found.sum(what) for what in ("stored", "friction_work", "contact_energy")), found

    at(0.0, 0.0)
    at(1.0, 0.0)
    ways = [at(1.0, angle) for angle in np.linspace(0.0, 0.1, 21)]
    assert (ways[-1][3].sides[1].status == 1).all() and ways[-1][3].sum("stored") > 0.003
    work = sum(0.5 * (f + g) @ (v - u) for (u, f, *_), (v, g, *_) in pairwise(ways))
    assert work == pytest.approx(ways[-1][2] - ways[0][2], rel=1e-4)
