"""Paths of a point: laws of the Green-Lagrange strain along logarithmic strains, and stresses that vanish."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.materials import point_path, tension

CURVE = uf.Swift(strength=520.0, offset=0.004, exponent=0.2)
J2, METAL = uf.J2(E=210e3, nu=0.3, hardening=CURVE), uf.Metal(210e3, 0.3, hardening=CURVE)


def test_j2_in_tension_is_its_curve():
    """The Kirchhoff stress is y(p) at the logarithmic strain p + y / E; the volume changes elastically only."""
    p = np.array([0.01, 0.05, 0.2])
    y = 520.0 * (0.004 + p) ** 0.2
    strain, stress, plastic = tension(J2, p + y / 210e3)
    np.testing.assert_allclose(stress, y, rtol=1e-10)
    np.testing.assert_allclose(plastic[:, :3], np.outer(p, [1.0, -0.5, -0.5]), atol=1e-10)
    assert np.abs(plastic[:, 3:]).max() < 1e-12
    np.testing.assert_allclose(strain, p + y / 210e3, rtol=1e-15)


@pytest.mark.parametrize("component", [0, 1, 3])
@pytest.mark.parametrize("angle", [0.0, 30.0])
def test_j2_is_the_metal_along_fixed_axes(component, angle):
    """Both laws are one where the principal axes stay: tension, shear without other stresses, and back again."""
    strains = np.concatenate([np.linspace(0.002, 0.1, 12), np.linspace(0.09, -0.05, 12)])
    found, expected = (tension(law, strains, angle, component=component) for law in (J2, METAL))
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-7, atol=1e-7)


def test_an_elastic_law_by_hand():
    """St. Venant-Kirchhoff in tension: S = E (L^2 - 1) / 2 without lateral stress; T = S L^2 is conjugate to ln L."""
    h = np.array([-0.2, 0.01, 0.3])
    _, stress, plastic = tension(uf.SVK(E=1000.0, nu=0.3), h)
    L = np.exp(h)
    np.testing.assert_allclose(stress, 500.0 * (L**2 - 1.0) * L**2, rtol=1e-10)
    assert np.isnan(plastic).all()


def test_all_components_are_conjugate(rng):
    """The work of T along h is that of S along E, for strains of all components: the energy of a neo-Hookean law."""
    law = uf.NeoHooke(E=1000.0, nu=0.3)
    h, way = rng.normal(scale=0.2, size=6), rng.normal(size=6)

    def energy(at):
        half = at * np.where(np.arange(6) < 3, 1.0, 0.5)
        values, vectors = np.linalg.eigh(half[np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])])
        E = (vectors * (np.expm1(2.0 * values) / 2.0)) @ vectors.T
        row = np.array([[E[0, 0], E[1, 1], E[2, 2], 2 * E[0, 1], 2 * E[1, 2], 2 * E[0, 2]]])
        return law.law().energy(row, np.zeros((1, 0)))[0][0]

    slope = (energy(h + 1e-5 * way) - energy(h - 1e-5 * way)) / 2e-5
    found = point_path(law, h[None], np.full((1, 6), np.nan))
    assert found.stress[0] @ way == pytest.approx(slope, rel=1e-7)


@pytest.mark.parametrize("rate", [30.0, 100.0])
def test_stress_free_states_are_reached(rate):
    """Bisection for the strain without stress after stretching: each state of it is reached."""
    modulus = uf.FallingModulus(saturated=160e3, rate=rate)
    for law in (
        uf.Metal(206e3, 0.3, hardening=uf.Voce(180.0, 330.0, 14.0), modulus=modulus),
        uf.Metal(
            206e3,
            0.3,
            hardening=uf.Swift(520.0, 0.004, 0.2),
            yield_function=uf.Hill48(r0=1.8, r45=1.5, r90=2.2),
            modulus=modulus,
        ),
    ):
        up = np.linspace(0.001, 0.03, 20)
        low, high = 0.025, 0.03
        for _ in range(45):
            middle = 0.5 * (low + high)
            if tension(law, [*up, middle])[1][-1] > 0.0:
                high = middle
            else:
                low = middle
        assert abs(tension(law, [*up, high])[1][-1]) < 1e-8
        assert high < 0.03 - 200.0 / 206e3


def test_a_stress_that_is_prescribed_as_zero():
    """All stresses zero after stretching: the plastic strain is left."""
    stretched = np.full((2, 6), np.nan)
    stretched[0, 0] = 0.05
    found = point_path(J2, stretched, np.zeros((2, 6)))
    assert np.abs(found.stress[1]).max() < 1e-7
    assert found.strain[1, 0] == pytest.approx(0.05 - found.stress[0, 0] / 210e3, rel=1e-7)


def test_what_is_no_law_is_refused():
    for thing in (uf.J2, 3.0, uf.sheet_metals.get("DC04")):
        with pytest.raises(InvalidValue, match="a path needs a law"):
            tension(thing, [0.01])


def test_a_gap_in_the_strains_of_a_bar_is_refused():
    with pytest.raises(uf.errors.InvalidValue, match="finite strains"):
        tension(J2, [0.01, np.nan, 0.05])


def test_a_component_with_neither_strain_nor_stress_is_refused():
    strain, stress = np.full((2, 6), np.nan), np.zeros((2, 6))
    strain[:, 0] = 0.01
    stress[1, 2] = np.nan
    with pytest.raises(InvalidValue, match=r"(?s)a finite strain or a finite stress.*row 1"):
        point_path(METAL, strain, stress)


@pytest.mark.parametrize("component", [-1, 6])
def test_a_component_that_is_none_is_refused(component):
    with pytest.raises(InvalidValue, match="a component is a place"):
        tension(METAL, [0.01], component=component)
