"""Sheets: their order of elimination, and their matrix in blocks."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from umform import _core
from umform.errors import SingularMatrix
from umform.solvers import Pattern, make_solver, pardiso, sheet_blocks, superlu

needs_mkl = pytest.mark.skipif(not pardiso.available(), reason="MKL is not installed")


def neighbours(*nodes):
    """Return the stiffness-like matrix of a grid of nodes, each with its neighbours along edges and diagonals."""
    matrix = sparse.eye(1)
    for k in nodes:
        matrix = sparse.kron(matrix, sparse.diags([1.0, 2.0, 1.0], [-1, 0, 1], shape=(k, k)))
    matrix = -matrix.tocsr()
    matrix.setdiag(0.0)
    matrix.setdiag(0.5 - np.asarray(matrix.sum(axis=1)).ravel())
    return matrix


def fibres(graph, size, seed=1):
    """Return a positive definite matrix with so many equations for a vertex, numbered face by face."""
    block = np.random.default_rng(seed).normal(size=(size, size))
    return sparse.kron(block @ block.T + np.eye(size), graph).tocsr()


def stored(matrix):
    """Return the pattern and the values of the upper triangle."""
    upper = sparse.triu(matrix).tocsr()
    upper.sort_indices()
    return Pattern(upper.shape[0], upper.indptr.astype(np.int32), upper.indices.astype(np.int32), True), upper.data


def order(matrix):
    pattern, _ = stored(matrix)
    return _core.SheetOrder(pattern.indptr, pattern.indices)


def fill_of(graph, vertices):
    """Entries of the Cholesky factor on and below the diagonal, by eliminating vertex after vertex."""
    columns = [set(graph.indices[graph.indptr[v] : graph.indptr[v + 1]]) - {v} for v in range(graph.shape[0])]
    entries = 0
    for v in vertices:
        entries += 1 + len(columns[v])
        for w in columns[v]:
            columns[w] |= columns[v]
            columns[w] -= {v, w}
    return entries


def loose(matrix, equations):
    """Return the matrix with these two equations tied to each other, and held by nothing but rounding."""
    matrix = matrix.tolil()
    matrix[equations, :] = 0.0
    matrix[:, equations] = 0.0
    matrix[np.ix_(equations, equations)] = np.array([[1.0, -1.0], [-1.0, 1.0 + 4e-16]])
    return matrix.tocsr()


@pytest.mark.parametrize("nodes", [(12, 12), (40, 7), (25, 25)])
def test_equations_of_a_fibre_follow_each_other(nodes):
    graph = neighbours(*nodes)
    found = order(fibres(graph, 6)).equations
    np.testing.assert_array_equal(np.sort(found), np.arange(6 * graph.shape[0]))
    vertices = (found % graph.shape[0]).reshape(-1, 6)
    assert (vertices == vertices[:, :1]).all()


@pytest.mark.parametrize("nodes", [(31, 31), (60, 20)])
def test_fill_is_that_of_dissection_along_the_lines_of_the_grid(nodes):
    """A. George's order of a grid, which knows where the nodes are, is no better than 5 %."""

    def dissected(ids):
        if ids.shape[0] < ids.shape[1]:
            ids = ids.T
        if len(ids) < 3:
            return list(ids.ravel())
        k = len(ids) // 2
        return [*dissected(ids[:k]), *dissected(ids[k + 1 :]), *ids[k]]

    graph = neighbours(*nodes)
    known = fill_of(graph, dissected(np.arange(graph.shape[0]).reshape(nodes)))
    found = order(fibres(graph, 3))
    assert fill_of(graph, found.vertices) < 1.05 * known


def test_the_same_order_each_time():
    matrix = fibres(neighbours(20, 30), 3)
    np.testing.assert_array_equal(order(matrix).equations, order(matrix).equations)


def test_pieces_are_ordered_on_their_own():
    pieces = [neighbours(9, 9), neighbours(1, 1), neighbours(4, 30), neighbours(1, 1)]
    matrix = sparse.block_diag([fibres(piece, 3) for piece in pieces])
    np.testing.assert_array_equal(np.sort(order(matrix).equations), np.arange(matrix.shape[0]))


@pytest.mark.parametrize(
    "matrix",
    [neighbours(30, 30), fibres(neighbours(12, 12, 12), 3)],
    ids=["each equation differs", "solid"],
)
def test_others_are_left_to_pardiso(matrix):
    found = order(matrix)
    assert len(found.vertices) == len(found.equations) == 0


