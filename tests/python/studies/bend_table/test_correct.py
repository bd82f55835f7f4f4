"""One measured bend corrects a card: a hidden metal is met in other bends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.materials import Metal, Perfect, Swift, Table, Voce
from umform.problem.metal_file import metal_of, write_metal
from umform.processes.air_bending import AirBending, air_bending
from umform.studies.bend_table import correct
from umform.studies.bend_table.correct import _notes, _scaled, _shape

#: The measured bend, and others: angles and tools.
CARD = AirBending(stroke=6.1, elements_per_thickness=1, layers=1, thickness_points=5, increment=0.0125)
OTHERS = ({"stroke": 4.0}, {"punch_radius": 3.0}, {"opening": 24.0, "stroke": 8.0})


def _measures(case):
    return air_bending(case, frames=1, progress=False).measures


@pytest.fixture(scope="module")
def coil():
    """A metal whose yield stress is 12 % above the card, and whose exponent is 5 % below it."""
    curve = CARD.material.hardening
    hidden = replace(curve, strength=1.12 * curve.strength, exponent=0.95 * curve.exponent)
    return replace(CARD, material=replace(CARD.material, hardening=hidden))


@pytest.fixture(scope="module")
def bend(coil):
    return _measures(coil)


def _angles(case):
    return np.array([_measures(replace(case, **other)).angle for other in OTHERS])


def test_a_hidden_metal_is_met_at_other_angles_and_tools(coil, bend):
    truth = _angles(coil)
    assert np.abs(_angles(CARD) - truth).max() > 0.3
    found = correct(CARD, bend.angle + 0.05, force=1.005 * bend.force)  # half a standard deviation off, both
    assert np.abs(_angles(found.case) - truth).max() < 0.3
    assert found.found.values["flow_stress"] == pytest.approx(1.12, abs=0.03)
    assert found.found.values["exponent"] == pytest.approx(0.95, abs=0.03)
    text = " ".join(found.notes)
    for words in (
        "corrected by one measured bend",
        "force",
        "flow stress times",
        "exponent times",
        "assumed",
        "coarse",
    ):
        assert words in text


def test_the_angle_alone_gives_one_factor_and_says_so(coil, bend):
    found = correct(CARD, bend.angle)
    assert list(found.found.values) == ["flow_stress"]
    assert _measures(found.case).angle == pytest.approx(bend.angle, abs=0.01)
    assert np.abs(_angles(found.case) - _angles(coil)).max() < 0.3
    text = " ".join(found.notes)
    assert "the angle alone does not tell" in text and "and no friction" in text
    assert "a friction of 0.1" in " ".join(_notes(replace(CARD, friction=0.1), found.found, [], "the card"))


def test_a_bend_that_no_factor_explains_is_refused(bend):
    with pytest.raises(InvalidValue, match="no flow curve") as caught:
        correct(CARD, bend.angle - 15.0)
    assert caught.value.where == "flow stress" and caught.value.value.startswith("0.5 times")


def test_measurements_that_contradict_each_other_give_a_card_and_a_note(bend):
    found = correct(CARD, bend.angle, radius=1.5 * bend.radius)
    assert "standard deviations from the measurement" in found.notes[-1]


def test_a_card_of_a_file_is_the_law_to_the_last_bit(tmp_path):
    law = replace(CARD.material, hardening=Swift(520.0 / 3.0, 0.004, 0.22))
    write_metal(tmp_path / "metal.toml", law, ["what was corrected"])
    found = metal_of(str(tmp_path / "metal.toml"))
    assert found.law == law and found.name == "metal" and "what was corrected" in found.note
    anisotropic = Metal(70e3, 0.33, hardening=Voce(125.0, 290.0, 12.0), yield_function=uf.Hill48(0.5, 0.3, 0.6))
    write_metal(tmp_path / "hill.toml", anisotropic, [])
    assert metal_of(str(tmp_path / "hill.toml")).law == anisotropic
    assert metal_of("DC04").law == uf.sheet_metals.get("DC04").law


@pytest.mark.parametrize(
    ("curve", "shape"),
    [(Swift(520.0, 0.004, 0.2), "exponent"), (Voce(125.0, 290.0, 12.0), "rate"), (Perfect(200.0), "")],
)
def test_curves_have_a_shape_and_a_scale(curve, shape):
    assert _shape(curve) == shape
    strains = np.linspace(0.0, 0.3, 7)
    scaled = _scaled(curve, 1.2, {}).curve()
    assert [scaled(e)[0] for e in strains] == pytest.approx([1.2 * curve.curve()(e)[0] for e in strains])


def test_a_table_is_scaled_in_its_stresses_only():
    assert _scaled(Table((0.0, 0.1), (100.0, 200.0)), 1.5, {}) == Table((0.0, 0.1), (150.0, 300.0))


def test_a_law_without_a_curve_is_refused():
    with pytest.raises(InvalidValue, match="no flow curve that could be scaled"):
        correct(replace(CARD, material=uf.sheet_metals.get("SPCC").law), 90.0)


@pytest.mark.parametrize(
    "given",
    [{"force": -5.0}, {"force_deviation": 0.0}, {"angle_deviation": 0.0}, {"radius": 0.0}, {"radius_deviation": -1.0}],
)
def test_measurements_and_deviations_are_positive(given):
    with pytest.raises(InvalidValue) as refused:
        correct(CARD, 90.0, **given)
    assert refused.value.where == next(iter(given))


@pytest.mark.parametrize("measured", ["force", "radius"])
def test_a_deviation_without_its_measurement_is_refused(measured):
    with pytest.raises(InvalidValue, match="has no measurement") as refused:
        correct(CARD, 90.0, **{f"{measured}_deviation": 1.0})
    assert refused.value.where == f"{measured}_deviation"


@pytest.mark.parametrize(("angle", "case"), [(0.0, CARD), (200.0, CARD), (90.0, replace(CARD, stroke=None))])
def test_a_measurement_that_is_none_is_refused(angle, case):
    with pytest.raises(InvalidValue):
        correct(case, angle)
