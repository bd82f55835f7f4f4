"""Kratos Multiphysics: hexahedra and shells of four nodes, direct solver of its LinearSolversApplication."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import KratosMultiphysics as km  # noqa: N813
import numpy as np
from KratosMultiphysics import LinearSolversApplication, StructuralMechanicsApplication  # noqa: F401
from KratosMultiphysics import python_linear_solver_factory as factory
from worker import means, work

from problem import Problem

LAW = {"solid": "LinearElastic3DLaw", "shell": "LinearElasticPlaneStress2DLaw"}


def solve(problem: Problem, options: Mapping[str, Any]) -> dict[str, Any]:
    """Build the model part and solve it: one linear step, or Newton's method at equal load levels."""
    km.Logger.GetDefaultOutput().SetSeverity(km.Logger.Severity.WARNING)
    model = km.Model()
    part = _part(model, problem, options["element"])
    loads = _loads(part, problem)
    strategy = _strategy(part, problem, options.get("solver", "LinearSolversApplication.sparse_lu"))
    iterations = 0
    for level in range(1, problem.levels + 1):
        part.CloneTimeStep(level / problem.levels)
        for condition, force in loads:
            condition.SetValue(StructuralMechanicsApplication.POINT_LOAD, (force * level / problem.levels).tolist())
        strategy.InitializeSolutionStep()
        strategy.Predict()
        if not strategy.SolveSolutionStep():
            raise SystemExit(f"no convergence at level {level}")
        strategy.FinalizeSolutionStep()
        iterations += part.ProcessInfo[km.NL_ITERATION_NUMBER] if problem.large else 1
    u = np.array([list(node.GetSolutionStepValue(km.DISPLACEMENT)) for node in part.Nodes])
    return {
        "probes": means(problem, u),
        "increments": problem.levels,
        "iterations": iterations,
        "solver": options.get("solver", "LinearSolversApplication.sparse_lu").split(".")[-1],
    }


def _part(model: Any, problem: Problem, kind: str) -> Any:
    """Nodes, elements, material and supports."""
    part = model.CreateModelPart("sheet", 2)
    part.ProcessInfo[km.DOMAIN_SIZE] = 3
    shell = problem.cell == "quad4"
    fields = (km.DISPLACEMENT, km.ROTATION) if shell else (km.DISPLACEMENT,)
    reactions = (km.REACTION, km.REACTION_MOMENT)
    for field in (*fields, *reactions[: len(fields)]):
        part.AddNodalSolutionStepVariable(field)
    for number, point in enumerate(problem.points.tolist(), 1):
        part.CreateNewNode(number, *point)
    properties = part.CreateNewProperties(1)
    properties.SetValue(km.YOUNG_MODULUS, problem.young)
    properties.SetValue(km.POISSON_RATIO, problem.poisson)
    properties.SetValue(km.THICKNESS, problem.thickness)
    properties.SetValue(km.DENSITY, 0.0)
    law = km.KratosGlobals.GetConstitutiveLaw(LAW["shell" if shell else "solid"])
    properties.SetValue(km.CONSTITUTIVE_LAW, law.Clone())
    for number, nodes in enumerate((problem.cells + 1).tolist(), 1):
        part.CreateNewElement(kind, number, nodes, properties)
    names = [f"{field.Name()}_{axis}" for field in fields for axis in "XYZ"]
    against = [f"{reaction.Name()}_{axis}" for reaction in reactions[: len(fields)] for axis in "XYZ"]
    variables = [km.KratosGlobals.GetVariable(name) for name in names]
    for variable, reaction in zip(variables, against, strict=True):
        km.VariableUtils().AddDof(variable, km.KratosGlobals.GetVariable(reaction), part)
    for node, axis in problem.fixed.tolist():
        part.Nodes[node + 1].Fix(variables[axis])
    return part


def _loads(part: Any, problem: Problem) -> list[tuple[Any, Any]]:
    """A point load on each node with a force."""
    assert problem.forces is not None
    loaded = np.flatnonzero(problem.forces.any(axis=1)).tolist()
    make, properties = part.CreateNewCondition, part.GetProperties()[1]
    return [
        (make("PointLoadCondition3D1N", k, [n + 1], properties), problem.forces[n]) for k, n in enumerate(loaded, 1)
    ]


def _strategy(part: Any, problem: Problem, solver: str) -> Any:
    """Linear strategy, or Newton-Raphson with the tolerances that Kratos' solvers take unless told otherwise."""
    linear = factory.ConstructSolver(km.Parameters(f'{{"solver_type": "{solver}"}}'))
    scheme = km.ResidualBasedIncrementalUpdateStaticScheme()
    builder = km.ResidualBasedBlockBuilderAndSolver(linear)
    if problem.large:
        criterion = km.ResidualCriteria(1e-4, 1e-9)
        strategy = km.ResidualBasedNewtonRaphsonStrategy(part, scheme, criterion, builder, 50, False, False, True)
    else:
        strategy = km.ResidualBasedLinearStrategy(part, scheme, builder, False, False, False, False)
    strategy.SetEchoLevel(0)
    strategy.Initialize()
    return strategy


if __name__ == "__main__":
    work(solve)
