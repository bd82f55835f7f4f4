"""Where the time of one free-bending run goes, and how much of it Python itself takes an iteration.

The run is that of the demo on the coarsest mesh: 24x1 ANS3DEAS, 2x2 contact points, 300 increments and unloading.
"""

from __future__ import annotations

import argparse

import record
import umform as uf


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--solver", default="auto")
    parser.add_argument("--increments", type=int, default=300, help="of 0.05 mm downwards, before the unloading")
    parser.add_argument("--frames", type=int, default=0, help="states kept for pictures in each step, about")
    record.add_option(parser)
    arguments = parser.parse_args()
    uf.set_threads(1)

    mesh = uf.mesh.strip(length=60, width=10, thickness=1, cells=(24, 1))
    steel = uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Perfect(yield_stress=160))
    model = uf.Model(mesh, "ANS3DEAS", material=steel, thickness_order=1, thickness_points=5)
    model.symmetry("x0", normal="x")
    model.fix(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), "y")
    punch = model.prescribe("x0_lower", "z", name="punch")
    model.contact("lower", uf.Cylinder(centre=(25, 0, -20.5), axis="y", radius=20), penalty=100, points=2)
    count = arguments.increments
    steps = [uf.Move(punch, to=-0.05 * count, steps=count), uf.Release(punch)]
    result = uf.solve(model, steps, solver=arguments.solver, frames=arguments.frames, progress=False)

    iterations = result.timing.elements.calls  # those of increments that were cut or taken back too
    print(f"{len(result) - 1} increments, {iterations} evaluations, {result.timing.total:.2f} s on one thread")
    print(f"{'':<24}{'s':>8}{'%':>8}{'ms an evaluation':>19}")
    numbers = {}
    for name, seconds, share, _ in result.timing.rows():
        numbers[f"{name}, ms an evaluation"] = each = 1e3 * seconds / iterations
        print(f"{name:<24}{seconds:>8.3f}{100 * share:>8.1f}{each:>19.3f}")
    record.write(arguments.json, "run", numbers | {"all, s": result.timing.total})


if __name__ == "__main__":
    main()
