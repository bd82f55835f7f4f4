"""Elements in plane strain: the same forces as with all Gauss points, and no mechanism."""

import numpy as np
import pytest

import umform as uf
from umform.analysis.run.stages import continued
from umform.elements import element
from umform.errors import InvalidValue, ModelError
from umform.model.transfer.rigid_motion import RigidMotion

NAMES = ["DISP3D", "ANS3DEAS", "EAS3DEAS", "BEND8", "MI9K3DEAS", "BEND18"]
STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(200.0, 1000.0))


#: The same heights with all points of the surface and with fewer: with staggered ones they would differ.
SAME = {"thickness_points": 12, "thickness_rule": "graded"}


def strip(name, plane_strain, material=STEEL, **through):
    """A strip of four unequal cells in two layers."""
    lines = np.array([0.0, 0.7, 2.0, 3.1, 4.0]), [0.0, 1.3], [0.0, 0.3, 1.0]
    mesh = uf.mesh.grid(*lines, element(name).cell)
    model = uf.Model(mesh, name, material=material, plane_strain=plane_strain, **through)
    model.fix(np.arange(len(model.mesh.points)), "y")
    return model


@pytest.mark.parametrize("name", NAMES)
def test_same_plastic_bend_as_with_all_points(name):
    results = []
    for plane_strain in (False, True):
        model = strip(name, plane_strain, **SAME)
        model.fix("x0", "xz")
        end = model.prescribe("x1", "z", name="end")
        results.append(uf.solve(model, uf.Move(end, to=0.4, steps=2), frames=0, progress=False))
    full, reduced = results
    assert reduced["end_force"] == pytest.approx(full["end_force"], rel=1e-7)
    assert reduced.model.u == pytest.approx(full.model.u, abs=1e-8)
    assert reduced.model.bodies[0].block.state.size < full.model.bodies[0].block.state.size


@pytest.mark.parametrize("name", NAMES)
def test_only_rigid_motions_are_free(build, name):
    model = strip(name, True, uf.SVK(E=1.0, nu=0.3))
    K = build.dense(model.system.pattern, model.evaluate(np.zeros(3 * len(model.mesh.points))).values)
    eigenvalues = np.linalg.eigvalsh(K)
    assert (np.abs(eigenvalues) < 1e-10 * eigenvalues.max()).sum() == 3  # two translations, one rotation


def test_points_and_modes():
    made = element("BEND18", plane_strain=True)
    assert made.surface_rule == (3, 2)
    assert len(made.modes) == len(element("BEND18").modes) // 3
    completed = uf.elements.at_order(made, 5)
    assert len(completed.modes) == 15
    assert completed.plane_strain


def test_an_element_of_the_user_takes_no_option():
    with pytest.raises(InvalidValue, match="takes no further options"):
        element(element("BEND8"), plane_strain=True)


def test_free_nodes_are_refused():
    model = uf.Model(uf.mesh.strip(4.0, 1.0, 0.5, (4, 1)), "BEND8", material=STEEL, plane_strain=True)
    model.fix("x0")
    with pytest.raises(ModelError, match="may move along y"):
        model.system.check()


def continued_in(Q, result):
    """A strip that goes on in the place to which Q has turned it, held there."""
    model = strip("BEND8", True)
    model.remove(model.supports.all[0])
    continued(model, result, RigidMotion(Q, np.array([5.0, 0.0, 0.0])))
    (across, along, up) = ("xyz"[int(np.abs(Q[:, k]).argmax())] for k in (1, 0, 2))
    model.fix(np.arange(len(model.mesh.points)), across, here=True)
    model.fix("x0", along + up, here=True)
    return model


def test_a_strip_that_was_turned_is_held_across_where_it_lies():
    first = strip("BEND8", True)
    first.fix("x0", "xz")
    result = uf.solve(first, uf.Move(first.prescribe("x1", "z", name="end"), to=0.2, steps=2), frames=0)
    shapes = []
    turns = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]
    for Q in (np.eye(3), *map(np.array, turns)):
        model = continued_in(Q, result)
        uf.solve(model, uf.Move(model.force("x1", -0.1 * Q[:, 2], name="load"), 1.0, steps=2), frames=0)
        shapes.append((model.positions - [5.0, 0.0, 0.0]) @ Q)
    np.testing.assert_allclose(shapes[1:], [shapes[0]] * 2, atol=1e-9)
    slanted = np.array([[0.8, -0.6, 0.0], [0.6, 0.8, 0.0], [0.0, 0.0, 1.0]])
    with pytest.raises(ModelError, match="does not lie along an axis"):
        continued_in(slanted, result).system.check()


def test_cells_must_lie_across_an_axis():
    mesh = uf.mesh.strip(4.0, 1.0, 0.5, (4, 1))
    x, y, z = mesh.points.T
    slanted = uf.Mesh(np.stack([x + 0.2 * y, y, z], axis=1), {"hex8": mesh.connectivity})
    model = uf.Model(slanted, "BEND8", material=STEEL, plane_strain=True)
    model.fix(np.arange(len(x)), "y")
    with pytest.raises(ModelError, match="along one axis"):
        model.system.check()


def test_a_rolling_direction_at_an_angle_is_refused():
    mesh = strip("BEND18", False).mesh
    law = uf.Metal(E=210e3, nu=0.3, yield_function=uf.Hill48(2.0, 1.2, 1.8), hardening=uf.Linear(200.0, 1000.0))
    model = uf.Model(mesh, "BEND18", material=law, rolling=uf.rolling_at(45), plane_strain=True)
    model.fix(np.arange(len(model.mesh.points)), "y")
    with pytest.raises(ModelError, match="at an angle"):
        model.system.check()


@pytest.mark.parametrize("name", ["BEND8", "BEND18"])
@pytest.mark.parametrize("faces", ["lower", "upper"])
def test_contact_with_fewer_points_across(name, faces):
    results = []
    for plane_strain in (False, True):
        model = strip(name, plane_strain, **SAME)
        model.fix("x0", "xz")
        top = 1.2 if faces == "upper" else -0.2
        tool = uf.Cylinder((3.0, 0.0, top + (1.0 if faces == "upper" else -1.0)), "y", 1.0)
        contact = model.contact(faces, tool, penalty=1000.0, points=5, name="tool")
        push = model.drive(contact, "-z" if faces == "upper" else "z", name="push")
        results.append(uf.solve(model, uf.Move(push, to=0.5, steps=2), frames=0, progress=False))
    full, reduced = results
    assert np.abs(full["push_force"]).max() > 10.0
    assert reduced["push_force"] == pytest.approx(full["push_force"], rel=1e-6)
    across = reduced.model.bodies[0].element.width_points
    assert reduced.model.contacts[0].rule == (5, across)
    assert len(reduced.model.contacts[0].gap_now(reduced.model.u)) == 4 * 5 * across
