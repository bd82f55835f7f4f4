"""What is measured of a section, on circular bends whose numbers are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from umform.errors import InvalidValue
from umform.processes.air_bending.measures import developed
from umform.processes.air_bending.section import Section

THICKNESS, HALF_LENGTH = 2.0, 20.0


def circular(radius: float, neutral: float, angle: float, order: int, lines: int = 401) -> Section:
    """A bend of inside radius and angle, whose fibre at the distance ``neutral`` (in thicknesses) keeps its length."""
    slope = math.radians(0.5 * (180.0 - angle))
    s = np.linspace(0.0, HALF_LENGTH, lines)
    arc = radius + neutral * THICKNESS
    turned = np.minimum(s / arc, slope)
    straight = np.maximum(s - slope * arc, 0.0)
    heights = np.array([0.0, 0.3, 1.0])
    out = radius + (1.0 - heights) * THICKNESS
    x = out * np.sin(turned)[:, None] + (straight * math.cos(slope))[:, None]
    z = -out * np.cos(turned)[:, None] + (straight * math.sin(slope))[:, None]
    flat = np.stack(np.broadcast_arrays(s[:, None], heights * THICKNESS), axis=-1)
    return Section(flat, np.stack([x, z], axis=-1), order)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize(("radius", "neutral", "angle"), [(2.5, 0.4, 90.0), (6.0, 0.45, 120.0), (1.5, 0.35, 75.0)])
def test_a_circular_bend_gives_its_own_numbers(radius, neutral, angle, order):
    section = circular(radius, neutral, angle, order)
    theta = math.radians(180.0 - angle)
    assert section.angle == pytest.approx(angle, abs=1e-9)
    assert section.radius == pytest.approx(radius, rel=1e-6)  # the spline goes on into the straight leg
    assert section.smallest_radius == pytest.approx(radius, rel=2e-3)
    assert 1.0 - section.neutral_height == pytest.approx(neutral, abs=1e-3)
    lengths = developed(section)
    allowance = theta * (radius + neutral * THICKNESS)
    setback = (radius + THICKNESS) * math.tan(0.5 * theta)
    assert lengths["bend_allowance"] == pytest.approx(allowance, rel=1e-6)
    assert lengths["bend_deduction"] == pytest.approx(2.0 * setback - allowance, rel=1e-9)
    assert lengths["setback"] == pytest.approx(setback, rel=1e-6)
    assert lengths["k_factor"] == pytest.approx(neutral, abs=1e-6)
    assert 2.0 * lengths["leg"] + allowance == pytest.approx(2.0 * HALF_LENGTH, rel=1e-6)
    assert lengths["length_balance"] == pytest.approx(0.0, abs=2e-3)
    np.testing.assert_allclose(section.thicknesses, 1.0, rtol=2e-4)


def curling(slope: float, lines: int = 401) -> Section:
    """A bend whose curvature falls along the sheet (a clothoid): the radius depends on where its fit ends."""
    s = np.linspace(0.0, HALF_LENGTH, lines)
    turned = np.minimum(0.4 * np.minimum(s, 6.0) * (1.0 - np.minimum(s, 6.0) / 12.0), slope)
    tangent = np.stack([np.cos(turned), np.sin(turned)], axis=-1)
    steps = 0.5 * (tangent[1:] + tangent[:-1]) * np.diff(s)[:, None]
    inner = np.concatenate([[[0.0, 0.0]], steps.cumsum(axis=0)])
    outer = inner + THICKNESS * np.stack([np.sin(turned), -np.cos(turned)], axis=-1)
    flat = np.stack(np.broadcast_arrays(s[:, None], np.array([0.0, THICKNESS])), axis=-1)
    return Section(flat, np.stack([outer, inner], axis=1), 1)


def test_the_radius_is_a_smooth_function_of_the_shape():
    """Over small changes, in which the end of the fit passes no point, it changes as over large ones."""

    def rate(at: float, change: float) -> float:
        return (curling(at + change).radius - curling(at - change).radius) / (2.0 * change)

    at = 0.25 * math.pi
    assert rate(at, 1e-6) == pytest.approx(rate(at, 1e-2), rel=1e-2)


@pytest.mark.parametrize("order", [1, 2])
def test_the_leg_of_a_thin_sheet_on_a_coarse_mesh_is_its_last_element(order):
    """With elements of 4 thicknesses only one line of nodes lies in the outermost two."""
    slope = math.radians(20.0)
    flat = np.stack(
        np.meshgrid(np.arange(0.0, HALF_LENGTH + 1.0, 8.0 / order), [0.0, THICKNESS], indexing="ij"), axis=-1
    )
    turn = np.array([[math.cos(slope), math.sin(slope)], [-math.sin(slope), math.cos(slope)]])
    assert Section(flat, flat @ turn, order).slope == pytest.approx(slope, abs=1e-12)


def test_fibres_are_as_long_as_their_arcs():
    section = circular(2.5, 0.4, 90.0, 2)
    for height in (0.0, 0.15, 0.3, 0.7, 1.0):
        grown = 0.25 * math.pi * THICKNESS * ((1.0 - height) - 0.4)
        assert section.element_lengths(height).sum() == pytest.approx(HALF_LENGTH + grown, abs=1e-4)


def test_quadratic_elements_measure_arcs_better_than_chords():
    exact = HALF_LENGTH + 0.25 * math.pi * THICKNESS * 0.6
    errors = [abs(circular(2.5, 0.4, 90.0, order, 41).element_lengths(0.0).sum() - exact) for order in (1, 2)]
    assert errors[1] < 0.3 * errors[0]


def test_a_flat_sheet_has_no_neutral_fibre():
    flat = circular(2.5, 0.4, 90.0, 1).reference
    assert not Section(flat, flat, 1).is_bent
    assert not Section(flat, flat + 1e-15 * np.sin(np.arange(len(flat)))[:, None, None], 1).is_bent
    assert circular(2.5, 0.4, 179.9, 1).is_bent
    with pytest.raises(InvalidValue, match="keeps its length"):
        _ = Section(flat, flat, 1).neutral_height
    assert Section(flat, flat, 1).smallest_radius == math.inf
