"""How the sparse solvers compare: analysis, factorisation with the analysis kept, solve, and peak memory.

Tangents of flat sheets: as they are at rest (positive), moved down until some eigenvalues are negative (indefinite),
and with another lower than upper triangle (unsymmetric); scaled ones have equations and unknowns in units between 1e-12
and 1e12. Each measurement has a process of its own, which gives its best of some factorisations; solvers take turns, so
that a shared machine troubles all alike. Milliseconds of CPU time on one thread, by the clock on several. Memory is
what the process grows by from the analysis on: the model and its matrix are not counted.

``python benchmarks/sparse.py --page docs/performance-solving.md`` measures the large sheets on one thread and two, and
writes the multifrontal solver beside PARDISO between the marks of the page; a case without both is left out.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import pages
import record
import umform as uf
from umform.solvers import Pattern, available, make_solver

#: Elements along and across, cell, factorisations in a process.
CASES = {
    "strip 24x1": ((24, 1), "hex8", 50),
    "strip 48x2": ((48, 2), "hex8", 50),
    "strip 24x2, 18 nodes": ((24, 2), "hex18", 50),
    "sheet 16x16": ((16, 16), "hex8", 200),
    "sheet 20x20": ((20, 20), "hex8", 20),
    "sheet 40x40": ((40, 40), "hex8", 10),
    "sheet 100x100": ((100, 100), "hex8", 5),
    "sheet 50x50, 18 nodes": ((50, 50), "hex18", 5),
    "sheet 200x200": ((200, 200), "hex8", 3),
    "sheet 316x316": ((316, 316), "hex8", 2),
}
KINDS = ("positive", "indefinite", "unsymmetric", "scaled indefinite", "scaled unsymmetric")
#: What the page shows: large sheets, kinds, solvers, threads.
LARGE = ("sheet 100x100", "sheet 200x200", "sheet 316x316")
BESIDE = ("multifrontal", "pardiso")
#: What is measured: milliseconds, and megabytes.
COLUMNS = ("analysis", "factor", "solve", "MB")
TIMES = COLUMNS[:3]


def tangent(cells: tuple[int, int], cell: str, kind: str = "positive") -> tuple[Pattern, np.ndarray]:
    """Pattern and entries of the tangent of a clamped sheet."""
    if kind.startswith("scaled "):
        pattern, values = tangent(cells, cell, kind.removeprefix("scaled "))
        rows, columns = 10.0 ** np.random.default_rng(0).uniform(-12.0, 12.0, (2, pattern.n))
        return pattern, values * rows[pattern.rows] * (rows if pattern.symmetric else columns)[pattern.indices]
    mesh = uf.mesh.strip(length=float(cells[0]), width=float(cells[1]), thickness=0.5, cells=cells, cell=cell)
    model = uf.Model(mesh, "ANS3DEAS" if cell == "hex8" else "MI9K3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    model.fix("x0")
    pattern, values = model.system.pattern, model.evaluate(np.zeros_like(model.u)).values.copy()
    diagonal = pattern.indptr[:-1]
    if kind == "indefinite":
        values[diagonal] -= 1e-4 * values[diagonal].mean()
    return unsymmetric(pattern, values) if kind == "unsymmetric" else (pattern, values)


def unsymmetric(pattern: Pattern, values: np.ndarray) -> tuple[Pattern, np.ndarray]:
    """The whole matrix, its lower triangle a tenth smaller than the upper one."""
    from scipy import sparse

    upper = sparse.csr_matrix((values, pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n))
    matrix = (upper + 0.9 * sparse.triu(upper, 1).T).tocsr()
    matrix.sort_indices()
    whole = Pattern(pattern.n, matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32), symmetric=False)
    return whole, matrix.data


def resident(what: str) -> float:
    """Megabytes of this process: VmRSS now, VmHWM at most; 0 where the system does not say."""
    status = Path("/proc/self/status")
    found = re.search(rf"{what}:\s+(\d+)", status.read_text()) if status.is_file() else None
    return int(found[1]) / 1e3 if found else 0.0


def forget_peak() -> None:
    """Count the peak from here on, where the system can."""
    if (peak := Path("/proc/self/clear_refs")).exists():
        peak.write_text("5")


def measure(case: str, kind: str, name: str, threads: int) -> dict[str, float]:
    """Milliseconds, megabytes and millions of entries of one solver, in this process."""
    uf.set_threads(threads)
    cells, cell, repeat = CASES[case]
    pattern, values = tangent(cells, cell, kind)
    make_solver(tangent((2, 2), "hex8")[0], name)  # what is imported once
    clock = time.process_time if threads == 1 else time.perf_counter
    forget_peak()
    before, start = resident("VmRSS"), clock()
    solver = make_solver(pattern, name)
    took = {"n": pattern.n, "analysis": clock() - start, "factor": np.inf, "solve": np.inf}
    rhs = np.ones(pattern.n)
    for _ in range(repeat + 1):
        start = clock()
        took["fill"] = solver.factor(values).fill / 1e6
        middle = clock()
        solver.solve(rhs)
        took["factor"], took["solve"] = min(took["factor"], middle - start), min(took["solve"], clock() - middle)
    return took | {what: 1e3 * took[what] for what in TIMES} | {"MB": resident("VmHWM") - before}


def apart(*arguments: str, threads: int) -> dict[str, float] | None:
    """Measure in a new process; None if the solver refuses."""
    environment = os.environ | {"OMP_NUM_THREADS": str(threads), "MKL_NUM_THREADS": str(threads)}
    command = [sys.executable, __file__, "--one", *arguments, str(threads)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    return json.loads(done.stdout) if done.returncode == 0 else None


def rounded(number: float) -> str:
    """A number with three digits at least."""
    return f"{number:.0f}" if number >= 100 else f"{number:.3g}"


def best_of(case: str, kind: str, names: list[str], threads: int, rounds: int) -> dict[str, dict[str, float]]:
    """The best measurements of each solver, without those that refuse."""
    best: dict[str, dict[str, float]] = {}
    for _ in range(rounds):
        for name in names:
            took = apart(case, kind, name, threads=threads)
            known = best.get(name, took)
            if took and known:
                best[name] = {what: min(took[what], known[what]) for what in took}
    return best


def beside(case: str, kind: str, threads: int, best: dict[str, dict[str, float]]) -> str:
    """Row of the page: the numbers of two solvers beside each other."""
    sheet = case.removeprefix("sheet ") + (f", {threads} threads" if threads > 1 else "")
    cells = [rounded(best[name][what]) for what in COLUMNS for name in BESIDE]
    equations = f"{best[BESIDE[0]]['n']:,.0f}".replace(",", " ")
    return f"| {sheet} | {equations} | {kind} | {' | '.join(cells)} |"


def main() -> None:
    """Run the benchmark."""
    names = [name for name, here in available().items() if here]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--case", choices=CASES, action="append", help="default: up to 40x40; with --page the large")
    parser.add_argument("--kind", choices=KINDS, action="append", help="default: positive; with --page the first three")
    parser.add_argument("--solver", choices=names, action="append", help="default: all that are installed")
    parser.add_argument("--threads", type=int, nargs="+", help="default: 1; with --page 1 and 2")
    parser.add_argument("--rounds", type=int, default=3, help="processes for each number, of which the best counts")
    parser.add_argument("--one", nargs=4, metavar=("CASE", "KIND", "SOLVER", "THREADS"), help="measure here, as JSON")
    parser.add_argument("--page", type=Path, help="page that gets the table between its marks")
    record.add_option(parser)
    arguments = parser.parse_args()
    if arguments.one:
        *which, threads = arguments.one
        print(json.dumps(measure(*which, int(threads))))
        return
    paged = arguments.page is not None
    if paged and not set(BESIDE) <= set(names):
        parser.error('the page needs PARDISO: pip install "umform[pardiso]"')
    solvers = arguments.solver or (list(BESIDE) if paged else names)
    numbers: dict[str, float] = {}
    heads = " | ".join(f"{what} | PARDISO" for what in COLUMNS)
    rows = [f"| sheet | equations | matrix | {heads} |", "|---|---:|---|" + "---:|" * 2 * len(COLUMNS)]
    print(f"| sheet | equations | matrix | threads | solver | {' | '.join(COLUMNS)} | fill, 1e6 |")
    print("|---|---:|---|---:|---|---:|---:|---:|---:|---:|")
    for threads in arguments.threads or ([1, 2] if paged else [1]):
        for case in arguments.case or (LARGE if paged else list(CASES)[:6]):
            for kind in arguments.kind or KINDS[: 3 if paged else 1]:
                best = best_of(case, kind, solvers, threads, arguments.rounds)
                for name, took in best.items():
                    cells = " | ".join(rounded(took[what]) for what in COLUMNS)
                    row = f"| {case} | {took['n']:.0f} | {kind} | {threads} | {name} | {cells} | {took['fill']:.3g} |"
                    print(row, flush=True)
                    label = f"{case}, {kind}, {threads} threads, {name}"
                    numbers |= {f"{label}, {what}": took[what] for what in COLUMNS}
                if set(BESIDE) <= set(best):
                    rows.append(beside(case, kind, threads, best))
    record.write(arguments.json, "sparse", numbers)
    if paged:
        pages.put(arguments.page, "sparse", "\n".join(rows))


if __name__ == "__main__":
    main()
