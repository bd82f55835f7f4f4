"""Forming limits of bent strain paths: effective strain over the direction of its rate."""

import numpy as np
import pytest

import umform as uf
from umform.results.forming import (
    EffectiveStrain,
    KeelerBrazier,
    LimitTable,
    PathFields,
    PathLimit,
    forming_fields,
    strain_paths,
)
from umform.results.forming.path_limits import BENDS, path_use, strain_on_ray, strain_use

CURVE = KeelerBrazier(thickness=1.0, n=0.2)
LAW = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(520.0, 0.004, 0.2))
SHEET = uf.mesh.strip(1.0, 1.0, 0.1, (1, 1))


def states(*strains, turn=0.0, parts=5):
    """Displacements of a sheet that is strained along x and y in turn, in parts, and rotated in its plane with it."""
    total, found = np.zeros(2), [np.zeros_like(SHEET.points)]
    for one in strains:
        for _ in range(parts):
            total = total + np.array(one) / parts
            F = np.diag([*np.exp(total), np.exp(-total.sum())])
            c, s = np.cos(turn * len(found)), np.sin(turn * len(found))
            found.append(SHEET.points @ (np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ F - np.eye(3)).T)
    return found


def fields_of(*strains, law=LAW, limit=CURVE, **how):
    return PathFields.of(SHEET, states(*strains, **how), limit, law)


@pytest.mark.parametrize("ratio", [-1.0, -0.5, 0.0, 0.3, 1.0])
def test_effective_strain_of_von_mises(ratio):
    """Closed form in plane stress."""
    exact = 2.0 / np.sqrt(3.0) * np.sqrt(1.0 + ratio + ratio**2)
    assert EffectiveStrain.of(LAW)(0.1, 0.1 * ratio) == pytest.approx(0.1 * exact, rel=2e-6)


@pytest.mark.parametrize("ratio", [-1.0, -0.5, 0.0, 0.3, 1.0])
def test_effective_strain_of_hill(ratio):
    """Closed form of Hill (1948) with r in all directions of the plane."""
    r = 1.8
    exact = (1.0 + r) / np.sqrt(1.0 + 2.0 * r) * np.sqrt(1.0 + ratio**2 + 2.0 * r / (1.0 + r) * ratio)
    assert EffectiveStrain(uf.Hill48(r0=r, r45=r, r90=r))(1.0, ratio) == pytest.approx(exact, rel=1e-5)


def test_effective_strain_is_the_plastic_work_over_the_yield_stress():
    """Tension of a metal with r-values along and across the rolling direction."""
    hill = uf.Hill48(r0=1.8, r45=1.4, r90=2.1)
    along = EffectiveStrain(hill)
    assert along(1.0, -1.8 / 2.8) == pytest.approx(1.0, rel=1e-5)
    stress, _ = uf.sheet_metals.uniaxial(hill, 90.0)
    assert along(-2.1 / 3.1, 1.0) == pytest.approx(stress, rel=1e-5)


@pytest.mark.parametrize("law", [LAW, uf.Metal(70e3, 0.33, hardening=uf.Perfect(100.0), yield_function=uf.Hosford(8))])
@pytest.mark.parametrize("ratio", [-0.5, -0.2, 0.0, 0.4, 1.0])
@pytest.mark.parametrize("turn", [0.0, 0.1])
def test_a_proportional_path_uses_as_much_of_both_limits(law, ratio, turn):
    found = fields_of((0.2, 0.2 * ratio), law=law, turn=turn)
    assert found.strain_use == pytest.approx(0.2 / strain_on_ray(CURVE, np.array([ratio]))[0], rel=1e-10)
    assert found.use == pytest.approx(found.strain_use, rel=1e-10)
    assert found.paths.bend == pytest.approx(0.0, abs=1e-4) and found.warning(SHEET) is None


def test_the_limit_on_a_ray_is_on_the_curve():
    ratio = np.array([-0.5, 0.0, 0.6, 1.0])
    major = strain_on_ray(CURVE, ratio)
    np.testing.assert_allclose(CURVE(ratio * major), major, rtol=1e-12)
    assert strain_on_ray(CURVE, np.array([-1.0, -2.0])) == pytest.approx(np.inf)  # no thinning: no limit


