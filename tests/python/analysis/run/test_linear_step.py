"""A linear step: one tangent, one factorisation; all that judges the answer are forces."""

from __future__ import annotations

import weakref

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.options import NewtonOptions
from umform.model import System


@pytest.fixture
def evaluations(monkeypatch):
    """Whether each evaluation of a model had a tangent."""
    tangents, evaluate = [], System.evaluate

    def counted(self, *arguments, tangent=True, **options):
        tangents.append(tangent)
        return evaluate(self, *arguments, tangent=tangent, **options)

    monkeypatch.setattr(System, "evaluate", counted)
    return tangents


def run(force=1e-9, steps=1, element="ANS3DEAS", **options):
    cell = uf.elements.element(element).cell
    mesh = uf.mesh.strip(length=100.0, width=40.0, thickness=1.0, cells=(10, 4), cell=cell)
    model = uf.Model(mesh, element, material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    load = model.force(mesh.nodes("x1"), (0.0, 0.0, force), name="load")
    return uf.solve(model, uf.Move(load, to=1.0, steps=steps), options=NewtonOptions(**options), progress=False)


@pytest.mark.parametrize("element", ["DISP3D", "ANS3DEAS", "EAS3DEAS", "MI9K3DEAS"])
def test_a_linear_step_has_one_tangent(evaluations, element):
    lean = run(element=element)
    assert evaluations.count(True) == 1
    assert not evaluations[0]  # the start state is for the history
    assert lean.timing.factorisation.calls == 1
    full = run(element=element, line_search=True)  # which asks for the tangent at each state
    assert full.timing.factorisation.calls > 1
    size = np.abs(full.model.u).max()
    np.testing.assert_allclose(lean.model.u, full.model.u, atol=1e-9 * size)
    for name in ("external_work", "elastic_energy"):
        assert lean[name][-1] == pytest.approx(full[name][-1], rel=1e-9)


def test_a_step_that_is_not_linear_has_new_factors_in_each_iteration(evaluations):
    lean = run(force=0.5, steps=3, element="EAS3DEAS")
    assert evaluations.count(False) == 2  # the start state, and the end of the first tangent
    assert lean.timing.solve.calls == lean.timing.factorisation.calls + 3  # the tangent at the end of each increment
    full = run(force=0.5, steps=3, element="EAS3DEAS", line_search=True)
    np.testing.assert_allclose(lean.model.u, full.model.u, atol=1e-7 * np.abs(full.model.u).max())
    np.testing.assert_allclose(lean["elastic_energy"], full["elastic_energy"], rtol=1e-6)


def test_no_tangent_is_kept_while_the_next_one_is_evaluated(monkeypatch):
    """With Cholesky's factors nothing asks for the matrix again."""
    kept, most, evaluate = [], [], System.evaluate

    def watched(self, *arguments, **options):
        most.append(sum(array() is not None for array in kept))
        evaluation = evaluate(self, *arguments, **options)
        if evaluation.values.size:
            kept.append(weakref.ref(evaluation.values))
        return evaluation

    monkeypatch.setattr(System, "evaluate", watched)
    result = run(force=0.5, steps=3, element="EAS3DEAS")
    assert result.solver == "multifrontal"
    assert len(kept) > 3
    assert max(most) == 0
