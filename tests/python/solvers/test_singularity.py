"""Mechanisms are refused however large the mesh is, and thin sheets that are held are not."""

from __future__ import annotations

import importlib.util
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scipy import sparse

import umform as uf
from umform.errors import SingularMatrix
from umform.solvers.singularity import resistance, vanishing_equation

_SPEC = importlib.util.spec_from_file_location("matrices", Path(__file__).with_name("matrices.py"))
matrices = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(matrices)
factored, grid = matrices.factored, matrices.grid


def sheet(size, cells, turned=0.0, clamped=True):
    """The tangent of a sheet of this length, width and thickness, turned about the edge by which it is held.

    It is held by both lines of nodes of that edge, or by the lower one alone, a hinge.
    """
    mesh = uf.mesh.strip(*size, cells)
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    points = mesh.points
    c, s = np.cos(turned), np.sin(turned)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    pattern, values = model.pattern, model.evaluate((points @ turn.T - points).reshape(model.u.shape)).values
    upper = sparse.csr_matrix((values, pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n))
    whole = (upper + sparse.triu(upper, 1).T).tocsr()
    held = (points[:, 0] == points[:, 0].min()) & (clamped | (points[:, 2] == points[:, 2].min()))
    free = np.flatnonzero(~np.repeat(held, 3))
    return whole[free][:, free]


SHEETS = [
    ((4.0, 1.0, 0.5), (4, 1)),
    ((60.0, 10.0, 1.0), (24, 1)),
    ((60.0, 0.005, 1.0), (12, 1)),
    ((600.0, 8.0, 0.2), (150, 2)),
    ((40.0, 30.0, 0.5), (40, 30)),
    ((40.0, 30.0, 0.02), (40, 30)),
]


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("turned", [0.0, 0.3])
@pytest.mark.parametrize(("size", "cells"), SHEETS)
def test_a_hinge_is_refused_and_a_clamp_is_not(size, cells, turned, symmetric):
    solver, told = factored(sheet(size, cells, turned), symmetric)
    assert told.odd is False
    assert np.isfinite(solver.solve(np.ones(solver._pattern.n))).all()
    with pytest.raises(SingularMatrix):
        factored(sheet(size, cells, turned, clamped=False), symmetric)


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("hold", [0.0, 1e-9, 1e-6])
def test_what_holds_a_loose_part_may_be_soft(hold, symmetric):
    """A stiffness of 1e-9 of the others holds; in any unit."""
    free = grid((9, 9), 2) - (1.0 - hold) * sparse.eye(162)
    unit = sparse.diags(10.0 ** np.random.default_rng(0).uniform(-8.0, 8.0, 162))
    for matrix in (free, unit @ free @ unit):
        if hold == 0.0:
            with pytest.raises(SingularMatrix):
                factored(matrix, symmetric)
        else:
            _, told = factored(matrix, symmetric)
            assert told.odd is False


def test_an_eigenvalue_that_vanishes_among_negative_ones_is_seen():
    matrix = grid((8, 8), 2).toarray()
    values, vectors = np.linalg.eigh(matrix)
    for gap, refused in ((0.0, True), (1e-9, False)):
        moved = values - values[20] + gap * values[-1]
        indefinite = (vectors * moved) @ vectors.T
        indefinite = 0.5 * (indefinite + indefinite.T)
        if refused:
            with pytest.raises(SingularMatrix):
                factored(indefinite)
        else:
            assert factored(indefinite)[1].negative_pivots == 20


def test_resistance_is_the_part_of_the_entries_that_would_have_to_change():
    """[[1, -1], [-1, 1 + d]] is singular without d, which is a quarter of what w = (1, 1) meets; in any unit."""

    def of(matrix, scale):
        return resistance(1, scale, scale, partial(np.linalg.solve, matrix), partial(np.matmul, np.abs(matrix)))

    unit = np.array([1e-6, 1e3])
    for d in (1e-3, 1e-9):
        matrix = np.array([[1.0, -1.0], [-1.0, 1.0 + d]])
        assert of(matrix, np.ones(2)) == pytest.approx(d / 4.0, rel=1e-3)
        assert of(matrix * np.outer(unit, unit), 1.0 / unit) == pytest.approx(d / 4.0, rel=1e-3)


def test_only_weak_pivots_are_asked_about():
    asked = []

    def held(equation):
        asked.append(equation)
        return 1e-12

    size = np.array([1.0, 10.0, 0.0])
    assert vanishing_equation(np.array([1e-7, -5.0]), size[:2], held) is None
    assert not asked
    assert vanishing_equation(np.array([-1e-9, 5.0]), size[:2], held) is None
    assert asked == [0]
    assert vanishing_equation(np.array([1.0, 1e-9]), size[:2], lambda _: 1e-17) == 1
    assert vanishing_equation(np.array([1.0, 1e-16]), size[:2], held) == 1
    assert vanishing_equation(np.array([1.0, 1.0, 0.0]), size, held) == 2
    assert asked == [0]
