"""What a drawn part costs: the defaults, beside tight tolerances, and beside increments that keep no contact points.

python benchmarks/draws.py --page docs/performance-draws.md
python benchmarks/draws.py --part "cup" --variant "as it is"
"""

from __future__ import annotations

import argparse
import logging
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pages
import record
import umform as uf
from umform.analysis.newton.options import NewtonOptions
from umform.model.contact.points import PairPoints
from umform.processes.draw import Cup, Drawn, UBend, draw, extrapolated
from umform.processes.draw.cup import ESAFORM
from umform.processes.draw.u_bend import NUMISHEET
from umform.timing import Timing, timings

#: Parts with the defaults of the commands: U-bends of NUMISHEET 93, cups of ESAFORM 2021, all of one steel.
STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(strength=520.0, offset=0.004, exponent=0.22))
PARTS: dict[str, Cup | UBend] = {
    "cup": Cup(**ESAFORM, material=STEEL),
    "cup, fine": Cup(**ESAFORM, **Cup.meshes["fine"], material=STEEL),
    "U-bend, coarse": UBend(**NUMISHEET, **UBend.meshes["coarse"], material=STEEL),
    "U-bend, one mesh": UBend(**NUMISHEET, material=STEEL),
}
TWO = "U-bend, two meshes"


@contextmanager
def _no_kept_points() -> Iterator[None]:
    with patch.object(PairPoints, "keeps_points", False):
        yield


def _tight(case: Cup | UBend) -> Cup | UBend:
    return replace(case, newton=NewtonOptions())


#: How it is run: the case, and the context of the run.
VARIANTS: dict[str, tuple[Callable[[Any], Any], Callable[[], Any]]] = {
    "tight, none kept": (_tight, _no_kept_points),
    "none kept": (lambda case: case, _no_kept_points),
    "as it is": (lambda case: case, nullcontext),
}


def measured(name: str, variant: str) -> dict[str, str]:
    """One part in one way."""
    change, context = VARIANTS[variant]
    case = change(PARTS["U-bend, one mesh"] if name == TWO else PARTS[name])
    how: Callable[..., Drawn] = extrapolated if name == TWO else draw
    start = time.process_time()
    with context(), timings() as runs:
        drawn = how(case, progress=False)
    seconds = time.process_time() - start
    attempts = Timing.sum(runs).attempts
    return {
        "part": name,
        "": variant,
        "CPU s": f"{seconds:.1f}",
        "evaluations": str(attempts.evaluations),
        "beside, %": f"{100.0 * attempts.beside:.0f}",
        "discarded, %": f"{100.0 * attempts.share:.0f}",
        "increments": str(sum(len(run) - 1 for run in (drawn.result, drawn.released) if run is not None)),
        "numbers": numbers(drawn),
    }


def numbers(drawn: Drawn) -> str:
    """What is asked of such a part."""
    names = ["theta1", "theta2", "radius of the wall"] if isinstance(drawn.case, UBend) else ["height, mean"]
    errors = {one.name: one.band.error for one in drawn.quantities if one.band is not None}
    texts = [f"{drawn[name].best:.2f}" + (f" ± {errors[name]:.2f}" if errors.get(name) else "") for name in names]
    return ", ".join([f"{drawn['largest punch force'].best:.2f} kN", *texts])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", choices=[*PARTS, TWO], nargs="*", default=[*PARTS, TWO])
    parser.add_argument("--variant", choices=VARIANTS, nargs="*", default=list(VARIANTS))
    parser.add_argument("--page", type=Path, metavar="FILE", help="write the table into this page")
    record.add_option(parser)
    given = parser.parse_args()
    logging.getLogger("umform").addHandler(logging.NullHandler())
    uf.set_threads(1)
    rows = []
    for name in given.part:
        for variant in given.variant if name != TWO else given.variant[-1:]:
            rows.append(measured(name, variant))
            print(" | ".join(rows[-1].values()), flush=True)
    record.write(given.json, "draws", {f"{row['part']}, {row['']}, CPU s": float(row["CPU s"]) for row in rows})
    if given.page:
        pages.put(given.page, "draws", pages.table(rows, left=(0, 1, 7)))


if __name__ == "__main__":
    main()
