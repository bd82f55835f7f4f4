import json

import numpy as np
import pytest

import umform as uf
from umform import sheet_metals
from umform.materials import J2, Swift
from umform.problem import Problem, load
from umform.problem.templates import template_file

TOOLS = {
    "Plane": ('point = [0, 0, -3]\nnormal = "z"', uf.Plane((0, 0, -3), "z"), None),
    "Cylinder": ('centre = [1, 0, -3]\naxis = "y"\nradius = 2.0', uf.Cylinder((1, 0, -3), "y", 2.0), 2.0),
    "Sphere": ("centre = [1, 0, -3]\nradius = 2.0\ninside = true", uf.Sphere((1, 0, -3), 2.0, True), None),
    "Torus": ('centre = [0, 0, 0]\naxis = "z"\nmajor = 3.0\nminor = 1.0', uf.Torus((0, 0, 0), "z", 3.0, 1.0), 1.0),
    "Box": ("centre = [0, 0, 0]\nsize = [1, 2, 3]\nradius = 0.2", uf.Box((0, 0, 0), (1, 2, 3), 0.2), 0.2),
    "VDie": (
        "opening = 8.0\nangle = 80.0\nshoulder_radius = 1.0\nbottom_radius = 0.5\norigin = [0, 0, -1]",
        uf.VDie(8.0, 80.0, 1.0, 0.5, origin=(0, 0, -1)),
        1.0,
    ),
    "UDie": ("opening = 8.0\ndepth = 4.0\nshoulder_radius = 1.0", uf.UDie(8.0, 4.0, 1.0), 1.0),
    "WipingDie": ('radius = 2.0\nx = [1, 0, 0]\ny = "-z"', uf.WipingDie(2.0, x="x", y="-z"), 2.0),
    "Punch": ("tip_radius = 1.0\nangle = 80.0\nwidth = 6.0", uf.Punch(1.0, 80.0, 6.0), 1.0),
    "Extruded": (
        "profile = { corners = [[-5, -4], [5, -4], [0, 5]], radii = [0.5, 0.25, 1] }",
        uf.Extruded(uf.Profile.from_corners([(-5, -4), (5, -4), (0, 5)], [0.5, 0.25, 1])),
        0.25,
    ),
    "LedAround": (
        "size = [8, 6]\ncorner = 2.0\n"
        "profile = { corners = [[-2, 0], [0, 0], [0, 9]], radii = [0, 1, 0], closed = false }",
        uf.LedAround(uf.Profile.from_corners([(-2, 0), (0, 0), (0, 9)], [0, 1, 0], closed=False), (8, 6), 2.0),
        1.0,
    ),
    "Revolved": (
        'profile.segments = [{ kind = "arc", start = [4, 0], end = [4, 0], centre = [3, 0] }]\naxis = "y"',
        uf.Revolved(uf.Profile.circle((3, 0), 1.0), (0, 0, 0), "y"),
        1.0,
    ),
}


@pytest.mark.parametrize("shape", TOOLS)
def test_each_tool_is_that_of_the_library_where_it_was_placed(shape, strip, rng):
    keys, tool, radius = TOOLS[shape]
    placing = "rotation = [0, 30, 0]\ntranslation = [1, 2, 3]"
    text = f'{strip}[tools.it]\nshape = "{shape}"\n{keys}\n'
    plain, placed = Problem.read(text), Problem.read(text + placing)
    x = rng.uniform(-6, 6, (40, 3))
    part = plain.contents.tools["it"]
    assert np.array_equal(part.build().gap(x)[0], tool.gap(x)[0])
    there = tool.moved((1, 2, 3), (0, np.pi / 6, 0))
    assert np.allclose(placed.contents.tools["it"].build().gap(x)[0], there.gap(x)[0], atol=1e-13)
    found = min(part.build().convex_radii(), default=None)
    assert found == pytest.approx(radius) if radius else found is None


