"""Tools that are written as drawings and as solids, and read again."""

import math

import numpy as np
import pytest

import umform as uf
from umform.errors import FileProblem, InvalidValue
from umform.surfaces import dxf

BOX = ((-14.0, -3.0, -14.0), (14.0, 3.0, 14.0))
#: (tool, side of the solid of its section)
DRAWN = {
    "die": (uf.VDie(16, 84, 2, origin=(1.0, 0.0, 0.5)), "below"),
    "punch": (uf.Punch(1.5, 84, width=9.0, origin=(0.0, 0.0, 2.0)), "above"),
    "other hand": (uf.VDie(10, 90, 1, bottom_radius=0.5, depth=3, x="-x"), "below"),
    "turned": (uf.Punch(1.5, 84).moved((0.0, 0.0, 1.0), (0.0, math.pi, 0.0)), "below"),
    "bar": (uf.Cylinder((1.0, 0.0, 2.0), "y", 4.0), "inside"),
    "bore": (uf.Cylinder((1.0, 0.0, 2.0), "y", 4.0, inside=True), "outside"),
    "block": (uf.Box((1.0, 0.0, 2.0), (9.0, 90.0, 7.0), 1.2), "inside"),
    "floor": (uf.Plane((0.0, 0.0, 1.0), "-z"), "above"),
}
MERIDIAN = uf.Profile.from_corners([(0, -10), (10, -10), (10, 0), (0, 0)], [0, 2, 2, 0])
RING = uf.Profile.from_corners([(30, 0), (8, 0), (8, -30)], [0, 3, 0], closed=False)
#: Solids of STEP, with the sections above.
SOLID = {name: tool for name, (tool, _) in DRAWN.items()} | {
    "ball": uf.Sphere((1.0, 0.0, 0.0), 5.0),
    "bowl": uf.Sphere((0.0, 0.0, 0.0), 9.0, inside=True),
    "disc": uf.Revolved(MERIDIAN, (0, 0, 3), "z"),
    "draw die": uf.Revolved(RING, (0, 0, 1), "z"),
    "ring": uf.Torus((0, 0, 0), "x", 8, 2),
    "mirrored": uf.VDie(16, 84, 2, depth=4).mirrored("x", (1.0, 0.0, 0.0)),
    "placed block": uf.Box((0, 0, 0), (9, 4, 7), 1.2).moved((1.0, 0.0, 0.0), (0.3, 0.2, 0.1)),
}


def places(count=400, spread=12.0):
    return np.random.default_rng(5).uniform(-spread, spread, (count, 3))


@pytest.mark.parametrize("name", DRAWN)
def test_a_drawing_is_read_with_the_same_contour(name, tmp_path):
    tool, solid = DRAWN[name]
    file = uf.write_tool(tool, tmp_path / "tool.dxf")
    again = uf.Extruded(uf.Profile.from_dxf(file, solid=solid))
    x = places() * (1.0, 0.01, 1.0)
    np.testing.assert_allclose(again.gap(x)[0], tool.gap(x)[0], atol=1e-6)


def test_tools_of_one_drawing_have_their_layers_and_places(tmp_path):
    tools = {name: DRAWN[name][0] for name in ("punch", "die")}
    file = uf.write_tool(tools, tmp_path / "tools.dxf")
    assert dxf.layers_and_unit(file)[1] == "mm"
    for name, tool in tools.items():
        again = uf.Extruded(uf.Profile.from_dxf(file, name, solid=DRAWN[name][1]))
        np.testing.assert_allclose(again.gap(places())[0], tool.gap(places())[0], atol=1e-6)


