"""Material laws against energies, differences, an update in F and closed forms; hardening curves; elastic constants."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from cards import ELASTIC, HARDENING, KAPPA, MU, green_lagrange, tensor
from scipy.spatial.transform import Rotation

from umform import materials as mt
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import HardeningNotMonotone, InvalidValue, NotFinite
from umform.history_variables import history_of, named
from umform.model import Model
from umform.spec import scalars


def respond(law, E, state):
    S, CC, new = law.respond(np.atleast_2d(E), np.atleast_2d(state))
    return S[0], CC[0], new[0]


def eqps_of(state):
    """Accumulated plastic strain in histories (..., size) of J2."""
    return named(state, TENSION.law().history_variables)["eqps"][..., 0][()]


def metric(state):
    return named(state, TENSION.law().history_variables)["Cp_inv"]


def stress(law, E, state):
    return respond(law, E, state)[0]


def difference_tangent(law, E, state, h=1e-5):
    """Differences of fourth order."""
    columns = []
    for e in np.eye(6):
        one, two = (stress(law, E + k * h * e, state) - stress(law, E - k * h * e, state) for k in (1, 2))
        columns.append((8 * one - two) / (12 * h))
    return np.stack(columns, axis=1)


def equivalent_stress(E, S):
    """Von Mises stress of tau = F S F^T from its invariants, without F."""
    SC = tensor(S) @ (np.eye(3) + 2 * tensor(E, 0.5))
    return math.sqrt(1.5 * (np.trace(SC @ SC) - np.trace(SC) ** 2 / 3))


def random_path(rng, steps=12, size=0.04):
    """A strain path of stretches and shears that turns back and goes on, with rotations on top."""
    F, path = np.eye(3), []
    for step in range(steps):
        F = (np.eye(3) + size * rng.normal(size=(3, 3))) @ F
        path.append(Rotation.random(random_state=step).as_matrix() @ F)
        if step % 4 == 3:
            F = (np.eye(3) + 1e-4 * rng.normal(size=(3, 3))) @ F  # an elastic step
            path.append(F)
    return path


def yield_stress(hardening, eqps):
    return hardening.curve()(eqps)[0]


# Elastic laws -----------------------------------------------------------------------------------------------


def energy(name, E):
    """Strain energies as the books write them."""
    C = np.eye(3) + 2 * tensor(E, 0.5)
    I1, I3 = np.trace(C), np.linalg.det(C)
    lame = KAPPA - 2 / 3 * MU
    if name == "svk":
        return lame / 2 * np.trace(tensor(E, 0.5)) ** 2 + MU * (tensor(E, 0.5) ** 2).sum()
    if name == "neo-hooke":
        return MU / 2 * (I1 - 3) - MU * math.log(I3) / 2 + lame / 8 * math.log(I3) ** 2
    nu = (3 * KAPPA - 2 * MU) / (2 * (3 * KAPPA + MU))
    beta = nu / (1 - 2 * nu)
    return MU / 2 * (I1 - 3) + MU / (2 * beta) * (I3**-beta - 1)


@pytest.mark.parametrize("name", ELASTIC)
def test_stress_and_tangent_are_derivatives_of_the_energy(name, rng):
    law, none = ELASTIC[name].law(), np.zeros((1, 0))
    for _ in range(10):
        E = green_lagrange(np.eye(3) + 0.2 * rng.normal(size=(3, 3)))
        S, CC, _ = respond(law, E, none)
        h = 1e-5
        gradient = [(energy(name, E + h * e) - energy(name, E - h * e)) / (2 * h) for e in np.eye(6)]
        np.testing.assert_allclose(S, gradient, atol=1e-7 * np.abs(CC).max())
        np.testing.assert_allclose(CC, difference_tangent(law, E, none), atol=1e-8 * np.abs(CC).max())
        assert np.abs(CC - CC.T).max() < 1e-14 * np.abs(CC).max()


@pytest.mark.parametrize("name", [*ELASTIC, "j2"])
def test_every_law_is_linear_elastic_at_small_strains_without_loss_of_digits(name, rng):
    law = (ELASTIC | {"j2": mt.J2(kappa=KAPPA, mu=MU, hardening=HARDENING["linear"])})[name].law()
    lame = KAPPA - 2 / 3 * MU
    C0 = np.diag([2 * MU] * 3 + [MU] * 3)
    C0[:3, :3] += lame
    _, CC, _ = respond(law, np.zeros(6), law.initial())
    np.testing.assert_allclose(CC, C0, rtol=1e-12, atol=1e-9)
    for size in (1e-8, 1e-12, 1e-15):
        E = size * rng.normal(size=6)
        S = stress(law, E, law.initial())
        np.testing.assert_allclose(S, C0 @ E, atol=(1e-12 + 20 * size) * np.abs(S).max())


@pytest.mark.parametrize("name", ["neo-hooke", "neo-hooke-power", "j2"])
def test_a_strain_without_a_deformation_is_refused(name):
    law = (ELASTIC | {"j2": mt.J2(kappa=KAPPA, mu=MU, hardening=HARDENING["linear"])})[name].law()
    for E in ([-0.5, 0, 0, 0, 0, 0], [0, 0, -0.7, 0, 0, 0], [-0.6, -0.6, 0, 0, 0, 0], [0, 0, 0, 3.0, 0, 0]):
        with pytest.raises(ValueError, match="domain"):
            respond(law, np.array(E, dtype=float), law.initial())


def test_elastic_constants_come_in_two_pairs():
    one = mt.SVK(E=210e3, nu=0.3)
    other = mt.SVK(kappa=one.kappa, mu=one.mu)
    assert one.kappa == pytest.approx(175e3, rel=1e-14)
    assert one.mu == pytest.approx(210e3 / 2.6, rel=1e-14)
    assert (other.E, other.nu) == pytest.approx((210e3, 0.3), rel=1e-14)
    assert one.lambda_ == pytest.approx(210e3 * 0.3 / (1.3 * 0.4), rel=1e-14)
    first = mt.J2(E=one.E, nu=one.nu, hardening=HARDENING["linear"]).law()
    second = mt.J2(kappa=one.kappa, mu=one.mu, hardening=HARDENING["linear"]).law()
    E = np.array([0.02, -0.01, 0.005, 0.01, -0.02, 0.003])
    np.testing.assert_allclose(stress(first, E, first.initial()), stress(second, E, second.initial()), rtol=1e-11)


@pytest.mark.parametrize("E", [210e3, 206e3 / 3.0, 210e3 * 1.0123456789012345, 0.1 + 0.2])
def test_constants_stay_those_that_were_given_to_the_last_bit(E):
    """They are what a deck writes, and the numbers of a problem: E is a parameter whatever its digits."""
    law = mt.J2(E=E, nu=0.3, hardening=HARDENING["linear"])
    assert (law.E, law.nu) == (E, 0.3)
    assert law.written()["E"] == E and [one.path for one in scalars(law)][:2] == ["E", "nu"]
    other = replace(law, hardening=HARDENING["voce"])
    assert (other.E, other.kappa) == (E, law.kappa)
    moduli = mt.J2(kappa=law.kappa / 3.0, mu=law.mu / 3.1, hardening=HARDENING["linear"])
    assert [one.path for one in scalars(moduli)][:2] == ["kappa", "mu"]


@pytest.mark.parametrize(
    "constants",
    [
        {"E": -1.0, "nu": 0.3},
        {"E": 1.0, "nu": 0.5},
        {"E": 1.0, "nu": -1.0},
        {"kappa": 0.0, "mu": 1.0},
        {"kappa": 1.0, "mu": -1.0},
        {"E": 1.0},
        {"E": 1.0, "mu": 1.0},
        {"E": 1.0, "nu": 0.3, "kappa": 1.0, "mu": 1.0},
        {},
    ],
)
def test_elastic_constants_of_no_stable_solid_are_refused(constants):
    with pytest.raises(InvalidValue):
        mt.NeoHooke(**constants)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_elastic_constants_must_be_finite(value):
    with pytest.raises(NotFinite):
        mt.SVK(E=value, nu=0.3)
    with pytest.raises(NotFinite):
        mt.J2(kappa=1.0, mu=value, hardening=HARDENING["linear"])


# Plasticity -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", HARDENING)
@pytest.mark.parametrize("seed", range(4))
def test_plastic_path_has_the_right_tangent_metric_and_yield_stress(name, seed):
    hardening = HARDENING[name]
    law = mt.J2(kappa=KAPPA, mu=MU, hardening=hardening).law()
    state, plastic_steps, elastic_steps, compared = law.initial(), 0, 0, 0
    for F in random_path(np.random.default_rng(seed)):
        E = green_lagrange(F)
        S, CC, new = respond(law, E, state)
        scale = np.abs(CC).max()
        assert np.abs(CC - CC.T).max() < 1e-14 * scale
        assert np.linalg.det(tensor(metric(new))) == pytest.approx(1.0, abs=1e-12)
        q, y = equivalent_stress(E, S), yield_stress(hardening, eqps_of(new))
        if eqps_of(new) > eqps_of(state):
            assert q == pytest.approx(y, rel=1e-9)
            plastic_steps += 1
        else:
            assert q <= y * (1 + 1e-12)
            assert (new == state).all()
            elastic_steps += 1
        if eqps_of(new) > eqps_of(state) + 1e-4 or q < 0.9 * y:  # away from the kink between elastic and plastic
            assert np.abs(CC - difference_tangent(law, E, state)).max() < 1e-7 * scale
            compared += 1
        state = new
    assert plastic_steps >= 10
    assert compared >= 12
    assert elastic_steps >= 1


@pytest.mark.parametrize("name", ["perfect", "linear", "table"])
def test_stress_equals_that_of_an_update_in_the_deformation_gradient(name):
    """The classical form: elastic left Cauchy-Green tensor, return in logarithmic strains, pull back with F."""
    hardening = HARDENING[name]
    law = mt.J2(kappa=KAPPA, mu=MU, hardening=hardening).law()
    state, Cp_inv, eqps = law.initial(), np.eye(3), 0.0
    for F in random_path(np.random.default_rng(11)):
        values, vectors = np.linalg.eigh(F @ Cp_inv @ F.T)
        strain = 0.5 * np.log(values)
        deviator = strain - strain.mean()
        q = math.sqrt(1.5) * 2 * MU * np.linalg.norm(deviator)
        if q > yield_stress(hardening, eqps):
            low, high = 0.0, q / (3 * MU)
            for _ in range(200):
                middle = 0.5 * (low + high)
                over = q - 3 * MU * middle > yield_stress(hardening, eqps + middle)
                low, high = (middle, high) if over else (low, middle)
            elastic = deviator * (1 - 3 * MU * low / q) + strain.mean()
            eqps += low
        else:
            elastic = strain
        tau = KAPPA * elastic.sum() + 2 * MU * (elastic - elastic.mean())
        F_inv = np.linalg.inv(F)
        expected = F_inv @ (vectors * tau) @ vectors.T @ F_inv.T
        Cp_inv = F_inv @ (vectors * np.exp(2 * elastic)) @ vectors.T @ F_inv.T
        S, _, state = respond(law, green_lagrange(F), state)
        np.testing.assert_allclose(tensor(S), expected, atol=1e-9 * np.abs(expected).max())
        np.testing.assert_allclose(tensor(metric(state)), Cp_inv, atol=1e-12)
        assert eqps_of(state) == pytest.approx(eqps, abs=1e-13)


def test_plasticity_is_isotropic_and_sees_no_rigid_rotation(rotation):
    """Turned strains and history give turned stresses; a rotation of the deformed body changes nothing."""
    law = mt.J2(kappa=KAPPA, mu=MU, hardening=HARDENING["voce"]).law()
    state, turned_state = law.initial(), law.initial()
    for F in random_path(np.random.default_rng(3)):
        S, _, state = respond(law, green_lagrange(F), state)
        turned = green_lagrange(F @ rotation.T)
        S_turned, _, turned_state = respond(law, turned, turned_state)
        expected = rotation @ tensor(S) @ rotation.T
        np.testing.assert_allclose(tensor(S_turned), expected, atol=1e-10 * np.abs(expected).max())
    assert eqps_of(turned_state) == pytest.approx(eqps_of(state), rel=1e-12)


ROOTS = [0.0, *(10.0**-k for k in range(2, 17))]


@pytest.mark.parametrize("gap", ROOTS)
@pytest.mark.parametrize("size", [1e-5, 0.05, 0.3], ids=["elastic", "plastic", "large"])
def test_close_and_equal_roots_lose_no_digits(gap, size, rotation):
    """Two principal stretches a relative gap apart, in skew axes, with and without history."""
    law = mt.J2(kappa=KAPPA, mu=MU, hardening=HARDENING["linear"]).law()

    def at(gap):
        U = rotation @ np.diag([1 + size, 1 + size * (1 + gap), 1 - 0.4 * size]) @ rotation.T
        return green_lagrange(U)

    for state in (law.initial(), respond(law, 0.6 * at(0.0), law.initial())[2]):
        S, CC, new = respond(law, at(gap), state)
        scale = np.abs(CC).max()
        assert np.abs(CC - CC.T).max() < 1e-14 * scale
        assert np.abs(CC - difference_tangent(law, at(gap), state, min(1e-5, 1e-2 * size))).max() < 1e-7 * scale
        assert np.linalg.det(tensor(metric(new))) == pytest.approx(1.0, abs=1e-12)
        S0, CC0, _ = respond(law, at(0.0), state)
        assert np.abs(S - S0).max() < (10 * gap * size + 1e-14) * scale
        assert np.abs(CC - CC0).max() < (10 * gap + 1e-11) * scale


def test_three_equal_roots_and_a_zero_deviator():
    law = mt.J2(kappa=KAPPA, mu=MU, hardening=HARDENING["linear"]).law()
    for stretch in (0.7, 1.0, 1.4):
        E = green_lagrange(stretch * np.eye(3))
        S, CC, state = respond(law, E, law.initial())
        expected = 3 * KAPPA * math.log(stretch) / stretch**2
        np.testing.assert_allclose(S, [expected] * 3 + [0] * 3, atol=1e-12 * KAPPA)
        assert np.isfinite(CC).all()
        assert eqps_of(state) == 0.0
        np.testing.assert_allclose(CC, difference_tangent(law, E, law.initial()), atol=1e-8 * np.abs(CC).max())


def test_response_changes_neither_strain_nor_history():
    law = mt.J2(kappa=KAPPA, mu=MU, hardening=HARDENING["linear"]).law()
    E, state = np.array([[0.1, -0.03, 0.0, 0.02, 0.0, 0.0]]), law.initial()[None]
    copies = E.copy(), state.copy()
    first, second = law.respond(E, state), law.respond(E, state)
    np.testing.assert_array_equal(E, copies[0])
    np.testing.assert_array_equal(state, copies[1])
    for a, b in zip(first, second, strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("name", ["perfect", "linear", "voce", "swift"])
def test_a_point_on_the_yield_surface_is_elastic_until_it_is_strained(name, rng):
    """Round-off must not make it plastic; nor must 1e-12 of its yield stress, which a lower eqps stands for."""
    hardening = HARDENING[name]
    law = mt.J2(kappa=KAPPA, mu=MU, hardening=hardening).law()
    elastic = mt.J2(kappa=KAPPA, mu=MU, hardening=mt.Perfect(1e9)).law()
    E = 0.03 * rng.normal(size=(100, 6))
    _, CC_plastic, state = law.respond(E, np.tile(law.initial(), (100, 1)))
    assert (eqps_of(state) > 0).all()
    S_elastic, CC_elastic, _ = elastic.respond(E, state)
    assert (np.abs(CC_elastic - CC_plastic).max(axis=(1, 2)) > 0.1 * MU).all()
    y, slope = np.transpose([hardening.curve()(eqps) for eqps in eqps_of(state)])
    for share in [0.0] if name == "perfect" else [0.0, 1e-12]:
        history = state.copy()
        if share:
            eqps_of(history)[:] -= share * y / slope
        S, CC, new = law.respond(E, history)
        np.testing.assert_array_equal(CC, CC_elastic)
        np.testing.assert_array_equal(S, S_elastic)
        np.testing.assert_array_equal(new, history)
    if name != "perfect":  # beyond round-off it is plastic
        eqps_of(history)[:] = eqps_of(state) - 1e-8 * y / slope
        assert (eqps_of(law.respond(E, history)[2]) > eqps_of(history)).all()


TENSION = mt.J2(kappa=175000.0, mu=80770.0, hardening=mt.Linear(160.0, 500.0))


@pytest.mark.parametrize("steps", [1, 7])
def test_uniaxial_tension_of_a_material_point(steps):
    """Stretch 1.2 of a bar of area 0.2; the answer of a proportional path does not depend on the number of steps."""
    law = TENSION.law()
    state, lateral = law.initial(), 0.0
    for step in range(1, steps + 1):
        axial = 0.5 * ((1 + 0.2 * step / steps) ** 2 - 1)
        for _ in range(60):
            E = np.array([axial, lateral, lateral, 0, 0, 0])
            S, CC, new = respond(law, E, state)
            lateral -= S[1] / (CC[1, 1] + CC[1, 2])
            lateral = max(lateral, -0.45)
        state = new
    assert S[1] == pytest.approx(0.0, abs=1e-8)
    assert 1.2 * S[0] * 0.2 == pytest.approx(41.760700, abs=5e-7)
    assert eqps_of(state) == pytest.approx(0.1811284, abs=5e-8)


@pytest.mark.parametrize(
    ("element", "options"),
    [
        ("DISP3D", {}),
        ("ANS3DEAS", {"thickness_points": 2}),
        ("ANS3DEAS", {"thickness_order": 3, "tie_E33": True}),
        ("EAS3DEAS", {"membrane_modes": 4}),
        ("DISP9K3DEAS", {}),
        ("MI9K3DEAS", {}),
    ],
)
def test_uniaxial_tension_of_a_bar(build, element, options):
    model, pull = build.bar(element, TENSION, area=0.2, **options)
    result = solve(model, Move(pull, 0.2, steps=10), frames=0)
    assert result["pull_force"][-1] == pytest.approx(41.760700, abs=5e-7)
    np.testing.assert_allclose(history_of(model.bodies.only.block)["eqps"], 0.1811284, atol=5e-8)


# Hardening --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", HARDENING)
def test_slope_of_hardening_is_its_derivative(name):
    curve = HARDENING[name].curve()
    for e in (1e-4, 0.013, 0.05, 0.3, 0.7):
        h = 1e-7
        assert curve(e)[1] == pytest.approx((curve(e + h)[0] - curve(e - h)[0]) / (2 * h), rel=1e-5, abs=1e-5)


@pytest.mark.parametrize(
    ("hardening", "expected"),
    [
        (mt.Perfect(160.0), lambda e: 160.0),
        (mt.Linear(160.0, 500.0), lambda e: 160 + 500 * e),
        (mt.Voce(160.0, 320.0, 15.0), lambda e: 320 - 160 * math.exp(-15 * e)),
        (
            mt.LinearVoce(160.0, 300.0, 250.0, 40.0),
            lambda e: 160 + 300 * e + 90 * (1 - math.exp(-40 * e)),
        ),
        (mt.Swift(500.0, 0.004, 0.21), lambda e: 500 * (0.004 + e) ** 0.21),
    ],
)
def test_hardening_curves_are_those_of_the_books(hardening, expected):
    for e in (0.0, 0.001, 0.1, 1.0):
        assert hardening.curve()(e)[0] == pytest.approx(expected(e), rel=1e-14)


def test_a_table_is_met_at_its_points_with_the_slope_to_the_right():
    curve = mt.Table((0.0, 0.02, 0.1, 0.5), (160.0, 220.0, 220.0, 400.0)).curve()
    assert [curve(e) for e in (0.0, 0.02, 0.1, 0.5, 2.0)] == [
        (160.0, pytest.approx(3000.0)),
        (220.0, pytest.approx(0.0)),
        (220.0, pytest.approx(450.0)),
        (400.0, 0.0),
        (400.0, 0.0),
    ]
    assert curve(0.01)[0] == pytest.approx(190.0)
    assert curve(0.3)[0] == pytest.approx(310.0)


def test_a_return_over_kinks_of_a_table_lands_on_the_table():
    """Kinks that throw Newton's method back and forth, met by steps of any size."""
    table = mt.Table((0.0, 1e-6, 2e-6, 0.01, 0.010001, 0.5), (1.0, 300.0, 300.0, 310.0, 900.0, 901.0))
    law = mt.J2(kappa=KAPPA, mu=MU, hardening=table).law()
    for size in np.geomspace(1e-6, 0.5, 60):
        E = np.array([size, -0.4 * size, 0.0, 0.3 * size, 0.0, 0.0])
        S, _, state = respond(law, E, law.initial())
        if eqps_of(state) > 0:
            assert equivalent_stress(E, S) == pytest.approx(yield_stress(table, eqps_of(state)), rel=1e-7)


