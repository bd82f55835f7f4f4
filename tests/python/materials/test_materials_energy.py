"""Energies of the laws: stress is their derivative, they take up the work done, and a law of the user may have them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cards import ELASTIC, HARDENING, KAPPA, MU, green_lagrange
from scipy.integrate import quad

from umform import materials as mt
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue, NotFinite
from umform.history_variables import named
from umform.materials.user_law import UserLaw
from umform.mesh import strip
from umform.model import Model

LAWS = ELASTIC | {
    "neo-hooke-power without Poisson": mt.NeoHookePower(E=200e3, nu=0.0),
    "neo-hooke-power auxetic": mt.NeoHookePower(E=200e3, nu=-0.3),
    "neo-hooke-power stiff": mt.NeoHookePower(E=200e3, nu=0.49),
}


def energy(law, E, state):
    elastic, plastic = law.energy(np.atleast_2d(E), np.atleast_2d(state))
    return elastic[0], plastic[0]


def respond(law, E, state):
    S, _, new = law.respond(np.atleast_2d(E), np.atleast_2d(state))
    return S[0], new[0]


def gradient(law, E, state, h):
    """Differences of fourth order of the elastic energy."""
    W = lambda k, e: energy(law, E + k * h * e, state)[0]  # noqa: E731
    return np.array([(8 * (W(1, e) - W(-1, e)) - (W(2, e) - W(-2, e))) / (12 * h) for e in np.eye(6)])


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("size", [1e-3, 0.02, 0.15])
def test_stress_of_an_elastic_law_is_the_derivative_of_its_energy(name, size, rng):
    law, none = LAWS[name].law(), np.zeros((1, 0))
    for _ in range(5):
        E = green_lagrange(np.eye(3) + size * rng.normal(size=(3, 3)))
        S, _ = respond(law, E, none)
        assert np.abs(S - gradient(law, E, none, 2e-3 * size)).max() < 1e-6 * np.abs(S).max()
        assert energy(law, E, none)[0] > 0.0
        assert energy(law, E, none)[1] == 0.0
    assert energy(law, np.zeros(6), none) == (0.0, 0.0)


def test_power_form_is_the_energy_of_the_books():
    law, E = LAWS["neo-hooke-power"], np.array([0.2, -0.1, 0.3, 0.1, -0.2, 0.15])
    C = np.eye(3) + np.array([[2 * E[0], E[3], E[5]], [E[3], 2 * E[1], E[4]], [E[5], E[4], 2 * E[2]]])
    beta = law.nu / (1 - 2 * law.nu)
    expected = MU / 2 * (np.trace(C) - 3) + MU / (2 * beta) * (np.linalg.det(C) ** -beta - 1)
    assert energy(law.law(), E, np.zeros((1, 0)))[0] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("name", HARDENING)
def test_stress_of_plasticity_is_the_derivative_of_the_elastic_energy(name, rng):
    """At the history that the step has left behind; the plastic work is the integral of the yield curve."""
    hardening = HARDENING[name]
    law = mt.J2(kappa=KAPPA, mu=MU, hardening=hardening).law()
    assert energy(law, np.zeros(6), law.initial()) == (0.0, 0.0)
    state, F, spent = law.initial(), np.eye(3), 0.0
    for _ in range(8):
        F = (np.eye(3) + 0.03 * rng.normal(size=(3, 3))) @ F
        E = green_lagrange(F)
        S, state = respond(law, E, state)
        assert np.abs(S - gradient(law, E, state, 1e-5)).max() < 1e-6 * np.abs(S).max()
        work = energy(law, E, state)[1]
        assert work > spent
        eqps = named(state, law.history_variables)["eqps"].item()
        kinks = [e for e in (0.02, 0.1, 0.5) if e < eqps]
        expected = quad(lambda e: hardening.curve()(e)[0], 0.0, eqps, points=kinks or None, epsabs=0, limit=200)[0]
        assert work == pytest.approx(expected, rel=1e-9)
        assert work == hardening.curve().work(eqps)
        spent = work


def balance_error(law, steps):
    """Work of the stress along a curved path of large strains minus the energies, relative, from a plastic state on."""
    a, b = np.array([[0.3, 0.2, 0.0], [0, -0.1, 0.1], [0, 0, -0.1]]), np.diag([0.1, -0.3, 0.1])
    state, work, before = law.initial(), 0.0, None
    for time in np.r_[np.linspace(0, 0.1, 21)[:-1], np.linspace(0.1, 1.0, steps + 1)]:
        E = green_lagrange(np.eye(3) + time * a + time**2 * b)
        S, state = respond(law, E, state)
        if time >= 0.1:
            if before is None:
                start = sum(energy(law, E, state))
            else:
                work += 0.5 * (S + before[1]) @ (E - before[0])
            before = E, S
    return (work + start) / sum(energy(law, E, state)) - 1.0


METALS = {
    "back stresses": {"hardening": HARDENING["voce"], "back_stress": mt.Chaboche([(4000.0, 80.0), (600.0, 6.0)])},
    "two surfaces": {
        "hardening": mt.Perfect(124.0),
        "back_stress": mt.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5),
    },
    "falling modulus": {"hardening": HARDENING["voce"], "modulus": mt.FallingModulus(saturated=160e3, rate=30.0)},
}
PLASTIC = {
    name: mt.J2(kappa=KAPPA, mu=MU, hardening=HARDENING[name]) for name in ("perfect", "linear", "voce", "swift")
}
PLASTIC |= {name: mt.Metal(E=206e3, nu=0.3, **parts) for name, parts in METALS.items()}


@pytest.mark.parametrize("name", PLASTIC)
def test_energies_take_up_the_work_with_an_error_of_second_order(name):
    law = PLASTIC[name].law()
    coarse, middle, fine = (balance_error(law, steps) for steps in (50, 100, 200))
    assert abs(fine) < 2e-4
    assert coarse / middle == pytest.approx(4.0, rel=0.1)
    assert middle / fine == pytest.approx(4.0, rel=0.1)


# Laws of the user -------------------------------------------------------------------------------------------

C = np.diag([800.0] * 3 + [400.0] * 3) + 600.0 * np.outer([1, 1, 1, 0, 0, 0], [1, 1, 1, 0, 0, 0])


def hooke(E, state):
    return E @ C, np.tile(C, (len(E), 1, 1)), state


def hooke_energy(E, state):
    return 0.5 * (E * (E @ C)).sum(axis=1), np.zeros(len(E))


def pulled(law):
    model = Model(strip(1.0, 0.5, 0.4, (2, 1)), "EAS3DEAS", material=law)
    for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(face, normal=normal)
    return solve(model, Move(model.prescribe("x1", "x", "pull"), 0.2, steps=3), frames=0)


def test_energy_of_a_law_of_the_user_is_that_of_the_house():
    mine, house = pulled(UserLaw(hooke, energy=hooke_energy)), pulled(mt.SVK(kappa=600 + 800 / 3, mu=400.0))
    for name in ("external_work", "elastic_energy", "plastic_work"):
        np.testing.assert_allclose(mine[name], house[name], rtol=1e-12)
    assert mine["elastic_energy"][-1] > 1.0


def test_a_law_without_an_energy_has_none(tmp_path):
    result = pulled(UserLaw(hooke))
    assert np.isnan(result["elastic_energy"]).all()
    assert np.isnan(result["plastic_work"]).all()
    balance = result.balance()
    assert np.isnan(balance.drift).all()
    np.testing.assert_array_equal(
        balance.external_work, pulled(UserLaw(hooke, energy=hooke_energy)).balance().external_work
    )
    assert balance.force_imbalance.max() < 1e-9
    assert "nan" in result.write(tmp_path / "run.csv").read_text()
    result.report(tmp_path / "run.html")


@pytest.mark.parametrize(
    ("answer", "error", "message"),
    [
        (lambda E, state: np.zeros(len(E)), InvalidValue, "two arrays: elastic, plastic"),
        (lambda E, state: (np.zeros(len(E)), np.zeros(1)), InvalidValue, "plastic work of a law must have shape"),
        (lambda E, state: (np.zeros((len(E), 1)), np.zeros(len(E))), InvalidValue, "elastic energy of a law must have"),
        (lambda E, state: (np.full(len(E), math.nan), np.zeros(len(E))), NotFinite, "elastic energy of a law is not"),
    ],
)
def test_a_wrong_energy_is_refused(answer, error, message):
    with pytest.raises(error, match=message) as caught:
        pulled(UserLaw(hooke, energy=answer, name="mine"))
    assert caught.value.where == "mine, cell 0"