CURVES = {
    "Perfect": 'curve = "Perfect", yield_stress = 100.0',
    "Linear": 'curve = "Linear", yield_stress = 100.0, modulus = 50.0',
    "Voce": 'curve = "Voce", yield_stress = 100.0, saturation = 200.0, rate = 5.0',
    "LinearVoce": 'curve = "LinearVoce", yield_stress = 100.0, modulus = 10.0, saturation = 200.0, rate = 5.0',
    "Swift": 'curve = "Swift", strength = 500.0, offset = 0.01, exponent = 0.2',
    "Table": 'curve = "Table", eqps = [0, 0.1], stress = [100, 120]',
}


@pytest.mark.parametrize("curve", CURVES)
def test_hardening(curve, strip):
    text = strip.replace('"SVK"', '"J2"').replace("nu = 0.3", f"nu = 0.3\nhardening = {{ {CURVES[curve]} }}")
    material = Problem.read(text).contents.material.law
    assert isinstance(material, J2)
    value = material.hardening.curve()(0.05)[0]
    expected = {
        "Perfect": 100.0,
        "Linear": 102.5,
        "Voce": 200 - 100 * np.exp(-0.25),
        "LinearVoce": 200.5 - 100 * np.exp(-0.25),
        "Swift": Swift(500.0, 0.01, 0.2).curve()(0.05)[0],
        "Table": 110.0,
    }
    assert value == pytest.approx(expected[curve])


@pytest.mark.parametrize("law", ["SVK", "NeoHooke", "NeoHookePower"])
def test_elastic_laws(law, strip):
    material = Problem.read(strip.replace('"SVK"', f'"{law}"')).contents.material.law
    assert type(material).__name__ == law
    assert (material.E, material.nu) == pytest.approx((210e3, 0.3))


def test_a_metal_of_the_library(strip, errors):
    text = strip.replace('law = "SVK"', 'library = "DC04"').replace("E = 210e3", "").replace("nu = 0.3", "")
    assert Problem.read(text).build().model.bodies.only.material == sheet_metals.get("DC04").law
    (told,) = errors(text.replace("DC04", "cheese"))
    assert "line 9, material.library" in told.where


def test_a_table_is_changed_before_the_keys_within_it(strip):
    whole = {"material": {"library": "DC04"}, "material.E": 2e5}
    for changes in (whole, dict(reversed(whole.items()))):
        problem = Problem.read(strip, changes=changes)
        dc04, law = sheet_metals.get("DC04").law, problem.contents.material.law
        assert pytest.approx(law.E) == 2e5 and law.hardening == dc04.hardening
        assert problem.with_({"material": {"library": "DC04"}}).contents.material.law == dc04
        law = problem.with_({"material.nu": 0.25}).contents.material.law
        assert (law.E, law.nu) == pytest.approx((2e5, 0.25)) and law.hardening == dc04.hardening


def test_grid_and_plate(strip):
    lines = 'generator = "grid"\nx = [0, 1, 3]\ny = [0, 2]\nz = [-0.5, 0, 0.5]\n'
    head, tail = strip.split('generator = "strip"')
    mesh = Problem.read(head + lines + tail[tail.index("[material]") :]).build().model.mesh
    assert len(mesh.connectivity) == 4
    plate = Problem.read(strip.replace('"strip"', '"plate"').replace("[4, 2]", "[4, 2]\nlayers = 2\ngrading = [3, 1]"))
    built = plate.build().model.mesh
    assert len(built.connectivity) == 16
    x = np.unique(built.points[:, 0].round(9))
    assert (x[-1] - x[-2]) / (x[1] - x[0]) == pytest.approx(3.0)


def test_the_mesh_takes_the_cells_of_the_element(strip):
    text = strip.replace(
        "[material]", '[element]\nname = "MI9K3DEAS"\nthickness_order = 3\nthickness_points = 6\n[material]'
    )
    model = Problem.read(text).build().model
    assert model.mesh.cell == "hex18"
    assert (model.bodies.only.element.thickness_order, model.bodies.only.thickness_points) == (3, 6)


