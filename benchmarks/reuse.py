"""What it saves to use the factors of the iteration before once more: factorisations, iterations, CPU time.

A plate that is bent far, and a sphere that is pressed into a clamped sheet; with new factors always, and with old ones
where `umform.analysis.newton.factor_reuse` lets them
serve. The two take turns. First the times that its estimate of the costs rests on.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import dome
import umform as uf
from umform.analysis.newton.factor_reuse import cost_of_factors
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.processes.air_bending import problem
from umform.processes.air_bending.spec import AirBending
from umform.processes.bending import case as bending
from umform.processes.bending.spec import FreeBending


def plate(cells: int) -> tuple[uf.Model, uf.Move]:
    """A clamped elastic plate, 50 x 50 x 1, whose far edge goes up by 20."""
    mesh = uf.mesh.strip(length=50.0, width=50.0, thickness=1.0, cells=(cells, cells))
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    edge = model.prescribe("x1_lower", "z", name="edge")
    return model, uf.Move(edge, to=20.0, steps=5)


def best(work: Callable[..., Any], *arguments: object) -> tuple[float, Any]:
    """Nanoseconds of CPU time of the fastest of three calls, and the answer."""
    times = []
    for _ in range(3):
        start = time.process_time()
        answer = work(*arguments)
        times.append(time.process_time() - start)
    return 1e9 * min(times), answer


def costs(cells: int) -> None:
    """Print nanoseconds in the units of the estimate, and the cost of factors as estimated and as measured."""
    print(
        f"{'':<22}{'factor/(fill^2/n)':>19}{'solve/fill':>12}{'evaluate/n/effort':>19}{'estimate':>10}{'measured':>10}"
    )
    models = {
        "free bending 24x1": bending.build(FreeBending())[0],
        "air bending": problem.build(AirBending())[0],
        "air bending, 40 wide": problem.build(AirBending(width=40.0, width_elements=10))[0],
        **{f"dome {count}x{count}": dome.build(count)[0] for count in (cells // 2, cells)},
    }
    for label, model in models.items():
        pattern, solver = model.system.pattern, Newton(model.system).ready_solver()
        evaluate, evaluation = best(model.evaluate, model.u)
        factor, told = best(solver.factor, evaluation)
        solve, _ = best(solver.solve, np.ones(pattern.n))
        fill = told.fill
        system = model.system
        units = (
            f"{factor / (fill**2 / pattern.n):>19.3f}{solve / fill:>12.2f}{evaluate / pattern.n / system.effort:>19.0f}"
        )
        ratios = f"{cost_of_factors(fill, pattern.n, model.system.effort):>10.2f}{factor / (evaluate + solve):>10.2f}"
        print(f"{label:<22}{units}{ratios}", flush=True)


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=40, help="elements along each side")
    parser.add_argument("--costs", action="store_true", help="the estimate only")
    parser.add_argument("--case", choices=("plate", "dome"), action="append", help="default: both")
    parser.add_argument(
        "--cost", type=float, help="of a factorisation over evaluation and solve; default: the estimate"
    )
    arguments = parser.parse_args()
    uf.set_threads(1)
    costs(arguments.cells)
    if arguments.costs:
        return
    print(f"{'':<8}{'factors':<10}{'factorisations':>15}{'solves':>8}{'of all %':>9}{'CPU s':>8}   force")
    for name in arguments.case or ("plate", "dome"):
        build = {"plate": plate, "dome": dome.build}[name]
        for label, cost in (("new", 0.0), ("reused", arguments.cost)):
            model, step = build(arguments.cells)
            start = time.process_time()
            result = uf.solve(model, step, options=NewtonOptions(factor_cost=cost), frames=0, progress=False)
            seconds, timing = time.process_time() - start, result.timing
            share = 100 * timing.factorisation.seconds / timing.total
            force = result[f"{step.moved()[0].name}_force"][-1]
            counts = f"{timing.factorisation.calls:>15}{timing.solve.calls:>8}{share:>9.0f}"
            print(f"{name:<8}{label:<10}{counts}{seconds:>8.2f}   {force:.10g}", flush=True)


if __name__ == "__main__":
    main()
