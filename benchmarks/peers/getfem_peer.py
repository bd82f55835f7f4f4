"""GetFEM: standard trilinear hexahedra and the direct solver MUMPS; the linear step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import getfem as gf
import numpy as np
from worker import means, work

from problem import Problem

#: Its nodes run along x first, then y, then z.
_LEXICOGRAPHIC = [0, 1, 3, 2, 4, 5, 7, 6]
_CLAMPED = 1


def solve(problem: Problem, options: Mapping[str, Any]) -> dict[str, Any]:
    """One linear step; all supports of the problem hold a node in all directions."""
    assert problem.forces is not None
    mesh = gf.Mesh("empty", 3)
    corners = problem.points[problem.cells[:, _LEXICOGRAPHIC]]
    mesh.add_convex(gf.GeoTrans("GT_QK(3,1)"), np.ascontiguousarray(corners.transpose(2, 1, 0)))
    place = mesh.pid_from_coords(problem.points.T).astype(int)
    mesh.set_region(_CLAMPED, mesh.faces_from_pid(place[np.unique(problem.fixed[:, 0])]))
    fem = gf.MeshFem(mesh, 3)
    fem.set_fem(gf.Fem("FEM_QK(3,1)"))
    model = gf.Model("real")
    model.add_fem_variable("u", fem)
    mu = problem.young / (2 + 2 * problem.poisson)
    model.add_initialized_data("mu", mu)
    model.add_initialized_data("lambda", 2 * mu * problem.poisson / (1 - 2 * problem.poisson))
    rule = gf.MeshIm(mesh, gf.Integ("IM_GAUSS_PARALLELEPIPED(3,3)"))
    model.add_isotropic_linearized_elasticity_brick(rule, "u", "lambda", "mu")
    model.add_Dirichlet_condition_with_simplification("u", _CLAMPED)
    order = _nodes_of_unknowns(fem, problem)
    model.add_explicit_rhs("u", problem.forces[order].ravel())
    model.solve("lsolver", options.get("solver", "mumps"))
    u = np.empty_like(problem.points)
    u[order] = np.reshape(model.variable("u"), (-1, 3))
    return {"probes": means(problem, u), "increments": 1, "iterations": 1, "solver": "mumps"}


def _nodes_of_unknowns(fem: Any, problem: Problem) -> Any:
    """Node of each third unknown, by its place."""
    where = fem.basic_dof_nodes().T[::3]
    keys = [np.lexsort(np.round(points, 6).T) for points in (where, problem.points)]
    order = np.empty(len(where), dtype=int)
    order[keys[0]] = keys[1]
    return order


if __name__ == "__main__":
    work(solve)
