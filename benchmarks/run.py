"""Where the time of one free-bending run goes: kernels, sparse solver, Python; and the overhead of Python an iteration.

The run is that of the demo on the coarsest mesh: 24x1 ANS3DEAS, 2x2 contact points, 300 increments and unloading.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import umform as uf
from umform import newton


class Stopwatch:
    """Adds up the time spent inside of the functions that it wraps."""

    def __init__(self) -> None:
        self.seconds = 0.0

    def wrap(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """The same function, timed."""

        def timed(*arguments: Any) -> Any:
            start = time.perf_counter()
            try:
                return function(*arguments)
            finally:
                self.seconds += time.perf_counter() - start

        return timed


class Timed:
    """Stands for an object and times the named methods."""

    def __init__(self, target: Any, stopwatch: Stopwatch, methods: tuple[str, ...]) -> None:
        self._target = target
        self._timed = {name: stopwatch.wrap(getattr(target, name)) for name in methods}

    def __getattr__(self, name: str) -> Any:
        return self._timed.get(name) or getattr(self._target, name)


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--solver", default="auto")
    arguments = parser.parse_args()
    uf.set_threads(1)

    mesh = uf.mesh.strip(length=60, width=10, thickness=1, cells=(24, 1))
    steel = uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Perfect(yield_stress=160))
    model = uf.Model(mesh, "ANS3DEAS", material=steel)
    model.symmetry("x0", normal="x")
    model.fix(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), "y")
    punch = model.prescribe("x0_lower", "z", name="punch")
    contact = model.contact("lower", uf.Cylinder(centre=(25, 0, -20.5), axis="y", radius=20), penalty=100, points=2)

    kernels, solver = Stopwatch(), Stopwatch()
    model.pattern  # noqa: B018  (assembled before the blocks are wrapped)
    model.block = Timed(model.block, kernels, ("evaluate", "recover", "commit"))  # type: ignore[assignment]
    contact.block = Timed(contact.block, kernels, ("evaluate",))  # type: ignore[assignment]
    make = newton.make_solver
    newton.make_solver = lambda *a: Timed(make(*a), solver, ("factor", "solve"))

    start = time.perf_counter()
    steps = [uf.Move(punch, to=-15.0, steps=300), uf.Release(punch)]
    result = uf.solve(model, steps, solver=arguments.solver, frames=0)
    total = time.perf_counter() - start
    iterations = int(result["iterations"].sum())
    rest = total - kernels.seconds - solver.seconds
    print(f"{len(result) - 1} increments, {iterations} iterations, {total:.2f} s on one thread")
    for name, seconds in (("kernels", kernels.seconds), ("solver", solver.seconds), ("Python", rest)):
        print(
            f"{name:<10}{seconds:8.3f} s{100 * seconds / total:7.1f} %{1e3 * seconds / iterations:9.3f} ms an iteration"
        )


if __name__ == "__main__":
    main()
