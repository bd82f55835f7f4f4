"""Laws of the user: what they must return, how their errors travel, and what becomes of their history."""

from __future__ import annotations

import math

import numpy as np
import pytest

import umform
from umform import materials as mt
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue, NoConvergence, NotFinite
from umform.materials import UserLaw, check_law
from umform.mesh import strip
from umform.model import Model

LAME, MU = 600.0, 400.0
C = np.diag([2 * MU] * 3 + [MU] * 3) + LAME * np.outer([1, 1, 1, 0, 0, 0], [1, 1, 1, 0, 0, 0])
ENERGY = 10.0  # at which the damage has come to 1 - 1/e of its end


def hooke(E, state):
    return E @ C, np.tile(C, (len(E), 1, 1)), state


def damage(E, state):
    """The largest energy so far takes up to half of the stiffness; it does not heal."""
    S = E @ C
    energy = 0.5 * (E * S).sum(axis=1)
    before = state.ravel()  # its only number
    largest = np.maximum(energy, before)
    left = 0.5 + 0.5 * np.exp(-largest / ENERGY)
    slope = np.where(energy > before, -0.5 / ENERGY * np.exp(-largest / ENERGY), 0.0)
    CC = left[:, None, None] * C + slope[:, None, None] * S[:, :, None] * S[:, None, :]
    return left[:, None] * S, CC, largest[:, None]


class Watched:
    """The damage law with a hook before each call, which may raise or return something else."""

    def __init__(self):
        self.hook = None
        self.histories = []

    def __call__(self, E, state):
        self.histories.append(state.copy())
        answer = damage(E, state)
        return answer if self.hook is None else self.hook(answer)

    def after(self, calls, action):
        """Answer `calls` times as ever, then by the action."""
        first = len(self.histories)
        self.hook = lambda answer: answer if len(self.histories) - first <= calls else action(answer)


def pulled(law, cells=(2, 1)):
    """A bar between sliding planes, pulled at x1: one strain everywhere."""
    model = Model(strip(1.0, 0.5, 0.4, cells), "EAS3DEAS", material=law)
    for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(face, normal=normal)
    return model, model.prescribe("x1", "x", "pull")


@pytest.fixture
def watched():
    function = Watched()
    model, pull = pulled(UserLaw(function, initial=(0.0,), name="damage"))
    return function, model, pull


def raised(error):
    def action(answer):
        raise error

    return action


# What a law returns -----------------------------------------------------------------------------------------


def test_a_law_of_the_user_is_the_law_of_the_house(rng):
    house = mt.SVK(kappa=LAME + 2 / 3 * MU, mu=MU)
    E = 0.1 * rng.normal(size=(7, 6))
    for mine, theirs in zip(
        UserLaw(hooke).law().respond(E, np.zeros((7, 0))), house.law().respond(E, np.zeros((7, 0)))
    ):
        np.testing.assert_allclose(mine, theirs, rtol=1e-13, atol=1e-10)
    (one, pull), (other, control) = pulled(UserLaw(hooke)), pulled(house)
    result = solve(one, Move(pull, 0.2, steps=2), frames=0)
    expected = solve(other, Move(control, 0.2, steps=2), frames=0)
    np.testing.assert_allclose(result["pull_force"], expected["pull_force"], rtol=1e-12)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda S, CC, h: (S[:, :5], CC, h), r"S of a law must have shape \(\d+, 6\)"),
        (lambda S, CC, h: (S[:1], CC, h), r"S of a law must have shape \(\d+, 6\)"),
        (lambda S, CC, h: (S.T, CC, h), r"S of a law must have shape \(\d+, 6\)"),
        (lambda S, CC, h: (S, CC[0], h), r"CC of a law must have shape \(\d+, 6, 6\)"),
        (lambda S, CC, h: (S, CC.reshape(-1, 36), h), r"CC of a law must have shape \(\d+, 6, 6\)"),
        (lambda S, CC, h: (S, CC, h[:, 0]), r"state of a law must have shape \(\d+, 1\)"),
        (lambda S, CC, h: (S, CC, np.hstack([h, h])), r"state of a law must have shape \(\d+, 1\)"),
        (lambda S, CC, h: (S, CC), "three arrays"),
        (lambda S, CC, h: [S, CC, h], "three arrays"),
        (lambda S, CC, h: None, "three arrays"),
    ],
)
def test_wrong_shapes_are_refused(watched, spoil, message):
    function, model, pull = watched
    function.hook = lambda answer: spoil(*answer)
    with pytest.raises(InvalidValue, match=message) as caught:
        solve(model, Move(pull, 0.1, steps=1), frames=0)
    assert caught.value.where == "damage, cell 0"
    with pytest.raises(InvalidValue, match=message):
        model.bodies.only.material.law().respond(np.zeros((3, 6)), np.zeros((3, 1)))


