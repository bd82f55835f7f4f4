"""Twenty brackets: 18 unfold to their closed-form lengths and fold back to the part, 2 are refused by face."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np
import pytest
from brackets import BRACKETS, L, block, cut, drill, fused, placed, section, write

from umform.errors import DrawingError, InvalidValue
from umform.flat_pattern import Allowance, KFactor, flat
from umform.flat_pattern.folding import folded_points
from umform.flat_pattern.skin import skin_of
from umform.flat_pattern.unfold import unfold
from umform.surfaces.cad.read_solid import read_solid
from umform.surfaces.segments import Arc

K = 0.44
UNFOLDED = [name for name, bracket in BRACKETS.items() if not bracket.refused]
REFUSED = [name for name, bracket in BRACKETS.items() if bracket.refused]


def test_there_are_twenty():
    assert (len(UNFOLDED), len(REFUSED)) == (18, 2)


@pytest.mark.parametrize("name", UNFOLDED)
def test_unfolds(pattern, name):
    bracket, made = BRACKETS[name], pattern(name)
    assert made.thickness == pytest.approx(bracket.thickness, abs=1e-6)
    assert len(made.bends) == bracket.bends
    assert len(made.holes) == bracket.holes
    assert made.folded_back < 1e-6
    if bracket.legs:
        lengths = made.size
        assert np.abs(lengths - bracket.flat_length(K)).min() < 1e-6
        turns = sorted(abs(turn) for turn in bracket.turns)
        found = [bend.angle for bend in made.bends]
        assert sorted(found)[-len(turns) :] == pytest.approx(turns, abs=1e-5)
    assert all(bend.radius == pytest.approx(bracket.radius, abs=1e-6) for bend in made.bends)
    assert made.deviation <= 0.01
    words = " ".join(made.warnings)
    assert bracket.warned in words if bracket.warned else "hole" not in words


@pytest.mark.parametrize("name", REFUSED)
def test_is_refused_by_face(step, name):
    with pytest.raises(DrawingError, match=BRACKETS[name].refused) as info:
        flat(step(name), allowance=KFactor(K))
    assert "face" in str(info.value)


def test_directions_are_seen_from_the_unfolded_side(pattern):
    assert [bend.direction for bend in pattern("u").bends] == ["up", "up"]
    assert sorted(bend.direction for bend in pattern("z").bends) == ["down", "up"]
    places = {round(float(bend.lines[0][:, 0].mean()), 3): bend.direction for bend in pattern("tabs").bends}
    assert sorted(places.values()) == ["down", "up", "up"]


def test_the_area_is_that_of_the_flat_lengths(pattern):
    bracket, made = BRACKETS["holes"], pattern("holes")
    assert made.area == pytest.approx(50.0 * bracket.flat_length(K) - math.pi * (9.0 + 20.25), rel=1e-9)
    box = pattern("box")
    arc = 2.0 * (20 + 0.5 * math.pi * (2.0 + K * 2.0))
    sides = 2.0 * (30 + 0.5 * math.pi * (2.0 + K * 2.0))
    base = 60 * 36 + 56 * 40 - 56 * 36
    assert box.area == pytest.approx(base + 36 * sides + 56 * arc, rel=1e-9)


def test_circles_stay_circles_and_a_hole_across_a_bend_is_a_polyline_near_its_curve(pattern):
    radii = sorted(hole.circle.radius for hole in pattern("holes").holes)
    assert radii == pytest.approx([3.0, 4.5], abs=1e-9)
    across = pattern("hole across the bend")
    assert across.holes[0].circle is None and 0.0 < across.deviation <= 0.01
    arcs = [segment for segment in pattern("rounded corners").outer.segments if isinstance(segment, Arc)]
    assert [arc.radius for arc in arcs] == pytest.approx([12.0, 12.0], abs=1e-9)


def test_the_deviation_of_polylines_can_be_chosen(step, pattern):
    name = "hole across the bend"
    fine = flat(step(name), allowance=KFactor(K), deviation=1e-3)
    assert fine.deviation < 1e-3 < 2.0 * pattern(name).deviation
    assert fine.area == pytest.approx(pattern(name).area, abs=0.5 * pattern(name).deviation * 40.0)


def test_folding_uses_the_angles_of_the_bends(step):
    """A wrong angle is noticed: the folded pattern is no longer the part."""
    laid = unfold(skin_of(read_solid(step("u"))), KFactor(K))
    first = next(place for place, lay in laid.maps.items() if hasattr(lay, "allowance"))
    bent = replace(laid.maps[first], angle=laid.maps[first].angle - 0.01)
    folded, drawn = folded_points(replace(laid, maps={**laid.maps, first: bent}))
    assert _shape(folded) == pytest.approx(_shape(folded_points(laid)[0]), abs=2.0)
    assert abs(_shape(folded) - _shape(drawn)) > 0.05
    assert abs(_shape(folded_points(laid)[0]) - _shape(drawn)) < 1e-9


def _shape(x):
    """Largest distance of two points."""
    return float(np.linalg.norm(x[:, None] - x, axis=2).max())


def test_a_slot_leaves_one_bend_with_two_lines(pattern):
    (bend,) = pattern("window in the bend").bends
    assert [round(float(np.linalg.norm(b - a)), 6) for a, b in bend.lines] == [17.0, 17.0]


def test_inches_are_converted_and_named(pattern):
    made = pattern("inches")
    assert made.unit == "inch" and made.thickness == pytest.approx(3.175, abs=1e-6)


def test_two_seconds_a_part(step):
    for name in ("box", "five", "hole across the bend"):
        step(name)
        start = time.process_time()
        flat(step(name), allowance=KFactor(K))
        assert time.process_time() - start < 2.0


def test_flanges_that_need_the_same_metal_overlap(tmp_path):
    """The flanges of both inner edges of a base like an L unfold over each other."""
    base = cut(block((-60, -60, -1), (120, 120, 2)), block((0, 0, -5), (100, 100, 10)))
    right = placed(section([20, 30], [90], 40.0), (-10, 30, 0))
    up = placed(section([20, 30], [90], 40.0), (30, -10, 0), 90.0)
    with pytest.raises(DrawingError, match="overlaps itself"):
        flat(write(fused(base, right, up), tmp_path / "inward.step"), allowance=KFactor(K))


def test_a_bend_without_flat_length_is_refused_by_its_face(step):
    with pytest.raises(InvalidValue, match="must be positive") as info:
        flat(step("l"), allowance=lambda angle, radius, thickness: Allowance(-0.1, "mine", 3.0))
    assert "face 6, mine" in info.value.value


def test_an_allowance_is_needed(step):
    with pytest.raises(InvalidValue, match="KFactor"):
        flat(step("l"))


def test_a_hole_is_warned_of_by_its_distance(tmp_path):
    near = cut(L.shape(), drill((12.5, 0, 0), (0, 0, 1), 3.0))  # its edge 4.5 + 2.26 mm from the line
    assert not flat(write(near, tmp_path / "far.step"), allowance=KFactor(K)).warnings
