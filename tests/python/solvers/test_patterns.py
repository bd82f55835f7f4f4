"""Patterns and scatter maps of the kernels, as terms of Python use them."""

from __future__ import annotations

import numpy as np
import pytest

from umform import _core

CELL = np.array([[0, 1, 2, 3], [2, 3, 4, 5]], dtype=np.int32)
EQUATION = np.arange(18, dtype=np.int32)


def test_a_pair_that_is_not_in_the_pattern_is_refused():
    pattern = _core.Pattern(EQUATION, [_core.Connectivity(CELL)], symmetric=True)
    assert pattern.indices[pattern.find(0, 11)] == 11
    with pytest.raises(IndexError, match="row 0 and column 12"):
        pattern.find(0, 12)


def test_a_scatter_of_unknown_couplings_is_refused():
    spring = _core.Connectivity(np.array([[0, 5]], dtype=np.int32))
    assert len(spring) == 1
    np.testing.assert_array_equal(spring.ids, [[0, 5]])
    pattern = _core.Pattern(EQUATION, [_core.Connectivity(CELL)], symmetric=True)
    with pytest.raises(IndexError, match="no term couples them"):
        pattern.scatter(spring)
    with pytest.raises(IndexError, match="node 9 of an element, the model has 6 nodes"):
        pattern.scatter(_core.Connectivity(np.array([[0, 9]], dtype=np.int32)))


@pytest.mark.parametrize("symmetric", [True, False])
def test_a_term_of_python_adds_its_matrices(build, rng, symmetric):
    """A spring between far nodes: degrees of freedom in the order 3 * node + direction."""
    ids = np.array([[0, 5], [4, 1]], dtype=np.int32)
    cells, springs = _core.Connectivity(CELL), _core.Connectivity(ids)
    equation = EQUATION.copy()
    equation[4:] -= 1
    equation[3] = -1  # the x of node 1 is held
    pattern = _core.Pattern(equation, [cells, springs], symmetric)
    scatter = pattern.scatter(springs)
    assert scatter.symmetric == symmetric
    matrices = rng.normal(size=(2, 6, 6))
    if symmetric:
        matrices += matrices.transpose(0, 2, 1)
    values, expected = np.zeros(len(pattern.indices)), np.zeros((18, 18))
    scatter.add(matrices, values)
    for nodes, K in zip(ids, matrices, strict=True):
        dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
        expected[np.ix_(dofs, dofs)] += K
    free = np.delete(np.arange(18), 3)
    np.testing.assert_array_equal(build.dense(pattern, values), expected[np.ix_(free, free)])
    with pytest.raises(ValueError, match="matrices must have shape"):
        scatter.add(matrices[:1], values)


def test_a_tangent_that_is_not_symmetric_needs_both_triangles(build):
    mesh_points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1.0]])
    block = _core.pressure_block(CELL[:1], mesh_points)
    block.pressure, block.name = 1.0, "pressure on the lid"
    assert not block.symmetric
    u, f = np.zeros(18), np.zeros(18)
    pattern = _core.Pattern(EQUATION, [block.connectivity], symmetric=True)
    scatter = pattern.scatter(block.connectivity)
    with pytest.raises(ValueError, match="pressure on the lid is not symmetric"):
        block.evaluate(u, scatter, f, np.zeros(len(pattern.indices)), None, None)
    block.evaluate(u, scatter, f, None, None, None)  # forces need no matrix
    assert f.any()
    scatter.require(True, "a spring")
    with pytest.raises(ValueError, match="a dashpot"):
        scatter.require(False, "a dashpot")
