"""Tools grown by a field: kinds of tools against differences and level sets; limits; decks; derivatives."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.problem import Problem
from umform.problem.errors import DeckError
from umform.surfaces import Extruded, Offset, Plane, Profile, Revolved, Sphere, check_surface, write_tool

#: A section with a convex and a concave radius.
SECTION = Profile.from_corners([(-20, 3), (-5, 0), (5, 2), (20, -3)], radii=[0, 9, 9, 0], closed=False).reversed()


def field(rng, height=0.05, along=("x", "y"), coefficients=(7, 5)):
    spans = [(-9, 9), (-6, 6), (-7, 8)][: len(along)]
    return uf.OffsetField(along, spans, coefficients, height * rng.uniform(-1, 1, int(np.prod(coefficients))))


def triangles(tmp_path):
    return uf.read_tool(write_tool(Sphere((0, 0, -30), 30), tmp_path / "ball.stl", ((-20, -20, -9), (20, 20, 1)), 0.05),
                        open=True)  # fmt: skip


@pytest.mark.parametrize("along", [("x",), ("x", "y"), ("y", "x", "z")])
def test_distance_normal_and_hessian_are_those_of_the_surface(rng, tmp_path, along):
    own = field(rng, along=along, coefficients=(7, 5, 4)[: len(along)])
    for tool in (
        Plane((0, 0, 0), "z"),
        Sphere((0, 0, -30), 30),
        Sphere((0, 0, 25), 25, inside=True),
        Extruded(SECTION, x="x", y="z"),
        Revolved(Profile.from_corners([(0, 4), (6, 0), (20, 0)], [0, 8, 0], closed=False).reversed(), axis="z"),
        triangles(tmp_path),
    ):
        x = np.c_[rng.uniform(-5, 5, (40, 2)), np.zeros(40)]
        for _ in range(9):  # to the tool, and up to half a millimetre off
            g, n, _ = tool.gap(x)
            x -= g[:, None] * n
        x += rng.uniform(-0.5, 0.5, (40, 1)) * tool.gap(x)[1]
        grown = tool.offset(own)
        g, n, H = grown.gap(x)
        feet = x - g[:, None] * n
        np.testing.assert_allclose(tool.gap(feet)[0], own.basis(feet) @ own.values, atol=1e-12)
        np.testing.assert_allclose(np.linalg.norm(n, axis=1), 1.0, atol=1e-14)
        # a joint of two arcs or triangles within a step of the differences spoils a few points
        deviations = [check_surface(grown, [one], 1e-5) for one in x]
        assert np.quantile([max(one.normal, one.hessian) for one in deviations], 0.8) < 1e-7
        assert np.abs(H - np.swapaxes(H, 1, 2)).max() < 1e-13


def test_positive_values_grow_the_tool_where_they_are():
    values = np.zeros(9)
    values[6] = 0.3
    tool = Plane((0, 0, 0), "z").offset(uf.OffsetField(["x"], [(-8, 8)], [9], values))
    g = tool.gap([(4.0, 0, 1.0), (2.0, 0, 1.0), (0.0, 0, 1.0), (-4.0, 0, 1.0)])[0]
    np.testing.assert_allclose(g[[0, 2, 3]], [0.8, 1.0, 1.0], atol=1e-12)
    assert 0.94 < g[1] < 0.951  # 1 - 0.3/6, nearer to the slope


def test_equal_values_are_an_offset(rng):
    x = rng.uniform((-3, -3, 28), (3, 3, 34), (50, 3))
    flat = uf.OffsetField(["x", "z"], [(-9, 9), (20, 40)], [5, 4], np.full(20, 0.4))
    for one, other in zip(Sphere((0, 0, 0), 30).offset(flat).gap(x), Offset(Sphere((0, 0, 0), 30), 0.4).gap(x),
                          strict=True):  # fmt: skip
        np.testing.assert_allclose(one, other, atol=1e-12)


def test_far_points_are_not_nearer_than_the_gap_says(rng):
    own = field(rng, 0.3)
    ball, x = Sphere((0, 0, 0), 9, inside=True), rng.uniform(-12, 12, (400, 3))
    g, phi = ball.offset(own).gap(x)[0], ball.gap(x)[0]
    assert ((g >= phi - max(own.values) - 1e-8) & (g <= phi - min(own.values) + 1e-8)).all()


def test_contact_culls_no_point_that_touches(rng):
    """A sheet that goes far over a wavy tool: the same history as with a tool whose facets are never far."""
    own = uf.OffsetField(["x"], [(-2, 22)], [9], 0.2 * rng.uniform(-1, 1, 9))

    def pressed(tool):
        model = uf.Model(uf.mesh.strip(20.0, 2.0, 0.5, (12, 1)), material=uf.SVK(E=210e3, nu=0.3))
        model.fix("x0"), model.fix("x1")
        stroke = model.drive(model.contact("upper", tool, penalty=1e3, points=2, name="tool"), "-z", name="stroke")
        return uf.solve(model, uf.Move(stroke, to=6.2, steps=8), progress=False)

    tool = uf.Cylinder((10.0, 0.0, 11.25), "y", 5.0).offset(own)
    kernel = tool.kernel()
    assert kernel.is_distance
    result, whole = pressed(tool), pressed(uf.UserSurface(kernel.gap, name="the same, of a function"))
    assert result["stroke_force"][-1] > 1.0
    np.testing.assert_allclose(result["stroke_force"], whole["stroke_force"], rtol=1e-9, atol=1e-9)
    assert result.model.tools[0].surface is tool
    assert result["iterations"][1:].max() <= 12


def test_friction_and_pressure_do_not_depend_on_the_slope_of_the_field():
    """A plane that a linear field inclines is a plane: the same forces and penetration."""
    slope = 0.2
    inclined = uf.OffsetField(["x"], [(-40, 60)], [11], slope * np.linspace(-40, 60, 11))
    normal = np.array([-slope, 0.0, 1.0]) / np.hypot(1.0, slope)

    def slid(tool):
        sheet = uf.mesh.strip(8.0, 2.0, 1.0, (4, 1)).moved((0, 0, 0.5))
        turn = np.array([[normal[2], 0, normal[0]], [0, 1, 0], [-normal[0], 0, normal[2]]])
        model = uf.Model(sheet.transformed(lambda x: x @ turn.T), material=uf.SVK(E=210e3, nu=0.3))
        model.contact("lower", tool, penalty=1e4, points=2, friction=0.2, name="tool")
        model.fix("upper", "y")
        down = [model.prescribe("upper", k, name=k) for k in "xz"]
        steps = [uf.Move(down, list(-0.01 * normal[[0, 2]]), steps=1)]
        steps += [uf.Move(down, list(-0.01 * normal[[0, 2]] + 0.5 * turn[[0, 2], 0]), steps=4)]
        return uf.solve(model, steps, progress=False)

    one = slid(Plane((0, 0, 0), "z").offset(inclined))
    other = slid(Plane((0, 0, 0), tuple(normal)))
    for name in ("tool_fx", "tool_fz", "tool_penetration"):
        np.testing.assert_allclose(one[name], other[name], rtol=1e-7, atol=1e-9)


def test_pictures_lie_on_the_surface(rng):
    own = field(rng, 0.2)
    tool = Plane((0, 0, 0), "z").offset(own)
    found = tool.triangles(((-8, -5, -1), (8, 5, 1)), chord=0.01)
    middles = found.corners.mean(axis=1)
    assert np.abs(tool.gap(middles)[0]).max() < 0.01
    assert (found.area_vectors[:, 2] > 0.0).all()
    assert found.area_vectors[:, 2].sum() == pytest.approx(160.0, rel=1e-3)


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"values": [0.0, 1.0, 0, 0, 0]}, "slope of a field must be less than 1"),
        ({"values": [0.0, float("nan"), 0, 0, 0]}, "slope of a field"),
        ({"values": [0.1] * 4}, "a value for each coefficient"),
        ({"span": [(3.0, 3.0)]}, "a larger last number"),
        ({"span": [(0, 4), (0, 4)]}, "one to three directions"),
        ({"coefficients": [1]}, "at least 2"),
        ({"along": ["x", (1.0, 0.1, 0.0)], "span": [(0, 4)] * 2, "coefficients": [2, 2]}, "at right angles"),
    ],
)
def test_fields_that_are_none_are_refused(change, what):
    given = {"along": ["x"], "span": [(0.0, 4.0)], "coefficients": [5], "values": [0.0] * 5}
    with pytest.raises(InvalidValue, match=what):
        uf.OffsetField(**given | change)


DECK = """
[mesh]
generator = "strip"
length = 10.0
width = 1.0
thickness = 0.5
cells = [10, 1]
[material]
law = "SVK"
E = 210e3
nu = 0.3
[tools.die]
shape = "Plane"
point = [0.0, 0.0, 0.0]
rotation = [180.0, 0.0, 0.0]
translation = [0.0, 0.0, 0.3]
[tools.die.offset_field]
along = ["x"]
span = [[0.0, 10.0]]
coefficients = [6]
[contacts.die]
tool = "die"
faces = "upper"
penalty = 2e3
points = 3
friction = 0.1
[[supports]]
kind = "fix"
nodes = "x0"
[[supports]]
kind = "fix"
nodes = "x1"
[controls.stroke]
kind = "tool"
contact = "die"
direction = "-z"
[[steps]]
kind = "move"
to = { stroke = 0.15 }
increments = 4
"""


def test_each_coefficient_is_a_parameter_of_a_deck():
    problem = Problem.read(DECK)
    paths = {one.path: one.value for one in problem.paths() if ".offset_field.values." in one.path}
    assert paths == {f"tools.die.offset_field.values.{k}": 0.0 for k in range(6)}
    grown = problem.with_({"tools.die.offset_field.values.2": 0.1})
    assert grown.contents.tools["die"].offset_field.values == (0.0, 0.0, 0.1, 0.0, 0.0, 0.0)
    assert Problem.read(grown.toml()).contents == grown.contents
    # the tool is turned over: its field grows it downwards, at x = 4
    low = [one.build().tools["die"].gap([(4.0, 0.0, 0.25)])[0][0] for one in (problem, grown)]
    assert low[0] - low[1] == pytest.approx(0.1 * 2 / 3, abs=1e-6)
    with pytest.raises(DeckError, match="slope of a field"):
        problem.with_({"tools.die.offset_field.values.2": 5.0})


def test_derivatives_by_coefficients_are_those_of_differences():
    base = Problem.read(DECK).with_({"tools.die.offset_field.values": [0.0, 0.02, 0.06, 0.08, 0.03, 0.0]})
    paths = [f"tools.die.offset_field.values.{k}" for k in (2, 4)]
    found = uf.derivatives(base, paths, ["stroke_force", "die_fx"])
    for path in paths:
        value = {one.path: one.value for one in base.paths()}[path]
        ends = [base.with_({path: value + change}).build().solve(progress=False) for change in (1e-4, -1e-4)]
        for name in ("stroke_force", "die_fx"):
            difference = (ends[0][name][-1] - ends[1][name][-1]) / 2e-4
            assert found[name, path].value == pytest.approx(difference, rel=5e-3, abs=0.02)
    assert found["stroke_force", paths[0]].value > 1.0
