"""Yield functions: states known to many digits, eigenvalues, convexity, special cases, values over the angle."""

from __future__ import annotations

import itertools

import cards
import numpy as np
import pytest

from umform import materials as mt


@pytest.mark.parametrize(
    ("stress", "equivalent"),
    [
        ([100, 0, 0, 0, 0, 0], 99.932153929799531134),
        ([0, 100, 0, 0, 0, 0], 110.32696825195229388),
        ([50, 50, 0, 50, 0, 0], 122.30436942533559492),
        ([120.5, -35.25, 60.75, 42.5, -28.0, 33.25], 187.28212180970985109),
    ],
)
def test_yld2004_at_states_known_to_20_digits(stress, equivalent):
    """M. Pacheco-Alarcon, tests of MUSCLE, in 90 digits; shears there and here 12, 23, 13."""
    assert cards.AA2090.function()(np.array(stress, dtype=float))[0] == pytest.approx(equivalent, rel=1e-14)


def test_gradient_of_yld2004():
    """The same source; shears there are of the tensor, half of those here."""
    stress = np.array([120.5, -35.25, 60.75, 42.5, -28.0, 33.25])
    known = [0.46131648419506466702, -0.81171119189451749695, 0.35039470769945102992]
    known += [2 * g for g in (0.31754139064342331668, -0.45754809859404116078, 0.43880414633419044754)]
    assert cards.AA2090.function()(stress)[1] == pytest.approx(known, rel=1e-12)


def by_eigenvalues(function, stress):
    """sum |S'_i - S''_j|^a = 4 phi^a from eigenvalues."""
    s = cards.tensor(stress) - np.trace(cards.tensor(stress)) / 3 * np.eye(3)
    roots = []
    for c in (function.first, function.second):
        normal = np.array([[0, c.c12, c.c13], [c.c21, 0, c.c23], [c.c31, c.c32, 0]])
        S = np.diag(-normal @ np.diag(s))
        for (i, j), factor in (((0, 1), c.shear12), ((1, 2), c.shear23), ((0, 2), c.shear13)):
            S[i, j] = S[j, i] = factor * s[i, j]
        roots.append(np.linalg.eigvalsh(S))
    differences = np.abs(np.subtract.outer(*roots))
    return (np.sum(differences**function.exponent) / 4) ** (1 / function.exponent)


@pytest.mark.parametrize("name", ["hosford", "hosford-20", "yld91", "aa2090", "aa6111", "aa5182", "hosford-3"])
def test_polynomial_is_the_sum_over_eigenvalues(name):
    function = cards.FUNCTIONS[name].function()
    for stress in np.random.default_rng(5).normal(size=(300, 6)):
        assert function(stress)[0] == pytest.approx(by_eigenvalues(cards.FUNCTIONS[name], stress), rel=2e-13)


@pytest.mark.parametrize("name", cards.FUNCTIONS)
def test_yield_functions_are_of_degree_one_and_convex(name):
    function = cards.FUNCTIONS[name].function()
    rng = np.random.default_rng(2)
    for a, b in rng.normal(size=(200, 2, 6)):
        (phi, gradient), (other, _) = function(a), function(b)
        assert function(7.0 * a)[0] == pytest.approx(7.0 * phi, rel=1e-13)
        assert gradient @ a == pytest.approx(phi, rel=1e-12)  # Euler
        assert gradient[:3].sum() == pytest.approx(0.0, abs=1e-12)
        assert function(0.5 * (a + b))[0] <= 0.5 * (phi + other) * (1 + 1e-13)
        assert gradient @ b <= other * (1 + 1e-12)  # the surface lies on one side of its tangent planes


def test_special_cases():
    rng = np.random.default_rng(8)
    mises, hosford = mt.Mises().function(), mt.Hosford(8).function()
    for stress in rng.normal(size=(50, 6)):
        roots = np.linalg.eigvalsh(cards.tensor(stress))
        eighth = sum(abs(a - b) ** 8 for a, b in itertools.combinations(roots, 2)) / 2
        assert hosford(stress)[0] == pytest.approx(eighth**0.125, rel=1e-13)
        assert mt.Hosford(2).function()(stress)[0] == pytest.approx(mises(stress)[0], rel=1e-14)
        assert mt.Hill48(1, 1, 1).function()(stress)[0] == pytest.approx(mises(stress)[0], rel=1e-14)
        assert mt.Yld91(1, 1, 1).function()(stress)[0] == pytest.approx(hosford(stress)[0], rel=1e-14)


@pytest.mark.parametrize(
    ("function", "values"),
    [
        (
            cards.AA2090,
            "0 1.00068 0.24506, 15 0.95405 0.27035, 30 0.90447 0.74288, 45 0.81763 1.54452, "
            "60 0.82011 1.06516, 75 0.89149 0.55735, 90 0.90640 0.68495",
        ),
        (
            cards.AA6111,
            "0 0.99021 0.89828, 15 0.98965 0.87599, 30 0.98037 0.74740, 45 0.96191 0.61565, "
            "60 0.94814 0.59574, 75 0.94460 0.63648, 90 0.94510 0.66041",
        ),
    ],
    ids=["AA2090-T3", "AA6111-T4"],
)
def test_yield_stress_and_r_over_the_angle(function, values):
    """Computed from the coefficients of Barlat et al. (2005) by an independent program, five digits."""
    for row in values.split(", "):
        angle, stress, r = map(float, row.split())
        assert cards.bar(function, angle) == pytest.approx((stress, r), abs=1.2e-5)


def test_hill48_returns_what_it_was_made_from():
    function = mt.Hill48(r0=1.79, r45=1.51, r90=2.27)
    assert [cards.bar(function, angle)[1] for angle in (0, 45, 90)] == pytest.approx([1.79, 1.51, 2.27], rel=1e-8)
    assert cards.bar(function, 0)[0] == pytest.approx(1.0, rel=1e-10)
    function = mt.Hill48.from_stresses(1.0, 1.04, 0.97, 1.05)
    assert [cards.bar(function, angle)[0] for angle in (0, 45, 90)] == pytest.approx([1.0, 1.04, 0.97], rel=1e-8)
    assert function.function()(np.array([1.05, 1.05, 0, 0, 0, 0]))[0] == pytest.approx(1.0, rel=1e-13)