@pytest.mark.parametrize("value", [math.nan, math.inf])
@pytest.mark.parametrize(("which", "name"), [(0, "S"), (1, "CC"), (2, "state")])
def test_what_is_not_finite_is_refused(watched, which, name, value):
    function, model, _ = watched

    def spoil(answer):
        answer[which].flat[-1] = value
        return answer

    function.hook = spoil
    with pytest.raises(NotFinite, match=f"{name} of a law is not finite") as caught:
        model.evaluate(model.u)
    assert caught.value.where == "damage, cell 0"


def test_a_law_cannot_change_strain_or_history(watched):
    _, model, pull = watched
    result = solve(model, Move(pull, 0.2, steps=2), frames=0)

    def scribble(E, state):
        answer = [array.copy() for array in damage(E, state)]
        E[:], state[:] = 7.0, 7.0
        return tuple(answer)

    other, control = pulled(UserLaw(scribble, initial=(0.0,)))
    np.testing.assert_array_equal(
        solve(other, Move(control, 0.2, steps=2), frames=0)["pull_force"], result["pull_force"]
    )
    np.testing.assert_array_equal(other.bodies.only.block.state, model.bodies.only.block.state)


# Errors -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("calls", [0, 3, 7])
def test_nan_in_the_middle_of_a_run_ends_with_its_cause_at_the_last_converged_state(watched, calls, same_state):
    function, model, pull = watched
    solve(model, Move(pull, 0.1, steps=2), frames=0)
    before, residual = model.system.snapshot(), model.evaluate(model.u).residual
    function.after(calls + 2, lambda answer: (answer[0] * math.nan, *answer[1:]))  # 2 of the first evaluation
    with pytest.raises(NoConvergence) as caught:
        solve(model, Move(pull, 0.3, steps=1, cuts=2), frames=0)
    assert "S of a law is not finite" in caught.value.cause
    assert len(caught.value.result) == 1
    function.hook = None
    assert same_state(model.system.snapshot(), before)
    np.testing.assert_array_equal(model.evaluate(model.u).residual, residual)


def test_a_single_nan_costs_a_cut_and_leaves_no_trace_in_the_history(watched):
    function, model, pull = watched
    spoilt = []

    def once(answer):
        if not spoilt and answer[2].max() > 8.0:
            spoilt.append(answer[2].max())
            return answer[0] * math.nan, *answer[1:]
        return answer

    function.hook = once
    result = solve(model, [Move(pull, 0.2, steps=2), Move(pull, 0.05, steps=1)], frames=0)
    assert spoilt
    other, control = pulled(UserLaw(damage, initial=(0.0,)))
    same = [Move(control, value, steps=1) for value in result["pull"][1:]]
    expected = solve(other, same, frames=0)
    np.testing.assert_allclose(result["pull_force"], expected["pull_force"], rtol=1e-7)
    np.testing.assert_allclose(model.bodies.only.block.state, other.bodies.only.block.state, rtol=1e-7)


