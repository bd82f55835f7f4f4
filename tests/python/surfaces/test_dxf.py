"""Sections from DXF drawings: lines, arcs, bulges, units, layers, blocks, splines, and what is refused."""

from __future__ import annotations

import math
import time
from itertools import pairwise

import numpy as np
import pytest

from umform.errors import FileProblem, InvalidValue, OpenSection
from umform.surfaces import Arc, Extruded, Line, Profile, UDie

ezdxf = pytest.importorskip("ezdxf")

QUARTER = math.tan(math.pi / 8)  # bulge of an arc of 90 degrees


@pytest.fixture
def draw(tmp_path):
    """Writes a drawing and reads its section."""

    def drawn(add, units=4, **options):
        doc = ezdxf.new(units=units)
        add(doc.modelspace(), doc)
        doc.saveas(tmp_path / "section.dxf")
        return Profile.from_dxf(tmp_path / "section.dxf", **options)

    return drawn


def u_die(m, doc=None, miss=0.0):
    """UDie(20, 18, 2, 3) from a polyline, loose lines and arcs in any order and direction."""
    m.add_line((12, 0), (30, 0))
    m.add_lwpolyline(
        [(-30, 0, 0), (-12, 0, -QUARTER), (-10, -2, 0), (-10, -15, QUARTER), (-7, -18, 0), (0, -18, 0)], format="xyb"
    )
    m.add_line((7, -18), (miss, -18))
    m.add_arc((7, -15), 3, 270, 360)
    m.add_arc((12, -2), 2, 90, 180)
    m.add_line((10, -15), (10, -2))


@pytest.mark.parametrize("solid", [None, "below", "above"])
def test_an_open_section(draw, solid, rng):
    made = draw(u_die) if solid is None else draw(u_die, solid=solid)
    x = rng.uniform((-28, -3, -30), (28, 3, 10), (400, 3))
    g, n, H = Extruded(made).gap(x)
    for mine, exact in zip((g, n, H), UDie(20, 18, 2, 3).gap(x), strict=True):
        assert np.abs(mine - (-exact if solid == "above" else exact)).max() < 1e-10


def test_ends_meet_within_a_tolerance(draw):
    made = draw(lambda m, doc: u_die(m, miss=5e-4))
    assert len(made.segments) == 10
    with pytest.raises(
        OpenSection, match=r"2 free ends|4 free ends, the nearest pair 0.0005 apart: \((0|0.0005), -18\)"
    ):
        draw(lambda m, doc: u_die(m, miss=5e-4), tolerance=1e-4)


@pytest.mark.parametrize(
    ("units", "unit", "factor"), [(4, "mm", 1.0), (1, "mm", 25.4), (6, "mm", 1e3), (4, "m", 1e-3), (0, "mm", 1.0)]
)
def test_units(draw, units, unit, factor):
    made = draw(lambda m, doc: m.add_circle((2, 1), 3), units=units, unit=unit, tolerance=1e-3 * factor)
    assert made.area == pytest.approx(9 * math.pi * factor**2)
    assert made.segments[0].centre == pytest.approx((2 * factor, factor))


def test_the_tolerance_is_in_millimetres_where_none_is_given(draw):
    for unit, metres in (("mm", 1e-3), ("m", 1.0), ("in", 0.0254)):
        made = draw(u_die, unit=unit)
        assert [s.radius * metres for s in made.segments if isinstance(s, Arc)] == pytest.approx(
            [2e-3, 3e-3, 3e-3, 2e-3]
        )
        small = draw(lambda m, doc: m.add_lwpolyline([(0, 0, 1), (0.4, 0, 1)], "xyb", close=True), unit=unit)
        assert small.area * metres**2 == pytest.approx(0.04e-6 * math.pi)


def test_layers_blocks_and_the_origin(draw):
    def add(m, doc):
        block = doc.blocks.new("hole")
        block.add_circle((0, 0), 1.0, dxfattribs={"layer": "Section"})
        m.add_blockref("hole", (5, 7), dxfattribs={"xscale": 2, "yscale": 2})
        m.add_lwpolyline([(0, 0), (1, 0), (0, 1)], close=True, dxfattribs={"layer": "OTHER"})
        m.add_text("no section")

    made = draw(add, layer="SECTION", solid="outside", origin=(5, 6))
    assert made.area == pytest.approx(-4 * math.pi)
    assert made.segments[0].centre == pytest.approx((0.0, 1.0))
    with pytest.raises(
        OpenSection, match=r"2 closed curves.*\n.*\n.*a circle around \(5, 7\), radius 2; one from \(0, 0\) to \(1, 1\)"
    ) as both:
        draw(add)
    assert "layer of its own" in str(both.value)
    with pytest.raises(InvalidValue, match=r"nothing on this layer(.*\n)*.*OTHER"):
        draw(add, layer="DIE")


