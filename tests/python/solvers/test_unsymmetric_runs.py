"""A run whose tangent is not symmetric, with each solver that takes it: a plate under a pressure that follows it."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.newton import Newton
from umform.solvers import pardiso

needs_mkl = pytest.mark.skipif(not pardiso.available(), reason="MKL is not installed")
GENERAL = ["multifrontal", "superlu", pytest.param("pardiso", marks=needs_mkl), "auto"]


def plate():
    """A cantilever plate that a pressure rolls up; with a free edge the stiffness of the load is not symmetric."""
    mesh = uf.mesh.strip(length=10.0, width=4.0, thickness=0.2, cells=(8, 3))
    model = uf.Model(mesh, material=uf.SVK(E=1e4, nu=0.3))
    model.fix("x0")
    return model, model.pressure("upper", name="pressure")


def dense(model, values):
    matrix = np.zeros((model.system.pattern.n, model.system.pattern.n))
    matrix[model.system.pattern.rows, model.system.pattern.indices] = values
    return matrix


@pytest.mark.parametrize("solver", GENERAL)
def test_a_follower_pressure_with_each_solver(solver):
    model, pressure = plate()
    uf.solve(model, uf.Move(pressure, to=1.0, steps=4), solver=solver, frames=0, progress=False)
    assert not model.system.pattern.symmetric
    matrix = dense(model, model.evaluate(model.u).values)
    assert np.abs(matrix - matrix.T).max() > 1e-5 * np.abs(matrix).max()
    assert np.abs(model.u).max() > 2.0  # far from the start
    result = uf.solve(model, uf.Move(pressure, to=1.05, steps=1), solver=solver, frames=0, progress=False)
    before, middle, last = [r.energy for r in result.iterations[-1] if r.energy > 0.0 and r.residual > 1e-10][-3:]
    assert np.log(last / middle) / np.log(middle / before) > 1.7  # the order of Newton's method
    assert all(record.negative_pivots is None for record in result.iterations[-1])
    reference, pressure = plate()
    steps = [uf.Move(pressure, to=1.0, steps=4), uf.Move(pressure, to=1.05, steps=1)]
    uf.solve(reference, steps, solver="superlu", frames=0, progress=False)
    np.testing.assert_allclose(model.u, reference.u, atol=1e-9 * np.abs(reference.u).max())


def test_the_banded_solver_leaves_it_to_others():
    model, _ = plate()
    with pytest.raises(uf.UmformError, match="symmetric matrices only"):
        Newton(model.system, solver="banded").ready_solver()
    assert Newton(model.system).solver != "banded"
