"""The membrane that is the reference of stretching over a punch: flow, tangent, contact."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform_book.drawing.membrane import Membrane, Round, Sheet, stretch
from umform_book.drawing.plane_stress import State, flow

STEEL = mt.J2(206e3, 0.3, hardening=mt.Swift(565.32, 0.007117, 0.2589))


def test_flow_is_a_point_in_plane_stress():
    """Along a path that is not straight; the kernels keep the stress across the sheet at zero."""
    path = np.concatenate(
        [np.linspace(0, 1, 41)[1:, None] * [0.02, 0.01], [0.02, 0.01] + np.linspace(0, 1, 41)[1:, None] * [0.0, 0.02]]
    )
    state, stress = State(np.zeros((1, 2)), np.zeros(1)), []
    for strain in path:
        tau, _, state = flow(STEEL, strain[None], state)
        stress.append(tau[0])
    asked = np.full((len(path), 6), np.nan)
    asked[:, :2] = path
    metal = mt.Metal(206e3, 0.3, hardening=STEEL.hardening)
    found = mt.point_path(metal, asked, np.zeros_like(asked))
    assert np.abs(np.array(stress) - found.stress[:, :2]).max() < 0.02 * 400


def test_moduli_are_the_derivatives_of_the_stress():
    rng = np.random.default_rng(0)
    state = State(rng.normal(0, 1e-3, (5, 2)), np.abs(rng.normal(0, 1e-2, 5)))
    strain, h = rng.normal(0, 5e-3, (5, 2)), 1e-7
    moduli = flow(STEEL, strain, state)[1]
    for j in range(2):
        shift = h * np.eye(2)[j]
        change = (flow(STEEL, strain + shift, state)[0] - flow(STEEL, strain - shift, state)[0]) / (2 * h)
        assert np.abs(change - moduli[:, :, j]).max() < 1e-7 * np.abs(moduli).max()


def test_force_of_the_punch_is_that_of_the_rim():
    """What the punch and the die exert is carried at the clamped rim; without friction the pole is thinnest."""
    punch, die = Round((0.0, 51.2), 50.8, 0.0, True), Round((59.18, -6.75), 6.35, 0.0, False)
    sheet = Sheet(STEEL, 0.8, 59.18)
    found = stretch(sheet, (punch, die), np.array([4.0, 8.0]), elements=40, step=0.5)
    assert found.force[1] > 2.0 * found.force[0] > 0.0
    assert np.argmin(found.thickness[1]) == 0
    assert found.meridional[1, 0] == pytest.approx(found.hoop[1, 0], rel=0.01)
    sticky = stretch(sheet, (Round(punch.centre, 50.8, 0.3, True), die), np.array([8.0]), elements=40, step=0.5)
    assert sticky.thickness[0, 0] > found.thickness[1, 0] + 0.005


def test_a_membrane_knows_the_volume_of_its_sheet():
    membrane = Membrane(Sheet(STEEL, 0.8, 50.0), (), 20)
    assert membrane.volume.sum() == pytest.approx(np.pi * 50.0**2 * 0.8)
    assert membrane.area.sum() == pytest.approx(np.pi * 50.0**2)