@pytest.mark.parametrize(("unit", "factor"), [("m", 1e-3), ("in", 1 / 25.4), ("um", 1e3)])
def test_a_tool_of_a_model_in_another_unit_has_its_size(unit, factor, tmp_path):
    tool, small = uf.VDie(16, 84, 2), uf.VDie(16 * factor, 84, 2 * factor)
    drawing = uf.write_tool(small, tmp_path / "tool.dxf", unit=unit)
    assert dxf.layers_and_unit(drawing)[1] == unit
    again = uf.Extruded(uf.Profile.from_dxf(drawing))
    np.testing.assert_allclose(again.gap(places())[0], tool.gap(places())[0], atol=1e-9)
    pytest.importorskip("OCP")
    box = tuple(tuple(factor * x for x in corner) for corner in BOX)
    solid = uf.read_tool(uf.write_tool(small, tmp_path / "tool.step", box, unit=unit), scale=factor)
    x = np.array([(0.0, 0.0, 0.5), (9.0, 1.0, 0.3), (1.0, -2.0, -3.0)])
    np.testing.assert_allclose(solid.gap(factor * x)[0] / factor, tool.gap(x)[0], atol=1e-6)
    with pytest.raises(InvalidValue, match="a unit is one of"):
        uf.write_tool(small, tmp_path / "tool.dxf", unit="mile")


def test_a_meridian_is_drawn(tmp_path):
    file = uf.write_tool(uf.Revolved(MERIDIAN, (0, 0, 3), "-z"), tmp_path / "tool.dxf")
    again = uf.Revolved(uf.Profile.from_dxf(file))
    np.testing.assert_allclose(
        again.gap(places())[0], uf.Revolved(MERIDIAN, (0, 0, 3), "-z").gap(places())[0], atol=1e-6
    )


@pytest.mark.parametrize("name", SOLID)
def test_a_solid_is_read_with_the_same_surface(name, tmp_path):
    pytest.importorskip("OCP")
    tool = SOLID[name]
    again = uf.read_tool(uf.write_tool(tool, tmp_path / "tool.step", BOX), open=True)
    x = places()
    foot = x - tool.gap(x)[0][:, None] * tool.gap(x)[1]
    low, high = (np.array(corner) for corner in BOX)
    there = ((foot > low + 2.0) & (foot < high - 2.0)).all(axis=1) & (np.abs(tool.gap(foot)[0]) < 1e-9)
    near = foot[there] + 0.01 * tool.gap(foot[there])[1]
    assert len(near) > 20
    off = np.abs(again.gap(near)[0] - tool.gap(near)[0])
    assert off.max() < 1e-4  # beside the seam of two faces the reader may take the other one
    assert np.mean(off < 1e-6) > 0.9


def test_what_has_no_section_or_no_end_is_refused(tmp_path):
    tool = uf.VDie(16, 84, 2).offset(1.0)
    with pytest.raises(InvalidValue, match="no section"):
        uf.write_tool(tool, tmp_path / "tool.dxf")
    with pytest.raises(InvalidValue, match="no solid"):
        uf.write_tool(tool, tmp_path / "tool.step", BOX)
    with pytest.raises(InvalidValue, match="goes on for ever"):
        uf.write_tool(tool, tmp_path / "tool.stl")
    with pytest.raises(InvalidValue, match="extruded along one direction"):
        uf.write_tool({"a": uf.VDie(16, 84, 2), "b": uf.Cylinder((0, 0, 0), "x", 3)}, tmp_path / "tool.dxf")
    with pytest.raises(InvalidValue, match="nothing of the tool"):
        uf.write_tool(uf.Sphere((90, 0, 0), 5), tmp_path / "tool.step", BOX)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("module", "suffix", "text"), [("ezdxf", "dxf", "ezdxf"), ("OCP", "step", "OpenCASCADE")])
def test_a_missing_extra_is_named(module, suffix, text, tmp_path, monkeypatch):
    import importlib

    real = importlib.import_module

    def without(name, *more):
        if name.partition(".")[0] == module:
            raise ImportError(f"No module named {module!r}")
        return real(name, *more)

    monkeypatch.setattr(importlib, "import_module", without)
    with pytest.raises(FileProblem, match=f"writing .* needs {text}"):
        uf.write_tool(uf.VDie(16, 84, 2), tmp_path / f"tool.{suffix}", BOX)


def test_triangles_of_several_tools_are_one_file(tmp_path):
    file = uf.write_tool({"a": uf.Sphere((-4, 0, 0), 3), "b": uf.Sphere((4, 0, 0), 3)}, tmp_path / "two.stl", BOX)
    again = uf.read_tool(file)
    assert again.gap([[-4.0, 0.0, 4.0], [4.0, 0.0, 4.0]])[0] == pytest.approx([1.0, 1.0], abs=0.05)
