"""Metals whose yield stress rises with the rate: bars at a given rate, relaxation, tangents, increments of any size."""

from __future__ import annotations

import math

import cards
import numpy as np
import pytest

import umform as uf
from umform import materials as mt
from umform.errors import InvalidValue

RATES = {
    "cowper-symonds": mt.CowperSymonds(reference=40.0, exponent=5.0),
    "linear": mt.CowperSymonds(reference=0.1, exponent=1.0),
    "steep": mt.CowperSymonds(reference=1e-3, exponent=20.0),
    "johnson-cook": mt.JohnsonCook(reference=1e-3, strength=0.02),
}
PARTS = {
    "mises": {"hardening": cards.CURVES["voce"]},
    "hill48": {
        "hardening": cards.CURVES["swift"],
        "yield_function": cards.FUNCTIONS["hill48"],
        "back_stress": cards.BACK["two"],
        "modulus": cards.FALLING,
    },
    "aa2090": {
        "hardening": cards.CURVES["table"],
        "yield_function": cards.AA2090,
        "back_stress": cards.BACK["four"],
    },
    "hosford-20": {"hardening": cards.CURVES["perfect"], "yield_function": cards.FUNCTIONS["hosford-20"]},
}
CASES = [(parts, rate) for parts in PARTS for rate in RATES]


def factor(rate, speed):
    """From the definition, apart from the kernels."""
    if isinstance(rate, mt.CowperSymonds):
        return 1.0 + (speed / rate.reference) ** (1.0 / rate.exponent)
    return 1.0 + rate.strength * math.log(max(speed / rate.reference, 1.0))


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("speed", [1e-4, 1.0, 300.0])
def test_a_bar_at_a_constant_rate_of_plastic_strain(rate, speed):
    """Linear hardening: the stress at a plastic strain p is (Y + H p) times the factor of the rate."""
    rate = RATES[rate]
    metal = mt.Metal(**cards.STEEL, hardening=mt.Linear(200.0, 1000.0), rate=rate)
    p = np.linspace(0.005, 0.1, 20)
    stress = (200.0 + 1000.0 * p) * factor(rate, speed)
    # With the strain p + stress / E at the time p / speed each increment has that rate.
    _, found, plastic = mt.tension(metal, p + stress / 210e3, time=p / speed)
    assert plastic[:, 0] == pytest.approx(p, rel=1e-9)
    assert found == pytest.approx(stress, rel=1e-9)


def test_relaxation_under_a_held_strain():
    """d(stress) = -E dp with a linear law: the overstress decays exponentially."""
    E, Y, D = 210e3, 200.0, 0.1
    metal = mt.Metal(**cards.STEEL, hardening=mt.Perfect(Y), rate=mt.CowperSymonds(D, 1.0))
    rise, hold = 1e-7, np.linspace(0.0, 0.05, 2001)[1:]
    strains, times = np.full(2001, 0.003), np.concatenate([[rise], rise + hold])
    _, stress, _ = mt.tension(metal, strains, time=times)
    assert stress[0] - Y == pytest.approx(E * 0.003 - Y, rel=1e-4)  # no time to flow yet
    decay = -np.log((stress[1:] - Y) / (stress[:-1] - Y))
    step = 0.05 / 2000
    assert decay[:20] == pytest.approx(math.log1p(E * D / Y * step), rel=1e-6)  # backward Euler of exp(-E D t / Y)


@pytest.mark.parametrize(("parts", "rate"), CASES)
@pytest.mark.parametrize("time", [1e-6, 1.0, 1e4])
def test_no_increment_up_to_ten_per_cent_fails(parts, rate, time):
    law = mt.Metal(**cards.ALUMINIUM, **PARTS[parts], rate=RATES[rate]).law()
    count, E = 800, np.zeros((800, 6))
    state = np.tile(law.initial(), (count, 1))
    sizes = np.exp(np.random.default_rng(1).uniform(math.log(1e-4), math.log(0.1), size=(3, count)))
    for number, size in enumerate(sizes):
        E = E + size[:, None] * cards.increments(count, 1.0, seed=number)
        _, CC, state = law.respond(E, state, step=time)  # raises where a point has no answer
        assert np.isfinite(CC).all() and np.isfinite(state).all()


