"""Matrices for the tests of the solvers, and what is asked of their solutions."""

from __future__ import annotations

import numpy as np
from scipy import sparse

import umform as uf
from umform.solvers import Pattern
from umform.solvers.multifrontal import Multifrontal


def stored(matrix, symmetric=True):
    """Return the pattern and the values of a matrix with its diagonal always stored."""
    full = sparse.csr_matrix(matrix)
    present = sparse.csr_matrix((np.ones(full.nnz), full.indices, full.indptr), shape=full.shape)
    present = (present + present.T * symmetric + sparse.eye(full.shape[0])).tocsr()
    present = (sparse.triu(present) if symmetric else present).tocsr()
    present.sort_indices()
    rows = np.repeat(np.arange(full.shape[0]), np.diff(present.indptr))
    pattern = Pattern(full.shape[0], present.indptr.astype(np.int32), present.indices.astype(np.int32), symmetric)
    return pattern, np.asarray(full[rows, present.indices]).ravel()


def factored(matrix, symmetric=True):
    pattern, values = stored(matrix, symmetric)
    solver = Multifrontal()
    solver.analyse(pattern)
    return solver, solver.factor(values)


def error_of(matrix, x, b):
    """Backward error of a solution: 1e-16 is rounding."""
    matrix = sparse.csr_matrix(matrix)
    residual = np.abs(matrix @ x - b).max(axis=0)
    return float(np.max(residual / (np.abs(matrix).max() * np.abs(x).max(axis=0) + np.abs(b).max(axis=0))))


def negative_eigenvalues(matrix):
    return np.count_nonzero(np.linalg.eigvalsh(np.asarray(matrix.todense() if sparse.issparse(matrix) else matrix)) < 0)


def grid(shape, unknowns, seed=0):
    """A positive definite matrix whose nodes are coupled with all neighbours in a grid, the diagonal ones too."""
    graph = sparse.eye(1)
    for count in shape:
        graph = sparse.kron(graph, sparse.diags([1.0, 1.0, 1.0], [-1, 0, 1], shape=(count, count)))
    blocks = sparse.kron(graph, np.ones((unknowns, unknowns))).tocoo()
    values = np.random.default_rng(seed).uniform(-1.0, 0.0, blocks.nnz)
    matrix = sparse.csr_matrix((values, (blocks.row, blocks.col)), shape=blocks.shape)
    matrix = matrix + matrix.T
    return (matrix + sparse.diags(-np.asarray(matrix.sum(axis=1)).ravel() + 1.0)).tocsr()


def tangent(cells, cell="hex8"):
    """The tangent of a clamped sheet at rest, as the model gives it."""
    mesh = uf.mesh.strip(float(cells[0]), float(cells[1]), 0.5, cells, cell=cell)
    model = uf.Model(mesh, "ANS3DEAS" if cell == "hex8" else "MI9K3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    values = model.evaluate(np.zeros_like(model.u)).values
    pattern = model.system.pattern
    upper = sparse.csr_matrix((values, pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n))
    return (upper + sparse.triu(upper, 1).T).tocsr()


def saddle(rows, held, seed):
    """[A B^T; B 0]: zeros on the diagonal, which no pivot of one column can be before others are eliminated."""
    random = np.random.default_rng(seed)
    stiffness = grid((rows, rows), 2, seed)
    border = sparse.random(held, stiffness.shape[0], density=0.02, random_state=random, format="csr")
    border = border + sparse.csr_matrix(
        (np.ones(held), (np.arange(held), random.permutation(stiffness.shape[0])[:held])), shape=border.shape
    )
    return sparse.bmat([[stiffness, border.T], [border, None]]).tocsr()


def some_matrix(seed, symmetric):
    """Sparse, of random size and density, with a diagonal of zeros, of very unequal entries or of large ones."""
    random = np.random.default_rng(seed)
    n = int(random.integers(1, 160))
    matrix = random.normal(size=(n, n)) * (random.random((n, n)) < random.uniform(0.01, 0.3))
    matrix = matrix + matrix.T if symmetric else matrix
    kind = random.integers(4)
    if kind == 0:
        np.fill_diagonal(matrix, 0.0)
    elif kind == 1:
        matrix += np.diag(random.normal(size=n) * random.choice([1e-3, 1.0, 1e3]))
    elif kind == 2:
        matrix += 0.5 * n * np.eye(n)
    return matrix
