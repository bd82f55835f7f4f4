"""Terms written in Python that couple several nodes: their tangent goes where their forces go."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from umform import _core
from umform import materials as mt
from umform.mesh import strip
from umform.model import Model
from umform.model.terms.term import Found, Term


class Pull(Term):
    """Nodes of each part under a potential that is quadratic in all their displacements together."""

    within_bodies = False

    def __init__(self, parts, matrix):
        self.name, self.parts, self.matrix = "pull", np.asarray(parts, dtype=np.int32), matrix
        self.symmetric = bool(np.allclose(matrix, matrix.T))

    def couples(self):
        return (_core.Connectivity(self.parts),)

    def evaluate(self, at, into):
        u = at.u.reshape(-1, 3)[self.parts]
        count, nodes = self.parts.shape
        forces = (u.reshape(count, -1) @ self.matrix.T).reshape(u.shape)
        tangents = np.broadcast_to(self.matrix.reshape(nodes, 3, nodes, 3), (count, nodes, 3, nodes, 3))
        into.add(self, self.parts, forces, tangents, at)
        return Found(float((forces**2).sum()))


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("nodes", [2, 3])
def test_its_tangent_is_the_derivative_of_its_forces(nodes, symmetric, rng):
    mesh = strip(8.0, 1.0, 1.0, (6, 1))
    model = Model(mesh, "DISP3D", material=mt.SVK(E=1.0, nu=0.3))
    model.fix("x0")
    matrix = 50.0 * rng.normal(size=(3 * nodes, 3 * nodes))
    term = Pull([rng.permutation(len(mesh.points))[:nodes] for _ in range(4)], matrix + symmetric * matrix.T)
    assert term.symmetric == symmetric
    model.add(term)
    u, du = (1e-2 * rng.normal(size=model.u.size) for _ in range(2))
    pattern, values = model.system.pattern, model.evaluate(u).values
    K = csr_matrix((values, pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n)).toarray()
    assert pattern.symmetric == symmetric
    K = K + np.triu(K, 1).T if symmetric else K
    q, step = model.system.coefficients(du), 1e-4
    ahead, behind = (
        model.system.restrict(model.evaluate(u + s * step * model.system.extend(q)).residual) for s in (1, -1)
    )
    np.testing.assert_allclose(K @ q, (ahead - behind) / (2 * step), atol=1e-6 * np.abs(K @ q).max())


def test_its_predictor_is_its_tangent_times_the_increment(rng):
    mesh = strip(8.0, 1.0, 1.0, (6, 1))
    plain, tied = (Model(mesh, "DISP3D", material=mt.SVK(E=1.0, nu=0.3)) for _ in range(2))
    matrix = rng.normal(size=(6, 6))
    tied.add(Pull([[1, 20], [7, 3]], matrix + matrix.T))
    u, du = (1e-2 * rng.normal(size=plain.u.size) for _ in range(2))
    step = 1e-4
    ahead, behind = (
        tied.evaluate(u + s * step * du).residual - plain.evaluate(u + s * step * du).residual for s in (1, -1)
    )
    share = tied.evaluate(u, du).predictor - plain.evaluate(u, du).predictor
    np.testing.assert_allclose(share, (ahead - behind) / (2 * step), atol=1e-9)
