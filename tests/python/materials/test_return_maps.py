"""Return maps of metals: tangents, increments of any size, yield surface, neighbours in the lanes, work."""

from __future__ import annotations

import itertools
import math

import cards
import numpy as np
import pytest

from umform import materials as mt
from umform.history_variables import named


@pytest.mark.parametrize("card", cards.CARDS)
def test_tangent_against_differences_and_its_symmetry(card):
    law = cards.CARDS[card].law()
    state = np.tile(law.initial(), (6, 1))
    E = np.zeros((6, 6))
    for step in range(3):  # paths that turn
        E = E + cards.increments(6, 0.03, seed=step)
        _, CC, after = law.respond(E, state)
        assert (cards.eqps(law, after) > cards.eqps(law, state)).all()
        assert np.abs(cards.differences(law, E, state, 1e-6) - CC).max() < 3e-8 * np.abs(CC).max(), step
        if law.symmetric:
            assert np.array_equal(CC, CC.transpose(0, 2, 1))
        state = after


def test_who_is_symmetric():
    """Where no back stress is recalled and the modulus stays."""
    symmetric = {name for name, card in cards.CARDS.items() if card.law().symmetric}
    assert symmetric == {
        name
        for name, card in cards.CARDS.items()
        if card.modulus is None and not {"two", "four"} & set(name.replace(",", "").split())
    }


@pytest.mark.parametrize("card", cards.CARDS)
def test_no_increment_up_to_ten_per_cent_fails(card):
    law = cards.CARDS[card].law()
    count, state = 4000, np.tile(law.initial(), (4000, 1))
    E = np.zeros((count, 6))
    sizes = np.exp(np.random.default_rng(1).uniform(math.log(1e-4), math.log(0.1), size=(2, count)))
    for step, size in enumerate(sizes):
        E = E + size[:, None] * cards.increments(count, 1.0, seed=step)
        _, _, state = law.respond(E, state)  # raises where a point has no answer
        assert np.isfinite(state).all()
    E = E + cards.increments(count, 0.1, seed=9)
    law.respond(E, state)


@pytest.mark.parametrize("function", cards.FUNCTIONS)
def test_no_increment_fails_in_any_combination(function):
    """Every yield function with every curve and every back stress, with a falling modulus in turn; and two surfaces."""
    rng, count, rounds = np.random.default_rng(7), 400, 4
    sizes = np.exp(rng.uniform(math.log(1e-4), math.log(0.1), size=(rounds, count, 1)))
    sizes[-1] = 0.1
    changes = [size * cards.increments(count, 1.0, seed=number) for number, size in enumerate(sizes)]
    parts = [*itertools.product(cards.CURVES.values(), cards.BACK.values()), *[(mt.Perfect(124.0), cards.SPCC)] * 2]
    for number, (curve, back) in enumerate(parts):
        falling = cards.FALLING if number % 2 else None
        metal = mt.Metal(
            **cards.ALUMINIUM,
            hardening=curve,
            yield_function=cards.FUNCTIONS[function],
            back_stress=back,
            modulus=falling,
        )
        law = metal.small_strain_law()
        state, h = np.tile(law.initial(), (count, 1)), np.zeros((count, 6))
        for change in changes:
            h = h + change
            T, C, state = law.respond(h, state)  # raises where a point has no answer
        assert all(np.isfinite(values).all() for values in (T, C, state))


@pytest.mark.parametrize("card", cards.CARDS)
def test_stress_lies_on_the_yield_surface(card):
    metal = cards.CARDS[card]
    law, function, curve = metal.small_strain_law(), metal.yield_function.function(), metal.hardening.curve()
    h = cards.increments(20, 0.05, seed=4)
    T, _, state = law.respond(h, np.tile(law.initial(), (20, 1)))
    for stress, row in zip(T, state, strict=True):
        parts = named(row, law.history_variables)
        back = sum((values for name, values in parts.items() if "back_stress" in name), np.zeros(6))
        assert function(stress - back)[0] == pytest.approx(curve(parts["eqps"].item())[0], rel=1e-11)
        assert parts["plastic_strain"][:3].sum() == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize("card", cards.CARDS)