@pytest.mark.parametrize(("threads", "cells"), [(1, (2, 1)), (1, (12, 8)), (2, (12, 8)), (5, (12, 8))])
@pytest.mark.parametrize(
    "error", [RuntimeError("broken law", 7), KeyError("K"), InvalidValue("bad", value=3), KeyboardInterrupt("stop")]
)
def test_an_error_of_the_function_arrives_intact_at_the_last_converged_state(
    threads_as_before, threads, cells, error, same_state
):
    """Also out of a team of threads, which is sent out for more than 64 elements."""
    umform.set_threads(threads)
    function = Watched()
    model, pull = pulled(UserLaw(function, initial=(0.0,)), cells)
    elements = len(model.mesh.connectivity)
    solve(model, Move(pull, 0.1, steps=2), frames=0)
    before, residual = model.system.snapshot(), model.evaluate(model.u).residual
    assert model.bodies.only.block.state.max() > 0.1
    function.after(int(3.6 * elements), raised(error))  # in the middle of the third evaluation from the first one on
    with pytest.raises(type(error)) as caught:
        solve(model, Move(pull, 0.3, steps=2), frames=0)
    assert caught.value is error
    assert len(error.result) == 1
    assert error.result["pull"][-1] == 0.1
    function.hook = None
    assert same_state(model.system.snapshot(), before)
    assert pull.value == 0.1
    np.testing.assert_array_equal(model.evaluate(model.u).residual, residual)
    other, control = pulled(UserLaw(damage, initial=(0.0,)), cells)
    for m, c in ((model, pull), (other, control)):
        if m is other:
            solve(m, Move(c, 0.1, steps=2), frames=0)
        solve(m, Move(c, 0.3, steps=2), frames=0)
    np.testing.assert_array_equal(model.u, other.u)
    np.testing.assert_array_equal(model.bodies.only.block.state, other.bodies.only.block.state)


@pytest.mark.parametrize("spoilt", [0, 5, 17])
def test_an_error_of_the_function_says_its_cell(spoilt):
    """Of a team of threads too; the error stays what it was, with a note."""

    def moody(E, state):
        if E[0, 0] > 0.1:
            raise ArithmeticError("too much")
        return hooke(E, state)

    def bitter(E, state):
        if E[0, 0] > 0.1:
            raise NotFinite("too much", where="bitter")
        return hooke(E, state)

    for function in (moody, bitter):
        model, _ = pulled(UserLaw(function, name="moody"), (18, 1))
        u = np.zeros_like(model.mesh.points)
        right = model.mesh.points[:, 0] > (spoilt + 0.5) / 18
        u[right, 0] = 0.5 / 18
        with pytest.raises((ArithmeticError, NotFinite), match="too much") as caught:
            model.evaluate(u.ravel())
        if function is moody:
            (note,) = caught.value.__notes__
            assert note.startswith(
                f"in the law 'moody', cell {spoilt}, called as law(strain, history) -> stress (n, 6)"
            )
        else:
            assert caught.value.where == f"bitter, cell {spoilt}"


def test_an_error_of_the_energy_says_its_cell():
    def energy(E, state):
        raise ZeroDivisionError("nothing")

    model, _ = pulled(UserLaw(hooke, energy=energy, name="mine"))
    with pytest.raises(ZeroDivisionError) as caught:
        model.bodies.only.block.energy(model.u)
    assert caught.value.__notes__ == [
        "in the law 'mine', cell 0, called as energy(strain, history) -> elastic energy (n,), plastic work (n,)"
    ]


def test_the_number_of_threads_changes_no_bit(threads_as_before):
    def run(threads):
        umform.set_threads(threads)
        model, pull = pulled(UserLaw(damage, initial=(0.0,)), (12, 8))
        solve(model, Move(pull, 0.2, steps=2), frames=0, solver="superlu")
        return model.u, model.bodies.only.block.state

    for a, b in zip(run(1), run(2), strict=True):
        np.testing.assert_array_equal(a, b)


# History ----------------------------------------------------------------------------------------------------


def test_history_is_committed_with_the_increment_and_not_before(watched):
    """All calls of an increment are given the history of the last converged one, whatever they answered before."""
    function, model, pull = watched
    assert (model.bodies.only.block.state == 0.0).all()
    solve(model, Move(pull, 0.1, steps=1), frames=0)
    assert all((history == 0.0).all() for history in function.histories)
    converged = model.bodies.only.block.state
    assert converged.min() > 0.1
    function.histories.clear()
    model.evaluate(2.0 * model.u)
    model.system.revert()
    np.testing.assert_array_equal(model.bodies.only.block.state, converged)
    solve(model, Move(pull, 0.2, steps=1), frames=0)
    for history in function.histories:
        assert any(np.array_equal(history, of_cell.reshape(history.shape)) for of_cell in converged)
    assert (model.bodies.only.block.state > converged).all()


