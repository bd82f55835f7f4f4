"""How the sparse solvers compare: time of a factorisation with the analysis kept, as ratios to the fastest one; and
what the analysis takes, that of the choice among them (`auto`) too, as ratios to the same factorisation.

A second table has what the order of a sheet does for PARDISO, beside the order that PARDISO finds itself.

Tangents of flat sheets at rest. The solvers that are installed take turns, so that a shared machine troubles all alike.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import record
import umform as uf
from umform.solvers import available, make_solver
from umform.solvers.pardiso import Pardiso

#: Name, elements along and across, cell, repetitions.
CASES = (
    ("strip 24x1", (24, 1), "hex8", 50),
    ("strip 48x2", (48, 2), "hex8", 30),
    ("strip 24x2, 18 nodes", (24, 2), "hex18", 20),
    ("sheet 20x20", (20, 20), "hex8", 10),
    ("sheet 40x40", (40, 40), "hex8", 3),
)

#: Sheets of the second table: elements along and across, cell, repetitions; in blocks from 100 000 equations on.
SHEETS = (((48, 48), "hex8", 20), ((100, 100), "hex8", 5), ((50, 50), "hex18", 5), ((300, 120), "hex8", 2))


class Metis(Pardiso):
    """PARDISO with the order that it finds itself."""

    name = "metis"

    def _order(self) -> None:
        return None


def tangent(cells: tuple[int, int], cell: str) -> tuple[uf.Model, np.ndarray]:
    """Model of a clamped sheet and the entries of its tangent at rest."""
    mesh = uf.mesh.strip(length=float(cells[0]), width=float(cells[1]), thickness=0.5, cells=cells, cell=cell)
    model = uf.Model(mesh, "ANS3DEAS" if cell == "hex8" else "MI9K3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    return model, model.evaluate(np.zeros_like(model.u)).values


def orders() -> dict[str, float]:
    """Print what PARDISO takes with both orders: best CPU milliseconds, and millions of entries of the factors."""
    numbers: dict[str, float] = {}
    columns = "".join(f"{what:>10}{'METIS':>9}" for what in ("analysis", "factor", "fill"))
    print(f"\n{'ms, and 1e6 entries':<24}{'n':>7}{columns}")
    for cells, cell, repeat in SHEETS:
        model, values = tangent(cells, cell)
        solvers = (Pardiso(), Metis())
        took = np.full((3, 2), np.inf)
        for _ in range(repeat):
            for k, solver in enumerate(solvers):
                begin = time.process_time()
                solver.analyse(model.pattern)
                middle = time.process_time()
                fill = solver.factor(values).fill
                end = time.process_time()
                took[:, k] = np.minimum(took[:, k], (1e3 * (middle - begin), 1e3 * (end - middle), 1e-6 * fill))
        label = f"sheet {cells[0]}x{cells[1]}, {cell}"
        row = "".join(f"{own:>10.1f}{metis:>9.1f}" for own, metis in took)
        print(f"{label:<24}{model.pattern.n:>7}{row}")
        for what, (own, metis) in zip(("analysis, ms", "factor, ms", "fill, 1e6"), took, strict=True):
            numbers |= {f"{label}, {what}": own, f"{label}, METIS, {what}": metis}
    return numbers


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--case", choices=[case[0] for case in CASES], action="append", help="default: all")
    record.add_option(parser)
    arguments = parser.parse_args()
    numbers: dict[str, float] = {}
    names = [name for name, here in available().items() if here]
    columns = "".join(f"{name:>10}" for name in names)
    print(f"{'fastest factorisation = 1':<24}{'n':>7}{columns}   {'auto':>10}{columns}   (analysis)")
    for label, cells, cell, repeat in CASES:
        if arguments.case and label not in arguments.case:
            continue
        model, values = tangent(cells, cell)
        best = dict.fromkeys(names, np.inf)
        analysis, solvers = {}, {}
        for name in ("auto", *names):
            start = time.perf_counter()
            solvers[name] = make_solver(model.pattern, name)
            analysis[name] = time.perf_counter() - start
        del solvers["auto"]
        for _ in range(repeat):
            for name, solver in solvers.items():
                start = time.perf_counter()
                solver.factor(values)
                best[name] = min(best[name], time.perf_counter() - start)
        fastest = min(best.values())
        ratios = "".join(f"{best[name] / fastest:>10.1f}" for name in names)
        analyses = "".join(f"{seconds / fastest:>10.1f}" for seconds in analysis.values())
        print(f"{label:<24}{model.pattern.n:>8}{ratios}   {analyses}")
        numbers |= {f"{label}, {name}, ms": 1e3 * best[name] for name in names}
        numbers |= {f"{label}, {name}, analysis, ms": 1e3 * seconds for name, seconds in analysis.items()}
    if "pardiso" in names:
        numbers |= orders()
    record.write(arguments.json, "sparse", numbers)


if __name__ == "__main__":
    main()
