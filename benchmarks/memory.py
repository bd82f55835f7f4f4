"""Peak memory of a sheet of many elements, from the start of Python to the first solution, and what takes it.

Everything happens in a process of its own, so that the peak is that of the run; ``--elements 100000`` needs some 3 GB.
"""

from __future__ import annotations

import argparse
import json
import math
import re
import resource
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import record

MB = 1e6


def peak() -> float:
    """Largest memory of this process so far, in MB; the system's own count begins with that of the parent."""
    status = Path("/proc/self/status")
    if status.exists():
        return float(re.search(r"VmHWM:\s+(\d+) kB", status.read_text()).group(1)) * 1024 / MB  # type: ignore[union-attr]
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / MB


def stages(elements: int, solver: str) -> Iterator[tuple[str, float, float]]:
    """Name, peak after it and bytes that are known to be held, both in MB, of the stages of one iteration."""
    import umform as uf
    from umform.analysis.newton.newton import Newton

    yield "umform and numpy loaded", peak(), math.nan
    side = round(math.sqrt(elements))
    mesh = uf.mesh.strip(length=float(side), width=float(side), thickness=0.5, cells=(side, side))
    steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0))
    model = uf.Model(mesh, "ANS3DEAS", material=steel, thickness_order=1, thickness_points=5)
    model.fix("x0")
    block, count = model.bodies.only.block, len(mesh.connectivity)
    held = 2 * block.state.nbytes
    yield "history, converged and trial", peak(), held / MB
    condensed = 8 * count * block.modes * (1 + mesh.connectivity.shape[1] * 3)
    yield "condensed blocks of the enhanced parameters", peak(), condensed / MB
    maps = [scatter for scatters in model.system._assembly().scatters.values() for scatter in scatters]
    yield "scatter map", peak(), sum(scatter.bytes for scatter in maps) / MB
    pattern = model.system.pattern
    yield "pattern, upper triangle", peak(), (pattern.indices.nbytes + pattern.indptr.nbytes) / MB
    evaluation = model.evaluate(model.u)
    yield "matrix, upper triangle", peak(), evaluation.values.nbytes / MB
    newton = Newton(model.system, solver=solver)
    sparse = newton.ready_solver()
    yield f"analysis by {sparse.solver.name}", peak(), math.nan
    told = sparse.factor(evaluation)
    yield "factors", peak(), 8 * told.fill / MB
    sparse.solve(np.ones(pattern.n))
    yield "solution", peak(), 8 * pattern.n / MB


def main() -> None:
    """Start the process, print what it says."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--elements", type=int, default=10_000, help="a square sheet of about so many")
    parser.add_argument("--solver", default="auto")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    record.add_option(parser)
    arguments = parser.parse_args()
    if arguments.inside:
        print(json.dumps(list(stages(arguments.elements, arguments.solver))))
        return
    output = subprocess.run(
        [sys.executable, *sys.argv, "--inside"], check=True, stdout=subprocess.PIPE, text=True
    ).stdout
    rows = json.loads(output)
    print(f"{'':<46}{'holds MB':>10}{'peak MB':>10}   {arguments.elements} elements")
    for name, highest, held in rows:
        print(f"{name:<46}{'' if math.isnan(held) else f'{held:.1f}':>10}{highest:>10.0f}")
    numbers = {f"{name}, MB": held for name, _, held in rows if not math.isnan(held)}
    record.write(arguments.json, f"memory {arguments.elements}", numbers | {"peak, MB": rows[-1][1]})


if __name__ == "__main__":
    main()
