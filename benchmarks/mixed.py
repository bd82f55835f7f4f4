"""What it saves to take the geometric stiffness from the stress that an increment foresaw: docs/theory, 5.13.

Thin and thick sheets, in load steps of several sizes, with the consistent tangent and with the mixed one. Old factors
do not serve, so that each iteration is one factorisation.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import dome
import needs_book  # noqa: F401
import record
import umform as uf
from sheets import sheet
from umform.analysis.newton.options import NewtonOptions
from umform.processes.bending import case as bending
from umform.processes.bending.spec import FreeBending
from umform_book.nonlinear import hemisphere, slit_annulus
from umform_book.nonlinear.course import TIED
from umform_book.nonlinear.tracing import Setup

#: Builds a model and its steps, in so many increments.
Build = Callable[[int], tuple[uf.Model, uf.Move]]


def loaded(setup: Setup, increments: int) -> tuple[uf.Model, uf.Move]:
    """All loads of a shell of the verification book at once."""
    return setup.model, uf.Move(list(setup.loads), list(setup.loads.values()), steps=increments)


def sphere(increments: int) -> tuple[uf.Model, uf.Move]:
    """A quarter of a clamped sheet of metal, 0.5 thick, and a sphere that goes 8 deep."""
    return dome.build(20, thickness=0.5, increments=increments)


def strip(increments: int) -> tuple[uf.Model, uf.Move]:
    """The strip of the free bending, 1 thick, over its cylinder."""
    model, punch = bending.build(FreeBending())
    return model, uf.Move(punch, to=-15.0, steps=increments)


def problems(cells: int) -> list[tuple[str, Build, tuple[int, ...]]]:
    """Name, builder and numbers of increments."""
    tied = TIED[0]
    return [
        ("hemisphere", lambda n: loaded(hemisphere.build(tied, cells), n), (2, 5, 20)),
        ("slit annulus", lambda n: loaded(slit_annulus.build(tied, cells), n), (5, 20)),
        ("sheet under a sphere", sphere, (10,)),
        ("strip over a cylinder", strip, (60,)),
    ]


def run(build: Build, increments: int, mixed: bool) -> tuple[int, int, float]:
    """Increments, evaluations (those of increments that were cut too), CPU seconds."""
    model, steps = build(increments)
    start = time.process_time()
    result = uf.solve(model, steps, options=NewtonOptions(mixed=mixed), frames=0, progress=False)
    return len(result) - 1, result.timing.elements.calls, time.process_time() - start


def cost_of_an_evaluation(element: str) -> float:
    """CPU time of an evaluation with the mixed tangent over that of one with the consistent tangent."""
    cells = 20 if element == "MI9K3DEAS" else 40
    model, u = sheet(element, "SVK", (cells, cells))
    seconds: dict[bool, list[float]] = {False: [], True: []}
    for _ in range(15):
        for mixed, times in seconds.items():
            model.system.revert()
            model.system.recover(u, mixed)
            start = time.process_time()
            model.evaluate(u)
            times.append(time.process_time() - start)
    return min(seconds[True]) / min(seconds[False])


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=32, help="of the shells along a side")
    record.add_option(parser)
    arguments = parser.parse_args()
    uf.set_threads(1)
    print(f"{'':<24}{'wanted':>7}{'increments':>13}{'evaluations':>15}{'CPU s':>15}{'ratio':>8}")
    numbers = {}
    for name, build, sizes in problems(arguments.cells):
        for increments in sizes:
            (n, k, s), (n_mixed, k_mixed, s_mixed) = (run(build, increments, mixed) for mixed in (False, True))
            numbers[f"{name} in {increments}, evaluations over those of the consistent tangent"] = k_mixed / k
            seconds = f"{s:>8.2f}{s_mixed:>7.2f}{s_mixed / s:>8.2f}"
            print(f"{name:<24}{increments:>7}{n:>7}{n_mixed:>6}{k:>8}{k_mixed:>7}{seconds}", flush=True)
    for element in ("ANS3DEAS", "EAS3DEAS", "MI9K3DEAS"):
        name = f"an evaluation of {element}, over one with the consistent tangent"
        numbers[name] = cost_of_an_evaluation(element)
        print(f"{name}: {numbers[name]:.3f}", flush=True)
    record.write(arguments.json, "mixed", numbers)


if __name__ == "__main__":
    main()
