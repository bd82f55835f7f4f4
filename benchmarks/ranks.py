"""One Newton iteration on 1 and 2 ranks: time, memory a rank, fill of the factors; growth to 10 million elements.

    python benchmarks/ranks.py                    # measures (minutes, and 6 GB at 102 400 elements); writes the figure
    python benchmarks/ranks.py benchmarks/ranks.json # tables and figure once more, from what was measured
    python benchmarks/ranks.py benchmarks/ranks.json memory # repeat the measurements of memory only
    mpiexec -n 2 python benchmarks/ranks.py 160   # one measurement: a sheet of 160 x 160 elements, as one line of JSON
    mpiexec -n 2 python benchmarks/ranks.py 1000 describe   # no more than the description of the sheet, and its parts
    mpiexec -n 8 python benchmarks/ranks.py 480000 tables   # what MUMPS keeps of each unknown on every rank

Needs the solver petsc (docs/parallel.md). A sheet of J2 over a cylinder, element ANS3DEAS with 5 points through the
thickness, is bent to where it is plastic; the displacement is given, so that every run does the same work.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import umform as uf
from ranks_growth import GB, Costs, Growth

SIZES, RANKS, DESCRIBED, REPEATS = (80, 160, 320), (1, 2), 1000, 2
BLOCK, BLOCKED, BLOCKS_ON = 12, (480_000, 960_000), 8
GAINS = (("wall", "{:.2f}"), ("cpu", "({:.2f})"))
ITERATION = ("evaluation", "factorisation", "solution")
MEASURED = Path("benchmarks/ranks.json")
FIGURE = Path("docs/images/ranks.png")


def sheet(cells: int) -> uf.Model:
    """A square sheet of 1 mm over a cylinder; the elements are squares of 1 mm."""
    mesh = uf.mesh.strip(float(cells), float(cells), 1.0, (cells, cells))
    steel = uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Linear(160.0, 500.0))
    model = uf.Model(mesh, "ANS3DEAS", material=steel, thickness_order=1, thickness_points=5)
    model.symmetry("x0", normal="x")
    model.symmetry("y0", normal="y")
    model.prescribe("x0_lower", "z", "punch")
    model.contact("lower", uf.Cylinder((0.6 * cells, 0.0, -20.5), "y", 20.0), penalty=100.0, name="tool")
    return model


def bent(points: np.ndarray, radius: float = 40.0) -> np.ndarray:
    """Displacement of a sheet that is bent to a radius: strains of 1.25 per cent at its faces."""
    x, z = points[:, 0], points[:, 2]
    arm = radius + z
    position = np.stack([arm * np.sin(x / radius), points[:, 1], arm * np.cos(x / radius) - radius], axis=1)
    return (position - points).ravel()


def memory(peak: bool = False) -> float:
    """Memory of this process in GB, now or at most so far."""
    if peak:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / GB
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / GB


def measure(cells: int) -> dict[str, object]:
    """Seconds (wall and CPU) of the parts of an iteration and memory after them, the largest of all ranks."""
    from umform.analysis.ranks.outline import Outline
    from umform.analysis.ranks.run import hand_out
    from umform.parallel.mpi_ranks import world
    from umform.parallel.solver import Petsc

    ranks, wall, cpu, held = world(), {}, {}, {"start": memory()}

    def timed(name, work):
        ranks.comm.Barrier()
        start, used = time.perf_counter(), time.process_time()
        answer = work()
        wall[name], cpu[name] = time.perf_counter() - start, time.process_time() - used
        held[name] = memory()
        return answer

    model = timed("describe", lambda: ranks.on_first(lambda: sheet(cells)))
    outline = Outline.from_first(None if model is None else Outline.of(model), ranks)
    share = timed("share", lambda: hand_out(outline, model, ranks))
    u, solver = bent(share.mesh.points), Petsc()
    timed("first evaluation", lambda: share.evaluate(u))
    found = timed("evaluation", lambda: share.evaluate(u))
    timed("matrix", lambda: solver.analyse(share.system.pattern))
    timed("first factorisation", lambda: solver.factor(found.values))
    factors = timed("factorisation", lambda: solver.factor(found.values))
    timed("solution", lambda: solver.solve(share.system.restrict(found.residual)))
    held["peak"] = memory(peak=True)
    flops = solver._ksp.pc.getFactorMatrix().getMumpsRinfog(3)
    others = {key: value if ranks.rank > 0 else 0.0 for key, value in held.items()}
    largest = {name: {key: ranks.max(value) for key, value in one.items()} for name, one in
               (("wall", wall), ("cpu", cpu), ("memory", held), ("others", others))}  # fmt: skip
    return {
        "elements": cells * cells,
        "unknowns": share.system.pattern.n,
        "ranks": ranks.size,
        "fill": factors.fill,
        "flops": flops,
        **largest,
    }


def describe(cells: int) -> dict[str, object]:
    """Bytes an element that the first rank takes to describe a sheet and to cut it; of the other, an own element."""
    from umform.analysis.ranks.outline import Outline
    from umform.analysis.ranks.run import hand_out
    from umform.parallel.mpi_ranks import world

    ranks = world()
    before, start = memory(), time.process_time()
    model = ranks.on_first(lambda: sheet(cells))
    kept = memory() - before
    outline = Outline.from_first(None if model is None else Outline.of(model), ranks)
    share = hand_out(outline, model, ranks)
    of_each = ranks.comm.gather(
        {
            "kept": kept * GB / cells**2,
            "peak": (memory(peak=True) - before) * GB / cells**2,
            "own kept": (memory() - before) * GB / len(share.cells),
            "own peak": (memory(peak=True) - before) * GB / len(share.cells),
        }
    )
    if ranks.rank > 0:
        return {}
    own = {name: max(one[name] for one in of_each[1:]) for name in ("own kept", "own peak")}
    first = {name: of_each[0][name] for name in ("kept", "peak")}
    return {"elements": cells**2, "seconds": time.process_time() - start, **first, **own, "arrays": arrays_of(model)}


def arrays_of(model: uf.Model) -> dict[str, float]:
    """Bytes an element of the arrays of a model, by what they hold."""
    mesh, contacts = model.mesh, model.contacts
    arrays = {
        "points": [mesh.points],
        "cells": [mesh.connectivity],
        "sets and faces": [*mesh.sets.values(), *mesh.faces.values()],
        "displacement and supports": [model.u, model.supports.fixed],
        "contact facets": [array for contact in contacts for array in (contact.facets, contact.nodes)],
    }
    return {name: sum(array.nbytes for array in each) / len(mesh.connectivity) for name, each in arrays.items()}


def tables(unknowns: int) -> dict[str, float]:
    """Bytes that MUMPS takes on a rank with hardly a share of the matrix, and entries of the factors that it gets.

    The matrix has dense blocks on its diagonal. All but one on each other rank are the first rank's.
    """
    from petsc4py import PETSc

    from umform.parallel.mpi_ranks import world

    ranks = world()
    rows = BLOCK if ranks.rank else unknowns - BLOCK * (ranks.size - 1)
    matrix = PETSc.Mat().createAIJ(((rows, None), (rows, None)), nnz=(BLOCK, 0), comm=ranks.petsc_comm)
    first, last = matrix.getOwnershipRange()
    for begin in range(first, last, BLOCK):
        block = np.arange(begin, begin + BLOCK, dtype=PETSc.IntType)
        matrix.setValues(block, block, np.eye(BLOCK) + 1.0)
    matrix.assemble()
    solver = PETSc.KSP().create(ranks.petsc_comm)
    solver.setType("preonly")
    solver.pc.setType("cholesky")
    solver.pc.setFactorSolverType("mumps")
    solver.setOperators(matrix)
    before = memory()
    solver.setUp()
    taken = ranks.comm.gather(((memory() - before) * GB, solver.pc.getFactorMatrix().getMumpsInfo(27)))
    if ranks.rank > 0:
        return {}
    taken, entries = np.mean(taken[1:], axis=0)
    return {"unknowns": unknowns, "bytes": taken, "entries": entries}


def launch(ranks: int, *words: object) -> dict:
    """The same in processes of its own."""
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
    command = ["mpiexec", "--oversubscribe", "-n", str(ranks), sys.executable, __file__, *map(str, words)]
    done = subprocess.run(command, env={**os.environ, **root}, capture_output=True, text=True, check=True)
    return json.loads(done.stdout.splitlines()[-1])


def fastest(ranks: int, cells: int) -> dict:
    """The fastest of some runs: others may use the machine."""
    return min((launch(ranks, cells) for _ in range(REPEATS)), key=lambda run: seconds(run, "wall"))


def seconds(run: dict, clock: str) -> float:
    """Seconds of one iteration, with the analysis of MUMPS kept."""
    return sum(run[clock][part] for part in ITERATION)


def table(runs: list[dict]) -> None:
    """What was measured: wall seconds, and the CPU seconds of the slowest rank in brackets."""
    print("| elements | unknowns | ranks | evaluation | first factorisation | factorisation | solution | iteration "
          "| faster by | peak GB, first rank | other | entries of the factors | operations |")  # fmt: skip
    print("|" + "---|" * 13)
    for run in runs:
        wall, cpu, others = run["wall"], run["cpu"], run["others"]["peak"]
        parts = ("evaluation", "first factorisation", "factorisation", "solution")
        each = " | ".join(f"{wall[part]:.2f} ({cpu[part]:.2f})" for part in parts)
        alone = next(one for one in runs if one["ranks"] == 1 and one["elements"] == run["elements"])
        gain = " ".join(form.format(seconds(alone, clock) / seconds(run, clock)) for clock, form in GAINS)
        print(f"| {run['elements']} | {run['unknowns']} | {run['ranks']} | {each} "
              f"| {seconds(run, 'wall'):.2f} ({seconds(run, 'cpu'):.2f}) | {gain} "
              f"| {run['memory']['peak']:.2f} | {f'{others:.2f}' if others else ''} "
              f"| {run['fill']:.3g} | {run['flops']:.3g} |")  # fmt: skip


def forecast(runs: list[dict], described: dict, tables: list[dict]) -> None:
    """The model with all points, how well it foretells the largest run from the others, and what it says."""
    alone = [run for run in runs if run["ranks"] == 1]
    *smaller, last = alone
    before, growth, costs = Growth(smaller), Growth(alone), Costs(last, described, tables)
    m = last["elements"]
    print(f"\nfill of {m} elements, foretold by the smaller runs: {before.fill(m) / last['fill'] - 1:+.1%}, "
          f"operations {before.flops(m) / last['flops'] - 1:+.1%}")  # fmt: skip
    print(f"a = {growth.fill_terms[0]:.3g}, b = {growth.fill_terms[1]:.3g}, c = {growth.flop_terms[0]:.3g}, "
          f"d = {growth.flop_terms[1]:.3g}; {costs.rate:.3g} operations a second")  # fmt: skip
    print(f"bytes an element of the whole on the first rank: {costs.described * GB:.0f} described, "
          f"{costs.cutting * GB:.0f} until it is cut "
          f"({described['seconds'] / described['elements'] * 1e6:.1f} s a million); on every rank of many: "
          f"{costs.tables * GB:.0f} by MUMPS\nbytes an own element: {described['own kept']:.0f} as it arrives, "
          f"{costs.own * GB:.0f} with history and matrix; "
          f"an entry of the factors: {costs.entry * GB:.1f}\narrays of the description, bytes an element: "
          + ", ".join(f"{name} {size:.0f}" for name, size in described["arrays"].items()) + "\n")  # fmt: skip
    for run in (run for run in runs if run["elements"] == m and run["ranks"] > 1):
        held = costs.memory(m, run["ranks"], growth)
        print(f"on {run['ranks']} ranks the fullest one took {run['memory']['peak'] / held - 1:+.0%} of that\n")
    counts = (16, 64, 256)
    print("| elements | entries of the factors | core hours an iteration | GB, 1 rank "
          + "".join(f"| {count} ranks: first, others, all " for count in counts) + "|")  # fmt: skip
    print("|" + "---|" * (4 + len(counts)))
    for m in (102_400, 1_000_000, 10_000_000):
        cells = [f"{growth.fill(m):.3g}", f"{costs.seconds(m, growth) / 3600:.3g}", f"{costs.memory(m, 1, growth):.3g}"]
        for count in counts:
            first, other = costs.memory(m, count, growth), costs.memory(m, count, growth, first=False)
            cells.append(f"{first:.3g}, {other:.3g}, {first + (count - 1) * other:.3g}")
        print(f"| {m} | " + " | ".join(cells) + " |")
    draw(runs, growth, costs)


def draw(runs: list[dict], growth: Growth, costs: Costs) -> None:
    """Seconds and memory against elements, the measured points on the curves."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.6), layout="constrained")
    m = np.geomspace(5e3, 1e7, 60)
    left.loglog(m, [costs.seconds(x, growth) for x in m], "k-", label="one iteration")
    left.loglog(m, costs.evaluation * m, "k:", label="its evaluation")
    alone = [run for run in runs if run["ranks"] == 1]
    left.loglog(
        [run["elements"] for run in alone], [seconds(run, "cpu") for run in alone], "ro", label="measured, 1 rank"
    )
    left.set(xlabel="elements", ylabel="CPU seconds")
    for ranks, style in ((1, "k-"), (2, "k-."), (16, "k--"), (256, "k:")):
        label = f"{ranks} rank{'s' if ranks > 1 else ''}"
        right.loglog(m, [costs.memory(x, ranks, growth) for x in m], style, label=label)
        if ranks > 2:
            others = [costs.memory(x, ranks, growth, first=False) for x in m]
            right.loglog(m, others, style[1:], color="0.6", label="each of the others")
        measured = [run for run in runs if run["ranks"] == ranks]
        if measured:
            points = [run["elements"] for run in measured], [run["memory"]["peak"] for run in measured]
            right.loglog(*points, "ro" if ranks == 1 else "bs", label=f"measured, {label}")
    right.set(xlabel="elements", ylabel="GB of the first rank, and of others")
    for axes in (left, right):
        axes.legend(frameon=False, fontsize=8)
        axes.grid(True, which="major", alpha=0.3)
    figure.savefig(FIGURE, dpi=150)


def main(words: list[str]) -> None:
    """Measure here, or start the measurements and draw conclusions."""
    if words and words[0].isdecimal():
        kind = {"describe": describe, "tables": tables}.get(words[-1], measure)
        outcome = kind(int(words[0]))
        from umform.parallel.mpi_ranks import world

        if world().rank == 0:
            print(json.dumps(outcome))
        return
    if words:
        found = json.loads(Path(words[0]).read_text())
    else:
        found = {"runs": [fastest(ranks, cells) for cells in SIZES for ranks in RANKS]}
    if "memory" in words:
        for run in found["runs"]:
            anew = launch(run["ranks"], round(run["elements"] ** 0.5))
            run |= {name: anew[name] for name in ("memory", "others")}
    if not words or "memory" in words:
        found["described"] = launch(RANKS[-1], DESCRIBED, "describe")
        found["tables"] = [launch(BLOCKS_ON, unknowns, "tables") for unknowns in BLOCKED]
        MEASURED.write_text(json.dumps(found, indent=1))
    table(found["runs"])
    forecast(found["runs"], found["described"], found["tables"])


if __name__ == "__main__":
    main(sys.argv[1:])