def test_the_first_crossing_counts():
    """A table that a ray crosses three times."""
    table = LimitTable([0.0, 0.1, 0.2, 0.3, 2.0], [0.3, 0.3, 0.15, 0.5, 0.5])
    assert strain_on_ray(table, np.array([0.9])) == pytest.approx(0.45 / 2.35, rel=1e-12)  # on the second piece


@pytest.mark.parametrize(("first", "sign"), [((0.1, 0.1), -1.0), ((0.1, -0.05), 1.0)])
def test_pre_strain_moves_the_limit_of_strains_as_measured(first, sign):
    """Then plane strain: after equibiaxial stretching it tears earlier, after tension later (Graf and Hosford 1993)."""
    level, last = CURVE.plane_strain, np.array([1.0, 0.0])
    before = fields_of(first)
    effective = EffectiveStrain.of(LAW)
    rest = float((PathLimit(CURVE, effective)(0.0) - before.paths.effective[-1][0]) / effective(*last))
    moved = first[0] + rest - level
    assert moved == pytest.approx(0.1 * (1.0 - (np.sqrt(3.0) if sign < 0 else np.sqrt(0.75))), abs=1e-6)
    assert moved * sign > 0.0
    torn = fields_of(first, rest * last)
    assert torn.use == pytest.approx(1.0, abs=1e-9)
    assert torn.strain_use < 0.95 and torn.paths.bend > BENDS  # the strain diagram calls both safe
    assert "bends by more than 13.3 degrees in 1 element" in torn.warning(SHEET)


def test_tension_across_earlier_tension_is_a_bend():
    """Principal increments are the same; the axes have turned by 90 degrees."""
    found = fields_of((0.1, -0.05), (-0.05, 0.1))
    assert found.paths.bend == pytest.approx(np.degrees(np.arccos(-0.1 / 0.125)), abs=0.1)  # H : H' over |H| |H'|
    np.testing.assert_allclose(found.paths.major[1:], 0.02, rtol=1e-9)
    assert found.use == pytest.approx(fields_of((0.2, -0.1)).use, rel=1e-9)


def test_what_flowed_before_counts_though_the_sheet_rests():
    """Small increments afterwards, in the direction of the lowest limit, are no flow."""
    flowed = fields_of((0.2, -0.2))
    assert flowed.use == 0.0  # no limit for a sheet that does not thin
    rested = fields_of((0.2, -0.2), (0.004, 0.0))
    assert rested.use < 0.2
    went_on = fields_of((0.2, -0.2), (0.05, 0.0))
    assert went_on.use > 0.5


def test_a_path_through_one_state_is_proportional():
    paths = strain_paths(SHEET, states((0.2, 0.1), parts=1), EffectiveStrain.of(LAW))
    assert paths.bend == pytest.approx(0.0, abs=1e-4) and len(paths.effective) == 2
    assert path_use(PathLimit(CURVE, EffectiveStrain.of(LAW)), paths) > 0.5


def test_use_and_margin_agree_at_the_limit():
    """Where one is one, the other is zero."""
    e = float(strain_on_ray(CURVE, np.array([0.3]))[0])
    u = states((e, 0.3 * e))[-1]
    assert forming_fields(SHEET, u, CURVE)["limit_margin"] == pytest.approx(0.0, abs=1e-12)
    major, minor = np.array([e, -0.1]), np.array([0.3 * e, -0.2])
    np.testing.assert_allclose(strain_use(CURVE, major, minor), [1.0, 0.0], atol=1e-12)


def test_what_was_used_stays_used():
    """After stretching, the sheet is drawn in a direction that has no limit."""
    stretched = fields_of((0.2, 0.0))
    assert fields_of((0.2, 0.0), (0.05, -0.06)).use == pytest.approx(stretched.use, rel=1e-12)


def test_a_sheet_that_is_thicker_than_the_blank_does_not_tear():
    """Squeezed, then stretched a little; and stretched until it is thinner."""
    assert fields_of((0.1, -0.4), (0.1, 0.0)).use == 0.0
    assert fields_of((0.1, -0.4), (0.5, 0.0)).use > 1.0
