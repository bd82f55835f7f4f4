"""Microseconds per element for residual and tangent of every element and material, on 1 and 2 threads.

Prints a table; ``--json FILE`` adds it to a file. Ratios within one run are what counts: the machine may be shared.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import record
import umform as uf
from umform import elements
from umform.model import Model

MATERIALS = {
    "SVK": uf.SVK(E=210e3, nu=0.3),
    "NeoHooke": uf.NeoHooke(E=210e3, nu=0.3),
    "NeoHookePower": uf.NeoHookePower(E=210e3, nu=0.3),
    "J2": uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0)),
}


def microseconds(model: Model, u: np.ndarray, repeat: int) -> float:
    """Best time of one evaluation for each element, in microseconds."""
    model.evaluate(u)
    best = np.inf
    for _ in range(repeat):
        start = time.perf_counter()
        model.evaluate(u)
        best = min(best, time.perf_counter() - start)
    return 1e6 * best / len(model.mesh.connectivity)


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, default=40, help="elements along each side of the sheet")
    parser.add_argument("--repeat", type=int, default=5, help="evaluations, of which the fastest counts")
    record.add_option(parser)
    arguments = parser.parse_args()

    rows = []
    print(f"{'element':<14}{'material':<16}{'points':>7}{'1 thread':>12}{'2 threads':>12}   us per element")
    for name in elements.CATALOGUE:
        cell = elements.element(name).cell
        cells = (arguments.cells, arguments.cells) if cell == "hex8" else (arguments.cells // 2, arguments.cells // 2)
        mesh = uf.mesh.strip(length=100.0, width=100.0, thickness=1.0, cells=cells, cell=cell)
        # Stretched and sheared beyond yield, so that J2 returns at every point.
        x, y, z = mesh.points.T
        u = np.stack([4e-3 * x + 1e-3 * y, -1e-3 * y, -2e-3 * z + 1e-4 * x * y / 10.0], axis=1).ravel()
        for label, material in MATERIALS.items():
            model = Model(mesh, name, material=material)
            model.fix("x0")
            times = []
            for threads in (1, 2):
                uf.set_threads(threads)
                times.append(microseconds(model, u, arguments.repeat))
            points = model.block.points
            rows.append({"element": name, "material": label, "points": points, "us_1": times[0], "us_2": times[1]})
            print(f"{name:<14}{label:<16}{points:>7}{times[0]:>12.2f}{times[1]:>12.2f}")
    numbers = {f"{row['element']} {row['material']}, {n} threads, us": row[f"us_{n}"] for row in rows for n in (1, 2)}
    record.write(arguments.json, "kernels", numbers)


if __name__ == "__main__":
    main()