def test_the_layer_0_of_a_block_is_that_of_its_reference(draw):
    def add(m, doc):
        doc.blocks.new("bore").add_circle((0, 0), 1.0)
        doc.blocks.new("pair").add_blockref("bore", (1, 1))
        m.add_blockref("pair", (5, 7), dxfattribs={"layer": "DIE"})
        m.add_circle((0, 0), 3.0)

    assert draw(add, layer="DIE").segments[0].centre == (6.0, 8.0)
    assert draw(add, layer="0").segments[0].centre == (0.0, 0.0)


def test_all_references_of_a_pattern_are_read(draw):
    def add(m, doc):
        doc.blocks.new("side").add_line((0, 0), (1, 0))
        m.add_blockref("side", (0, 0), dxfattribs={"column_count": 3, "column_spacing": 1})
        m.add_lwpolyline([(3, 0), (3, 1), (0, 0)])

    assert draw(add).area == pytest.approx(1.5)


@pytest.mark.parametrize("ends", [(0, 360), (30, 390), (0, 359.999)])
def test_an_arc_may_be_a_circle(draw, ends):
    made = draw(lambda m, doc: m.add_arc((1, 2), 3, *ends))
    assert len(made.segments) == 1
    assert made.area == pytest.approx(9 * math.pi)


def test_polylines_in_space_and_with_a_frame(draw):
    assert draw(lambda m, doc: m.add_polyline3d([(0, 0, 2), (10, 0, 2), (10, 5, 2)], close=True)).area == 25.0

    def fitted(m, doc):
        made = m.add_polyline2d([(0, 0), (5, 9), (10, 0), (10, 5)], close=True)
        made.vertices[1].dxf.flags = made.vertices[1].SPLINE_FRAME_CONTROL_POINT

    assert draw(fitted).area == 25.0


def test_mirrored_arcs_turn_the_other_way(draw):
    def add(m, doc):
        m.add_arc((-3, 0), 2, 0, 180, dxfattribs={"extrusion": (0, 0, -1)})  # about (3, 0) in the drawing
        m.add_line((1, 0), (5, 0))

    assert draw(add).area == pytest.approx(2 * math.pi)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_ellipses_and_splines_become_arcs(draw, tolerance):
    ellipse = draw(lambda m, doc: m.add_ellipse((1, 2), (5, 0), 0.4), tolerance=tolerance)
    angle = np.linspace(0, 2 * math.pi, 500)
    x = np.c_[1 + 5 * np.cos(angle), np.zeros(500), 2 + 2 * np.sin(angle)]
    assert np.abs(Extruded(ellipse).gap(x)[0]).max() < 1.2 * tolerance
    assert not any(
        np.cross([*a.tangents()[1], 0], [*b.tangents()[0], 0])[2] > 1e-9
        for a, b in zip(ellipse.segments, ellipse.segments[1:], strict=False)
    )

    def add(m, doc):
        m.add_open_spline([(0, 0), (2, 4), (6, -3), (9, 1)], degree=3)
        m.add_line((0, 0), (9, 1))

    points = ezdxf.math.BSpline([(0, 0), (2, 4), (6, -3), (9, 1)]).approximate(300)
    x = np.array([(p.x, 0.0, p.y) for p in points])
    with pytest.raises(InvalidValue, match="must not meet itself"):
        draw(add, tolerance=tolerance)
    curve = draw(
        lambda m, doc: (
            m.add_open_spline([(0, 0), (2, 4), (6, -3), (9, 1)], degree=3),
            m.add_line((9, 1), (12, 1)),
            m.add_line((-3, -6), (0, 0)),
        ),
        tolerance=tolerance,
    )
    assert np.abs(Extruded(curve).gap(x)[0]).max() < 1.2 * tolerance


def bezier(m, doc=None):
    """A right triangle with the sides 10 and 5 as one spline with corners."""
    m.add_rational_spline(
        [(0, 0), (3, 0), (7, 0), (10, 0), (10, 2), (10, 4), (10, 5), (7, 3.5), (3, 1.5), (0, 0)],
        [1] * 10,
        knots=[0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3],
    )


@pytest.mark.parametrize(
    "add", [bezier, lambda m, doc: m.add_open_spline([(0, 0), (10, 0), (10, 5), (0, 0)], degree=1)]
)
def test_splines_may_have_corners(draw, add):
    made = draw(add)
    assert made.area == pytest.approx(25.0, rel=1e-9)
    assert len(made.segments) <= 20


def test_end_points_of_splines_may_coincide(draw):
    points = [(0, 0), (0, 0), (2, 4), (6, 3), (9, 1), (9, 1)]
    made = draw(lambda m, doc: (m.add_open_spline(points, degree=3), m.add_line((9, 1), (0, 0))))
    x = np.array([(p.x, 0.0, p.y) for p in ezdxf.math.BSpline(points).approximate(300)])
    assert np.abs(Extruded(made).gap(x)[0]).max() < 1.2e-3
    assert len(made.segments) < 40