@needs_mkl
def test_others_are_solved(monkeypatch):
    monkeypatch.setattr(pardiso, "_LARGE", 0)
    matrix = neighbours(30, 30)
    pattern, values = stored(matrix)
    solver = make_solver(pattern, "pardiso")
    solver.factor(values)
    np.testing.assert_allclose(matrix @ solver.solve(np.ones(900)), 1.0, rtol=1e-9)
    assert solver.memory() == pardiso.CHOLESKY


def test_blocks_are_left_out_where_they_would_be_half_empty():
    """Half of the fibres have three equations, half of them two."""
    matrix = fibres(neighbours(8, 8), 3)
    kept = np.arange(matrix.shape[0] - 32)
    matrix = matrix[kept][:, kept]
    found = order(matrix)
    assert len(found.vertices) == 64
    assert not sheet_blocks.worth_blocks(found, matrix.shape[0])


def test_larger_groups_are_split():
    """Two fibres at a corner that have the same neighbours."""
    graph = neighbours(8, 8).tolil()
    graph[1, :] = graph[0, :]
    graph[:, 1] = graph[:, 0]
    graph[0, 1] = graph[1, 0] = -1.0
    graph[1, 1] = graph[0, 0] = 20.0
    found = order(fibres(graph.tocsr(), 6))
    assert found.largest == 6
    assert len(found.vertices) == 64


@pytest.mark.parametrize("removed", [[], [0, 7, 200, 201]])
def test_blocks_hold_the_matrix(removed):
    matrix = fibres(neighbours(7, 9), 6).toarray()
    kept = np.setdiff1d(np.arange(len(matrix)), removed)
    matrix = matrix[np.ix_(kept, kept)]
    pattern, values = stored(sparse.csr_matrix(matrix))
    blocks = sheet_blocks.SheetBlocks(_core.SheetOrder(pattern.indptr, pattern.indices))
    blocks.fill(pattern.indptr, pattern.indices, values)
    whole = sparse.bsr_matrix((blocks.data.reshape(-1, 6, 6), blocks.indices, blocks.indptr)).toarray()
    whole = np.triu(whole) + np.triu(whole, 1).T
    place = blocks.gather(np.arange(len(whole)))
    np.testing.assert_array_equal(whole[np.ix_(place, place)], matrix)
    rest = np.setdiff1d(np.arange(len(whole)), place)
    np.testing.assert_array_equal(whole[rest], np.eye(len(whole))[rest])


def test_blocks_refuse_another_pattern():
    pattern, _ = stored(fibres(neighbours(7, 9), 6))
    blocks = sheet_blocks.SheetBlocks(_core.SheetOrder(pattern.indptr, pattern.indices))
    other, values = stored(fibres(neighbours(9, 7), 6))
    with pytest.raises(ValueError, match="none of the blocks"):
        blocks.fill(other.indptr, other.indices, values)


@pytest.fixture(params=["equations", "blocks"])
def solver_of(request, monkeypatch):
    """PARDISO with a matrix that has analysed its pattern: by equations, or in blocks however small it is."""
    if request.param == "blocks":
        monkeypatch.setattr(pardiso, "_LARGE", 0)

    def made(matrix):
        pattern, values = stored(matrix)
        solver = make_solver(pattern, "pardiso")
        assert (solver.memory() == pardiso.IN_BLOCKS) == (request.param == "blocks")
        return solver, values

    return made


@needs_mkl
@pytest.mark.parametrize("columns", [(), (1,), (4,)])
@pytest.mark.parametrize("removed", [[], [0, 7, 200, 201]])
def test_solution(solver_of, columns, removed):
    matrix = fibres(neighbours(8, 9), 6)
    kept = np.setdiff1d(np.arange(matrix.shape[0]), removed)
    matrix = matrix[kept][:, kept]
    solver, values = solver_of(matrix)
    rhs = np.random.default_rng(0).normal(size=(len(kept), *columns))
    for factor in (1.0, 3.0):
        factorisation = solver.factor(factor * values)
        assert factorisation.negative_pivots == 0
        assert factorisation.fill >= len(values)
        np.testing.assert_allclose(factor * (matrix @ solver.solve(rhs)), rhs, rtol=1e-9, atol=1e-10)


@needs_mkl
def test_inertia_and_the_kind_of_factors_that_is_kept(solver_of):
    matrix = fibres(neighbours(8, 9), 6)
    lowest = np.linalg.eigvalsh(matrix.toarray())
    shifted = matrix - 0.5 * (lowest[4] + lowest[5]) * sparse.eye(matrix.shape[0])
    solver, values = solver_of(matrix)
    first = solver.memory()
    assert solver.factor(stored(shifted)[1]).negative_pivots == 5
    x = solver.solve(np.ones(matrix.shape[0]))
    np.testing.assert_allclose(shifted @ x, 1.0, rtol=1e-8)
    later = solver.memory()
    assert later not in (first, pardiso.CHOLESKY)
    again, _ = solver_of(matrix)
    again.recall(later)
    again.factor(stored(shifted)[1])
    np.testing.assert_array_equal(again.solve(np.ones(matrix.shape[0])), x)
    again.recall(first)
    assert again.factor(values).negative_pivots == 0
    assert again.memory() == first


