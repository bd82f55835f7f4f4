"""The S-rail of the verification book on other meshes and penalties: force, thinning, CPU seconds.

    python benchmarks/s_rail.py                        # all meshes (an hour)
    python benchmarks/s_rail.py --only "24 degrees, 40 along" --stroke 10

Degrees are what an element turns over a radius at most; along are the elements along the rail.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import record
from umform_book.drawing.s_rail import CASE, STROKE, Setup, make
from umform_book.page import Page

#: The last one has 6 000 elements.
MESHES = {
    "45 degrees, 14 along": Setup(45.0, 14),
    "24 degrees, 20 along": Setup(24.0, 20),
    "24 degrees, 20 along, penalty 1e3": Setup(24.0, 20, penalty=1e3),
    "24 degrees, 20 along, penalty 4e3": Setup(24.0, 20, penalty=4e3),
    "24 degrees, 40 along": Setup(24.0, 40),
    "15 degrees, 75 along": Setup(15.0, 75),
}

_HEADER = """| | elements | stroke, mm | punch, kN | thinning, % | halves, h | CPU s | iterations | discarded |
|---|---:|---:|---:|---:|---:|---:|---:|---:|"""


def row(setup: Setup, stroke: float) -> dict[str, Any]:
    """Draw one rail."""
    import umform as uf

    uf.set_threads(1)
    start = time.process_time()
    made, result = make(Page(CASE), "rail", setup, stroke)
    return {
        "elements": made.elements,
        "stroke": float(made.stroke[-1]),
        "force": made.force,
        "thinning": made.thinning,
        "uneven": made.uneven,
        "CPU s": time.process_time() - start,
        "iterations": int(result["iterations"].sum()),
        "thrown": result.timing.attempts.share,
    }


def line(name: str, found: dict[str, Any]) -> str:
    """A row of the table."""
    return (
        f"| {name} | {found['elements']} | {found['stroke']:g} | {found['force']:.2f} | {found['thinning']:.1f} | "
        f"{found['uneven']:.1e} | {found['CPU s']:.0f} | {found['iterations']} | {100 * found['thrown']:.1f} % |"
    )


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    record.add_option(parser)
    parser.add_argument("--only", choices=MESHES, help="one mesh")
    parser.add_argument("--stroke", type=float, default=STROKE, help="mm, of 37")
    given = parser.parse_args()
    numbers: dict[str, Any] = {}
    print(_HEADER)
    for name in [given.only] if given.only else MESHES:
        found = row(MESHES[name], given.stroke)
        print(line(name, found), flush=True)
        numbers |= {f"{name}: {key}": found[key] for key in ("force", "CPU s", "iterations")}
    record.write(given.json, "s_rail", numbers)


if __name__ == "__main__":
    main()
