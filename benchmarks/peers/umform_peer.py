"""umform: one process of Python with the package."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from typing import Any

import numpy as np
from worker import means, work

from problem import Problem
from umform import J2, SVK, Cylinder, Linear, Mesh, Model, Move, NewtonOptions, Result, set_threads
from umform.analysis.run import solve as solve_steps


def solve(problem: Problem, options: Mapping[str, Any]) -> dict[str, Any]:
    """Build the model and solve it."""
    heard, solver = _Heard(), options.get("solver", "auto")
    set_threads(1)
    mesh = Mesh(problem.points, {problem.cell: problem.cells}, faces={"lower": [(c, 0) for c in problem.touching]})
    if problem.flow is None:
        law: SVK | J2 = SVK(E=problem.young, nu=problem.poisson)
    else:
        kappa, mu = problem.young / (3 - 6 * problem.poisson), problem.young / (2 + 2 * problem.poisson)
        law = J2(kappa=kappa, mu=mu, hardening=Linear(*problem.flow))
    model = Model(mesh, options["element"], material=law, **options.get("model", {}))
    for axis, name in enumerate("xyz"):
        held = problem.fixed[problem.fixed[:, 1] == axis, 0]
        if len(held):
            model.fix(held, name)
    newton = NewtonOptions(**options.get("newton", {}))
    told = _bend(problem, model, newton) if len(problem.pushed) else _load(problem, model, newton, solver)
    return told | {"solver": heard.solver or solver, "probes": means(problem, model.u.reshape(-1, 3))}


class _Heard(logging.Handler):
    """Hears which solver `auto` stands for."""

    def __init__(self) -> None:
        super().__init__(logging.INFO)
        self.solver = ""
        log = logging.getLogger("umform.solvers")
        log.setLevel(logging.INFO)
        log.addHandler(self)

    def emit(self, record: logging.LogRecord) -> None:
        self.solver = record.getMessage().removeprefix("solver: ").split(";")[0]


def _bend(problem: Problem, model: Model, newton: NewtonOptions) -> dict[str, Any]:
    """Push nodes down on a tool."""
    tool, control = problem.tool, model.prescribe(problem.pushed, "z", "punch")
    assert tool is not None
    cylinder = Cylinder((tool.x, 0.0, tool.z), "y", tool.radius)
    points = 2 if problem.cell == "hex8" else 3
    model.contact("lower", cylinder, penalty=tool.penalty, points=points, name="tool")
    steps = Move(control, to=problem.stroke, steps=problem.levels)
    result = solve_steps(model, steps, options=newton, frames=0, progress=False)
    sign = np.sign(problem.stroke)
    curve = {"u": (sign * result["punch"]).tolist(), "force": (sign * result["punch_force"]).tolist()}
    return curve | _counts(result)


def _load(problem: Problem, model: Model, newton: NewtonOptions, solver: str) -> dict[str, Any]:
    """Dead nodal forces, in levels or in one linear step."""
    forces = problem.forces
    assert forces is not None
    if not problem.large:
        # Imported here since the book brings the drawing of curves with it, which a run without it does not load.
        from umform_book.linear_algebra import linear_solution

        model.u[:] = linear_solution(model, forces.ravel(), solver=solver).ravel()
        return {"increments": 1, "iterations": 1}
    values, number = np.unique(forces, axis=0, return_inverse=True)
    loads = [model.force(np.flatnonzero(number == k), f) for k, f in enumerate(values) if f.any()]
    steps = Move(loads, [1.0] * len(loads), steps=problem.levels)
    result = solve_steps(model, steps, solver=solver, options=newton, frames=0, progress=False)
    return _counts(result)


def _counts(result: Result) -> dict[str, Any]:
    return {"increments": len(result) - 1, "iterations": int(result["iterations"].sum())}


if __name__ == "__main__":
    work(solve)
