"""Old factors where they pay: the decision by itself, and runs with it."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.factor_reuse import Reuse, cost_of_factors
from umform.analysis.newton.options import NewtonOptions
from umform.solvers import Factorisation


def decision(cost, *iterations):
    """What is decided for iterations of (residual, increment) or (residual, increment, settled)."""
    reuse = Reuse(NewtonOptions(factor_cost=cost), equations=2, effort=1.0)
    decisions = []
    for residual, increment, *settled in iterations:
        decisions.append(reuse.factors_will_do(residual, increment, settled=not settled or settled[0]))
        if not decisions[-1]:
            reuse.remember(Factorisation(0, 3))
    return decisions


FAST = (1e-3, 1e-3), (1e-8, 1e-6)  # old factors: a residual of 3e-11


def test_the_first_iteration_has_new_factors():
    assert decision(5.0, *FAST) == [False, True]


def test_cheap_factors_are_made_anew():
    assert decision(0.5, *FAST) == [False, False]


def test_new_contact_makes_new_factors():
    assert decision(5.0, FAST[0], (*FAST[1], False)) == [False, False]


@pytest.mark.parametrize(("cost", "answer"), [(1.0, False), (1.5, True)])
def test_iterations_are_weighed_against_factors(cost, answer):
    """At a fall of 3e-2 old factors need 4 iterations from 1e-4 to 1e-9, new ones 2, which weigh 4 or 5."""
    assert decision(cost, (1e-2, 1e-2), (1e-4, 1e-4)) == [False, answer]


def test_old_factors_that_disappoint_are_not_used_on():
    """3e-3 was predicted; nothing was gained."""
    assert decision(5.0, *FAST, (9e-9, 9e-7)) == [False, True, False]
    assert decision(5.0, *FAST, (2e-9, 1e-8)) == [False, True, True]


def test_sheets_beyond_some_ten_thousand_elements_have_dear_factors():
    """Entries of sheets of 3600 and 40 000 elements, as the multifrontal solver counts them; a strip; no factors."""
    assert cost_of_factors(3_520_000, 21_360, 1.0) < 1.0
    assert cost_of_factors(55_070_000, 241_200, 1.0) > 1.5
    assert cost_of_factors(300 * 24, 300, 1.0) < 0.05
    assert cost_of_factors(0, 300, 1.0) == 0.0


def plate(steps=3):
    mesh = uf.mesh.strip(length=50.0, width=50.0, thickness=1.0, cells=(8, 8))
    model = uf.Model(mesh, material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    return model, uf.Move(model.prescribe("x1_lower", "z", name="edge"), to=15.0, steps=steps)


def run(cost):
    model, move = plate()
    return uf.solve(model, move, options=NewtonOptions(factor_cost=cost), frames=0, progress=False)


def test_a_run_with_old_factors_ends_where_the_other_does():
    new, old = run(0.0), run(4.0)
    assert new.timing.factorisation.calls == new.timing.solve.calls
    assert old.timing.factorisation.calls < new.timing.factorisation.calls
    assert old.timing.factorisation.calls < old.timing.solve.calls
    np.testing.assert_allclose(old.model.u, new.model.u, atol=1e-7 * np.abs(new.model.u).max())
    assert all(iterations[-1].residual <= 1e-9 for iterations in old.iterations if iterations)


def test_it_repeats_to_the_last_bit():
    np.testing.assert_array_equal(run(4.0).model.u, run(4.0).model.u)


def test_arcs_have_new_factors():
    model, move = plate()
    options = NewtonOptions(factor_cost=9.0)
    result = uf.solve(model, uf.Arc(move.control, to=5.0, increment=0.5), options=options, frames=0, progress=False)
    assert result.timing.factorisation.calls == result.timing.solve.calls


def test_a_negative_cost_is_refused():
    with pytest.raises(uf.UmformError, match="the cost of a factorisation relative to"):
        NewtonOptions(factor_cost=-1.0)
