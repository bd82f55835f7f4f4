"""Wall time of a whole run on one thread and on two, in turns: the sheet under a sphere of `dome.py`, 40 000 elements.

It needs as many free processors as threads. Two processes beside each other, one thread each, show what the machine
itself takes from two processors that work at the same time.
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import subprocess
import sys
import time
from typing import Any

import dome


def measured(elements: int, depth: float, threads: int) -> dict[str, Any]:
    """One run in this process: wall seconds of its parts."""
    import umform as uf

    uf.set_threads(threads)
    model, step = dome.build(round(elements**0.5))
    wall, cpu = time.perf_counter(), time.process_time()
    result = uf.solve(model, dataclasses.replace(step, to=-depth), frames=0, progress=False)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    parts = {name: seconds for name, seconds, _, _ in result.timing.rows()}
    return {"whole run": wall, **parts, "CPU seconds": cpu, "force": float(result["punch_force"][-1])}


def fastest(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """The row with the shortest run."""
    return min(rows, key=lambda row: row["whole run"])


def table(rows: dict[int, list[dict[str, Any]]]) -> str:
    """The fastest run of each number of threads, in Markdown."""
    best = {threads: fastest(runs) for threads, runs in rows.items()}
    one = best[min(best)]
    words = [f"{count} threads" if count > 1 else "1 thread" for count in best]
    lines = ["| wall seconds | " + " | ".join(words) + " | faster |", "|---|" + "---:|" * (len(best) + 1)]
    for part in one:
        if part in ("CPU seconds", "force"):
            continue
        values = [row[part] for row in best.values()]
        ratio = values[0] / values[-1] if values[-1] > 0.0 else float("nan")
        lines.append(f"| {part} | " + " | ".join(f"{value:.2f}" for value in values) + f" | {ratio:.2f} |")
    return "\n".join(lines)


def started(*words: str) -> subprocess.Popen[str]:
    """A run in a process of its own."""
    return subprocess.Popen([sys.executable, __file__, "--inside", *words], stdout=subprocess.PIPE, text=True)


def answer(process: subprocess.Popen[str]) -> dict[str, Any]:
    """What a run has printed."""
    output, _ = process.communicate()
    if process.returncode != 0:
        raise SystemExit("a run has failed")
    row: dict[str, Any] = json.loads(output.splitlines()[-1])
    return row


def main() -> None:
    """Run each number of threads in turns, and print the fastest."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--elements", type=int, default=40_000)
    parser.add_argument("--depth", type=float, default=2.0, help="way of the sphere, mm")
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--turns", type=int, default=2)
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.inside:
        print(json.dumps(measured(arguments.elements, arguments.depth, arguments.threads[0])))
        return
    size = ("--elements", str(arguments.elements), "--depth", str(arguments.depth), "--threads")
    rows: dict[int, list[dict[str, Any]]] = {threads: [] for threads in arguments.threads}
    for _ in range(arguments.turns):
        for threads, runs in rows.items():
            runs.append(answer(started(*size, str(threads))))
    beside = [answer(one) for one in [started(*size, "1") for _ in range(2)]]
    if len({row["force"] for runs in rows.values() for row in runs}) != 1:
        raise SystemExit("the forces differ")
    print(table(rows))
    if 1 in rows:
        slower = max(row["whole run"] for row in beside) / fastest(rows[1])["whole run"]
        print(f"\nTwo processes beside each other, one thread each, take {slower:.2f} times as long as one alone.")


if __name__ == "__main__":
    main()
