"""Evaluations of drawn parts over several coefficients of friction: what a change of the method saves.

    python benchmarks/draw_sums.py             # three parts, eight coefficients each (three minutes)
    python benchmarks/draw_sums.py --part cup

One run says little: any change of its path shifts its count by a tenth, and by a fifth where an attempt fails.
"""

from __future__ import annotations

import argparse
import dataclasses
import logging
import time

import umform as uf
from draws import PARTS
from umform.problem import load
from umform.problem.templates import template_file
from umform.processes.draw import draw
from umform.timing import Timing, timings

FRICTION = (0.07, 0.08, 0.085, 0.09, 0.095, 0.1, 0.11, 0.13)


def _drawn(part: str, friction: float) -> None:
    draw(dataclasses.replace(PARTS[part], friction=friction), frames=0, progress=False)


def _rail(friction: float) -> None:
    changes = {f"contacts.{tool}.friction": friction for tool in ("die", "holder", "punch")}
    load(template_file("hat-rail"), changes).build().solve(progress=False)


#: Runs of a part by the coefficient of friction; that of NUMISHEET 93 is .05 larger than the others.
RUNS = {
    "cup": lambda friction: _drawn("cup", friction),
    "U-bend, coarse": lambda friction: _drawn("U-bend, coarse", friction + 0.05),
    "template hat-rail": _rail,
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", choices=RUNS, nargs="*", default=list(RUNS))
    given = parser.parse_args()
    logging.getLogger("umform").addHandler(logging.NullHandler())
    uf.set_threads(1)
    for part in given.part:
        start, found = time.process_time(), []
        for friction in FRICTION:
            with timings() as runs:
                RUNS[part](friction)
            found.append(Timing.sum(runs).attempts)
        sums = sum(one.evaluations for one in found), sum(one.discarded for one in found)
        each = ", ".join(str(one.evaluations) for one in found)
        print(f"{part} | {time.process_time() - start:.1f} CPU s | {sums[0]}, {sums[1]} discarded | {each}", flush=True)


if __name__ == "__main__":
    main()
