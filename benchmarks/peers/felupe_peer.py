"""felupe: standard hexahedra, no assumed strains, and SciPy's direct solver; the linear step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import felupe as fem
import numpy as np
from worker import means, work

from problem import Problem


def solve(problem: Problem, options: Mapping[str, Any]) -> dict[str, Any]:
    """One linear step."""
    assert problem.forces is not None
    mesh = fem.Mesh(problem.points, problem.cells, "hexahedron")
    region = fem.RegionHexahedron(mesh)
    field = fem.FieldContainer([fem.Field(region, dim=3)])
    solid = fem.SolidBody(umat=fem.LinearElastic(E=problem.young, nu=problem.poisson), field=field)
    loaded = np.flatnonzero(problem.forces.any(axis=1))
    load = fem.PointLoad(field, loaded, values=problem.forces[loaded])
    held = np.zeros(problem.points.shape, dtype=bool)
    held[tuple(problem.fixed.T)] = True
    bounds = fem.BoundaryDict({"held": fem.Boundary(field[0], mask=held)})
    free = fem.dof.partition(field, bounds)
    step = fem.newtonrhapson(items=[solid, load], dof0=free[0], dof1=free[1], verbose=False)
    return {
        "probes": means(problem, step.x[0].values),
        "increments": 1,
        "iterations": int(step.iterations),
        "solver": "scipy spsolve",
    }


if __name__ == "__main__":
    work(solve)
