"""The cup of AA6016-T4 of the ESAFORM benchmark 2021 and an isotropic one on four meshes: height, force, CPU seconds.

    python benchmarks/esaform_cup.py                  # all meshes (a minute and a half of CPU)
    python benchmarks/esaform_cup.py --only "15 degrees"

Release included. Degrees are what an element turns over the edge of the punch or of the die at most.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import needs_book  # noqa: F401
import pages
import record
from umform_book.drawing.cups import esaform, isotropic

#: Changes of the cup of the verification book.
MESHES: dict[str, dict[str, Any]] = {
    "15 degrees": {},
    "15 degrees, two layers": {"layers": 2, "thickness_points": 3},
    "10 degrees": {"turn": 10.0},
    "7.5 degrees": {"turn": 7.5},
} | {
    f"isotropic, {turn:g} degrees": {"turn": turn, "around": 8, "penalty": 1e4, "isotropic": True}
    for turn in (30.0, 20.0, 15.0, 10.0)
}


def row(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Draw and release one cup."""
    import umform as uf
    from umform.processes.draw import draw

    uf.set_threads(1)
    start = time.process_time()
    given = {name: value for name, value in changes.items() if name != "isotropic"}
    drawn = draw(esaform(isotropic() if changes.get("isotropic") else None, **given), frames=0, progress=False)
    return {
        "elements": len(drawn.result.model.mesh.connectivity),
        "mean height": drawn.ears.mean,
        "fourth harmonic": drawn.ears.wave(4)[0],
        "force": drawn.punch_force.value / 1000.0,
        "peak": float(drawn.forces["punch"].max()) / 1000.0,
        "ripple": drawn.punch_force.ripple / 1000.0,
        "CPU s": time.process_time() - start,
        "iterations": drawn.iterations,
        "discarded": drawn.result.timing.attempts.share,
        "ending": "" if drawn.ending is None else drawn.ending.kind,
    }


_HEADER = """| | elements | height, mm | cos 4θ, mm | punch, kN | highest tooth, kN | CPU s | iterations | discarded | |
|---|---:|---:|---:|---:|---:|---:|---:|---:|---|"""


def line(name: str, found: Mapping[str, Any]) -> str:
    """A row of the table."""
    force = f"{found['force']:.1f} ± {found['ripple']:.1f}"
    return (
        f"| {name} | {found['elements']} | {found['mean height']:.2f} | {found['fourth harmonic']:.3f} | {force} | "
        f"{found['peak']:.1f} | "
        f"{found['CPU s']:.0f} | {found['iterations']} | {100 * found['discarded']:.1f} % | {found['ending']} |"
    )


def main() -> None:
    """Run, print, and write where asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    record.add_option(parser)
    parser.add_argument("--only", choices=MESHES, help="one mesh")
    parser.add_argument("--page", type=Path, help="page that gets the table between its marks")
    given = parser.parse_args()
    lines, numbers = [_HEADER], {}
    print(_HEADER)
    for name in [given.only] if given.only else MESHES:
        found = row(MESHES[name])
        lines.append(line(name, found))
        print(lines[-1], flush=True)
        numbers |= {f"{name}: {key}": found[key] for key in ("mean height", "CPU s", "iterations")}
    if given.page is not None:
        pages.put(given.page, "cup", "\n".join(lines))
    record.write(given.json, "esaform_cup", numbers)


if __name__ == "__main__":
    main()