def test_answers_do_not_depend_on_the_neighbours(card):
    law = cards.CARDS[card].law()
    E = np.concatenate(
        [cards.increments(6, 1e-4, seed=1), cards.increments(7, 0.08, seed=2), cards.increments(5, 0.004, seed=3)]
    )
    E = E[np.random.default_rng(0).permutation(len(E))]
    together = law.respond(E, np.tile(law.initial(), (len(E), 1)))
    for k, strain in enumerate(E):
        for one, all_ in zip(law.respond(strain[None], law.initial()[None]), together, strict=True):
            assert np.array_equal(one[0], all_[k])


@pytest.mark.parametrize("card", cards.CARDS)
def test_work_is_what_the_energies_say(card):
    """Trapezoidal work along a path that turns against elastic energy and plastic work: second order in the step."""
    law = cards.CARDS[card].small_strain_law()
    corners = np.concatenate([np.zeros((1, 6)), np.cumsum(cards.increments(3, 0.02, seed=6), axis=0)])
    drift = []
    for steps in (100, 200):
        path = np.concatenate([np.linspace(a, b, steps + 1)[1:] for a, b in itertools.pairwise(corners)])
        state, before, T_before, work = law.initial(), np.zeros(6), np.zeros(6), 0.0
        for h in path:
            T, _, new = law.respond(h[None], state[None])
            work += 0.5 * (T[0] + T_before) @ (h - before)
            state, before, T_before = new[0], h, T[0]
        drift.append(abs(float(sum(law.energy(h[None], state[None]))[0]) / work - 1))
    assert drift[1] < 2e-3 and drift[1] < 0.7 * drift[0]


def _last_orders(metal, count):
    """Orders of the last three residuals above round-off of random increments behind one of 2 %."""
    law = metal.small_strain_law()
    before = cards.increments(count, 0.02, seed=3)
    _, _, states = law.respond(before, np.tile(law.initial(), (count, 1)))
    sizes = np.exp(np.random.default_rng(5).uniform(math.log(1e-3), math.log(0.1), size=(count, 1)))
    orders = []
    for strain, state in zip(before + sizes * cards.increments(count, 1.0, seed=4), states, strict=True):
        residuals = metal.residuals(strain, state)
        assert len(residuals) < 15
        assert not residuals[:-1].size or residuals[-1] < 1e-13  # an increment that unloads has none
        told = residuals[residuals > 1e-13]
        if len(told) >= 3 and told[-3] < 0.1:
            orders.append(math.log(told[-1] / told[-2]) / math.log(told[-2] / told[-3]))
    return orders


@pytest.mark.parametrize("function", cards.FUNCTIONS)
def test_newton_of_the_return_map_is_quadratic_in_any_combination(function):
    told = 0
    parts = [*itertools.product(cards.CURVES.values(), cards.BACK.values()), (mt.Perfect(124.0), cards.SPCC)]
    for number, (curve, back) in enumerate(parts):
        metal = mt.Metal(
            **cards.ALUMINIUM,
            hardening=curve,
            yield_function=cards.FUNCTIONS[function],
            back_stress=back,
            modulus=cards.FALLING if number % 2 else None,
        )
        orders = _last_orders(metal, 30)
        assert not orders or np.median(orders) > 1.8, (number, np.median(orders))
        told += len(orders)
    assert told > 60


def test_residuals_of_an_elastic_increment_and_of_a_rate():
    metal = cards.CARDS["hill48, voce, fixed"]
    assert metal.residuals(1e-5 * np.ones(6)).size == 0
    quick = mt.Metal(**cards.ALUMINIUM, hardening=cards.CURVES["voce"], rate=mt.CowperSymonds(40.0, 5.0))
    strain = [0.02, -0.01, -0.01, 0.0, 0.0, 0.0]
    assert quick.residuals(strain).size == 0  # no time
    residuals = quick.residuals(strain, time=1.0)
    assert len(residuals) > 2 and residuals[-1] < 1e-13
    with pytest.raises(ValueError, match="state"):
        metal.residuals(strain, np.zeros(3))
