"""Forming limit curves and the margin up to them."""

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.results.forming import KeelerBrazier, LimitTable, limit_margin


def test_keeler_brazier():
    curve = KeelerBrazier(thickness=1.0, n=0.21)
    assert np.expm1(curve.plane_strain) == pytest.approx(0.3743)  # 23.3 + 14.13 per cent
    assert KeelerBrazier(1.0, 0.30).plane_strain == curve.plane_strain
    assert KeelerBrazier(5.0, 0.1).plane_strain == KeelerBrazier(3.1, 0.1).plane_strain
    minor = np.array([-0.2, 0.0, 0.1])
    left, middle, right = curve(minor)
    assert left == pytest.approx(middle + 0.2)  # a line of the same thickness
    e2 = 100 * np.expm1(0.1)
    assert 100 * np.expm1(right) == pytest.approx(37.43 + e2 * (0.784854 - 0.008565 * e2))


def test_margin():
    table = LimitTable(minor=[-0.2, 0.0, 0.2], major=[0.5, 0.3, 0.4])
    minor, major = np.array([-0.1, 0.0, 0.4]), np.array([0.3, 0.35, 0.1])
    np.testing.assert_allclose(limit_margin(table, major, minor), [0.1, -0.05, 0.3])
    np.testing.assert_allclose(limit_margin(lambda e: 0.3 + 0.5 * abs(e), major, minor), [0.05, -0.05, 0.4])


@pytest.mark.parametrize(
    "make",
    [
        lambda: KeelerBrazier(-1.0, 0.2),
        lambda: KeelerBrazier(1.0, 0.0),
        lambda: LimitTable([0.1, 0.0], [0.3, 0.3]),
        lambda: LimitTable([0.1], [0.3]),
        lambda: limit_margin(lambda minor: 0.3, np.zeros(2), np.zeros(2)),
    ],
)
def test_what_is_no_limit_is_refused(make):
    with pytest.raises(InvalidValue):
        make()


@pytest.mark.parametrize("name", ["SPFC", "TRIP1180"])
def test_the_hardening_exponent_of_a_metal_with_back_stress(name):
    """The yield surface has a constant size; the uniform elongation of tension gives n."""
    metal = uf.sheet_metals.get(name)
    found = KeelerBrazier.of(1.0, metal.law)
    assert found.n == pytest.approx(np.log1p(metal.uniform_elongation), abs=0.006) and found.n > 0.05
    constant = metal.law.hardening.curve()
    assert constant(0.0)[0] == pytest.approx(constant(0.3)[0])


def test_the_hardening_exponent_of_a_swift_curve():
    """Slope and stress of K (e0 + p)^n are equal at p = n - e0."""
    assert KeelerBrazier.of(1.0, uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(520.0, 0.01, 0.2))).n == pytest.approx(0.19)
