"""What threads bring, by the clock: one evaluation of a sheet, a whole cup, and a large sheet under a sphere.

    python benchmarks/threads.py sheets               # 225, 625 and 1600 elements, all points flow (two minutes)
    python benchmarks/threads.py cups --turns 2       # whole runs of 240 and 768 elements, one thread and two in turns
    python benchmarks/threads.py cups --cpu           # CPU seconds of their parts instead
    python benchmarks/threads.py dome                 # 40 000 elements of `dome.py`

It needs as many free processors as threads; the load of the machine is printed. Numbers of threads take turns, and the
shortest time of each counts. On a loaded machine only CPU times mean something: those of the busier thread, and an
estimate for free processors from what runs outside of the loop and from the groups of four elements in the line. It
leaves out how long a thread takes to wake up, some 15 us.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import os
import subprocess
import sys
import time
from typing import Any
from unittest.mock import patch

SHEETS = (15, 25, 40)
#: Elements of a group, and numbers of threads for the estimates.
LANES, ESTIMATED = 4, (2, 8, 16)
#: Mesh of a cup by its number of elements.
CUPS: dict[int, dict[str, Any]] = {240: {}, 768: {"turn": 9.0, "around": 24}}
#: What a run says beside the seconds of its parts.
BESIDE = ("CPU seconds", "force")


def evaluations(side: int, threads: list[int], repeat: int) -> dict[str, Any]:
    """Shortest evaluation of a square sheet of AA6016 (Yld2004) in which all points flow, in ms; as CPU time too."""
    import umform as uf
    from sheets import stretched

    mesh = uf.mesh.strip(length=100.0, width=100.0, thickness=1.0, cells=(side, side))
    model = uf.Model(mesh, material=uf.sheet_metals.get("AA6016-T4").law, rolling=(1.0, 0.0, 0.0))
    model.fix("x0")
    u = stretched(mesh, 100.0)
    wall: dict[int, list[float]] = {count: [] for count in threads}
    busy: dict[int, list[float]] = {count: [] for count in threads}
    bits = set()
    for _ in range(repeat):
        for count in threads:
            uf.set_threads(count)
            start, of_all, of_first = time.perf_counter(), time.process_time(), time.thread_time()
            evaluation = model.evaluate(u)
            wall[count].append(time.perf_counter() - start)
            first, both = time.thread_time() - of_first, time.process_time() - of_all
            busy[count].append(max(first, (both - first) / max(count - 1, 1)))
            bits.add((evaluation.residual.tobytes(), evaluation.values.tobytes()))
    if len(bits) != 1:
        raise SystemExit("the bits differ")
    uf.set_threads(1)
    alone = [of_one_thread(model, u) for _ in range(repeat)]
    return {
        "elements": side**2,
        "points": model.bodies.only.block.points * side**2,
        "wall": {count: 1e3 * min(times) for count, times in wall.items()},
        "busy": {count: 1e3 * min(times) for count, times in busy.items()},
        "cpu": 1e3 * min(whole for whole, _ in alone),
        "outside": 1e3 * min(outside for _, outside in alone),
    }


def of_one_thread(model: Any, u: Any) -> tuple[float, float]:
    """CPU seconds of an evaluation, and of what no thread shares: all but the block of elements."""
    with patch.object(time, "perf_counter", time.thread_time):  # the clock of `umform.timing`
        before, start = model.system.timing.elements.seconds, time.thread_time()
        model.evaluate(u)
        whole = time.thread_time() - start
        inside = model.system.timing.elements.seconds - before
        start = time.thread_time()
        _ = model.bodies.only.block.flowing  # part of the time of the elements
        return whole, whole - inside + time.thread_time() - start


def estimate(row: dict[str, Any], threads: int) -> float:
    """Times as fast on free processors: a group takes as long as any other, and the last round may not be full."""
    groups = math.ceil(row["elements"] / LANES)
    rounds = math.ceil(groups / threads)
    whole: float = row["cpu"] / (row["outside"] + (row["cpu"] - row["outside"]) * rounds / groups)
    return whole


def sheets(threads: list[int], repeat: int, only: int | None) -> None:
    """Print what one evaluation takes with each number of threads."""
    one = threads[0]
    heads = [f"{count} threads" for count in threads[1:]]
    columns = " | ".join(f"{head} | by CPU time" for head in heads)
    expected = " | ".join(f"{count} threads, estimate" for count in ESTIMATED)
    print(f"| elements | points | ms, 1 thread | {columns} | CPU ms | outside of the loop | {expected} |")
    print("|---:|---:|---:|" + "---:|---:|" * len(heads) + "---:|---:|" + "---:|" * len(ESTIMATED))
    for side in SHEETS if only is None else [round(only**0.5)]:
        row = evaluations(side, threads, repeat)
        cells = [f"{row['elements']} | {row['points']} | {row['wall'][one]:.2f}"]
        for count in threads[1:]:
            cells += [f"{row[clock][one] / row[clock][count]:.2f}" for clock in ("wall", "busy")]
        cells += [f"{row['cpu']:.2f} | {row['outside']:.2f}"]
        cells += [f"{estimate(row, count):.2f}" for count in ESTIMATED]
        print("| " + " | ".join(cells) + " |", flush=True)


def of_run(timing: Any, wall: float, cpu: float, force: float) -> dict[str, Any]:
    """Seconds of the parts of a run."""
    parts = {name: seconds for name, seconds, _, _ in timing.rows()}
    return {"whole run": wall, **parts, "CPU seconds": cpu, "force": force}


def dome_run(elements: int, depth: float) -> dict[str, Any]:
    """The sheet under a sphere, in this process."""
    import dome
    import umform as uf

    model, step = dome.build(round(elements**0.5))
    wall, cpu = time.perf_counter(), time.process_time()
    result = uf.solve(model, dataclasses.replace(step, to=-depth), frames=0, progress=False)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    return of_run(result.timing, wall, cpu, float(result["punch_force"][-1]))


def cup_run(elements: int) -> dict[str, Any]:
    """A cup with the defaults of the command, in this process."""
    from draws import PARTS
    from umform.processes.draw import draw
    from umform.timing import Timing, timings

    case = dataclasses.replace(PARTS["cup"], **CUPS[elements])
    wall, cpu = time.perf_counter(), time.process_time()
    with timings() as runs:
        drawn = draw(case, frames=0, progress=False)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    if len(drawn.result.model.mesh.connectivity) != elements:
        raise SystemExit("the mesh of the cup has changed")
    return of_run(Timing.sum(runs), wall, cpu, drawn.punch_force.value)


def table(rows: dict[int, list[dict[str, Any]]]) -> str:
    """The fastest run of each number of threads, in Markdown."""
    best = {threads: min(runs, key=lambda row: row["whole run"]) for threads, runs in rows.items()}
    one = best[min(best)]
    words = [f"{count} threads" if count > 1 else "1 thread" for count in best]
    lines = ["| seconds | " + " | ".join(words) + " | faster |", "|---|" + "---:|" * (len(best) + 1)]
    for part in one:
        if part in BESIDE:
            continue
        values = [row[part] for row in best.values()]
        ratio = values[0] / values[-1] if values[-1] > 0.0 else float("nan")
        lines.append(f"| {part} | " + " | ".join(f"{value:.2f}" for value in values) + f" | {ratio:.2f} |")
    return "\n".join(lines)


def started(words: list[str], threads: int) -> subprocess.Popen[str]:
    """A run in a process of its own."""
    command = [sys.executable, __file__, *words, "--threads", str(threads), "--inside"]
    return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)


def answer(process: subprocess.Popen[str]) -> dict[str, Any]:
    """What a run has printed."""
    output, _ = process.communicate()
    if process.returncode != 0:
        raise SystemExit("a run has failed")
    row: dict[str, Any] = json.loads(output.splitlines()[-1])
    return row


def in_turns(title: str, words: list[str], threads: list[int], turns: int, beside: bool) -> None:
    """Run each number of threads in turns, and print the fastest; two at the same time show what the machine takes."""
    rows: dict[int, list[dict[str, Any]]] = {count: [] for count in threads}
    for _ in range(turns):
        for count, runs in rows.items():
            runs.append(answer(started(words, count)))
    if len({row["force"] for runs in rows.values() for row in runs}) != 1:
        raise SystemExit("the forces differ")
    print(f"\n{title}, load {os.getloadavg()[0]:.1f}\n\n{table(rows)}", flush=True)
    if beside and 1 in rows:
        both = [answer(one) for one in [started(words, 1) for _ in range(2)]]
        slower = max(row["whole run"] for row in both) / min(row["whole run"] for row in rows[1])
        print(f"\nTwo processes beside each other, one thread each, take {slower:.2f} times as long as one alone.")


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=["sheets", "cups", "dome"])
    parser.add_argument("--elements", type=int, help="dome: 40 000 of them; else one of the sizes")
    parser.add_argument("--depth", type=float, default=2.0, help="dome: way of the sphere, mm")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--turns", type=int, default=2, help="runs with each number of threads")
    parser.add_argument("--repeat", type=int, default=40, help="sheets: evaluations with each number of threads")
    parser.add_argument("--cpu", action="store_true", help="cups, dome: CPU seconds of all threads, not the clock's")
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.inside:
        import umform as uf

        uf.set_threads(given.threads[0])
        with patch.object(time, "perf_counter", time.process_time if given.cpu else time.perf_counter):
            found = dome_run(given.elements, given.depth) if given.kind == "dome" else cup_run(given.elements)
        print(json.dumps(found))
    elif given.kind == "sheets":
        print(f"load {os.getloadavg()[0]:.1f}, {os.cpu_count()} processors\n")
        sheets(given.threads, given.repeat, given.elements)
    elif given.kind == "dome":
        elements = given.elements or 40_000
        words = ["dome", "--elements", str(elements), "--depth", str(given.depth), *["--cpu"] * given.cpu]
        in_turns(f"{elements} elements", words, given.threads, given.turns, beside=True)
    else:
        for elements in [given.elements] if given.elements else CUPS:
            words = ["cups", "--elements", str(elements), *["--cpu"] * given.cpu]
            in_turns(f"cup of {elements} elements", words, given.threads, given.turns, beside=False)


if __name__ == "__main__":
    main()