@pytest.mark.parametrize(
    "make",
    [
        lambda: mt.Linear(160.0, -1.0),
        lambda: mt.Voce(160.0, 150.0, 10.0),
        lambda: mt.Voce(160.0, 250.0, -10.0),
        lambda: mt.Table((0.0, 0.1, 0.2), (160.0, 200.0, 199.0)),
        lambda: mt.Table((0.0, 0.1, 0.1), (160.0, 200.0, 210.0)),
        lambda: mt.Table((0.0, 0.2, 0.1), (160.0, 200.0, 210.0)),
    ],
)
def test_softening_is_refused(make):
    with pytest.raises(HardeningNotMonotone):
        make()


def test_a_falling_table_names_its_row():
    with pytest.raises(HardeningNotMonotone) as caught:
        mt.Table((0.0, 0.1, 0.2, 0.3), (160.0, 200.0, 210.0, 205.0))
    assert "row 3" in caught.value.where


@pytest.mark.parametrize(
    ("make", "error"),
    [
        (lambda: mt.Perfect(0.0), InvalidValue),
        (lambda: mt.Perfect(-160.0), InvalidValue),
        (lambda: mt.Linear(math.nan, 1.0), NotFinite),
        (lambda: mt.Swift(0.0, 0.01, 0.2), InvalidValue),
        (lambda: mt.Swift(500.0, 0.0, 0.2), InvalidValue),
        (lambda: mt.Swift(500.0, 0.01, 1.2), InvalidValue),
        (lambda: mt.Swift(500.0, math.inf, 0.2), NotFinite),
        (lambda: mt.Table((0.0,), (160.0,)), InvalidValue),
        (lambda: mt.Table((0.0, 0.1), (160.0, 170.0, 180.0)), InvalidValue),
        (lambda: mt.Table((0.001, 0.1), (160.0, 170.0)), InvalidValue),
        (lambda: mt.Table((0.0, 0.1), (0.0, 170.0)), InvalidValue),
        (lambda: mt.Table((0.0, math.nan), (160.0, 170.0)), NotFinite),
    ],
)
def test_curves_that_are_none_are_refused(make, error):
    with pytest.raises(error):
        make()


def test_a_model_wants_a_material(build):
    mesh = build.bar()[0].mesh
    for other in ({"E": 210e3, "nu": 0.3}, "DC04", mt.SVK):
        with pytest.raises(InvalidValue, match=r"material law[\s\S]*sheet_metals.get\('DC04'\).law"):
            Model(mesh, material=other)
