"""Terms that are written in Python: assembly, history, checkpoints, balance, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.run import resume, solve
from umform.analysis.steps import Move
from umform.errors import FileProblem, InvalidValue, NotFinite, RigidBodyMotion
from umform.history_variables import named
from umform.mesh import strip
from umform.model import Connectivity, Model, NodalTerm, Term
from umform.model.terms.term import Energies, Found

STEEL = mt.SVK(E=210e3, nu=0.3)


class Foam(NodalTerm):
    """Springs along z that are crushed for good beyond a force, which grows with the crush."""

    def __init__(self, nodes, stiffness, name="foam"):
        super().__init__(name, nodes, history={"crush": 1})
        self.stiffness = stiffness

    def respond(self, u, history, at):
        k, slope, crush = self.stiffness, 1.0, named(history, self.history_variables)["crush"][:, 0]
        beyond = np.maximum(-k * (u[:, 2] - crush) - 0.4 + slope * crush, 0.0)
        crush = crush - beyond / (k + slope)
        forces, tangents = np.zeros((len(u), 3)), np.zeros((len(u), 3, 3))
        forces[:, 2] = k * (u[:, 2] - crush)
        tangents[:, 2, 2] = np.where(beyond > 0.0, k * slope / (k + slope), k)
        return forces, tangents, crush[:, None]

    def energy(self, u, history):
        crush = named(history, self.history_variables)["crush"][:, 0]
        return 0.5 * self.stiffness * (u[:, 2] - crush) ** 2, 0.5 * crush**2 - 0.4 * crush


class Links(Term):
    """Springs between nodes, and a spring between each of them and the ground: two kinds of parts."""

    name = "links"

    def __init__(self, pairs, stiffness):
        self.pairs, self.singles, self.stiffness = (
            pairs.astype(np.int32),
            pairs.astype(np.int32).reshape(-1, 1),
            stiffness,
        )

    def couples(self):
        return Connectivity(self.pairs), Connectivity(self.singles)

    def evaluate(self, at, into):
        squares = 0.0
        for kind, nodes in enumerate((self.pairs, self.singles)):
            one = np.array([[1.0, -1.0], [-1.0, 1.0]]) if kind == 0 else np.ones((1, 1))
            stiffness = self.stiffness * np.einsum("ab,kl->akbl", one, np.eye(3))
            forces = np.einsum("akbl,ebl->eak", stiffness, at.u.reshape(-1, 3)[nodes])
            into.add(self, nodes, forces, np.tile(stiffness, (len(nodes), 1, 1, 1, 1)), at, kind)
            squares += float((forces**2).sum())
        return Found(squares)

    def energies(self, found, u):
        x = u.reshape(-1, 3)[self.pairs]
        length = np.sum((x[:, 1] - x[:, 0]) ** 2)
        return Energies(0.5 * self.stiffness * float(length + np.sum(x**2)))


def bedded(stiffness=8.0, element="ANS3DEAS", material=STEEL):
    """A strip on foam, which alone holds it against falling and tilting."""
    mesh = strip(20.0, 4.0, 0.5, (8, 2))
    model = Model(mesh, element, material=material)
    model.fix("x0_lower", "x")
    model.fix("y0_lower", "y")
    foam = model.add(Foam(mesh.nodes("lower"), stiffness))
    weight = model.line_load("x1", "upper", (0.0, 0.0, -1.0), "weight")
    return model, foam, weight


def derivative(model, x, direction, step=1e-6):
    """Rate of the residual by differences."""
    ahead, behind = (model.evaluate(x + sign * step * direction, tangent=False).residual for sign in (1.0, -1.0))
    return (ahead - behind) / (2.0 * step)


@pytest.mark.parametrize("kind", ["nodal", "links"])
def test_tangent_and_predictor_are_derivatives(kind, rng):
    model, foam, _ = bedded(element="DISP3D", material=mt.SVK(E=10.0, nu=0.3))  # no enhanced modes, as soft as foam
    if kind == "links":
        model.add(Links(np.stack([model.mesh.nodes("x0_lower"), model.mesh.nodes("x1_lower")], axis=1), 30.0))
    x = 1e-2 * rng.normal(size=model.u.size)
    x.reshape(-1, 3)[foam.nodes, 2] -= 0.05  # some nodes beyond their limit, none near it
    q = rng.normal(size=model.system.pattern.n)
    evaluation = model.evaluate(x)
    K = np.zeros((model.system.pattern.n, model.system.pattern.n))
    K[model.system.pattern.rows, model.system.pattern.indices] = evaluation.values
    K = np.triu(K) + np.triu(K, 1).T
    expected = model.system.restrict(derivative(model, x, model.system.extend(q)))
    np.testing.assert_allclose(K @ q, expected, atol=1e-6 * np.abs(expected).max())
    du = rng.normal(size=x.size)
    predictor = model.evaluate(x, du).predictor
    along = derivative(model, x, du)
    np.testing.assert_allclose(predictor, along, atol=1e-6 * np.abs(along).max())


def test_the_foundation_alone_holds_the_sheet_and_carries_the_load():
    model, foam, weight = bedded()
    result = solve(model, [Move(weight, 4.0, steps=8), Move(weight, 0.0, steps=4)])
    assert foam.history.min() < -0.1  # crushed
    balance = result.balance()
    assert balance.force_imbalance[1:].max() < 1e-9
    assert balance.moment_imbalance[1:].max() < 1e-9
    assert abs(balance.drift[-1]) < 0.02  # of increments; crushed foam has spent the work, none of it came from outside
    assert balance.plastic[-1] > 0.3
    other = Model(model.mesh, material=STEEL)
    other.fix("x0_lower", "x")
    other.fix("y0_lower", "y")
    with pytest.raises(RigidBodyMotion):
        solve(other, Move(other.line_load("x1", "upper", (0.0, 0.0, -1.0)), 1.0))


def test_an_evaluation_leaves_the_history_as_it_was(rng):
    model, foam, _ = bedded()
    x = 0.2 * rng.normal(size=model.u.size)
    evaluation = model.evaluate(x)
    assert not foam.history.any()
    assert evaluation.found[foam].history.any()
    assert evaluation.flowing.size == len(foam.nodes)
    before = model.system.snapshot()
    model.system.commit(evaluation)
    np.testing.assert_array_equal(foam.history, evaluation.found[foam].history)
    model.system.restore(before)
    assert not foam.history.any()


class Stop(Exception):
    """The end of a run in its middle."""


#: Part of the step at which the load ends the run.
END = {"at": 2.0}


def load(fraction):
    """Way of the load."""
    if fraction > END["at"]:
        raise Stop
    return 4.0 * fraction


def run(how, model, weight, *where, **options):
    """Loading and unloading."""
    return how(*where, model, [Move(weight, load, steps=8), Move(weight, 0.0, steps=2)], **options)


def test_a_run_that_was_stopped_goes_on_with_the_same_bits(tmp_path, monkeypatch):
    model, foam, weight = bedded()
    whole = run(solve, model, weight)
    file = tmp_path / "run.chk.h5"
    stopped, same, weight = bedded()
    monkeypatch.setitem(END, "at", 0.6)
    with pytest.raises(Stop):
        run(solve, stopped, weight, checkpoint=file, every=0.0)
    assert foam.history.min() < same.history.min() < 0.0
    monkeypatch.undo()
    again, third, weight = bedded()
    result = run(resume, again, weight, file)
    np.testing.assert_array_equal(again.u, model.u)
    np.testing.assert_array_equal(third.history, foam.history)
    for column in whole.columns():
        np.testing.assert_array_equal(result[column], whole[column], err_msg=column)


@pytest.mark.parametrize("same", [True, False])
def test_another_foundation_is_refused(same, tmp_path):
    model, _, weight = bedded()
    file = tmp_path / "run.chk.h5"
    solve(model, Move(weight, 1.0, steps=2), checkpoint=file, every=0.0)
    other, _, weight = bedded(8.0 if same else 9.0)
    if same:
        resume(file, other, Move(weight, 1.0, steps=2))
        np.testing.assert_array_equal(other.u, model.u)
        return
    with pytest.raises(FileProblem) as caught:
        resume(file, other, Move(weight, 1.0, steps=2))
    assert "other terms" in caught.value.value


def test_what_makes_no_sense_is_refused():
    model, foam, _ = bedded()
    with pytest.raises(InvalidValue, match="the name of a term is taken"):
        model.add(Foam(foam.nodes, 1.0))
    with pytest.raises(InvalidValue, match="does not exist"):
        model.add(Foam([0, len(model.mesh.points)], 1.0, "far"))
    with pytest.raises(InvalidValue, match="a row of numbers"):
        Foam(np.ones((2, 2)), 1.0)
    assert model.system.others == [foam]


class Damper(NodalTerm):
    """Forces by the velocity: the history has the displacement of the step before."""

    def __init__(self, nodes, viscosity):
        super().__init__("damper", nodes, history={"before": 3, "work": 1})
        self.viscosity = viscosity

    def respond(self, u, history, at):
        before, work = named(history, self.history_variables).values()
        rate = self.viscosity / at.step if at.step else 0.0
        forces = rate * (u - before)
        work = work + np.sum(forces * (u - before), axis=1, keepdims=True)
        return forces, np.tile(rate * np.eye(3), (len(u), 1, 1)), np.hstack([u, work])

    def energy(self, u, history):
        return 0.0, named(history, self.history_variables)["work"][:, 0]


def test_forces_that_vanish_with_the_commit_are_in_balance():
    mesh = strip(20.0, 4.0, 0.5, (8, 2))
    model = Model(mesh, material=STEEL)
    model.fix("x0")
    damper = model.add(Damper(mesh.nodes("x1"), 5.0))
    pull = model.line_load("x1", "upper", (0.0, 0.0, -1.0), "pull")
    result = solve(model, Move(pull, 1.0, steps=10))
    assert damper.history[:, 3].min() > 0.0
    assert result.balance().force_imbalance.max() < 1e-9


def alike(u):
    return 5.0 * u, np.tile(5.0 * np.eye(3), (len(u), 1, 1))


def turning(u):
    """Forces without a potential."""
    K = np.array([[5.0, 1.0, 0.0], [-1.0, 5.0, 0.0], [0.0, 0.0, 5.0]])
    return u @ K.T, np.tile(K, (len(u), 1, 1))


class Loop(NodalTerm):
    """A term whose answer is that of a function of displacements and history."""

    def __init__(self, nodes, answer, symmetric=True):
        super().__init__("own", nodes, history={"loops": 2})
        self.answer, self.symmetric = answer, symmetric

    def respond(self, u, history, at):
        return self.answer(u, history)


def added(answer, **options):
    mesh = strip(20.0, 4.0, 0.5, (8, 2))
    model = Model(mesh, material=STEEL)
    model.fix("x0")
    return model, model.add(Loop(mesh.nodes("x1"), answer, **options))


@pytest.mark.parametrize(
    ("answer", "kind", "said"),
    [
        (lambda u, h: alike(u), InvalidValue, "respond of a term must return 3 arrays"),
        (lambda u, h: [*alike(u), h], InvalidValue, "respond of a term must return 3 arrays"),
        (lambda u, h: (u[:, 0], alike(u)[1], h), InvalidValue, r"forces of a term must have shape \(6, 3\)"),
        (lambda u, h: (u, np.eye(3), h), InvalidValue, r"tangents of a term must have shape \(6, 3, 3\)"),
        (lambda u, h: (*alike(u), h[:, :1]), InvalidValue, r"history of a term must have shape \(6, 2\)"),
        (lambda u, h: (np.nan * u, alike(u)[1], h), NotFinite, "forces of a term must be finite"),
        (lambda u, h: (*turning(u), h), InvalidValue, "the tangent of a term is not symmetric"),
    ],
)
def test_a_wrong_answer_names_the_term(answer, kind, said):
    model, _ = added(answer)
    with pytest.raises(kind, match=said) as caught:
        model.evaluate(model.u)
    assert "Loop('own')" in caught.value.where


def test_an_unsymmetric_tangent_that_is_meant_is_taken(rng):
    model, _ = added(lambda u, h: (*turning(u), h), symmetric=False)
    model.evaluate(1e-3 * rng.normal(size=model.u.size))
    assert not model.system.pattern.symmetric


def test_an_error_of_a_term_names_it_and_the_call():
    def crush(u, history):
        history += 1.0
        return (*alike(u), history)

    for answer, kind in ((lambda u, h: 1 / 0, ZeroDivisionError), (crush, ValueError)):
        model, own = added(answer)
        with pytest.raises(kind) as caught:
            model.evaluate(model.u)
        assert "in the term Loop('own'), called as respond(u, history, at)" in caught.value.__notes__[0]
        assert not own.history.any()


@pytest.mark.parametrize("energy", [3.0, (np.zeros(2), 0.0)])
def test_energies_of_another_shape_are_refused(energy, monkeypatch):
    monkeypatch.setattr(Loop, "energy", lambda self, u, history: energy)
    model, _ = added(lambda u, h: (*alike(u), h))
    tip = model.prescribe("x1", "z", "tip")
    with pytest.raises(InvalidValue, match="energy of a term must"):
        solve(model, Move(tip, 0.1, steps=1))


@pytest.mark.parametrize(("named", "written"), [([], {"tip": 7.0}), (["own_force"], {})])
def test_columns_that_a_term_has_not_named_are_refused(named, written, monkeypatch):
    """Without this, the column of the control would have the number of the term."""
    monkeypatch.setattr(Loop, "column_names", lambda self: named)
    monkeypatch.setattr(Loop, "columns", lambda self, found, ranks: written)
    model, _ = added(lambda u, h: (*alike(u), h))
    tip = model.prescribe("x1", "z", "tip")
    with pytest.raises(InvalidValue, match="must write the columns that it names"):
        solve(model, Move(tip, 0.1, steps=1))
