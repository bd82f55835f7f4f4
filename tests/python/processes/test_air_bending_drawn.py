"""Punch and die from drawings: measured, put in place, refused; the same bend as with tools given by numbers."""

import json
import math
from dataclasses import replace
from types import SimpleNamespace

import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.errors import InvalidValue, OpenSection, UmformError
from umform.problem import Problem
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.air_bending.drawn_tools import DrawnDie, DrawnPunch, read_die, read_punch
from umform.processes.air_bending.files import record
from umform.processes.air_bending.problem import problem_of
from umform.surfaces import Profile, Punch, VDie

COARSE = AirBending(stroke=3.0, elements_per_thickness=1.0, layers=1, increment=0.02)


def block(opening=16.0, angle=85.0, radius=2.0, at=(0.0, 0.0), bottom=0.0, height=40.0):
    """A die as it is drawn: a closed block with a V."""
    half, far = 0.5 * opening, opening
    deep = half / math.tan(math.radians(0.5 * angle))
    corners = [(-far, -height), (far, -height), (far, 0.0), (half, 0.0), (0.0, -deep), (-half, 0.0), (-far, 0.0)]
    radii = [0.0, 0.0, 0.0, radius, bottom, radius, 0.0]
    return Profile.from_corners([(x + at[0], z + at[1]) for x, z in corners], radii)


def blade(angle=85.0, radius=1.5, at=(0.0, 0.0), lean=0.0, left=9.0, height=60.0):
    """A punch as it is drawn: flanks up to a body with a flat back; its tip is at a place."""
    half = math.radians(0.5 * angle)
    low = radius - radius / math.sin(half)
    tan = math.tan(half)
    corners = [(-left, height), (-left, low + left / tan), (0.0, low), (9.0, low + 9.0 / (tan + lean)), (9.0, height)]
    return Profile.from_corners([(x + at[0], z + at[1]) for x, z in corners], [0.0, 0.0, radius, 0.0, 0.0])


def test_drawn_tools_are_measured_and_put_in_place():
    die, punch = DrawnDie.of(block(at=(100.0, -7.0))), DrawnPunch.of(blade(at=(-3.0, 250.0)))
    assert (die.opening, die.angle, die.radius) == pytest.approx((16.0, 85.0, 2.0))
    assert die.depth == pytest.approx(8.0 / math.tan(math.radians(42.5)))
    assert (punch.angle, punch.radius) == pytest.approx((85.0, 1.5))
    case = replace(COARSE, die_section=die, punch_section=punch)
    x = [(0.5, 0.0, -1.0), (9.0, 0.0, 1.0), (5.0, 0.0, -4.0)]
    assert case.die.gap(x)[0] == pytest.approx(VDie(16.0, 85.0, 2.0).gap(x)[0], abs=1e-9)
    above = Punch(1.5, 85.0, origin=(0.0, 0.0, case.thickness))
    assert case.punch.gap(x)[0] == pytest.approx(above.gap(x)[0], abs=1e-9)


def test_depth_of_a_rounded_bottom_is_the_largest_stroke_of_a_shallow_die():
    die = DrawnDie.of(block(angle=88.0, bottom=6.0))
    deep = 8.0 / math.tan(math.radians(44.0)) - (6.0 / math.sin(math.radians(44.0)) - 6.0)
    assert die.depth == pytest.approx(deep, abs=1e-5)
    case = replace(COARSE, die_section=die)
    assert case.largest_stroke == min(die.depth, case.rigid_stroke(case.steepest))


def test_bend_with_drawn_tools_is_that_of_their_numbers():
    numbers = air_bending(COARSE, progress=False).measures
    drawn = replace(COARSE, opening=99.0, die_section=DrawnDie.of(block()), punch_section=DrawnPunch.of(blade()))
    bend = air_bending(drawn, progress=False)
    assert bend.measures.angle == pytest.approx(numbers.angle, abs=1e-6)
    assert bend.measures.force == pytest.approx(numbers.force, rel=1e-6)
    written = json.loads(json.dumps(record(bend)))["parameters"]
    assert written["opening"] == pytest.approx(16.0) and "lines and arcs" in written["die_section"]
    again = Problem.read(problem_of(drawn).toml()).build().solve(progress=False)
    assert again["stroke_force"].tolist() == bend.result["stroke_force"].tolist()


@pytest.mark.parametrize(("right", "end"), [(-1e-14, 0.0), (-1e-4, 0.0), (1e-4, 0.0), (0.0, -1e-3)])
def test_sheet_lies_on_a_die_that_is_not_quite_level(right, end):
    """By round-off, at the right shoulder, or towards the right end of its top."""
    corners = [(-16, -40), (16, -40), (16, right + end), (8, right), (0, -8 / math.tan(math.radians(42.5))), (-8, 0)]
    askew = Profile.from_corners([*corners, (-16, 0)], [0, 0, 0, 2, 0, 2, 0])
    case = replace(COARSE, stroke=1.0, die_section=DrawnDie.of(askew), punch_section=DrawnPunch.of(blade()))
    level = replace(case, die_section=DrawnDie.of(block()))
    force, known = (air_bending(one, progress=False).result["stroke_force"].max() for one in (case, level))
    assert force == pytest.approx(known, rel=2e-3)


