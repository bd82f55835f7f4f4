"""Newton's method: its order, its purity, its line search, and how it gives up."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from one_unknown import Evaluated, OneUnknown

from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue
from umform.history_variables import history_of
from umform.mesh import strip
from umform.model import Model
from umform.model.terms.term import Border
from umform.results.records import Cause, Failed

ELEMENTS = ("DISP3D", "ANS3DEAS", "EAS3DEAS", "MI9K3DEAS")


def block(element, law):
    """A thick block clamped at x0, bent and twisted by a force at x1."""
    made = strip(2.0, 1.0, 0.6, (2, 1), cell="hex18" if "9K" in element else "hex8")
    model = Model(made, element, material=law)
    model.fix("x0")
    return model, model.traction("x1", (0.3, 0.2, 1.0))


# Order of convergence ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("law", [mt.SVK(E=100.0, nu=0.3), mt.NeoHooke(E=100.0, nu=0.3)], ids=["svk", "neo-hooke"])
def test_convergence_is_quadratic_at_large_displacements(element, law):
    model, load = block(element, law)
    solve(model, Move(load, 4.0, steps=8), frames=0)
    assert np.abs(model.u).max() > 0.8
    converged = model.u.copy()
    load.value = 5.0
    norms = [it.residual for it in Newton(model.system, NewtonOptions(residual=1e-12, mixed=False)).solve().iterations]
    np.testing.assert_array_equal(model.u, converged)  # Newton alone commits nothing
    asymptotic = [n for n in norms if 1e-12 < n < 0.1]
    assert len(asymptotic) >= 3
    orders = [
        math.log(c / b) / math.log(b / a) for a, b, c in zip(asymptotic, asymptotic[1:], asymptotic[2:], strict=False)
    ]
    assert max(orders) > 1.8
    assert norms[-1] < 1e-10


def test_convergence_is_quadratic_in_a_plastic_step(build):
    case = build.free_bending((8, 1), thickness_points=5)
    solve(case.model, Move(case.punch, -2.0, steps=8), frames=0)
    assert (history_of(case.model.bodies.only.block)["eqps"] > 0).any()
    case.punch.value = -2.05
    records = Newton(case.model.system, NewtonOptions(residual=1e-12)).solve().iterations
    quiet = [r.residual for r in records if r.entered == r.left == 0 and r.residual > 1e-11]
    assert len(records) <= 10
    assert quiet[-1] < 1e3 * quiet[-2] ** 1.6


def test_a_linear_problem_takes_one_correction():
    model, load = block("ANS3DEAS", mt.SVK(E=100.0, nu=0.3))
    load.value = 1e-9
    records = Newton(model.system).solve().iterations
    assert records[0].residual < 1e-7
    assert len(records) <= 2


# Purity -----------------------------------------------------------------------------------------------------


@pytest.fixture
def plastic(build):
    """A strip bent into plasticity with contact, and a displacement to evaluate at."""
    case = build.free_bending((8, 1), "EAS3DEAS")
    solve(case.model, Move(case.punch, -1.5, steps=6), frames=0)
    u = case.model.u + 1e-3 * np.random.default_rng(0).normal(size=case.model.u.size)
    return SimpleNamespace(**vars(case), u=u)


def state_of(model):
    return (
        model.u.copy(),
        model.bodies.only.block.state,
        model.bodies.only.block.alpha,
        model.system.time,
        [c.value for c in model.controls],
    )


@pytest.fixture
def assert_same(same_state):
    def check(one, other):
        assert same_state(one, other)

    return check


def numbers(evaluation):
    return evaluation.residual, evaluation.values, evaluation.predictor, evaluation.force_scale, evaluation.failed


def test_evaluation_is_pure(plastic, assert_same):
    model, u = plastic.model, plastic.u
    before = state_of(model)
    first = numbers(model.evaluate(u, np.ones(u.size)))
    model.evaluate(model.u)
    model.evaluate(2 * u)
    assert_same(numbers(model.evaluate(u, np.ones(u.size))), first)
    assert_same(state_of(model), before)


def test_predictor_is_the_tangent_times_the_increment(plastic, build, rng):
    model = plastic.model
    du = np.zeros(plastic.u.size)
    du[model.system.free] = rng.normal(size=len(model.system.free))
    evaluation = model.evaluate(plastic.u, du)
    K = build.dense(model.system.pattern, evaluation.values)
    np.testing.assert_allclose(
        evaluation.predictor[model.system.free], K @ du[model.system.free], atol=1e-11 * np.abs(K).max()
    )


def test_tangent_of_a_whole_model_is_the_derivative_of_its_residual(plastic, build, rng):
    """With contact and prescribed displacements; the parameters are held, so without enhanced modes."""
    case = build.free_bending((8, 1), "DISP3D", material=mt.NeoHooke(kappa=175e3, mu=80.77e3))
    solve(case.model, Move(case.punch, -1.0, steps=4), frames=0)
    model, u = case.model, case.model.u
    evaluation = model.evaluate(u)
    K = build.dense(model.system.pattern, evaluation.values)
    assert evaluation.active.any()
    du = np.zeros(u.size)
    du[model.system.free] = rng.normal(size=len(model.system.free))
    slope = build.central_difference(lambda v: model.evaluate(v).residual[model.system.free], u, du, 1e-6)
    assert build.relative_error(K @ du[model.system.free], slope) < 1e-7


def test_shorten_and_revert_leave_no_trace(plastic, assert_same):
    model, u = plastic.model, plastic.u
    clean = numbers(model.evaluate(u))
    before = state_of(model)
    model.system.recover(1e-3 * u)
    assert not np.array_equal(model.evaluate(u).residual, clean[0])
    model.system.shorten(0.0)
    assert_same(numbers(model.evaluate(u)), clean)
    for _ in range(3):
        model.system.recover(1e-3 * u)
        model.evaluate(u)
    model.system.revert()
    assert_same(numbers(model.evaluate(u)), clean)
    assert_same(state_of(model), before)


def test_a_restored_snapshot_repeats_the_run_bit_by_bit(plastic, assert_same):
    model = plastic.model
    saved = model.system.snapshot()
    clean = numbers(model.evaluate(plastic.u))

    def go_on():
        solve(model, Move(plastic.punch, -2.0, steps=3), frames=0)
        return state_of(model)

    first = go_on()
    model.system.restore(saved)
    sheet = saved.terms["body sheet"]
    controls = list(saved.controls.values())
    assert_same(state_of(model), (saved.u, sheet["history"], sheet["alpha"], saved.time, controls))
    assert_same(model.system.snapshot(), saved)
    assert_same(numbers(model.evaluate(plastic.u)), clean)
    model.system.restore(saved)
    assert_same(go_on(), first)


def test_the_same_run_twice_gives_the_same_bits(build, assert_same):
    def run():
        case = build.free_bending((8, 1))
        result = solve(case.model, Move(case.punch, -1.5, steps=5), frames=0)
        return case.model.u, result["punch_force"]

    assert_same(run(), run())


@pytest.mark.parametrize("element", ["ANS3DEAS", "MI9K3DEAS"])
def test_a_load_that_is_taken_away_leaves_nothing_to_iterate_on(build, element):
    model, tip = build.cantilever(element=element)
    result = solve(model, [Move(tip, 1.0, steps=2), Move(tip, 0.0, steps=2)], frames=0)
    assert np.abs(model.u).max() <= np.finfo(float).eps * model.system.extent
    assert result["iterations"][-1] <= 10


# Line search ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("element", ["ANS3DEAS", "EAS3DEAS", "MI9K3DEAS"])
def test_line_search_reaches_the_same_solution(build, element):
    """Also where increments were shortened, and the enhanced parameters put back in between."""

    def run(line_search):
        model, tip = build.cantilever(1.0, element=element)
        tip.value = 1.0
        converged = Newton(model.system, NewtonOptions(line_search=line_search, residual=1e-11, mixed=False)).solve()
        model.system.commit(converged.evaluation)
        return model, [it.step_length for it in converged.iterations]

    (searched, lengths), (plain, full) = run(True), run(False)
    assert min(lengths) < 1.0
    assert full == [1.0] * len(full)
    np.testing.assert_allclose(searched.u, plain.u, atol=1e-9)
    np.testing.assert_allclose(searched.bodies.only.block.alpha, plain.bodies.only.block.alpha, atol=1e-9)


def test_line_search_of_a_thin_strip_does_not_creep():
    """All of a large load at once on a strip as thin as a hundredth of its length: its energy is a narrow valley."""

    def run(line_search):
        model = Model(strip(10.0, 1.0, 0.1, (6, 1)), "ANS3DEAS", material=mt.SVK(E=1.2e6, nu=0.0))
        model.fix("x0")
        tip = model.line_load("x1", "lower", (0.0, 0.0, 1.0))
        options = NewtonOptions(line_search=line_search, max_iterations=40, mixed=False)
        result = solve(model, Move(tip, 4.0, steps=1, cuts=0), options=options, frames=0)
        return model.u, [it.step_length for it in result.iterations[-1]]

    (searched, lengths), (plain, _) = run(True), run(False)
    assert min(lengths) < 1.0
    np.testing.assert_allclose(searched, plain, atol=1e-7)


class Scalar(OneUnknown):
    """Residual and slope are functions of x, the active set a function of x."""

    def __init__(self, residual, slope, start=0.0, active=lambda x: [], scale=1.0):
        super().__init__(start)
        self.residual, self.slope, self.active, self.scale = residual, slope, active, scale
        self.calls, self.kept = [], []

    def evaluate(self, x, du=None, *, tangent=True, keep=False):
        at = float(x[0])
        self.calls.append("evaluate" if tangent else "forces")
        self.kept.append(keep)
        return Evaluated(
            x=x, residual=np.array([self.residual(at)]), values=np.array([self.slope(at)]), predictor=np.zeros(1),
            force_scale=self.scale, failed=4 if abs(at) > 1e6 else -1, failure="is out of its domain", round_off=0.0,
            status=np.array(self.active(at), dtype=np.uint8), flowing=np.zeros(0, dtype=np.uint8),
            border=Border.of((), 1), kept=keep,
            at_points=lambda chosen: f": {int(chosen.sum())} points",
        )  # fmt: skip

    def recover(self, du, mixed=False):
        self.calls.append("recover")

    def shorten(self, part):
        self.calls.append("shorten")

    def commit(self, evaluation):
        self.calls.append("commit")

    def revert(self):
        self.calls.append("revert")


def arc_tangent(start):
    return Scalar(math.atan, lambda x: 1 / (1 + x * x), start)


def test_no_state_converges_with_points_that_are_kept():
    system = arc_tangent(0.0)  # in equilibrium from the beginning
    kept = Newton(system).solve(None, np.zeros(1), keep=True)
    assert len(kept.iterations) == 2
    assert not kept.evaluation.kept
    assert len(Newton(system).solve(None, np.zeros(1)).iterations) == 1


def test_kept_points_stay_kept_while_the_line_search_shortens_their_correction():
    """A part of the correction leaves them open."""
    system = arc_tangent(3.0)
    converged = Newton(system, NewtonOptions(line_search=True)).solve(None, np.full(1, -9.5), keep=True)
    assert abs(converged.x[0]) < 1e-6
    shortened = [record.step_length < 1.0 for record in converged.iterations]
    assert True in shortened and not shortened[-1]
    # The predictor keeps them, and each trial; a correction at full length does not, and after it none.
    assert system.kept[0] and not system.kept[1] and system.kept[2]
    last = len(system.kept) - system.kept[::-1].index(True)
    assert system.calls[: system.calls.index("shorten")].count("evaluate") == 2
    assert not any(system.kept[last:]) and len(system.kept) > last


def test_a_sheet_that_springs_back_is_solved_like_an_elastic_one():
    newton = Newton(arc_tangent(3.0))
    assert (newton.mode().mixed, newton.mode().line_search) == (False, True)
    newton = newton.but(springs_back=True)
    assert (newton.mode().mixed, newton.mode().line_search) == (True, False)
    assert newton.mode(friction=True).line_search
    newton.options = NewtonOptions(mixed=False, line_search=True)
    assert (newton.mode().mixed, newton.mode().line_search) == (False, True)


def test_line_search_tames_a_step_that_diverges_without():
    with pytest.raises(Failed):
        Newton(arc_tangent(3.0), NewtonOptions(max_iterations=20, line_search=False)).solve()
    system = arc_tangent(3.0)
    # The first increment is that of the predictor and never shortened: from 3 it lands at -9.5.
    converged = Newton(system, NewtonOptions(line_search=True)).solve()
    assert abs(converged.x[0]) < 1e-6
    assert min(record.step_length for record in converged.iterations) < 1.0


def test_a_shorter_increment_costs_one_evaluation_and_none_where_the_full_one_will_do():
    system = arc_tangent(3.0)
    converged = Newton(system, NewtonOptions(line_search=True)).solve()
    recoveries, trials = system.calls.count("recover"), system.calls.count("shorten")
    assert trials >= 1
    assert recoveries == len(converged.iterations)
    # One evaluation for the predictor, one for each increment, one for each shorter one.
    assert system.calls.count("evaluate") == 1 + recoveries + trials
    assert "forces" not in system.calls
    at = system.calls.index("shorten")
    assert system.calls[at - 2 : at + 2] == ["recover", "evaluate", "shorten", "evaluate"]


def test_an_increment_out_of_the_domain_of_a_law_is_shortened_to_a_quarter():
    """From 1 the full increment leads to -1e7; beyond 1e6 there is no residual."""
    system = Scalar(lambda x: 1.0 if x == 2.0 else x, lambda x: 1e-7 if x == 1.0 else 1.0, start=2.0)
    with pytest.raises(Failed, match="cell 4"):
        Newton(system, NewtonOptions(line_search=False)).solve()
    converged = Newton(system, NewtonOptions(line_search=True)).solve()
    assert abs(converged.x[0]) < 1e-6
    assert 1 / 64 in [record.step_length for record in converged.iterations]


def test_by_default_there_is_a_line_search_where_a_law_has_a_history():
    plastic, elastic = arc_tangent(3.0), arc_tangent(3.0)
    elastic.elastic = True
    assert [Newton(system).mode().line_search for system in (plastic, elastic)] == [True, False]
    assert not Newton(plastic, NewtonOptions(line_search=False)).mode().line_search
    assert Newton(elastic, NewtonOptions(line_search=True)).mode().line_search


# Giving up --------------------------------------------------------------------------------------------------


def test_a_cycle_of_contact_that_stays_ends_the_iterations():
    """Out of touch it is pulled in, in touch it is pushed out: no equilibrium."""
    system = Scalar(lambda x: x + 1 if x >= 0 else x - 1, lambda x: 1.0, 1.0, lambda x: [x < 0, True])
    with pytest.raises(Failed, match="comes and goes in a cycle: 1 points") as caught:
        Newton(system, NewtonOptions(line_search=False)).solve()
    assert caught.value.cause is Cause.CYCLE
    assert 6 <= len(caught.value.iterations) <= 10
    assert {(record.entered, record.left) for record in caught.value.iterations[1:4]} == {(1, 0), (0, 1)}
    assert system.calls[-1] == "revert"


def test_a_cycle_of_contact_is_broken_by_half_an_increment():
    """Stiff in touch, soft out of touch: full increments lead from -3 to 3 and back, half of one to the equilibrium."""
    system = Scalar(
        lambda x: 1.0 if x > 2.0 else -1.0 if x < -2.0 else x, lambda x: 1 / 6 if abs(x) > 2.0 else 1.0, 9.0,
        lambda x: [x < 0],
    )  # fmt: skip
    converged = Newton(system, NewtonOptions(line_search=False)).solve()
    assert abs(converged.x[0]) < 1e-6
    lengths = [record.step_length for record in converged.iterations]
    assert lengths.count(0.5) == 1
    assert len(lengths) <= 8


def test_a_cycle_of_three_states_ends_the_iterations_too():
    """From 1 to 2 to 3 and back to 1."""
    system = Scalar(
        lambda x: (2.0, -1.0, -1.0)[round(x) % 3], lambda x: 1.0, 1.0, lambda x: [round(x) % 3 == k for k in range(3)]
    )
    system.smooth = True  # else the residual, which does not fall, ends them sooner
    with pytest.raises(Failed, match="comes and goes in a cycle") as caught:
        Newton(system, NewtonOptions(line_search=False)).solve()
    assert caught.value.cause is Cause.CYCLE


def test_a_residual_that_does_not_fall_ends_the_search():
    """Pushed on for ever with the same force."""
    system = Scalar(lambda x: -1.0 - 1e-9 * x, lambda x: 1.0)
    with pytest.raises(Failed, match="has not fallen for 8 iterations") as caught:
        Newton(system, NewtonOptions(line_search=True)).solve()
    assert caught.value.cause is Cause.STALL
    assert len(caught.value.iterations) == 8


def test_an_active_set_that_alternates_while_the_residual_falls_is_not_chattering():
    """An overshooting slope: the point goes in and out, but each time less."""
    system = Scalar(lambda x: x - 5.0, lambda x: 0.7, 6.0, lambda x: [x < 5.0])
    converged = Newton(system, NewtonOptions(max_iterations=60)).solve()
    assert converged.x[0] == pytest.approx(5.0, abs=1e-6)
    assert any(record.entered for record in converged.iterations)


def test_a_step_that_does_not_end_fails_with_its_records():
    seen = []
    system = Scalar(lambda x: math.exp(-x), lambda x: -math.exp(-x))
    newton = Newton(system, NewtonOptions(max_iterations=7, residual=1e-12))
    newton.callbacks.append(seen.append)
    with pytest.raises(Failed, match="no convergence in 7 iterations") as caught:
        newton.solve()
    assert caught.value.cause is Cause.ITERATIONS
    assert [record.number for record in caught.value.iterations] == list(range(1, 8))
    assert seen == caught.value.iterations
    assert system.calls[-1] == "revert"
    assert "commit" not in system.calls


def test_a_strain_outside_of_the_domain_names_its_cell():
    system = Scalar(lambda x: 1e9, lambda x: 1.0)
    with pytest.raises(Failed, match="cell 4 "):
        Newton(system).solve()


@pytest.mark.parametrize("residual", [math.nan, math.inf])
def test_a_residual_that_is_not_finite_fails(residual):
    system = Scalar(lambda x: 1.0 if x == 0 else residual, lambda x: 1.0)
    with pytest.raises(Failed, match="not finite"):
        Newton(system).solve()


def test_a_singular_tangent_fails():
    system = Scalar(lambda x: 1.0, lambda x: 0.0)
    with pytest.raises(Failed):
        Newton(system).solve()
    assert system.calls[-1] == "revert"


@pytest.mark.parametrize("error", [RuntimeError("broken"), KeyboardInterrupt("stop")])
def test_whatever_ends_the_iterations_the_system_is_reverted(error):
    def residual(x):
        if system.calls.count("evaluate") > 3:
            raise error
        return math.exp(-x)

    system = Scalar(residual, lambda x: -math.exp(-x))
    with pytest.raises(type(error)) as caught:
        Newton(system).solve()
    assert caught.value is error
    assert system.calls[-2:] == ["evaluate", "revert"]


@pytest.mark.parametrize(
    "options",
    [{"residual": 0.0}, {"residual": math.nan}, {"increment": -1.0}, {"max_iterations": 0}],
)
def test_options_that_make_no_sense_are_refused(options):
    with pytest.raises(InvalidValue):
        NewtonOptions(**options)