def test_rolled_strip(strip):
    rolled = strip.replace("[4, 2]", "[4, 2]\nrolled = 20.0")
    X = Problem.read(rolled).build().model.mesh.points
    radius = np.hypot(X[:, 0], X[:, 2] + 20.0)
    assert set(radius.round(9)) == {19.5, 20.5}
    assert np.arctan2(X[:, 0], X[:, 2] + 20.0).max() == pytest.approx(0.5)


CONTROLS = """
[controls.lift]
kind = "midline"
nodes = { intersection = ["x1", { min = [0, 1, -1] }] }
direction = "z"
[controls.push]
kind = "force"
nodes = { nearest = [5, 0, 1] }
force = [0, 0, -1]
[controls.drag]
kind = "traction"
faces = "upper"
traction = [1, 0, 0]
[controls.edge]
kind = "line_load"
faces = "x1"
side = "upper"
load = [0, 1, 0]
[controls.blow]
kind = "pressure"
faces = "upper"
[controls.weight]
kind = "body_force"
force = [0, 0, -1]
[controls.drive]
kind = "tool"
contact = "floor"
direction = [0, 0, 2]
[tools.floor]
shape = "Plane"
point = [0, 0, -1]
[contacts.floor]
tool = "floor"
faces = "lower"
penalty = 1e3
points = "nodes"
[contacts.floor.motion]
time = [0, 1, 2]
translation = [[0, 0, 0], [0, 0, 1], [0, 0, 1]]
rotation = [[0, 0, 0], [0, 90, 0], [0, 90, 0]]
"""


def test_every_control_is_that_of_the_model(strip):
    problem = Problem.read(strip + CONTROLS).build()
    assert list(problem.controls) == ["pull", "lift", "push", "drag", "edge", "blow", "weight", "drive"]
    total = {name: getattr(control, "vector", None) for name, control in problem.controls.items()}
    sums = {
        name: vector.reshape(-1, 3).sum(axis=0).round(9).tolist()
        for name, vector in total.items()
        if vector is not None
    }
    assert sums == {"push": [0, 0, -1], "drag": [20, 0, 0], "edge": [0, 2, 0], "weight": [0, 0, -20]}
    contact = problem.contacts["floor"]
    problem.model.system.time = 0.5
    Q, c = contact.pose
    assert c.tolist() == [0, 0, 0.5]
    assert np.allclose(Q @ [1, 0, 0], [np.sqrt(0.5), 0, -np.sqrt(0.5)])
    assert problem.controls["drive"].direction == (0, 0, 1)


def test_a_shared_tool_has_one_motion(strip, errors):
    text = (strip + CONTROLS).replace('shape = "Plane"', 'shape = "Plane"\nshared = true')
    motion = CONTROLS[CONTROLS.index("time = ") :]
    more = f'[contacts.more]\ntool = "floor"\nfaces = "upper"\n[contacts.more.motion]\n{motion}'
    [found] = errors(text + more)
    assert (found.what, found.value) == ("a shared tool has one motion in time", "tool floor")
    assert "contacts.more" in found.where


@pytest.mark.parametrize(
    "keys",
    [
        {},
        {"penalty": 300.0},
        {"penetration": 1e-3, "points": "auto"},
        {"augmented": True},
        {"cells": 4, "points": None},
        {"cells": "auto", "ripple": 0.01, "points": None},
        {"penalty": 300.0, "penetration": 1e-3, "augmented": True},
    ],
    ids=str,
)
def test_contacts_are_those_of_the_model(keys, strip):
    given = {key: value for key, value in ({"points": 3} | keys).items() if value is not None}
    lines = [f"{key} = {json.dumps(value)}" for key, value in given.items()]
    text = (strip + CONTROLS).replace("penalty = 1e3", "\n".join(lines)).replace('points = "nodes"', "")
    contact = Problem.read(text).build().contacts["floor"]
    model = uf.Model(uf.mesh.strip(10.0, 2.0, 1.0, (4, 2)), material=uf.SVK(E=210e3, nu=0.3))
    same = model.contact("lower", uf.Plane((0, 0, -1)), **{"points": 3} | keys)
    for name in ("penalty", "points", "cells", "ripple", "allowed", "augmented"):
        assert getattr(contact, name) == getattr(same, name)


