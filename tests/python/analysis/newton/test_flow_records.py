"""Newton's method records the points of the material that begin or cease to flow."""

from __future__ import annotations

from itertools import pairwise

from umform.analysis.newton.newton import Newton


def test_newton_records_the_points_that_begin_or_cease_to_flow(build):
    """Two increments of a strip that yields as it is bent."""
    case = build.free_bending((8, 1))
    model, newton = case.model, Newton(case.model.system)
    seen = []
    newton.callbacks.append(lambda record: seen.append((record.switched, model.bodies.only.block.flowing.astype(bool))))
    for value in (-0.5, -1.0):
        case.punch.value = value
        before = model.bodies.only.block.state
        seen.clear()
        converged = newton.solve()
        model.system.commit(converged.evaluation)
        counts, flowing = zip(*seen, strict=True)
        assert list(counts[1:]) == [(a ^ b).sum() for a, b in pairwise(flowing)]
        assert max(counts) > 0
        changed_history = (model.bodies.only.block.state != before).any(axis=-1).ravel()
        assert (flowing[-1] == changed_history).all()
        assert 0 < changed_history.sum() < changed_history.size
        assert (converged.evaluation.flowing == flowing[-1]).all()  # the evaluation keeps what it found
        assert not model.bodies.only.block.flowing.any()  # committed: nothing has changed since


def test_a_law_without_history_does_not_flow(build):
    model, _ = build.bar()
    assert model.evaluate(model.u).flowing.size == 0