@needs_mkl
@pytest.mark.parametrize("fibre", [0, 30, 71])
def test_the_equation_of_a_vanishing_pivot_is_named(solver_of, fibre):
    """The pattern is that of the whole sheet; the values leave two directions of a fibre without a hold."""
    matrix = fibres(neighbours(8, 9), 6)
    solver, _ = solver_of(matrix)
    pattern, _ = stored(matrix)
    dense = loose(matrix, [fibre, fibre + 72]).toarray()
    with pytest.raises(SingularMatrix) as caught:
        solver.factor(dense[pattern.rows, pattern.indices])
    assert caught.value.value in (fibre, fibre + 72)


@needs_mkl
def test_singular(solver_of):
    matrix = fibres(neighbours(8, 9), 6)
    solver, values = solver_of(matrix)
    pattern, _ = stored(matrix)
    touched = (pattern.rows == 17) | (pattern.indices == 17)
    for bad in (0.0 * values, np.where(touched, 0.0, values)):
        with pytest.raises(SingularMatrix):
            solver.factor(bad)
        with pytest.raises(RuntimeError, match="factor"):
            solver.solve(np.ones(matrix.shape[0]))


@needs_mkl
def test_widely_differing_stiffness_is_not_singular(solver_of):
    matrix = fibres(neighbours(8, 9), 6)
    stiff = sparse.diags(np.r_[1e5, np.ones(matrix.shape[0] - 1)])
    matrix = (stiff @ matrix @ stiff).tocsr()
    solver, values = solver_of(matrix)
    solver.factor(values)
    np.testing.assert_allclose(matrix @ solver.solve(np.ones(matrix.shape[0])), 1.0, rtol=1e-6)


def whole(matrix, symmetric):
    """Return pattern and values, of all entries unless only the upper triangle of a symmetric matrix is stored."""
    if symmetric:
        return stored(matrix)
    matrix = matrix.tocsr()
    matrix.sort_indices()
    pattern = Pattern(matrix.shape[0], matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32), False)
    return pattern, matrix.data


@pytest.mark.parametrize("symmetric", [True, False])
def test_the_order_of_a_sheet_is_that_of_its_structure(symmetric):
    matrix = fibres(neighbours(12, 9), 6)
    pattern, _ = whole(matrix, symmetric)
    np.testing.assert_array_equal(sheet_blocks.sheet_of(pattern).equations, order(matrix).equations)


def test_there_is_none_for_an_unsymmetric_structure():
    matrix = fibres(neighbours(12, 9), 6).tolil()
    matrix[0, 100] = 1.0
    pattern, _ = whole(matrix, symmetric=False)
    assert sheet_blocks.sheet_of(pattern) is None


@pytest.mark.parametrize("name", ["superlu", pytest.param("pardiso", marks=needs_mkl)])
@pytest.mark.parametrize("symmetric", [True, False])
def test_a_sheet_in_its_order_leaves_less_to_factorise(name, symmetric, monkeypatch):
    """Than minimum degree (SuperLU) or METIS (PARDISO), with symmetric values and with others."""
    matrix = fibres(neighbours(50, 50), 6)
    if not symmetric:
        matrix = (matrix + 0.1 * (sparse.triu(matrix, 1) - sparse.tril(matrix, -1))).tocsr()
    pattern, values = whole(matrix, symmetric)
    solver = make_solver(pattern, name)
    own = solver.factor(values).fill
    rhs = np.random.default_rng(0).normal(size=(matrix.shape[0], 2))
    np.testing.assert_allclose(matrix @ solver.solve(rhs), rhs, rtol=1e-8, atol=1e-8)
    monkeypatch.setattr(superlu if name == "superlu" else pardiso, "sheet_of", lambda pattern: None)
    other = make_solver(pattern, name).factor(values).fill
    assert own < 0.97 * other


@needs_mkl
def test_less_to_factorise_than_with_the_order_of_pardiso(monkeypatch):
    matrix = fibres(neighbours(40, 40), 6)
    pattern, values = stored(matrix)
    own = make_solver(pattern, "pardiso").factor(values).fill
    monkeypatch.setattr(pardiso.Handle, "eliminate_in", lambda self, order: None)
    assert own < 0.97 * make_solver(pattern, "pardiso").factor(values).fill
