"""Sizes of elements over the curvature of tools of any shape."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.processes.sizes_picture import draw_sizes
from umform.surfaces import tool_sizes

BOX = ((-40.0, 0.0), (40.0, 10.0))
DIE = uf.UDie(opening=40.0, depth=20.0, shoulder_radius=5.0, bottom_radius=3.0)
GIVEN = {"thickness": 1.0, "turn": 10.0, "largest": 4.0}


def test_the_radius_of_a_profile():
    sizes = tool_sizes([DIE], [], BOX, **GIVEN)
    assert sizes(22.5, 5.0) == pytest.approx(np.radians(10.0) * 5.5, rel=0.01)
    assert sizes(0.0, 5.0) == 4.0  # the flat bottom
    assert sizes.radius.min() == pytest.approx(5.5, rel=0.01)  # not the concave radius of 3
    grows = sizes(30.0, 5.0) - sizes(29.0, 5.0)
    assert grows == pytest.approx(np.log(1.5), rel=0.02)


@pytest.mark.parametrize("height", [-500.0, -90.0, 90.0, 1e4])
def test_the_height_of_a_tool_does_not_matter(height):
    there, here = (tool_sizes([DIE.moved((0.0, 0.0, z))], [], BOX, **GIVEN) for z in (height, 0.0))
    np.testing.assert_allclose(there.size, here.size, rtol=1e-5)
    ball = uf.Sphere((0.0, 5.0, height), 20.0)
    for tools in (([ball], []), ([], [ball])):
        assert tool_sizes(*tools, BOX, **GIVEN)(0.0, 5.0) == pytest.approx(np.radians(10.0) * 20.5, rel=0.01)


@pytest.mark.parametrize("ends", [[(20.0, 300.0), (90.0, 300.0)], [(20.0, 900.0)]], ids=["walls", "endless wall"])
def test_a_die_is_found_between_high_walls(ends):
    corners = [(-90.0, 300.0), (-60.0, 300.0), (-60.0, 0.0), (-20.0, 0.0), (-20.0, -50.0), (20.0, -50.0), *ends]
    radii = [0.0, 0.0, 0.0, 5.0, *[0.0] * (2 + len(ends))]
    die = uf.Extruded(uf.Profile.from_corners(corners[::-1], radii[::-1], closed=False), x="x", y="z")
    assert die.gap([(0.0, 0.0, 0.0)])[0][0] > 0.0
    assert tool_sizes([die], [], BOX, **GIVEN)(-22.5, 5.0) == pytest.approx(np.radians(10.0) * 5.5, rel=0.01)


def test_a_tool_on_the_wrong_side_is_refused():
    with pytest.raises(InvalidValue, match=r"(?s)fills the space.*above\[0\]"):
        tool_sizes([], [DIE], BOX, **GIVEN)


def test_metal_that_flows_over_a_radius_has_its_size():
    sizes = tool_sizes([DIE], [], BOX, **GIVEN, flow=10.0)
    assert sizes(33.0, 5.0) == pytest.approx(np.radians(10.0) * 5.5, rel=0.01)
    assert sizes(39.0, 5.0) > 1.5


def test_both_curvatures_and_both_sides():
    ball = uf.Sphere((0.0, 0.0, 30.0), 20.0)
    punch = tool_sizes([], [ball], ((-10.0, -10.0), (10.0, 10.0)), **GIVEN)  # a sphere
    assert punch(0.0, 0.0) == pytest.approx(np.radians(10.0) * 20.5, rel=0.01)
    ring = uf.Revolved(
        uf.Profile.from_corners([(60.0, 0.0), (25.0, 0.0), (25.0, -30.0)], [0.0, 6.0, 0.0], closed=False)
    )
    if ring.gap([(40.0, 0.0, 5.0)])[0][0] < 0.0:
        ring = uf.Revolved(ring.profile.reversed())
    cup = tool_sizes([ring], [ball], ((0.0, 0.0), (60.0, 60.0)), thickness=1.0, turn=15.0, largest=10.0)
    assert cup(27.0, 0.0) == pytest.approx(np.radians(15.0) * 6.5, rel=0.01)
    assert cup(0.0, 0.0) == pytest.approx(np.radians(15.0) * 20.5, rel=0.01)


def test_triangles_give_what_the_profile_gives():
    tool = uf.Triangulated(DIE.triangles(((-45.0, -5.0, -25.0), (45.0, 15.0, 1.0)), 0.002), open=True)
    exact, sampled = (tool_sizes([one], [], BOX, **GIVEN) for one in (DIE, tool))
    on = np.linspace(21.0, 24.5, 8)
    np.testing.assert_allclose([sampled(x, 5.0) for x in on], [exact(x, 5.0) for x in on], rtol=0.2)


def test_a_mesh_of_these_sizes_turns_as_asked():
    pytest.importorskip("gmsh")
    sizes = tool_sizes([DIE], [], BOX, thickness=1.0, turn=20.0, largest=6.0, flow=4.0)
    outline = uf.Profile.from_corners([(-40.0, 0.0), (40.0, 0.0), (40.0, 10.0), (-40.0, 10.0)])
    fine, coarse = uf.mesh.blank(outline, 1.0, sizes), uf.mesh.blank(outline, 1.0, 6.0)
    asked = uf.mesh.blank(outline, 1.0, lambda x, y: sizes(x, y))  # not refined: gmsh misses the sizes
    assert 10.0 < sizes.turns(fine).max() <= 20.0 < sizes.turns(asked).max()
    assert sizes.turns(coarse).max() > 45.0
    assert "may turn by 20 degrees over radii from 5.5" in str(sizes)
    assert f"turn by up to {sizes.turns(fine).max():.3g} degrees over radii from 5.5" in sizes.on(fine)


def test_the_angle_of_an_element_is_the_integral_of_the_curvature():
    sizes = tool_sizes([DIE], [], BOX, thickness=1.0, turn=20.0, largest=6.0)
    turns = [
        float(sizes.turns(uf.mesh.grid(x, [4.0, 5.0], [-0.5, 0.5]))[0])
        for x in ([0.0, 18.0], [21.0, 24.0], [24.0, 36.0])  # beside, on, and at the end of the edge of the die
    ]
    radius = sizes.radius[np.argmin(np.abs(sizes.x - 22.0)), 0]
    assert turns[0] == 0.0 and turns[1] == pytest.approx(np.degrees(3.0 / radius), rel=1e-9)
    assert 0.0 < turns[2] < turns[1]


def test_a_picture_and_a_blank_that_nothing_bends(tmp_path):
    flat = tool_sizes([uf.Plane((0.0, 0.0, 0.0))], [], BOX, **GIVEN)
    assert "no tool bends the sheet" in str(flat) and flat(1.0, 2.0) == 4.0
    sizes = tool_sizes([DIE], [], BOX, **GIVEN)
    draw_sizes(sizes, tmp_path / "sizes.png", uf.mesh.strip(40.0, 10.0, 1.0, (10, 2)))
    assert (tmp_path / "sizes.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    "wrong", [{"turn": 0.0}, {"largest": -1.0}, {"growth": 1.0}, {"flow": -1.0}, {"smallest": 9.0}, {"thickness": 0.0}]
)
def test_numbers_out_of_range_are_refused(wrong):
    place = "sizes need" if wrong.keys() & {"growth", "smallest"} else f"tool_sizes, {next(iter(wrong))}"
    with pytest.raises(InvalidValue, match=place):
        tool_sizes([DIE], [], BOX, **{**GIVEN, **wrong})


def test_a_box_has_two_corners():
    with pytest.raises(InvalidValue, match="lowest and a highest corner"):
        tool_sizes([DIE], [], ((0.0, 0.0), (-1.0, 1.0)), **GIVEN)