@pytest.mark.parametrize(("parts", "rate"), CASES)
def test_tangent_against_differences(parts, rate):
    law = mt.Metal(**cards.ALUMINIUM, **PARTS[parts], rate=RATES[rate]).law()
    E, state = np.zeros((6, 6)), np.tile(law.initial(), (6, 1))
    for number, time in enumerate((1e-3, 1.0, 1e3)):
        E = E + cards.increments(6, 0.03, seed=number)
        _, CC, after = law.respond(E, state, step=time)
        assert (cards.eqps(law, after) > cards.eqps(law, state)).all()
        assert np.abs(cards.differences(law, E, state, 1e-6, time=time) - CC).max() < 3e-8 * np.abs(CC).max()
        state = after


def test_no_time_no_flow():
    law = mt.Metal(**cards.STEEL, hardening=mt.Perfect(200.0), rate=RATES["linear"]).law()
    h = cards.increments(5, 0.01)
    S, _, state = law.respond(h, np.tile(law.initial(), (5, 1)))
    elastic = uf.LogarithmicSpace(mt.SVK(**cards.STEEL)).law()
    assert pytest.approx(elastic.respond(h, np.empty((5, 0)))[0], rel=1e-12) == S
    assert not state.any()


def pulled(speed, **options):
    """A bar of one element that is pulled by 5 % at a nominal strain rate."""
    cube = uf.mesh.strip(length=1.0, width=1.0, thickness=1.0, cells=(1, 1))
    metal = uf.Metal(**cards.STEEL, hardening=uf.Linear(200.0, 1000.0), rate=RATES["cowper-symonds"])
    model = uf.Model(cube, "ANS3DEAS", material=metal)
    for name, axis in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(name, axis)
    pull = model.prescribe("x1", "x", "pull")
    return model, uf.solve(model, uf.Move(pull, to=0.05, steps=50, time=0.05 / speed), progress=False, **options)


@pytest.mark.parametrize("speed", [1e-3, 1.0, 1e3])
def test_an_element_that_is_pulled_over_the_time_of_a_step(speed):
    """T = (Y + H p) (1 + (dp/dt / D)^(1/q)) where it flows, and the force is T / stretch."""
    model, result = pulled(speed)
    assert result["time"][-1] == pytest.approx(0.05 / speed)
    stretch = 1.0 + result["pull"]
    stress = result["pull_force"] * stretch
    p = np.log(stretch) - stress / 210e3
    rate = np.diff(p) / np.diff(result["time"])
    wanted = (200.0 + 1000.0 * p[1:]) * (1.0 + (np.maximum(rate, 0.0) / 40.0) ** 0.2)
    flows = rate > 0.1 * speed
    assert flows.sum() > 30
    assert stress[1:][flows] == pytest.approx(wanted[flows], rel=1e-6)
    assert np.abs(result.balance().drift).max() < 0.01
    at = uf.fields.point_fields(model)  # fields are those of the converged state: nothing relaxes
    assert at.stress()[..., 0] == pytest.approx(stress[-1] * np.exp(-(1 - 2 * 0.3) / 210e3 * stress[-1]), rel=1e-6)
    assert at.eqps == pytest.approx(p[-1], rel=1e-6)


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: mt.CowperSymonds(-40.0, 5.0), "must be positive"),
        (lambda: mt.CowperSymonds(40.0, 0.2), "from 1 to 20"),
        (lambda: mt.CowperSymonds(40.0, math.nan), "from 1 to 20"),
        (lambda: mt.JohnsonCook(0.0, 0.01), "must be positive"),
        (lambda: mt.JohnsonCook(1.0, 0.0), "from 0.001"),
        (lambda: mt.Metal(**cards.STEEL, hardening=mt.Perfect(200.0), rate=40.0), "rate must be a rate factor"),
        (
            lambda: mt.Metal(**cards.STEEL, hardening=mt.Perfect(124.0), back_stress=cards.SPCC, rate=RATES["linear"]),
            "constant size: no rate",
        ),
        (
            lambda: mt.tension(mt.Metal(1e5, 0.3, hardening=mt.Perfect(1), rate=RATES["linear"]), [0.1]),
            "needs the times",
        ),
        (lambda: mt.tension(mt.Metal(1e5, 0.3, hardening=mt.Perfect(1)), [0.1, 0.2], time=[0, 1]), "must rise"),
        (lambda: uf.Move([], [], time=0.0), "must be positive"),
        (lambda: uf.Move([], [], time=math.inf), "must be positive"),
    ],
)
def test_bad_input(make, text):
    with pytest.raises(InvalidValue, match=text):
        make()
