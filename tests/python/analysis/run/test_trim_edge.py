"""Trimming with an edge on the line: its place, the area, the state of the new elements, friction that stays."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform import _core
from umform.errors import InvalidValue
from umform.history_variables import history_of
from umform.mesh.fitted.sheet import Sheet
from umform.mesh.quality import jacobians
from umform.model.transfer.transfer import Weights

STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0))
CURVE, BACK = uf.Linear(yield_stress=160.0, modulus=500.0), uf.Chaboche(((4000.0, 40.0),))
ISOTROPIC = uf.Metal(E=210e3, nu=0.3, hardening=CURVE, back_stress=BACK)
HILL = uf.Metal(E=210e3, nu=0.3, hardening=CURVE, yield_function=uf.Hill48(1.8, 1.2, 2.2), back_stress=BACK)


def across(x, tilt=0.0):
    """A line that crosses the sheet at x; what is left of it stays."""
    return [(x - tilt, -5.0), (x + tilt, 15.0)]


def area(mesh):
    """Area of the lower faces."""
    a, b, c, d = (mesh.points[mesh.connectivity[:, k], :2] for k in range(4))
    return 0.5 * ((c - a)[:, 0] * (d - b)[:, 1] - (c - a)[:, 1] * (d - b)[:, 0]).sum()


@pytest.mark.parametrize("tilt", [0.0, 0.7, 3.0, 8.0])
def test_the_edge_lies_on_a_straight_line_and_what_is_cut_off_is_exact(tilt):
    model = uf.Model(uf.mesh.strip(20.0, 10.0, 1.0, (30, 15), layers=2), material=uf.SVK(E=210e3, nu=0.3))
    part = uf.Trim(across(10.3, tilt)).of(model)
    assert part.edge_distance < 1e-12 and part.missed == 0 and part.remark == ""
    assert area(part.mesh) == pytest.approx(2 * 10.3 * 10.0, rel=1e-12)  # two layers
    x, y = part.mesh.points[part.mesh.nodes("cut")].T[:2]
    np.testing.assert_allclose(x, 10.3 + tilt * (y - 5.0) / 10.0, atol=1e-12)
    J = jacobians(part.mesh.points, part.mesh.connectivity)
    assert (J.min(axis=1) > 0.2 * J.max(axis=1)).all()
    for name, side in (("y0", 0.0), ("y1", 10.0)):
        nodes = part.mesh.nodes(name)
        assert (part.mesh.points[nodes, 1] == pytest.approx(side)) and np.isin(
            np.flatnonzero(np.abs(part.mesh.points[:, 1] - side) < 1e-9), nodes
        ).all()
    assert len(part.mesh.facets("lower")) == len(part.mesh.facets("upper")) == len(part.mesh.connectivity) // 2
    assert (~part.same).sum() < 0.35 * len(part.same)  # only elements near the line change


def test_a_hole_lies_on_its_circle():
    model = uf.Model(uf.mesh.plate(8.0, 8.0, 0.5, (16, 16)), material=uf.SVK(E=210e3, nu=0.3))
    part = uf.Trim(uf.Profile.circle((4.1, 3.9), 2.0, hole=True)).of(model)
    corners = part.mesh.points[part.mesh.nodes("cut"), :2] - (4.1, 3.9)
    assert np.abs(np.linalg.norm(corners, axis=1) - 2.0).max() < 1e-9 and part.missed == 0
    sides = len(part.mesh.faces["cut"])
    inscribed = 64.0 - 0.5 * sides * 4.0 * np.sin(2.0 * np.pi / sides)
    assert area(part.mesh) == pytest.approx(inscribed, abs=0.02)
    assert len(np.unique(corners.round(9), axis=0)) == sides


def stretched(material, **options):
    """A strip under uniform tension beyond yielding, and back by a part."""
    lines = np.linspace(0.0, 9.0, 7), np.linspace(0.0, 4.0, 4), [0.0, 1.0]
    model = uf.Model(uf.mesh.grid(*lines), material=material, thickness_points=3, **options)
    for side, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(side, normal)
    pull = model.prescribe("x1", "x", "pull")
    return uf.solve(model, [uf.Move(pull, 0.18, steps=4), uf.Move(pull, 0.175, steps=1)], frames=0).model


def stresses(model):
    """Second Piola-Kirchhoff stresses in global axes at all points."""
    return _core.point_stresses(
        *(a.reshape(-1, *a.shape[2:]) for a in model.bodies.only.block.point_fields(model.u)[:4])
    )[2]


def back_stress(model):
    """The back stress in global axes at all points."""
    frame = model.bodies.only.block.point_fields(model.u)[2].reshape(-1, 3, 3)
    parts = history_of(model.bodies.only.block)["back_stress_1"].reshape(-1, 6)
    local = parts[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
    return np.einsum("pki,pkl,plj->pij", frame, local, frame)


@pytest.mark.parametrize(
    ("metal", "options"),
    [(STEEL, {}), (ISOTROPIC, {}), (HILL, {"rolling": (1.0, 0.0, 0.0)})],
    ids=["J2", "back stress", "Hill48 with back stress"],
)
def test_a_uniform_state_is_moved_without_error(metal, options):
    whole = stretched(metal, **options)
    part = uf.Trim(across(5.7, 5.0), formed=False).of(whole)
    assert (~part.same).sum() > 3 and part.edge_distance < 1e-12  # they lie askew
    expected, found = stresses(whole), stresses(part.model)
    assert np.abs(expected - expected[0]).max() < 1e-5 * np.abs(expected).max()
    assert np.abs(found - expected[0]).max() < 1e-5 * np.abs(expected).max()
    eqps = history_of(whole.bodies.only.block)["eqps"][0, 0]
    np.testing.assert_allclose(*np.broadcast_arrays(history_of(part.model.bodies.only.block)["eqps"], eqps), rtol=1e-6)
    if metal is ISOTROPIC:
        backs = [back_stress(whole), back_stress(part.model)]
        assert np.abs(backs[1] - backs[0][0]).max() < 1e-4 * np.abs(backs[0]).max() > 1e-3


def bend(lines):
    """A cantilever that is bent beyond yielding, and half let go."""
    model = uf.Model(uf.mesh.grid(lines, [0.0, 2.0], [-0.5, 0.5]), material=STEEL)
    model.fix("x0")
    load = model.force("x1", (0.0, 0.0, -1.0), "load")
    return uf.solve(model, [uf.Move(load, 1.25, steps=4), uf.Move(load, 0.6, steps=1)], frames=0)


def springback(part):
    """By how much the edge rises when the forces of the metal that was cut off decrease to zero."""
    model = part.model
    model.fix("x0", here=True)
    edge, before = model.mesh.nodes("cut"), model.u.reshape(-1, 3).copy()
    uf.solve(model, uf.Move(model.unbalanced("cut"), 0.0, steps=2), frames=0)
    return float((model.u.reshape(-1, 3) - before)[edge, 2].mean())


@pytest.fixture(scope="module")
def bent():
    return {count: bend(np.linspace(0.0, 20.0, count + 1)) for count in (10, 20)}


def test_springback_is_that_of_a_mesh_with_an_edge_on_the_line(bent):
    for count, result in bent.items():
        first = round(13.7 / 20.0 * count)
        lines = np.concatenate([np.linspace(0.0, 13.7, first + 1), np.linspace(13.7, 20.0, count - first + 1)[1:]])
        exact = uf.Trim(across(13.7), formed=False).of(bend(lines))
        assert exact.same.all()  # an edge of elements lies there
        expected, found = springback(exact), springback(uf.Trim(across(13.7), formed=False).of(result))
        assert expected > 0.07
        assert found == pytest.approx(expected, rel=0.06 / count)  # 0.4 % and 0.13 %


def test_plastic_strain_stays_between_its_extremes_and_releases_nothing_new(bent):
    whole = bent[20].model
    part = uf.Trim(across(2.6), formed=False).of(whole)  # through metal that has yielded
    eqps = history_of(part.model.bodies.only.block)["eqps"][~part.same]
    around = history_of(whole.bodies.only.block)["eqps"][1:5]
    assert around.max() >= eqps.max() > 0.01 and eqps.min() >= 0.0
    work = part.model.bodies.only.block.energy(part.model.u)[1]
    springback(part)
    assert part.model.bodies.only.block.energy(part.model.u)[1] == pytest.approx(work, rel=1e-6)


def test_a_line_on_the_formed_part_is_met_where_the_part_is(bent):
    model = bent[20].model
    part = uf.Trim(across(10.3)).of(model)
    place = part.mesh.displaced(part.model.u)
    half = len(part.mesh.nodes("cut")) // 2
    cut = part.mesh.nodes("cut")
    assert half == 2 and place[cut, 0].mean() == pytest.approx(10.3, abs=1e-9) and part.edge_distance < 1e-9
    assert part.mesh.points[cut, 0].mean() > 10.5  # it was bent down there


def test_a_strip_in_plane_strain_has_one_point_across():
    model = uf.Model(uf.mesh.strip(20.0, 1.0, 1.0, (20, 1)), material=STEEL, plane_strain=True)
    model.fix("x0")
    model.fix(lambda x, y, z: x > 0.5, directions="y")
    press = model.force("x1", (0.0, 0.0, -0.5), "press")
    result = uf.solve(model, [uf.Move(press, 1.2, steps=3), uf.Move(press, 0.5, steps=1)], frames=0)
    part = uf.Trim(across(13.3), formed=False).of(result)
    assert part.edge_distance < 1e-12 and part.remark == "" and part.model.bodies[0].element.surface_rule == (2, 1)
    eqps = history_of(model.bodies.only.block)["eqps"][11:15]
    assert eqps.min() <= history_of(part.model.bodies.only.block)["eqps"][~part.same].max() <= eqps.max()


def test_what_cannot_be_fitted_follows_elements_and_says_why():
    plate = uf.mesh.plate(8.0, 4.0, 0.5, (8, 4), cell="hex18")
    part = uf.Trim(across(4.4)).of(uf.Model(plate, "DISP9K3DEAS", material=uf.SVK(E=210e3, nu=0.3)))
    assert "8-node" in part.remark and "warning: the edge follows elements" in str(part)
    assert part.edge_distance == pytest.approx(0.4)
    coarse = uf.Model(uf.mesh.plate(8.0, 4.0, 0.5, (4, 2)), material=uf.SVK(E=210e3, nu=0.3))
    assert "too large" in uf.Trim(across(1.9)).of(coarse).remark
    with pytest.raises(InvalidValue, match="follows elements"):
        uf.Trim(across(1.9), edge="exact")


def rubbed():
    """A block that sticks to a plane after it has slid and turned back."""
    model = uf.Model(uf.mesh.strip(10.0, 2.0, 1.0, (10, 1)), material=STEEL)
    down, aside = model.prescribe("upper", "z", "down"), model.prescribe("upper", "x", "aside")
    model.fix("upper", directions="y")
    die = model.contact("lower", uf.Plane((0, 0, -0.5)), name="die", friction=0.3, penalty=1e4)
    way = model.drive(die, "x", "way")
    steps = [uf.Move(down, -1e-3, steps=1), uf.Move(way, 0.05, steps=2), uf.Move(aside, -0.02, steps=2)]
    return uf.solve(model, [*steps, uf.Move(aside, -0.0199, steps=1)], frames=0), die


def test_contact_points_keep_their_friction_through_a_cut():
    result, die = rubbed()
    part = uf.Trim(across(7.3), formed=False).of(result)
    part.model.fix("upper", here=True)
    plane = part.model.contact("lower", uf.Plane((0.05, 0, -0.5)), name="die", friction=0.3, penalty=1e4)
    assert part.keep_friction(plane) == 6  # the seventh element is fitted to the line
    found, points = part.model.evaluate(part.model.system.x).found[plane], 6 * plane.block.per_facet
    np.testing.assert_allclose(found.friction[:points], die.found.friction[:points], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(found.slip[:points], die.found.slip[:points], rtol=1e-12)
    assert die.found.slip[:points].min() > 0.06
    with pytest.raises(InvalidValue, match="no contact of this name"):
        part.keep_friction(plane, before="punch")


def test_states_beyond_the_last_points_are_means_of_known_ones():
    """Points between the last Gauss points and the edge of the sheet extrapolate nothing. eq. (1.32)"""
    mesh = uf.mesh.strip(2.0, 1.0, 1.0, (2, 1))
    sheet = Sheet.of(mesh)
    x = mesh.points[sheet.nodes[:, 0], :2]
    new = np.array([[[0.0, 0.0], [0.1, 0.0], [0.1, 1.0], [0.0, 1.0]]])
    weights = Weights.between(sheet, x, np.arange(2), new, (2, 2), np.array([-0.6, 0.6]))
    assert (weights.share >= 0.0).all()
    np.testing.assert_allclose(weights.share.sum(axis=-1), 1.0, rtol=1e-14)


def test_a_linear_field_of_the_points_is_met():
    """In a new stack between the points of an old one, shares give back a linear field. eq. (1.32)"""
    mesh = uf.mesh.strip(2.0, 1.0, 1.0, (1, 1))
    sheet = Sheet.of(mesh)
    x = mesh.points[sheet.nodes[:, 0], :2]
    new = np.array([[[0.6, 0.3], [1.2, 0.4], [1.1, 0.6], [0.7, 0.7]]])
    weights = Weights.between(sheet, x, np.arange(1), new, (2, 2), np.zeros(1))
    g = 0.5 / np.sqrt(3.0)
    places = np.array([[1.0 + 2.0 * a * g, 0.5 + b * g] for b in (-1, 1) for a in (-1, 1)])
    N = [
        [0.25 * (1.0 + a * 2 * g) * (1.0 + b * 2 * g) for a, b in ((k, m), (-k, m), (-k, -m), (k, -m))]
        for m in (-1, 1)
        for k in (-1, 1)
    ]
    expected = np.einsum("qa,ai->qi", N, new[0][[2, 3, 0, 1]])
    np.testing.assert_allclose(weights.mean(places[None])[0], expected, atol=1e-12)