REGIONS = (
    "{ mu = [[0, 0.14], [50, 0.1]], cap = 90.0, regions = [{ mu = 0.3, lower = [-inf, -1, -9], upper = [2, 1, inf] }] }"
)


def test_friction_of_a_contact_is_a_number_a_law_or_laws_in_regions(strip, errors):
    def friction(text):
        return (strip + CONTROLS).replace("penalty = 1e3", f"penalty = 1e3\nfriction = {text}")

    def found(text):
        problem = Problem.read(friction(text))
        assert problem.build().contacts["floor"].has_friction
        return problem.contents.contacts["floor"].of_spec()["friction"]

    assert found("0.2") == 0.2
    law = uf.Friction(((0.0, 0.14), (50.0, 0.1)), cap=90.0)
    box = uf.Region((-np.inf, -1.0, -9.0), (2.0, 1.0, np.inf), uf.Friction(0.3))
    assert found(REGIONS) == uf.FrictionByRegion(law, (box,))
    (told,) = errors(friction(REGIONS.replace("mu = 0.3", "mu = 3.0")))
    assert told.where.endswith("contacts.floor.friction.regions[0].mu") and told.value == "3.0"
    (told,) = errors(friction("{ mu = 0.1, kinetic = 0.05 }"))
    assert "belong together" in told.what and told.where.endswith("contacts.floor.friction.kinetic")


def test_points_and_cells_are_not_both_given(strip, errors):
    (told,) = errors((strip + CONTROLS).replace("penalty = 1e3", "penalty = 1e3\ncells = 3"))
    assert "points or cells, and not both" in told.what


def test_a_ripple_is_wanted_of_cells_whose_number_follows_from_it(strip, errors):
    (told,) = errors((strip + CONTROLS).replace("penalty = 1e3", "penalty = 1e3\nripple = 0.01"))
    assert "cells whose number follows" in told.what


def test_penalty_and_penetration_are_not_both_given(strip, errors):
    (told,) = errors((strip + CONTROLS).replace("penalty = 1e3", "penalty = 1e3\npenetration = 1e-3"))
    assert "not both" in told.what


def test_steps(strip):
    text = strip + '[[steps]]\nkind = "release"\ncontrol = "pull"\n[[steps]]\nkind = "arc"\nto = { pull = 0.2 }\n'
    move, release, arc = (
        Problem.read(text + 'length = "spherical"\nmost = 3\ncuts = 3\ngrow = 2.0\ntime = 4.0\n').build().steps
    )
    assert (move.steps, move.to) == (2, [0.1])
    assert release.control.name == "pull"
    assert (arc.kind, arc.most, arc.cuts, arc.grow, arc.time) == ("spherical", 3, 3, 2.0, 4.0)


def test_a_deck_solves_as_the_same_lines_of_python(strip):
    result = Problem.read(strip).build().solve(progress=False)
    model = uf.Model(uf.mesh.strip(10.0, 2.0, 1.0, (4, 2)), material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    pull = model.prescribe("x1", "x", "pull")
    same = uf.solve(model, uf.Move(pull, 0.1, steps=2))
    assert np.array_equal(result["pull_force"], same["pull_force"])


def test_the_text_of_a_changed_problem_has_the_change():
    problem = load(template_file("air-bending"), {"steps.0.to.stroke": 1.25})
    again = Problem.read(problem.toml())
    assert again.contents.steps[0].to == {"stroke": 1.25}
    assert [one.value for one in again.paths()] == [one.value for one in problem.paths()]
