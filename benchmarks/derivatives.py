"""Cost of derivatives: CPU seconds of runs, and of the same runs with derivatives by several parameters, in turns.

With --search: trials of the search for an angle after springback by the secant, and by Newton's method.

Usage: python benchmarks/derivatives.py [--turns 3] [--cup] [--search]
"""

from __future__ import annotations

import argparse
import logging
import resource
import time
from dataclasses import replace
from statistics import median

import umform as uf
from umform.processes.air_bending.brake import Brake
from umform.processes.air_bending.goal import Goal
from umform.processes.air_bending.search import find_stroke
from umform.processes.air_bending.spec import AirBending
from umform.processes.draw.cup import ESAFORM, Cup
from umform.processes.problems import problem_of

#: Parameters of the cases.
BEND = (
    "stroke",
    "thickness",
    "die_radius",
    "punch_radius",
    "opening",
    "die_angle",
    "material.E",
    "material.nu",
    "material.hardening.strength",
    "material.hardening.exponent",
)
CUP = ("friction", "holder_force", "thickness", "material.hardening.strength", "material.hardening.exponent")


def main() -> None:
    """Print a line for each case."""
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--turns", type=int, default=3)
    words.add_argument("--cup", action="store_true", help="also a coarse cup: minutes")
    words.add_argument("--search", action="store_true", help="only the search for an angle, of 12 bends")
    given = words.parse_args()
    logging.disable(logging.WARNING)
    if given.search:
        search()
        return
    cases = [("air bend", AirBending(stroke=6.1), BEND)]
    if given.cup:
        metal = uf.sheet_metals.get("DC04").law
        cases.append(("coarse cup", Cup(**ESAFORM | Cup.meshes["coarse"], material=metal), CUP))
    print("case          parameters   run, CPU s   with derivatives   runs in all   a parameter   peak MB")
    for name, case, by in cases:
        alone, whole = [], []
        for _ in range(given.turns):
            start = time.process_time()
            problem_of(case).build().solve()
            middle = time.process_time()
            uf.derivatives(case, by)
            alone.append(middle - start)
            whole.append(time.process_time() - middle)
        run, both = median(alone), median(whole)
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        print(
            f"{name:12} {len(by):11} {run:12.2f} {both:18.2f} {both / run:13.2f} {(both / run - 1) / len(by):13.2f} "
            f"{peak:9.0f}"
        )


#: Metal, thickness, opening and wanted angle of bends.
BENDS = (
    ("", 2.0, 16.0, 90.0),
    ("", 1.0, 10.0, 90.0),
    ("", 1.0, 16.0, 120.0),
    ("", 4.0, 32.0, 90.0),
    ("", 6.0, 40.0, 110.0),
    ("", 0.5, 8.0, 135.0),
    ("DC04", 1.0, 8.0, 90.0),
    ("DC04", 2.0, 20.0, 100.0),
    ("DC04", 0.8, 16.0, 140.0),
    ("DP600", 1.5, 12.0, 95.0),
    ("DP600", 3.0, 24.0, 120.0),
    ("DP600", 1.0, 16.0, 150.0),
)


def search() -> None:
    """Print trials and CPU seconds of both methods; Newton's begins at the first trial of the secant."""
    print("metal   thickness   opening   angle   secant: trials   CPU s   Newton: trials   derivatives, CPU s")
    sums = [0.0] * 4
    for metal, thickness, opening, angle in BENDS:
        law = {"material": uf.sheet_metals.get(metal).law} if metal else {}
        coarse = {"layers": 1, "elements_per_thickness": 1.0, "increment": 0.025}
        case = AirBending(thickness=thickness, opening=opening, **coarse, **law)
        start = time.process_time()
        found = find_stroke(case, angle, progress=False, frames=1)
        spent, derived = time.process_time() - start, 0.0
        (stroke, reached), trials = found.trials[0], 1
        while abs(reached - angle) > Goal.tolerance:
            start = time.process_time()
            slope = uf.derivatives(replace(case, stroke=stroke), ["stroke"], ["angle"], progress=False).values[0, 0]
            derived += time.process_time() - start
            stroke, trials = stroke + (angle - reached) / slope, trials + 1
            brake = Brake(case, frames=1)
            brake.load(stroke)
            reached = brake.unload().angle
        row = [len(found.trials), spent, trials, derived]
        sums = [one + other for one, other in zip(sums, row, strict=True)]
        print(f"{metal:7} {thickness:9g} {opening:9g} {angle:7g} {row[0]:16} {spent:7.2f} {trials:16} {derived:20.2f}")
    print(f"{'sum':41} {sums[0]:10g} {sums[1]:7.2f} {sums[2]:16g} {sums[3]:20.2f}")


if __name__ == "__main__":
    main()