def test_seams_of_a_mirrored_half_are_no_corners():
    whole = blade().segments
    tip = next(one for one in whole if one.points(1.0)[0][1] < 1.0 and hasattr(one, "centre"))
    middle = (tip.centre[0], tip.centre[1] - tip.radius)
    halves = [type(tip)(tip.start, middle, tip.centre), type(tip)(middle, tip.end, tip.centre)]
    at = whole.index(tip)
    punch = DrawnPunch.of(Profile([*whole[:at], *halves, *whole[at + 1 :]]))
    assert (punch.angle, punch.radius) == pytest.approx((85.0, 1.5))


@pytest.mark.parametrize(
    ("make", "what"),
    [
        (lambda: DrawnPunch.of(block()), "no round tip"),
        (lambda: DrawnPunch.of(blade(radius=0.0)), "no round tip"),
        (lambda: DrawnPunch.of(blade(lean=0.05)), "flanks of the punch differ"),
        (lambda: DrawnDie.of(blade()), "not one V"),
        (lambda: DrawnDie.of(block(radius=0.0)), "not one V"),
        (lambda: DrawnDie.of(Profile.circle((0.0, 0.0), 5.0)), "not one V"),
    ],
)
def test_drawings_of_something_else_are_refused(make, what):
    with pytest.raises(OpenSection, match=what):
        make()


def test_punch_that_stands_out_on_the_left_is_refused_and_a_neck_is_not():
    points = [(-12.0, 60.0), (-12.0, 3.0), (-2.0, 3.0), (-1.0, 1.2)]
    low = 1.5 - 1.5 / math.sin(math.radians(42.5))
    tan = math.tan(math.radians(42.5))
    corners = [*points[:2], (-tan * (3.0 - low), 3.0), (0.0, low), (9.0, low + 9.0 / tan), (9.0, 60.0)]
    nose = DrawnPunch.of(Profile.from_corners(corners, [0.0, 0.0, 0.0, 1.5, 0.0, 0.0]))
    with pytest.raises(InvalidValue, match="left side"):
        replace(COARSE, punch_section=nose)
    neck = DrawnPunch.of(blade(left=4.0))  # a body that is narrower on the left
    assert replace(COARSE, punch_section=neck).punch_angle == pytest.approx(85.0)


def test_tool_that_is_no_drawn_tool_is_refused():
    with pytest.raises(InvalidValue, match="drawn tool"):
        replace(COARSE, die_section=block())


ezdxf = pytest.importorskip("ezdxf")


def drawn(path, profile, units=4, layer="TOOL"):
    document = ezdxf.new(units=units)
    for one in profile.segments:
        if hasattr(one, "centre"):
            ends = [one.end, one.start] if one.clockwise else [one.start, one.end]
            angles = [math.degrees(math.atan2(y - one.centre[1], x - one.centre[0])) for x, y in ends]
            document.modelspace().add_arc(one.centre, one.radius, *angles, dxfattribs={"layer": layer})
        else:
            document.modelspace().add_line(one.start, one.end, dxfattribs={"layer": layer})
    document.saveas(path)
    return path


def test_drawings_are_read_from_files_open_and_closed(tmp_path):
    assert read_die(drawn(tmp_path / "die.dxf", block(at=(5.0, 5.0))), "tool").opening == pytest.approx(16.0, abs=1e-6)
    half = Punch(1.5, 85.0).profile
    assert not half.closed
    assert read_punch(drawn(tmp_path / "punch.dxf", half)).radius == pytest.approx(1.5, abs=1e-6)
    inches = drawn(tmp_path / "inch.dxf", block(opening=0.63, radius=0.08, height=2.0), units=1)
    assert read_die(inches).opening == pytest.approx(16.002, abs=1e-4)


def test_files_that_are_no_tool_are_refused(tmp_path):
    path = drawn(tmp_path / "die.dxf", block())
    with pytest.raises(UmformError, match="layer"):
        read_die(path, "OTHER")
    parts = block().segments
    with pytest.raises(OpenSection, match="do not make one curve"):
        read_die(drawn(tmp_path / "gap.dxf", SimpleNamespace(segments=[*parts[:2], *parts[3:6]])))


def test_command_takes_drawings(tmp_path):
    die = drawn(tmp_path / "die.dxf", block(opening=20.0))
    done = CliRunner().invoke(app, ["bend", "--stroke", "2", "--die-dxf", str(die), "--layers", "1", "--print-deck"])
    assert done.exit_code == 0 and 'kind = "arc"' in done.stdout and "opening of 20 mm" in done.stdout
