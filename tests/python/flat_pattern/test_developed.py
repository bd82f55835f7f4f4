"""Flat length from outside dimensions: by hand with a K-factor, and by bending the part that was developed."""

import math
from dataclasses import replace

import pytest

from umform import sheet_metals
from umform.errors import InvalidValue
from umform.flat_pattern.allowance import KFactor
from umform.flat_pattern.developed import developed, developed_at_once, developed_of
from umform.flat_pattern.tooling import ComputedBends
from umform.io.store import Store
from umform.processes.air_bending import AirBending
from umform.processes.bend_sequence import bend_sequence
from umform.processes.bend_sequence.form import sequence_form
from umform.processes.bend_sequence.outside import OutsideBend, OutsidePart

COARSE = AirBending(thickness=1.0, opening=8.0, elements_per_thickness=1.0, layers=1, increment=0.0125)
U = OutsidePart((20.0, 30.0, 15.0), (OutsideBend(110.0, line=2), OutsideBend(130.0, direction="down", line=1)))


def test_the_developed_part_has_its_outside_dimensions_when_it_is_bent(tmp_path):
    """An independent run: the strip of this length, bent at these lines, is measured."""
    found = developed(U, COARSE, store=Store(tmp_path))
    part = bend_sequence(found.sequence(COARSE), progress=False)
    assert part.flanges == pytest.approx(U.flanges, abs=0.005)
    assert found.length < sum(U.flanges) - 1.0
    assert "V 8" in found.deductions[0].source and found.deductions[0].notes


def test_a_bend_has_tools_of_its_own(tmp_path):
    wide = OutsidePart((30.0, 30.0), (OutsideBend(130.0, tools={"opening": 16.0}),))
    (one,) = developed(wide, COARSE, allowance=KFactor(0.4)).deductions
    assert one.radius == pytest.approx(0.16 * 16.0)


def test_deductions_by_a_k_factor_are_those_of_the_hand():
    """t = 2, V = 16, so R = 2.56; bent by 120 degrees to 60."""
    allowance = math.radians(120.0) * (2.56 + 0.44 * 2.0)
    for acute, setback in (("apex", 4.56 * math.tan(math.radians(60.0))), ("tangent", 4.56)):
        part = OutsidePart((50.0, 40.0), (OutsideBend(60.0),), acute)
        found = developed(part, AirBending(), allowance=KFactor(0.44))
        assert found.length == pytest.approx(90.0 - 2.0 * setback + allowance)
        assert found.positions == pytest.approx([50.0 - setback + 0.5 * allowance])
    for angle in (90.0, 120.0):  # the tangent is meant below 90 degrees only
        apex, tangent = (
            developed(OutsidePart((50.0, 40.0), (OutsideBend(angle),), way), AirBending(), allowance=KFactor(0.44))
            for way in ("apex", "tangent")
        )
        assert apex.length == tangent.length


def test_the_form_of_a_file_is_developed_by_what_it_names(tmp_path):
    data = {"flanges": [50.0, 40.0], "bends": [{"angle": 90.0}]}
    by_factor = developed_of(sequence_form({**data, "k_factor": 0.44}), AirBending())
    assert by_factor == developed(
        OutsidePart((50.0, 40.0), (OutsideBend(90.0),)), AirBending(), allowance=KFactor(0.44)
    )
    head = "metal,thickness mm,opening mm,punch_radius mm,die_radius mm,angle degrees,bend_deduction mm\n"
    (tmp_path / "bends.csv").write_text(f"{head}DC04,2,16,1.5,2,90,3.8\nDC04,2,20,1.5,2,90,4.0\n")
    form = sequence_form({**data, "table": "bends.csv"})
    for opening, length in ((16.0, 86.2), (20.0, 86.0)):
        assert developed_of(form, AirBending(opening=opening), tmp_path).length == pytest.approx(length)
    with pytest.raises(InvalidValue, match="another metal or die"):
        developed_of(form, AirBending(opening=12.0), tmp_path)
    other = replace(AirBending(), material=sheet_metals.get("S355").law)
    with pytest.raises(InvalidValue, match="another metal or die"):
        developed_of(form, other, tmp_path)


def test_stored_bends_are_known_at_once_and_others_follow_the_factor(tmp_path):
    store = Store(tmp_path)
    part = OutsidePart((20.0, 20.0), (OutsideBend(150.0),))
    before = developed_at_once(part, COARSE, KFactor(0.44), store)
    computed = developed(part, COARSE, store=store)
    after = developed_at_once(part, COARSE, KFactor(0.44), store)
    assert before.deductions[0].source == "K-factor 0.44"
    assert after == computed and after.deductions[0].source.startswith("computed")


def test_a_bend_whose_angle_is_not_computed_is_named():
    with pytest.raises(InvalidValue, match="15 to 165 degrees") as refused:
        developed(OutsidePart((20.0, 20.0), (OutsideBend(170.0),)), COARSE)
    assert refused.value.where == "bend 1, angle" and "a K-factor" in refused.value.remedy
    with pytest.raises(InvalidValue) as refused:
        ComputedBends()(10.0, 2.0, 2.0)
    assert refused.value.where == "the bend by 10 degrees"


def test_the_computed_deduction_to_the_tangent_is_smaller_below_90_degrees(tmp_path):
    store = Store(tmp_path)
    acute = AirBending(
        thickness=1.0,
        opening=8.0,
        die_angle=60.0,
        punch_angle=60.0,
        die_radius=1.0,
        punch_radius=1.0,
        elements_per_thickness=1.0,
        layers=1,
        increment=0.0125,
    )
    apex, tangent = (
        developed(OutsidePart((20.0, 20.0), (OutsideBend(80.0),), way), acute, store=store)
        for way in ("apex", "tangent")
    )
    (one,) = apex.deductions
    setback = (one.radius + 1.0) * math.tan(math.radians(50.0))
    difference = one.value - tangent.deductions[0].value
    assert difference == pytest.approx(2.0 * (setback - one.radius - 1.0), abs=5e-4)  # the angle is met within 0.005
