"""What the allowed penetration costs: jobs with the estimated penalty alone, and with one that grows in the run.

python benchmarks/penetration.py --page docs/penetration.md
python benchmarks/penetration.py --job cup
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import pages
import umform as uf
from umform.processes.draw.cup import Cup
from umform.results.penetration import force_error, penetrations

STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(strength=520.0, offset=0.004, exponent=0.22))
ALUMINIUM = uf.J2(E=70e3, nu=0.33, hardening=uf.Swift(strength=450.0, offset=0.01, exponent=0.25))


def quarter(mesh: Any, law: Any) -> Any:
    """A quarter of a blank."""
    model = uf.Model(mesh, material=law)
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    return model


def drawn(model: Any, die: Any, punch: Any, *, gap: float, stroke: float, steps: int, friction: float) -> Any:
    """Die, holder at a distance and punch; the steps."""
    model.contact("lower", model.tool("die", die), name="on_die", friction=friction)
    holder = uf.Plane((0.0, 0.0, gap), "-z")
    model.contact("upper", model.tool("holder", holder), name="under_holder", friction=friction)
    ram = model.tool("punch", punch)
    model.contact("upper", ram, name="under_punch", friction=friction)
    return model, [uf.Move(model.drive(ram, "-z", name="stroke"), stroke, steps=steps)]


def edge(radius: float, at: float, z: float, deep: float) -> Any:
    """Meridian of a tool: a flat, an edge and a wall."""
    outer = 200.0 if deep < 0.0 else 0.0
    return uf.Profile.from_corners([(outer, z), (at, z), (at, deep)], radii=[0, radius, 0], closed=False)


def cup() -> Any:
    """A cup of aluminium on 80 elements."""
    radii: dict[str, Any] = {"punch_radius": 30.0, "punch_edge": 6.0, "die_radius": 31.2, "die_edge": 8.0}
    blank = Cup(thickness=1.0, blank_radius=48.0, material=ALUMINIUM, turn=30.0, around=8, **radii).blank()
    die, punch = uf.Revolved(edge(8.0, 31.2, -0.5, -60.0)), uf.Revolved(edge(6.0, 30.0, 0.5, 60.0))
    return drawn(quarter(blank, ALUMINIUM), die, punch, gap=0.54, stroke=30.0, steps=60, friction=0.05)


def sphere() -> Any:
    """A clamped sheet of steel under a sphere, 100 elements."""
    model = quarter(uf.mesh.strip(50.0, 50.0, 1.0, (10, 10)), STEEL)
    model.fix("x1")
    model.fix("y1")
    pair = model.contact("upper", uf.Sphere((0.0, 0.0, 20.5), radius=20.0), name="sphere", friction=0.1)
    return model, [uf.Move(model.drive(pair, "z", name="stroke"), -12.0, steps=40)]


def air_bend() -> Any:
    """Half of an air bend of steel, plane strain, 40 elements."""
    model = uf.Model(uf.mesh.strip(30.0, 1.0, 1.0, (40, 1)), "BEND8", material=STEEL, plane_strain=True)
    model.symmetry("x0", "x")
    model.fix(np.arange(len(model.mesh.points)), "y")
    model.contact("lower", model.tool("die", uf.VDie(16.0, 88.0, 2.0, origin=(0.0, 0.0, -0.5))), name="on_die")
    punch = model.tool("punch", uf.Punch(1.0, 88.0, 10.0, origin=(0.0, 0.0, 0.5)))
    model.contact("upper", punch, name="under_punch")
    return model, [uf.Move(model.drive(punch, "-z", name="stroke"), 5.0, steps=40)]


JOBS: dict[str, Callable[[], Any]] = {one.__name__: one for one in (cup, sphere, air_bend)}


def measured(name: str, *, grows: bool) -> dict[str, Any]:
    """One run, with penalties that grow or stay."""
    model, steps = JOBS[name]()
    if not grows:
        for contact in model.contacts:
            contact.penalty = contact.penalty
    start = time.process_time()
    result = uf.solve(model, *steps, frames=0, progress=False)
    seconds = time.process_time() - start
    shares = {n: one.reached / one.allowed for n, one in penetrations(model, result).items()}
    return {
        "job": name.replace("_", " "),
        "penalty": "grows" if grows else "stays",
        "reached / allowed": ", ".join(f"{n.replace('_', ' ')} {share:.2g}" for n, share in shares.items()),
        "largest force, N": f"{np.abs(result['stroke_force']).max():.0f}",
        "force error %": f"{100.0 * force_error(result):.2g}",
        "CPU s": f"{seconds:.1f}",
        "evaluations": str(result.timing.attempts.evaluations),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--job", choices=JOBS, nargs="*", default=list(JOBS))
    parser.add_argument("--page", type=Path, metavar="FILE", help="write the table into this page")
    given = parser.parse_args()
    uf.set_threads(1)
    text = pages.table([measured(name, grows=grows) for name in given.job for grows in (False, True)], left=(0, 1, 2))
    print(text)
    if given.page:
        pages.put(given.page, "penetration", text)


if __name__ == "__main__":
    main()
