"""Residual and tangent of every element and law: microseconds, floating-point operations, bytes, share of the peak.

Prints a table; ``--json FILE`` adds it to a file. Operations are counted by running the kernels with a scalar that
counts (``flops.cpp``), the peak of a core is that of a loop of multiply-adds in registers (``peak.cpp``); both are
compiled when a C++ compiler is found. ``--scaling N`` measures 1 and 2 threads side by side on about N elements
instead. Ratios within one run are what counts: the machine may be shared.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

import record
import umform as uf
from sheets import sheet
from umform import elements
from umform.elements.technology import COMPONENTS, Element
from umform.model import Model

HERE = Path(__file__).parent
#: Laws of the table; `sheets` has one more for the instructions.
TIMED = ("SVK", "NeoHooke", "NeoHookePower", "J2 elastic", "J2 plastic")


def best(call: Callable[[], object], repeat: int, clock: Callable[[], float]) -> float:
    """Shortest time of a call."""
    times = []
    for _ in range(repeat):
        start = clock()
        call()
        times.append(clock() - start)
    return min(times)


class Native:
    """The two C++ programs beside this file; None where there is no compiler."""

    def __init__(self, folder: Path) -> None:
        self.compiler = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
        self.folder = folder

    def run(self, source: str, flags: list[str], text: str = "") -> list[float] | None:
        """Compile once, run with ``text`` as input; the numbers of the last line."""
        if self.compiler is None:
            return None
        program = self.folder / Path(source).stem
        if not program.exists():
            include = HERE.parent / "cpp" / "include"
            command = [self.compiler, "-std=c++20", *flags, f"-I{include}", str(HERE / source), "-o", str(program)]
            subprocess.run(command, check=True)
        done = subprocess.run([str(program)], input=text, capture_output=True, text=True, check=True)
        return [float(word) for word in done.stdout.split("\n")[-2].split()]

    def peak(self) -> list[float] | None:
        """GFlop/s and GB/s of one core."""
        return self.run("peak.cpp", ["-O3", "-march=x86-64-v3"])

    def operations(self, model: Model, u: np.ndarray) -> list[float] | None:
        """Operations of strains, law, integration and condensation of the first element."""
        law = model.bodies.only.material
        if not isinstance(law, uf.SVK | uf.J2):
            return None
        constants = [law.lambda_, law.mu]
        if isinstance(law, uf.J2):
            y0, slope = law.hardening.curve()(0.0)
            constants = [law.kappa, law.mu, y0, slope]
        return self.run("flops.cpp", ["-O1"], description(model.bodies.only.element, model, constants, u))


def description(element: Element, model: Model, constants: list[float], u: np.ndarray) -> str:
    """What flops.cpp reads: the element as data, its rule, its law, and nodal values as mean and half difference."""
    index = COMPONENTS.index
    numbers: list[float] = [len(element.tying)]
    for row in element.tying:
        numbers += [index(row.component), row.at_layer, len(row.r), *row.r, len(row.s), *row.s]
    numbers.append(len(element.modes))
    for mode in element.modes:
        numbers.append(len(mode.polynomials))
        for part in mode.polynomials:
            numbers += [index(part.component), part.factor, part.a, part.b, part.c]
    t, w = (np.atleast_2d(part) for part in model.bodies.only.through)
    numbers += [element.nodes, element.surface_points, *t.shape]
    for heights, weights in zip(t, w, strict=True):
        numbers += [*heights, *weights]
    numbers += [len(constants), *constants]
    ids = model.mesh.connectivity[0]
    for field in (model.mesh.points, u.reshape(-1, 3)):
        lower, upper = field[ids[: element.nodes // 2]].T, field[ids[element.nodes // 2 :]].T
        numbers += [*(0.5 * (upper + lower)).ravel(), *(0.5 * (upper - lower)).ravel()]
    return " ".join(repr(float(number)) if isinstance(number, float) else str(int(number)) for number in numbers)


def moved_bytes(model: Model) -> int:
    """Bytes of an element that come from and go to memory beyond the caches.

    Entries of the tangent and their places, forces, coordinates and displacements, history old and new, condensed rows.
    """
    size = 3 * model.bodies.only.element.nodes
    entries = size * (size + 1) // 2
    block = model.bodies.only.block
    return (4 + 16) * entries + 32 * size + 16 * block.points * block.state_size + 8 * block.modes * (size + 3)


def table(names: list[str], cells: int, repeat: int, native: Native) -> list[dict[str, object]]:
    """Print and return a row for each element and law."""
    peak = native.peak()
    if peak is not None:
        print(f"one core: {peak[0]:.1f} GFlop/s in registers (AVX2), {peak[1]:.1f} GB/s")
    heads = f"{'us':>9}{'kflop':>8}{'GFlop/s':>9}{'of peak':>9}{'kB':>7}"
    print(f"{'element':<12}{'law':<15}{'points':>7}{heads}   per element")
    uf.set_threads(1)
    rows: list[dict[str, object]] = []
    for name in names:
        side = cells if elements.element(name).cell == "hex8" else cells // 2
        for law in TIMED:
            model, u = sheet(name, law, (side, side))
            model.evaluate(u)
            seconds = best(partial(model.evaluate, u), repeat, time.process_time) / len(model.mesh.connectivity)
            row: dict[str, object] = {
                "element": name,
                "law": law,
                "points": model.bodies.only.block.points,
                "us": 1e6 * seconds,
            }
            row["bytes"] = moved_bytes(model)
            line = f"{name:<12}{law:<15}{model.bodies.only.block.points:>7}{1e6 * seconds:>9.2f}"
            operations = native.operations(model, u)
            if operations is None or peak is None:
                line += " " * 26
            else:
                row |= {"flops": sum(operations), "of_peak": sum(operations) / seconds / (1e9 * peak[0])}
                line += f"{1e-3 * sum(operations):>8.1f}{1e-9 * sum(operations) / seconds:>9.1f}{row['of_peak']:>8.0%} "
            print(f"{line}{1e-3 * moved_bytes(model):>7.1f}")
            rows.append(row)
    return rows


def scaling(count: int, repeat: int) -> list[dict[str, object]]:
    """Print and return how much faster 2 threads are than 1, taken in turn so that both see the same machine.

    The ratio of wall times needs two free cores. On a shared machine the ratio of CPU times tells what two free cores
    would do: that of one thread over that of the busier of two.
    """
    side = round(count**0.5)
    rows: list[dict[str, object]] = []
    for name, law in [("ANS3DEAS", "SVK"), ("ANS3DEAS", "J2 plastic"), ("MI9K3DEAS", "SVK")]:
        model, u = sheet(name, law, (side, side))
        wall: dict[int, list[float]] = {1: [], 2: []}
        busy: dict[int, list[float]] = {1: [], 2: []}
        for _ in range(repeat):
            for threads in wall:
                uf.set_threads(threads)
                start, of_all, of_first = time.perf_counter(), time.process_time(), time.thread_time()
                model.evaluate(u)
                wall[threads].append(time.perf_counter() - start)
                first, both = time.thread_time() - of_first, time.process_time() - of_all
                busy[threads].append(max(first, both - first))
        row = {"element": name, "law": law, "elements": side**2}
        row |= {"wall": min(wall[1]) / min(wall[2]), "cpu": min(busy[1]) / min(busy[2])}
        print(f"{name:<12}{law:<12}{side**2:>7} elements: {row['wall']:.2f} by wall time, {row['cpu']:.2f} by CPU time")
        rows.append(row)
    return rows


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=40, help="elements along each side of the sheet")
    parser.add_argument("--elements", nargs="+", default=list(elements.CATALOGUE), help="elements by name")
    parser.add_argument("--repeat", type=int, default=5, help="evaluations, of which the fastest counts")
    parser.add_argument("--scaling", type=int, metavar="N", help="measure 2 threads against 1 on about N elements")
    record.add_option(parser)
    arguments = parser.parse_args()
    if arguments.scaling:
        rows = scaling(arguments.scaling, arguments.repeat)
    else:
        with tempfile.TemporaryDirectory() as folder:
            rows = table(arguments.elements, arguments.cells, arguments.repeat, Native(Path(folder)))
    record.write(arguments.json, "threads" if arguments.scaling else "kernels", numbers(rows))


def numbers(rows: list[dict[str, object]]) -> dict[str, float]:
    """What was measured, by element, law and quantity."""
    return {
        f"{row['element']} {row['law']}: {key}": float(value)
        for row in rows
        for key, value in row.items()
        if isinstance(value, int | float)
    }


if __name__ == "__main__":
    main()
