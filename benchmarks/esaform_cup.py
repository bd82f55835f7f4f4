"""The cup of AA6016-T4 of the ESAFORM benchmark 2021 on four meshes: height, force, CPU seconds, release included.

    python benchmarks/esaform_cup.py                  # all meshes (some ten minutes)
    python benchmarks/esaform_cup.py --only "15 degrees"

Degrees are what an element turns over the edge of the punch or of the die at most.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import record
from umform_book.drawing.cups import esaform, fourth

#: Changes of the cup of the verification book.
MESHES: dict[str, dict[str, Any]] = {
    "15 degrees": {},
    "15 degrees, two layers": {"layers": 2, "thickness_points": 3},
    "10 degrees": {"turn": 10.0},
    "7.5 degrees": {"turn": 7.5},
}


def row(changes: Mapping[str, Any]) -> dict[str, Any]:
    """Draw and release one cup."""
    import umform as uf
    from umform.processes.draw import draw

    uf.set_threads(1)
    start = time.process_time()
    drawn = draw(esaform(**changes), frames=0, progress=False)
    return {
        "elements": len(drawn.result.model.mesh.connectivity),
        "mean height": drawn.ears.mean,
        "fourth harmonic": fourth(drawn.ears)[0],
        "force": float(drawn.forces["punch"].max()) / 1000.0,
        "CPU s": time.process_time() - start,
        "iterations": drawn.iterations,
        "thrown": drawn.result.timing.attempts.share,
        "ending": "" if drawn.ending is None else drawn.ending.kind,
    }


_HEADER = """| | elements | mean height, mm | fourth harmonic, mm | punch, kN | CPU s | iterations | discarded | |
|---|---:|---:|---:|---:|---:|---:|---:|---|"""


def line(name: str, found: Mapping[str, Any]) -> str:
    """A row of the table."""
    return (
        f"| {name} | {found['elements']} | {found['mean height']:.2f} | {found['fourth harmonic']:.3f} | "
        f"{found['force']:.1f} | {found['CPU s']:.0f} | {found['iterations']} | {100 * found['thrown']:.1f} % | "
        f"{found['ending']} |"
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
        record.put(given.page, "cup", "\n".join(lines))
    record.write(given.json, "esaform_cup", numbers)


if __name__ == "__main__":
    main()