def test_damage_stays_when_the_load_goes(watched):
    _, model, pull = watched
    result = solve(model, [Move(pull, 0.1, steps=4), Move(pull, 0.02, steps=4)], frames=0)
    damaged = model.bodies.only.block.state
    assert np.ptp(damaged) < 1e-9 * damaged.max()
    left = 0.5 + 0.5 * math.exp(-damaged.max() / ENERGY)
    fresh, control = pulled(UserLaw(hooke))
    expected = solve(fresh, [Move(control, 0.1, steps=4), Move(control, 0.02, steps=4)], frames=0)
    # The factor of the damage leaves the ratio of the strains alone, so that the elastic bar is its companion.
    np.testing.assert_allclose(result["pull_force"][4:], left * expected["pull_force"][4:], rtol=1e-8)
    solve(model, Move(pull, 0.1, steps=2), frames=0)
    np.testing.assert_allclose(model.bodies.only.block.state, damaged, rtol=1e-8)
    solve(model, Move(pull, 0.12, steps=2), frames=0)
    assert (model.bodies.only.block.state > 1.2 * damaged).all()


def test_a_snapshot_holds_the_history(watched, same_state):
    _, model, pull = watched
    solve(model, Move(pull, 0.1, steps=1), frames=0)
    saved = model.system.snapshot()
    first = solve(model, Move(pull, 0.2, steps=2), frames=0)["pull_force"]
    model.system.restore(saved)
    assert same_state(model.system.snapshot(), saved)
    np.testing.assert_array_equal(solve(model, Move(pull, 0.2, steps=2), frames=0)["pull_force"], first)


# The check --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("size", [0.02, 0.1])
def test_check_law_finds_a_right_tangent_right(rng, size):
    E = size * rng.normal(size=(10, 6))
    assert check_law(UserLaw(hooke), E) < 1e-8
    law = UserLaw(damage, initial=(0.0,))
    assert check_law(law, E) < 1e-7
    energy = 0.5 * (E * (E @ C)).sum(axis=1)[:, None]
    assert check_law(law, E, 0.8 * energy) < 1e-7  # loading
    assert check_law(law, E, 1.2 * energy) < 1e-7  # unloading
    assert check_law(mt.NeoHooke(E=1e3, nu=0.3), E) < 1e-7
    assert check_law(mt.J2(E=210e3, nu=0.3, hardening=mt.Linear(160.0, 500.0)), E) < 1e-6


def test_check_law_finds_a_wrong_tangent_wrong(rng):
    E = 0.1 * rng.normal(size=(10, 6))

    def secant(E, state):
        S, _, new = damage(E, state)
        left = 0.5 + 0.5 * np.exp(-new[:, 0] / ENERGY)
        return S, left[:, None, None] * C, new

    law = UserLaw(secant, initial=(0.0,))
    assert check_law(law, E) > 1e-2
    energy = 0.5 * (E * (E @ C)).sum(axis=1)[:, None]
    assert check_law(law, E, 1.2 * energy) < 1e-7  # the secant is the tangent of unloading
    assert check_law(UserLaw(lambda E, state: (E @ C, 1.01 * hooke(E, state)[1], state)), E) == pytest.approx(
        0.01 / 1.01, rel=1e-3
    )


@pytest.mark.parametrize(
    ("call", "said"),
    [
        (lambda: UserLaw(hooke(np.zeros((1, 6)), np.zeros((1, 0)))), "a function of strain and history"),
        (lambda: UserLaw(hooke, thickness_points=0), "thickness_points is a whole number"),
        (lambda: UserLaw(hooke, thickness_points=3.5), "thickness_points is a whole number"),
        (lambda: check_law(hooke, np.zeros((2, 6))), r"material law[\s\S]*UserLaw\(function\)"),
        (lambda: check_law(UserLaw(hooke), np.zeros(6)), r"shape \(n, 6\)"),
        (lambda: check_law(UserLaw(hooke), np.zeros((2, 3, 3))), r"shape \(n, 6\)"),
        (lambda: check_law(UserLaw(hooke), np.zeros((0, 6))), r"shape \(n, 6\)"),
        (lambda: UserLaw(hooke, state=["back_stress", "eqps"]), "names without sizes"),
        (lambda: UserLaw(hooke, state={"eqps": 1.0}), "parts of a history have one number or more"),
        (lambda: mt.LogarithmicSpace(hooke), r"material law[\s\S]*LogarithmicSpace"),
    ],
)
def test_what_is_no_law_is_refused_where_it_is_given(call, said):
    with pytest.raises(InvalidValue, match=said):
        call()
