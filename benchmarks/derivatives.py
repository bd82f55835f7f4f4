"""Cost of derivatives: CPU seconds of runs, and of the same runs with derivatives by several parameters, in turns.

Usage: python benchmarks/derivatives.py [--turns 3] [--cup]
"""

from __future__ import annotations

import argparse
import logging
import resource
import time
from statistics import median

import umform as uf
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
    given = words.parse_args()
    logging.disable(logging.WARNING)
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


if __name__ == "__main__":
    main()
