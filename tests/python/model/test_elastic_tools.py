"""A tool as a body in contact: bodies by name, the default penalty of solid bodies, the force that is reported."""

import numpy as np
import pytest

import umform as uf

DIE = uf.VDie(opening=8, angle=88, shoulder_radius=1.5)
STEEL = uf.SVK(E=210e3, nu=0.3)


def blocks(layers, size=1.0):
    """Two blocks on each other, each of so many layers; heights 8 and 4."""
    lower = uf.mesh.grid(np.arange(0.0, 5.0, size), [0.0, 1.0], np.linspace(-8.0, 0.0, layers[0] + 1))
    upper = uf.mesh.grid(np.arange(0.0, 5.0, size), [0.0, 1.0], np.linspace(0.0, 4.0, layers[1] + 1))
    return uf.mesh.together(a=lower, b=upper)


def penalty(layers, moduli=(210e3, 210e3), swapped=False):
    bodies = [
        uf.Body(material=uf.SVK(E=E, nu=0.3), cells=name, name=name) for E, name in zip(moduli, "ab", strict=True)
    ]
    model = uf.Model(blocks(layers), bodies=bodies)
    faces = ("upper of a", "lower of b")
    return model.sheet_contact(*(faces[::-1] if swapped else faces), name="faces")


def test_the_penalty_of_solid_bodies_follows_from_their_layers():
    stiff = 210e3 / (1.0 - 0.3**2)
    sheets, mixed, solid = penalty((4, 4)), penalty((8, 4)), penalty((8, 8))
    assert sheets.penalty == pytest.approx(stiff / (50.0 * (8.0 + 4.0)), rel=1e-6)
    assert sheets.largest_penalty == pytest.approx(100.0 * sheets.penalty, rel=1e-9)
    assert mixed.penalty == pytest.approx(stiff / (50.0 * 4.0 + 0.1 * 1.0), rel=1e-6)
    assert mixed.largest_penalty == pytest.approx(stiff / (0.5 * 4.0 + 0.1 * 1.0), rel=1e-6)
    assert solid.penalty == solid.largest_penalty == pytest.approx(stiff / (0.1 * (1.0 + 0.5)), rel=1e-6)
    assert solid.allowed == pytest.approx(4 * 0.5 / 200.0) and solid.settings.deepest == pytest.approx(2.0)


def test_the_penalty_is_the_same_in_either_order():
    one, other = (penalty((8, 4), (70e3, 210e3), swapped) for swapped in (False, True))
    assert one.penalty == other.penalty and one.allowed == other.allowed


def test_a_body_of_a_name():
    mesh = blocks((2, 1))
    model = uf.Model(mesh, bodies=[uf.Body(material=STEEL, cells=name, name=name) for name in "ab"])
    assert [len(body.cells) for body in model.bodies] == [8, 4]
    assert (mesh.points[mesh.connectivity[model.bodies[0].cells], 2] <= 0.0).all()
    with pytest.raises(uf.errors.UnknownSet, match="no node set"):
        uf.Model(mesh, bodies=[uf.Body(material=STEEL, cells="c")])
    with pytest.raises(uf.errors.EmptySet, match="no cell"):
        uf.Model(mesh, bodies=[uf.Body(material=STEEL, cells="x0 of a")])


@pytest.mark.parametrize("rule", [{"points": 3}, {"cells": 3}])
def test_the_force_of_an_elastic_die_is_that_of_the_punch(rule):
    thickness = 1.0
    block = DIE.elastic_body(((1.5, -2.5), (9, 0)), ((1.5, -10), (9, -10)), size=1.0, layers=5, growth=3, turn=15)
    half = uf.mesh.strip(9.0, 1.0, thickness, (18, 1)).moved((0, 0, 0.5 * thickness))
    mesh = uf.mesh.together(sheet=half, die=block)
    model = uf.Model(mesh, bodies=[uf.Body(material=STEEL, cells=name, name=name) for name in ("sheet", "die")])
    contact = model.sheet_contact("lower of sheet", "upper of die", name="shoulder", **rule)
    model.fix(np.arange(len(mesh.points)), "y")
    model.symmetry("x0 of sheet", "x")
    model.fix("lower of die", "xz")
    stroke = model.prescribe("x0_upper of sheet", "z", "stroke")
    result = uf.solve(model, uf.Move(stroke, -0.4, steps=2), progress=False)
    assert result["shoulder_fz"][-1] == pytest.approx(-result["stroke_force"][-1], rel=1e-9)
    assert result["shoulder_penetration"][-1] > 0.0
    on_die = contact.forces(model.u).reshape(-1, 3)[mesh.nodes("die")].sum(axis=0)
    assert on_die == pytest.approx(contact.found.force, rel=1e-9, abs=1e-9 * abs(on_die[2]))
