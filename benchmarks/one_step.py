"""CPU time of one-step estimates of a blank on one thread: triangles, iterations, and what takes the time.

The cup of the page drawing-one-step-blank without and with holder, friction and gap. The first estimate of a process is
not counted: it loads modules.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from typing import Any

os.environ["OMP_NUM_THREADS"] = os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before NumPy

import umform as uf
from umform.flat_pattern.one_step.equations import Equations
from umform.flat_pattern.one_step.places import FlatProblem
from umform.solvers import multifrontal
from umform_book.drawing.revolved import cup

#: Mean height of the cup, mm; rings of some 20 000 triangles.
HEIGHT, RINGS = 34.13, 58
HELD: dict[str, Any] = {"holder_force": 40e3, "friction": 0.09, "gap": 1.2}
#: Methods that are timed: energies, forces and matrices of triangles; their sums; factors; solutions.
PARTS = {
    "triangles": ((FlatProblem, "residual"), (FlatProblem, "energy")),
    "sums": ((Equations, "matrix"), (Equations, "vector")),
    "factors": ((multifrontal.Multifrontal, "factor"),),
    "solutions": ((multifrontal.Multifrontal, "solve"),),
}


@contextmanager
def timed() -> Iterator[dict[str, float]]:
    """CPU seconds of the parts while it is open."""
    spent = dict.fromkeys(PARTS, 0.0)
    kept = [(owner, name, getattr(owner, name)) for methods in PARTS.values() for owner, name in methods]

    def around(part: str, method: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(method)
        def call(*given: Any, **named: Any) -> Any:
            start = time.process_time()
            try:
                return method(*given, **named)
            finally:
                spent[part] += time.process_time() - start

        return call

    for part, methods in PARTS.items():
        for owner, name in methods:
            setattr(owner, name, around(part, getattr(owner, name)))
    try:
        yield spent
    finally:
        for owner, name, method in kept:
            setattr(owner, name, method)


def main() -> None:
    """Print a row for each case."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rings", type=int, default=RINGS)
    parser.add_argument("--repeats", type=int, default=3, help="the fastest one is printed")
    chosen = parser.parse_args()
    law = uf.sheet_metals.get("AA6016-T4").law
    uf.blank(cup(8, HEIGHT), uf.Blank(law, 1.0, **HELD))
    print(
        f"{'':<26}{'triangles':>10}{'iterations':>11}{'CPU s':>8}" + "".join(f"{part:>11}" for part in (*PARTS, "rest"))
    )
    for label, changes in (("without holder and gap", {}), ("with holder and gap", HELD)):
        rows = []
        for _ in range(chosen.repeats):
            part = cup(chosen.rings, HEIGHT)
            with timed() as spent:
                start = time.process_time()
                found = uf.blank(part, uf.Blank(law, 1.0, **changes))
                total = time.process_time() - start
            rows.append((total, found, spent))
        total, found, spent = min(rows, key=lambda row: row[0])
        parts = [*spent.values(), total - sum(spent.values())]
        numbers = "".join(f"{seconds:>11.2f}" for seconds in parts)
        print(f"{label:<26}{len(found.sheet.triangles):>10}{found.iterations:>11}{total:>8.2f}{numbers}")


if __name__ == "__main__":
    main()