@pytest.mark.parametrize("radius", [0.2, 2.0])
@pytest.mark.parametrize("lines", [None, 1, -1])
def test_segments_shorter_than_the_tolerance_do_not_open_a_curve(draw, radius, lines):
    """A fillet of pieces of 0.8 micrometres was left out, and the section open without a word."""
    angle = np.linspace(0.0, 0.5 * np.pi, round(0.5 * np.pi * radius / 0.8e-3))
    fillet = np.c_[10 - radius + radius * np.cos(angle), 5 - radius + radius * np.sin(angle)]
    corners = [(0, 0), (10, 0), *fillet.tolist(), (0, 5)]

    def add(m, doc):
        if lines is None:
            m.add_lwpolyline(corners, close=True)
        else:  # exploded, in the order of the walk or against it
            [m.add_line(*ends) for ends in list(pairwise([*corners, (0, 0)]))[::lines]]

    made = draw(add)
    assert made.closed
    assert made.area == pytest.approx(50 - (1 - np.pi / 4) * radius**2, abs=1e-3 * radius)
    on = np.array([(x, 0.0, y) for x, y in fillet])
    assert np.abs(Extruded(made).gap(on)[0]).max() < 1e-3


def test_a_polyline_of_thousands_of_points_is_read_at_once(draw):
    """All pairs of segments were tried: two minutes for 2000."""
    angle = np.linspace(0.0, 2 * np.pi, 3001)[:-1]
    begin = time.process_time()
    made = draw(lambda m, doc: m.add_lwpolyline(np.c_[30 * np.cos(angle), 30 * np.sin(angle)].tolist(), close=True))
    assert time.process_time() - begin < 30.0
    assert made.area == pytest.approx(900 * np.pi, rel=1e-5)


@pytest.mark.parametrize(
    ("add", "message"),
    [
        (lambda m, doc: m.add_text("nothing"), "no line and no arc"),
        (lambda m, doc: m.add_circle((0, 0), 1e-4), r"shorter than the tolerance(.*\n)*.*up to 0.000628"),
        (
            lambda m, doc: [m.add_line((0, 0), end) for end in ((1, 0), (0, 1), (-1, 0))],
            r"more than two ends.*\n.*\n.*\(0, 0\)",
        ),
        (lambda m, doc: m.add_3dface([(0, 0), (1, 0), (1, 1)]), "3DFACE on the layer 0"),
        (lambda m, doc: m.add_circle((0, 0), 1, dxfattribs={"extrusion": (1, 0, 0)}), "not lie in the plane"),
        (
            lambda m, doc: m.add_lwpolyline([(0, 0), (9, 0), (9, 5)], dxfattribs={"extrusion": (0, 0.6, 0.8)}),
            r"this line does not lie in the plane(.*\n)*.*from z = 0 to z = 3",
        ),
        (
            lambda m, doc: m.add_open_spline([(0, 0, 0), (2, 4, 0), (6, 3, 1), (9, 1, 0)]),
            r"this spline does not lie in the plane(.*\n)*.*from z = 0 to z = 1",
        ),
        (
            lambda m, doc: [m.add_line((0, 0), (1, 0)), m.add_line((1.1, 0), (2, 1))],
            r"4 free ends, the nearest pair 0.1 apart: \(1, 0\), \(1.1, 0\)",
        ),
    ],
)
def test_what_is_no_section(draw, add, message):
    with pytest.raises(OpenSection, match=message):
        draw(add)


def test_sides_that_do_not_fit(draw):
    with pytest.raises(InvalidValue, match="one of inside, outside"):
        draw(lambda m, doc: m.add_circle((0, 0), 1), solid="below")
    with pytest.raises(InvalidValue, match=r"no such side(.*\n)*.*below, above"):
        draw(u_die, solid="left")
    with pytest.raises(InvalidValue, match="a unit is one of"):
        draw(u_die, unit="parsec")


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(FileProblem, match="no such file"):
        Profile.from_dxf(tmp_path / "nothing.dxf")
    (tmp_path / "die.dxf").write_text("AC1032 no drawing")
    with pytest.raises(FileProblem, match="no DXF drawing"):
        Profile.from_dxf(tmp_path / "die.dxf")


def _few_knots(m, doc):
    spline = m.add_spline()
    spline.control_points, spline.knots = [(0, 0, 0), (1, 1, 0), (2, 0, 0), (3, 1, 0)], [0, 0, 0, 1, 1, 1]


@pytest.mark.parametrize(
    ("add", "message"),
    [(_few_knots, "this spline of the drawing is broken"), (lambda m, doc: m.add_blockref("GONE", (0, 0)), "GONE")],
)
def test_broken_drawings(draw, add, message):
    with pytest.raises(FileProblem, match=message):
        draw(add)


def test_segments_keep_their_kind(draw):
    kinds = [type(segment) for segment in draw(u_die).segments]
    assert kinds == [Line, Arc, Line, Arc, Line, Line, Arc, Line, Arc, Line]
