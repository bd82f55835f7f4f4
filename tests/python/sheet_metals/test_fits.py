"""Constants from measurements: yield functions over the angle, hardening curves, cycles."""

from __future__ import annotations

import math

import numpy as np
import pytest

from umform import materials as mt
from umform.errors import InvalidValue
from umform.sheet_metals import (
    Directions,
    balanced,
    fit_chaboche,
    fit_cycles,
    fit_hill48,
    fit_swift,
    fit_voce,
    fit_yld2004,
    uniaxial,
)

ANGLES = (0, 15, 30, 45, 60, 75, 90)
#: Measured; Barlat et al. (2005).
AA2090 = Directions(
    stress=dict(zip(ANGLES, (1.0, 0.9605, 0.9102, 0.8114, 0.8096, 0.8815, 0.9102), strict=True)),
    r=dict(zip(ANGLES, (0.2115, 0.3269, 0.6923, 1.5769, 1.0385, 0.5384, 0.6923), strict=True)),
    biaxial=1.035,
    r_biaxial=0.67,
)


def test_yld2004_meets_the_measurements_of_aa2090():
    found = fit_yld2004(AA2090)
    for angle in ANGLES:
        stress, r = uniaxial(found.law, angle)
        assert stress == pytest.approx(AA2090.stress[angle], rel=0.01)
        assert r == pytest.approx(AA2090.r[angle], rel=0.11)
    assert balanced(found.law) == pytest.approx((1.035, 0.67), rel=0.015)
    assert found.misfit < 1.0  # that of the published coefficients, by the same measure, is 1.38
    assert set(found.deviations) == set(found.constants)


def test_hill48_from_its_own_values():
    own = mt.Hill48(1.79, 1.51, 2.27)
    seen = Directions(*({a: uniaxial(own, a)[k] for a in ANGLES} for k in (0, 1)))
    found = fit_hill48(seen)
    assert found.constants == pytest.approx({"r0": 1.79, "r45": 1.51, "r90": 2.27}, rel=1e-6)


@pytest.mark.parametrize(
    ("fitted", "curve"), [(fit_swift, mt.Swift(520.0, 0.004, 0.22)), (fit_voce, mt.Voce(130.0, 300.0, 12.0))]
)
def test_curves_from_their_own_values(fitted, curve):
    eqps = np.linspace(0.0, 0.2, 30)
    found = fitted(eqps, [curve.curve()(e)[0] for e in eqps])
    assert vars(found.law) == pytest.approx(vars(curve), rel=1e-5)


def test_back_stresses_from_a_noisy_cycle():
    def build(c):
        return mt.Metal(
            206e3,
            0.3,
            hardening=mt.Voce(c["Y"], c["Y"] + c["Q"], c["d"]),
            back_stress=mt.Chaboche([(c["C"], c["gamma"])]),
        )

    own = {"Y": 180.0, "Q": 60.0, "d": 12.0, "C": 8000.0, "gamma": 80.0}
    strain = np.concatenate(
        [np.linspace(0.003, 0.05, 25), np.linspace(0.047, -0.05, 40), np.linspace(-0.047, 0.05, 40)]
    )
    _, stress, _ = mt.tension(build(own), strain)
    noisy = stress + np.random.default_rng(1).normal(size=len(stress))
    found = fit_cycles(strain, noisy, build, {"Y": 150.0, "Q": 40.0, "d": 20.0, "C": 5000.0, "gamma": 50.0}, 5e-3)
    for name, value in own.items():
        assert abs(found.constants[name] - value) < 4 * found.deviations[name] + 0.02 * value
    assert 0.0 < found.deviations["C"] < 0.1 * own["C"]


@pytest.mark.parametrize("parts", [3, 4])
def test_back_stresses_of_chaboche_from_their_own_cycles(parts):
    pairs = [(30000.0, 600.0), (5000.0, 80.0), (900.0, 12.0), (100.0, 1.0)][:parts]
    own = mt.Metal(206e3, 0.3, hardening=mt.Voce(120.0, 200.0, 8.0), back_stress=mt.Chaboche(pairs))
    strain = np.concatenate(
        [np.geomspace(0.001, 0.03, 15), np.linspace(0.028, -0.03, 30), np.linspace(-0.028, 0.06, 30)]
    )
    _, stress, _ = mt.tension(own, strain)
    found = fit_chaboche([(strain, stress)], parts, 206e3, 0.3, largest_step=1.0)
    assert found.misfit < 1e-3
    assert found.law.back_stress.parts == pytest.approx(np.array(pairs), rel=1e-2)


def test_what_nothing_determines():
    """A curve that is flat says nothing about how fast it saturates."""
    found = fit_voce([0.0, 0.1, 0.2, 0.3], [200.0, 200.0, 200.0, 200.0])
    assert found.constants["yield_stress"] == pytest.approx(200.0, rel=1e-3)
    assert math.isinf(found.deviations["rate"]) or found.deviations["rate"] > found.constants["rate"]


def test_bad_input():
    with pytest.raises(InvalidValue, match="r at 45 must be positive"):
        Directions(stress={}, r={45: -1.0})
    with pytest.raises(InvalidValue, match="three or more pairs"):
        fit_swift([0.0, 0.1], [1.0, 2.0])
