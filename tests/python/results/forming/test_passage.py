"""Largest force over passages of an element, and its ripple."""

import numpy as np
import pytest
from scipy.signal import savgol_filter, sawtooth

import umform as uf
from umform.errors import InvalidValue
from umform.results.forming import largest_force, longest_element, section

STROKE = np.linspace(0.0, 40.0, 401)
#: Rises to 100 at 20 and falls again.
SMOOTH = 100.0 - (STROKE - 20.0) ** 2 / 4.0


@pytest.mark.parametrize("way", [2.0, 4.0, 6.0])
@pytest.mark.parametrize("phase", [0.0, 1.0, 2.0, 4.0])
def test_a_ripple_of_elements_is_taken_out_and_told(way, phase):
    tooth = 12.0 * sawtooth(2.0 * np.pi * STROKE / way + phase, 0.5)
    found = largest_force(STROKE, SMOOTH + tooth, way)
    lost = way**2 / 48.0  # of a parabola in its mean
    assert found.value == pytest.approx(100.0 - lost, abs=0.7)
    assert found.stroke == pytest.approx(20.0, abs=0.5 * way)
    assert found.ripple == pytest.approx(12.0, abs=2.0) and found.is_rough
    assert abs(found.value - 100.0) < found.ripple


def test_a_smooth_force_keeps_its_value():
    found = largest_force(STROKE, SMOOTH, 2.0)
    assert found.value == pytest.approx(100.0, abs=0.1) and found.ripple < 1.5 and not found.is_rough


def test_the_largest_force_of_a_rising_one_is_that_at_the_end():
    found = largest_force(STROKE, 3.0 * STROKE + 2.0 * sawtooth(np.pi * STROKE, 0.5), 2.0)
    assert found.value == pytest.approx(120.0, abs=1.5) and found.stroke == pytest.approx(40.0, abs=0.2)
    assert found.ripple == pytest.approx(2.0, rel=0.1)


def test_the_band_reaches_a_peak_far_from_the_largest_mean():
    peak = SMOOTH + 60.0 * np.exp(-(((STROKE - 33.0) / 0.3) ** 2))
    found = largest_force(STROKE, peak, 4.0)
    assert found.stroke == pytest.approx(20.0, abs=0.5)
    assert found.value + found.ripple == pytest.approx(peak.max())


def test_a_part_of_the_stroke():
    peak = SMOOTH + 60.0 * np.exp(-(((STROKE - 33.0) / 0.3) ** 2))
    first = largest_force(STROKE, peak, 4.0, between=(0.0, 30.0))
    assert first.value == pytest.approx(100.0, abs=0.5) and first.ripple < 0.1 * first.value
    later = largest_force(STROKE, peak, 4.0, between=(30.0, 40.0))
    assert later.stroke > 30.0 - 0.2 and later.value + later.ripple >= peak[STROKE > 30.0].max() - 1e-9
    edge = largest_force(STROKE, SMOOTH, 4.0, between=(24.0, 40.0))
    assert edge.value == pytest.approx(96.0, abs=1.0) and edge.stroke == pytest.approx(24.0, abs=0.2)


def test_a_travel_that_stands_still_or_is_shorter_than_a_passage():
    stroke = np.concatenate([[0.0, 0.0], STROKE])
    found = largest_force(stroke, np.concatenate([[-50.0, 700.0], SMOOTH]), 4.0)
    assert found == largest_force(STROKE, SMOOTH, 4.0)
    short = STROKE[:11]
    assert largest_force(short, 3.0 * short, 4.0).value == pytest.approx(3.0)
    still = largest_force(np.zeros(5), np.arange(5.0), 4.0)
    assert (still.value, still.ripple, still.stroke) == (4.0, 0.0, 0.0)
    with pytest.raises(InvalidValue, match="has a length"):
        largest_force(STROKE, SMOOTH, 0.0)


def test_means_at_the_ends_are_those_of_the_line_through_a_whole_passage():
    force = np.random.default_rng(3).normal(size=STROKE.size)
    mean = savgol_filter(force, 21, 1, mode="interp")
    for place in (0, 4, 9, 10, 11, 200, 389, 390, 391, 395, 400):
        at = (STROKE[place] - 1e-9, STROKE[place] + 1e-9)
        assert largest_force(STROKE, force, 2.1, between=at).value == pytest.approx(mean[place])


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
def test_the_longest_element_of_a_stretched_strip(cell):
    strip = uf.mesh.strip(10.0, 1.0, 0.5, (5, 1), cell=cell)
    u = np.zeros_like(strip.points)
    u[:, 0] = 0.1 * np.maximum(strip.points[:, 0] - 4.0, 0.0)
    cut, ends = section(strip, u), np.linspace(0.0, 10.0, 6)
    assert longest_element(cut, ends, 4.0) == pytest.approx(2.2)
    assert longest_element(cut, ends[:3], 0.0) == pytest.approx(2.0)
