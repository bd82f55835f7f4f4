"""Metals along paths: tension and shear, cycles of Chaboche and of Yoshida and Uemori, a modulus that falls."""

from __future__ import annotations

import itertools
import math

import cards
import numpy as np
import pytest

from umform import materials as mt

#: Strain and stress where the reference has both; it turns at 5 % without a stress.
CYCLES = [
    (0.010123, 178.5434),
    (0.030156, 220.0028),
    (0.05, 250.9086),
    (0.045291, -171.6909),
    (0.03527, -244.1090),
    (0.015239, -252.7580),
    (-0.048878, -312.3143),
    (-0.05, math.nan),
    (-0.044786, 196.0257),
    (-0.034764, 298.6798),
    (-0.030756, 304.7781),
]


def tension_shear(metal, stresses, steps):
    """Strains 11 and 12 (of the tensor) and eqps behind each corner of a path in s11 and s12."""
    corners = np.array([[0.0, 0.0], *stresses])
    rows = np.concatenate([np.linspace(a, b, steps + 1)[1:] for a, b in itertools.pairwise(corners)])
    stress = np.zeros((len(rows), 6))
    stress[:, 0], stress[:, 3] = rows.T
    found = mt.point_path(metal, np.full_like(stress, np.nan), stress)
    ends = slice(steps - 1, None, steps)
    return np.stack([found.strain[ends, 0], 0.5 * found.strain[ends, 3], found.history["eqps"][ends, 0]], axis=1)


def test_tension_and_shear_with_isotropic_hardening():
    """Test SSNP15 of Code_Aster in closed form: the second part in the limit of small steps, by extrapolation."""
    metal = mt.Metal(E=195e3, nu=0.3, hardening=mt.Linear(181.0, 1930.0 * 195e3 / (195e3 - 1930.0)))
    first, second = tension_shear(metal, [(151.2, 93.1), (257.2, 33.1)], 200)
    assert first == pytest.approx([0.014829713606886, 0.013601401082429, 0.020547265463595], rel=1e-9)
    finer = tension_shear(metal, [(151.2, 93.1), (257.2, 33.1)], 400)[1]
    assert 2 * finer - second == pytest.approx([0.035265, 0.020471, 0.042329286420819], rel=2.5e-5)


def test_tension_and_shear_with_prager():
    """Test SSNP14 of Code_Aster: the second part is that of other programs, five digits, at their 30 steps."""
    metal = mt.Metal(
        E=195e3, nu=0.3, hardening=mt.Perfect(181.0), back_stress=mt.Chaboche([(1930.0 * 195e3 / (195e3 - 1930.0), 0)])
    )
    one, two, three = tension_shear(metal, [(151.2, 93.1), (257.2, 33.1), (259.3, 0.0)], 30)[:, :2]
    assert one == pytest.approx([0.014829713606886, 0.013601401082429], rel=1e-9)
    assert two == pytest.approx([0.0406612, 0.01978], rel=5e-5)
    assert three == pytest.approx([0.044151, 0.0190853], rel=1e-3)


def test_tension_and_shear_with_two_back_stresses():
    """Test SSNV101 of Code_Aster: moduli that grow with p; integrated along the proportional path p = 0.19198873."""
    metal = mt.Metal(
        E=145200.0,
        nu=0.3,
        hardening=mt.Voce(87.0, 151.0, 2.3),
        back_stress=mt.Chaboche([(187 * 341.0, 341.0), (29 * 17184.0, 17184.0)], first=0.43, rate=6.09),
    )
    known = np.array([0.09698266, 0.14527633, 0.19198873])
    coarse, fine = (tension_shear(metal, [(143.5, 143.5)], steps)[0] for steps in (1000, 2000))
    assert 2 * fine - coarse == pytest.approx(known, rel=1e-5)


def test_back_stress_saturates_in_a_cycle():
    """Tension, then compression: alpha goes from C/gamma (1 - exp(-gamma p)) to -C/gamma in closed form."""
    metal = mt.Metal(**cards.STEEL, hardening=mt.Perfect(200.0), back_stress=mt.Chaboche([(10000.0, 100.0)]))
    strain, stress, plastic = mt.tension(
        metal, np.concatenate([np.linspace(0, 0.1, 2001)[1:], np.linspace(0.1, 0.06, 2001)[1:]])
    )
    assert stress[1999] == pytest.approx(200.0 + 100.0 * (1 - math.exp(-100.0 * plastic[1999, 0])), rel=1e-5)
    back = plastic[1999, 0] - plastic[-1, 0]
    assert stress[-1] == pytest.approx(-200.0 - 100.0 * (1 - 2 * math.exp(-100.0 * back)), rel=2e-3)
    assert strain[-1] == pytest.approx(0.06)


def test_two_surfaces_in_cycles_of_spcc():
    """Yoshida and Uemori (2002), table 1: an explicit integration with steps of 2e-6 against the limit of ours.

    Its strains have six digits and overshoot where the cards.bar turns: 2e-6 times the slope. Stresses have four.
    """
    metal = mt.Metal(206e3, 0.3, hardening=mt.Perfect(124.0), back_stress=cards.SPCC)
    known = np.array(CYCLES)
    stresses = []
    for size in (1e-4, 5e-5):
        corners = np.concatenate([[0.0], known[:, 0]])
        path, ends = [], []
        for a, b in itertools.pairwise(corners):
            path += list(np.linspace(a, b, math.ceil(abs(b - a) / size) + 1)[1:])
            ends.append(len(path) - 1)
        strain, stress, _ = mt.tension(metal, path)
        stresses.append(stress)
    fine = stresses[1][ends]
    slope = np.gradient(stresses[1], strain)[ends]
    coarse_ends = np.cumsum([math.ceil(abs(b - a) / 1e-4) for a, b in itertools.pairwise(corners)]) - 1
    limit = 2 * fine - stresses[0][coarse_ends]
    wanted = ~np.isnan(known[:, 1])
    assert (np.abs(limit - known[:, 1]) <= 0.05 + 2e-6 * np.abs(slope))[wanted].all()


def test_modulus_falls():
    metal = mt.Metal(**cards.STEEL, hardening=mt.Linear(200.0, 1000.0), modulus=mt.FallingModulus(150e3, 30.0))
    strain, stress, plastic = mt.tension(metal, [0.01, 0.02, 0.0199])
    E = (stress[1] - stress[2]) / (strain[1] - strain[2])
    assert pytest.approx(150e3 + 60e3 * math.exp(-30.0 * plastic[1, 0]), rel=1e-9) == E
    assert stress[1] == pytest.approx(200.0 + 1000.0 * plastic[1, 0], rel=1e-10)
