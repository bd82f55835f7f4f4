"""Air bending: balance, rules of the shop, elastic recovery, branches of unloading, search, refusals."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

from umform.analysis.run.open_run import OpenRun
from umform.errors import InvalidValue, NotFinite
from umform.problem import Problem
from umform.processes.air_bending import (
    AirBending,
    Measures,
    air_bending,
    bending_table,
    brake,
    find_stroke,
)
from umform.processes.air_bending.brake import Brake
from umform.processes.air_bending.files import record
from umform.processes.air_bending.formulas import shop_forces, tensile_strength
from umform.processes.air_bending.loading import INCREMENTS, OPTIONS, loading
from umform.processes.air_bending.problem import build, problem_of
from umform.processes.air_bending.sheet import lines_along
from umform.results.quantity import GIVEN, declared

COARSE = AirBending(stroke=3.0, elements_per_thickness=2.0, layers=1, increment=0.0125)


@pytest.fixture(scope="module")
def bend():
    return air_bending(replace(COARSE, stroke=6.0), progress=False)


@pytest.fixture(scope="module")
def table():
    return bending_table(COARSE, [6.0, 3.0, 4.5], progress=False)


def test_the_punch_pushes_as_hard_as_the_die(bend):
    assert bend.force_balance < 1e-9
    assert bend.result.balance().force_imbalance.max() < 1e-6


def test_tight_iterations_find_the_same_bend(bend, monkeypatch):
    monkeypatch.setattr(brake, "OPTIONS", replace(OPTIONS, residual=1e-9, increment=1e-6))
    tight = air_bending(replace(COARSE, stroke=6.0), progress=False)
    assert tight.iterations > bend.iterations
    assert bend.measures.angle == pytest.approx(tight.measures.angle, abs=2e-6)
    assert bend.measures.loaded_angle == pytest.approx(tight.measures.loaded_angle, abs=2e-6)
    assert bend.measures.force == pytest.approx(tight.measures.force, rel=2e-6)


def test_the_force_is_that_of_the_shop(bend):
    low, high = shop_forces(bend.case)
    assert 0.6 * low < bend.measures.largest_force < 1.6 * high


def test_flat_length_is_legs_and_allowance(bend):
    m, flat = bend.measures, 2.0 * bend.case.half_length
    assert 2.0 * m.leg + m.bend_allowance == pytest.approx(flat, rel=1e-12)
    assert 2.0 * (m.leg + m.setback) - m.bend_deduction == pytest.approx(flat, rel=1e-12)
    assert abs(m.length_balance) < 1e-3 * flat
    theta = math.radians(180.0 - m.angle)
    assert m.bend_allowance == pytest.approx(theta * (m.radius + m.k_factor * bend.case.thickness), rel=1e-12)


def test_the_depth_of_the_punch_counts_from_the_top_of_the_die(bend):
    case = bend.case
    tip = case.punch.profile.points(1e-4, 20.0)[:, 1].min() + case.punch.origin[2] - bend.measures.stroke
    top = case.die.profile.points(1e-4, 20.0)[:, 1].max()
    assert bend.measures.below_die == pytest.approx(top - tip, abs=1e-9)


def test_the_bend_is_plausible(bend):
    m = bend.measures
    assert 0.3 < m.k_factor < 0.5
    assert 0.3 < m.neutral_fibre < 0.5
    assert m.smallest_radius < m.radius
    assert 0.12 < m.radius / bend.case.opening < 0.2  # the shop reckons with 0.15 to 0.17 for mild steel
    assert 0.9 < m.thinning < 1.0
    outer = math.log((m.smallest_radius + 2.0) / (m.smallest_radius + m.neutral_fibre * 2.0))
    assert 0.5 * outer < m.outer_strain < 1.2 * outer
    assert m.springback == pytest.approx(m.angle - m.loaded_angle)
    assert m.springback_ratio == pytest.approx((180.0 - m.angle) / (180.0 - m.loaded_angle))


def test_the_curve_begins_and_ends_without_force(bend):
    assert bend.stroke[0] == 0.0
    assert abs(bend.force[-1]) <= 2e-3 * bend.measures.force
    assert bend.force.max() == bend.measures.largest_force
    assert bend.path[-1] == pytest.approx([6.0, bend.measures.loaded_angle])
    assert bend.against == ""
    assert bend.warnings == []


def test_the_angle_falls_with_the_stroke(table):
    assert [row.stroke for row in table] == [3.0, 4.5, 6.0]
    for name in ("loaded_angle", "angle"):
        assert (np.diff([getattr(row, name) for row in table]) < 0).all()
    assert all(row.springback > 0.5 for row in table)


def test_a_branch_of_unloading_leaves_no_trace(bend, table):
    """Loaded after two branches, the sheet is to the last bit as in a straight run."""
    assert table[-1] == bend.measures


def test_springback_is_elastic_unbending():
    """A thin wide sheet springs back by the integral of M / (E' I), E' = E / (1 - nu²), M from the force of the die."""
    case = replace(COARSE, thickness=1.0, opening=40.0, punch_radius=2.0, stroke=6.0, increment=0.00625)
    brake = Brake(case)
    state = brake.load(case.stroke)
    at = brake.model.contacts[0].at_points()
    share = at.pressure * at.area
    support = share @ at.x / share.sum()
    normal = share @ at.normal / share.sum()
    force = share.sum() / case.thickness  # for each mm of the bend
    across = np.array([normal[2], -normal[0]])
    mid = state.section.fibre(0.5)
    arm = np.maximum((support[[0, 2]] - 0.5 * (mid[1:] + mid[:-1])) @ across, 0.0)
    stiffness = case.material.E / (1.0 - case.material.nu**2) * case.thickness**3 / 12.0
    turned = (force * arm * np.linalg.norm(np.diff(mid, axis=0), axis=1)).sum() / stiffness
    springback = brake.unload().springback
    assert springback == pytest.approx(2.0 * math.degrees(turned), rel=0.02)
    # closed form: the moment grows linearly from the shoulder to the middle
    lever = (support[[0, 2]] - mid[0]) @ across
    assert springback == pytest.approx(math.degrees(force * lever**2 / stiffness), rel=0.02)


def test_a_finer_mesh_changes_little():
    case = AirBending(stroke=4.0, increment=0.0125)
    base, fine = (
        bending_table(replace(case, elements_per_thickness=n), [case.stroke], progress=False)[0] for n in (3.0, 6.0)
    )
    assert fine.loaded_angle == pytest.approx(base.loaded_angle, abs=0.3)
    assert fine.angle == pytest.approx(base.angle, abs=0.3)


def layered(bend):
    """The numbers of a bend on one layer as if they were of two, of which there are studies."""
    return replace(bend, case=replace(bend.case, layers=2))


def test_the_stroke_for_an_angle_is_found():
    found = find_stroke(COARSE, 135.0, tolerance=0.05, progress=False)
    assert layered(found.bend)["stroke"].band.error > 0.0
    assert len(found.trials) <= 3
    assert found.measures.angle == pytest.approx(135.0, abs=0.05)
    assert found.trials[-1] == (found.case.stroke, found.measures.angle)


def test_the_bend_that_is_found_is_that_of_its_stroke_and_of_its_deck():
    """To the last bit, with what the trials before it have left; no part of the loading is gone twice."""
    found = find_stroke(COARSE, 150.0, progress=False).bend
    straight = air_bending(found.case, progress=False)
    deck = Problem.read(problem_of(found.case).toml()).build().solve(progress=False)
    assert found.measures == straight.measures
    np.testing.assert_array_equal(found.path, straight.path)
    for name in deck.columns():
        np.testing.assert_array_equal(found.result[name], straight.result[name])
        np.testing.assert_array_equal(found.result[name], deck[name])


def test_a_search_repeats_the_last_part_of_the_loading_only(monkeypatch):
    """Increments: those of the bend, and for each trial that was left those of a part and of an unloading."""
    taken, take = [], OpenRun.take

    def counted(self, *steps, **options):
        before = len(self.result)
        take(self, *steps, **options)
        taken.append(len(self.result) - before)

    monkeypatch.setattr(OpenRun, "take", counted)
    found = find_stroke(COARSE, 150.0, progress=False)
    back = int((found.bend.step == 2).sum())
    left = len(found.trials) - 1
    assert left > 0
    assert sum(taken) - (len(found.bend.result) - 1) <= left * (INCREMENTS + 2 * back)


def test_a_table_and_a_search_share_their_loading():
    brake = Brake(COARSE)
    rows = bending_table(COARSE, [1.0, 2.5], brake=brake, progress=False)
    before = brake.run.iterations
    found = find_stroke(COARSE, 150.0, brake=brake, progress=False)
    alone = find_stroke(COARSE, 150.0, progress=False)
    assert rows == bending_table(COARSE, [1.0, 2.5], progress=False)
    assert found.measures == alone.measures
    assert brake.run.iterations - before < alone.iterations


def test_the_parts_of_a_loading_are_the_same_for_all_strokes():
    part = INCREMENTS * COARSE.way
    assert loading(COARSE, 2.5 * part) == [(part, INCREMENTS), (2.0 * part, INCREMENTS), (2.5 * part, 3)]
    assert loading(COARSE, 2.0 * part) == [(part, INCREMENTS), (2.0 * part, INCREMENTS)]
    assert loading(COARSE, 0.1 * part) == [(0.1 * part, 1)]


def test_the_pressing_of_bottoming_has_four_times_the_increments():
    """Most of the work is done there: one increment in the air has a hundredth of it."""
    case = replace(COARSE, die_angle=88.0, punch_angle=88.0, bottoming=True)
    part = INCREMENTS * case.way
    for end, count in loading(case, case.bottom_stroke + 0.1 * case.thickness)[:-1]:
        pressed = end > case.bottom_stroke - 0.5 * case.thickness
        assert count == (4 if pressed else 1) * INCREMENTS
    assert loading(case, case.bottom_stroke)[-1][1] > INCREMENTS
    assert loading(case, 2.0 * part) == loading(COARSE, 2.0 * part)


def test_an_angle_beyond_the_tools_is_refused():
    with pytest.raises(InvalidValue, match="against a flank"):
        find_stroke(COARSE, 84.0, progress=False)
    with pytest.raises(InvalidValue, match="180"):
        find_stroke(COARSE, 181.0, progress=False)
    with pytest.raises(InvalidValue, match="the tolerance of the angle"):
        find_stroke(COARSE, 135.0, tolerance=0.0, progress=False)
    blunt = replace(COARSE, die_angle=150.0, punch_angle=150.0, stroke=1.0)
    with pytest.raises(InvalidValue, match="against a flank") as refused:
        find_stroke(blunt, 150.2, progress=False)
    assert "lies against the" in refused.value.cause


def test_a_sheet_against_a_flank_is_told():
    blunt = replace(COARSE, die_angle=150.0, punch_angle=150.0, stroke=1.0)
    pressed = air_bending(replace(blunt, stroke=blunt.largest_stroke), progress=False, frames=1)
    assert pressed.against in ("die", "punch")
    assert "no air bending" in pressed.warnings[0]


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("thickness", -1.0, "more than 0 and at most 1000"),
        ("thickness", 1e300, "more than 0 and at most 1000"),
        ("opening", math.nan, "positive and finite"),
        ("die_angle", 190.0, "between 1 and 180"),
        ("punch_radius", 12.0, "wider than the opening"),
        ("die_radius", 40.0, "rounder than its flanks"),
        ("thickness", 10.0, "does not find room"),
        ("stroke", 7.5, "beyond air bending"),
        ("increment", 0.5, "of the opening"),
        ("increment", 1e-9, "of the opening"),
        ("elements_per_thickness", 1e9, "from 0.5 to 100"),
        ("elements_per_thickness", 0.2, "from 0.5 to 100"),
        ("layers", 0, "whole number"),
        ("contact_points", 2.5, "whole number"),
        ("contact_points", "some", "whole number"),
        ("penetration", -0.1, "positive"),
        ("penetration", 1.5, "half of the thickness"),
        ("punch_width", 2.0, "narrower than its round tip"),
        ("material", "DC04", "plastic material"),
        ("width", 0.0, "positive"),
    ],
)
def test_what_does_not_fit_is_refused(name, value, message):
    with pytest.raises(InvalidValue, match=message) as refused:
        replace(AirBending(stroke=6.0), **{name: value})
    assert refused.value.where in (name, "opening")
    assert isinstance(refused.value, NotFinite) == (value != value)


def test_penalty_and_penetration_exclude_each_other():
    with pytest.raises(InvalidValue, match="follows from the penetration"):
        AirBending(penalty=1e5, penetration=0.01)


def test_tools_penetrate_as_far_as_is_allowed(bend):
    """By default thickness / 200; each contact takes the points that it needs."""
    allowed = bend.case.thickness / 200.0
    for contact in bend.result.model.contacts:
        assert contact.allowed == pytest.approx(allowed)
        assert bend.result[f"{contact.name}_penetration"].max() < allowed
    by_depth = air_bending(replace(COARSE, stroke=6.0, penetration=0.002), progress=False, frames=1)
    assert by_depth.result["die_penetration"].max() < 0.005
    assert by_depth.measures.angle == pytest.approx(bend.measures.angle, abs=0.2)


def test_a_penetration_that_takes_much_of_the_stroke_is_told(bend):
    assert not any("penetrate" in warning for warning in bend.warnings)
    soft = AirBending(stroke=1.0, elements_per_thickness=1.0, layers=1, increment=0.025, penetration=0.2)
    deep = air_bending(soft, progress=False, frames=1)
    assert 0.04 < deep.penetration < 0.2
    assert any(f"penetrate by {deep.penetration:.3g}" in warning for warning in deep.warnings)


def test_penalty_and_points_may_be_given():
    case = replace(COARSE, penalty=1e5, contact_points=5)
    assert {(contact.penalty, contact.points) for contact in build(case)[0].contacts} == {(1e5, 5)}


def test_a_bend_needs_a_stroke():
    with pytest.raises(InvalidValue, match="way of the punch is missing"):
        air_bending(replace(COARSE, stroke=None), progress=False)


def test_a_wrapped_sheet_of_thin_lines_meets_the_tools():
    """The rigid stroke: shoulder and tip are at a distance of the radii and the thickness from one straight leg."""
    case = AirBending()
    for slope in (10.0, 30.0, 45.0):
        a = math.radians(slope)
        tip = np.array([0.0, case.thickness + case.punch_radius - case.rigid_stroke(slope)])
        shoulder = np.array([case.shoulder, -case.die_radius])
        normal = np.array([-math.sin(a), math.cos(a)])
        assert (tip - shoulder) @ normal == pytest.approx(case.punch_radius + case.thickness + case.die_radius)


def test_the_mesh_is_fine_where_it_must_be():
    case = AirBending(elements_per_thickness=4.0)
    lines = lines_along(case)
    size = np.diff(lines)
    assert lines[0] == 0.0
    assert lines[-1] == pytest.approx(case.half_length)
    assert size[lines[1:] < 4.0].max() <= 0.5 + 1e-12
    assert size[(lines[1:] > case.shoulder) & (lines[:-1] < case.reach)].max() <= 0.5 + 1e-12
    assert size.max() > 0.7


def test_tensile_strength_is_where_a_bar_necks():
    n, offset, strength = 0.22, 0.004, 520.0
    uniform = n - offset
    assert tensile_strength(AirBending().material) == pytest.approx(strength * n**n * math.exp(-uniform), rel=1e-6)


def test_all_measures_are_defined_in_the_docs():
    page = (Path(__file__).parents[3] / "docs" / "air-bending.md").read_text(encoding="utf-8")
    assert set(declared(Measures)) == {field.name for field in fields(Measures)}
    for name, quantity in declared(Measures).items():
        assert f"| {quantity.label} | `{name}` |" in page


def test_a_sheet_and_a_die_in_inches_get_their_sizes_in_mm():
    with pytest.raises(InvalidValue, match="wider than the opening") as caught:
        AirBending(thickness=0.08, opening=0.63, stroke=0.1)
    assert "thickness 2.032, opening 16.00" in caught.value.remedy
    with pytest.raises(InvalidValue, match="wider than the opening") as caught:
        AirBending(thickness=0.8, opening=1.63, stroke=0.1)
    assert "inches" not in caught.value.remedy


def test_title_record_and_notes_have_the_length_and_the_depth_of_the_machine(bend):
    long = replace(bend, bend_length=1000.0)
    assert ", 1000 mm long, " in long.title and " long" not in bend.title
    assert record(long)["bend_length"] == 1000.0 and record(bend)["bend_length"] is None
    depth = bend.measures.below_die
    side = "below" if depth >= 0.0 else "above"
    assert bend.notes[0] == f"for the machine: the tip of the punch {abs(depth):.3f} mm {side} the top of the die"


def test_the_numbers_of_a_bend_have_bands(bend):
    """A stroke found for an angle has the error of the angle over its change with the stroke; a given one has none."""
    assert {one.name for one in bend.quantities if one.band} == {"stroke", "below_die"}  # one layer: no studies
    bend = layered(bend)
    assert [one.name for one in bend.quantities if one.band is None] == ["length_balance"]
    assert {one.name for one in bend.quantities if one.band == GIVEN} == {"stroke", "below_die"}
    assert "error: given" not in bend.all_notes
    bend = replace(bend, searched="angle")
    found = {one.name: one for one in bend.quantities}
    assert [name for name, one in found.items() if one.band is None] == ["length_balance"]
    (way, turned), angle = np.diff(bend.path[-2:], axis=0)[0], found["angle"].band
    assert found["stroke"].band.error == pytest.approx(angle.error * way / -turned) and way > 0.0 > turned
    assert "not from this run" in angle.source and angle.sources["layers"] > 0.0
    table = replace(bend, bend_length=1000.0)["total_force"]
    assert table.band.error / table.value == pytest.approx(
        found["largest_force"].band.error / bend.measures.largest_force
    )
    assert replace(bend, path=bend.path[:1])["stroke"].band is None
