"""The S-rail of the verification book on other meshes and penalties: force, thinning, CPU seconds.

    python benchmarks/s_rail.py                        # all meshes (an hour)
    python benchmarks/s_rail.py --only "24 degrees, 40 along" --stroke 10
    python benchmarks/s_rail.py --only "15 degrees, 75 along" --release --checkpoints build

Degrees are what an element turns over a radius at most; along are the elements along the rail. The memory is the most
that the process has had so far, so that of one mesh needs --only. A run with a checkpoint in the folder continues; CPU
seconds are those of the process.
"""

from __future__ import annotations

import argparse
import resource
import time
from pathlib import Path
from typing import Any

import numpy as np

import needs_book  # noqa: F401
import record
from umform.results.forming import forming_fields
from umform_book.drawing.s_rail import STROKE, Setup, model_of

#: The last one has 6 000 elements.
MESHES = {
    "45 degrees, 14 along": Setup(45.0, 14),
    "24 degrees, 20 along": Setup(24.0, 20),
    "24 degrees, 20 along, penalty 1e3": Setup(24.0, 20, penalty=1e3),
    "24 degrees, 20 along, penalty 4e3": Setup(24.0, 20, penalty=4e3),
    "24 degrees, 40 along": Setup(24.0, 40),
    "15 degrees, 75 along": Setup(15.0, 75),
}

_HEADER = """| | elements | stroke, mm | punch, kN | thinning, % | CPU s | iterations | discarded | MB |
|---|---:|---:|---:|---:|---:|---:|---:|---:|"""


def row(setup: Setup, stroke: float, release: bool, checkpoint: Path | None) -> dict[str, Any]:
    """Draw one rail, and open the tools if asked."""
    import umform as uf

    uf.set_threads(1)
    start = time.process_time()
    model, steps = model_of(setup, stroke)
    if release:
        gauge = model.hold_rigid(lambda x, y, z: z < 1e-9, name="gauge")
        steps = [*steps, uf.Free(model.tools, steps=6, on=gauge)]
    if checkpoint is not None and checkpoint.is_file():
        result = uf.resume(checkpoint, model, steps, frames=0, progress=False)
    else:
        result = uf.solve(model, steps, frames=0, progress=False, checkpoint=checkpoint)
    drawn = np.argmax(result["die_left"] > 0.0) - 1 if release else -1  # the last state before the tools open
    return {
        "elements": len(model.mesh.connectivity),
        "stroke": float(result["stroke"][drawn]),
        "force": 1e-3 * float(result["stroke_force"][drawn]),
        "thinning": float(forming_fields(model.mesh, model.u)["thinning"].max()),
        "CPU s": time.process_time() - start,
        "iterations": int(result["iterations"].sum()),
        "discarded": result.timing.attempts.share,
        "MB": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    }


def line(name: str, found: dict[str, Any]) -> str:
    """A row of the table."""
    return (
        f"| {name} | {found['elements']} | {found['stroke']:g} | {found['force']:.2f} | {found['thinning']:.1f} | "
        f"{found['CPU s']:.0f} | {found['iterations']} | {100 * found['discarded']:.1f} % | {found['MB']:.0f} |"
    )


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    record.add_option(parser)
    parser.add_argument("--only", choices=MESHES, help="one mesh")
    parser.add_argument("--stroke", type=float, default=STROKE, help="mm, of 37")
    parser.add_argument("--release", action="store_true", help="open the tools at the end")
    parser.add_argument("--checkpoints", type=Path, help="folder of checkpoints")
    given = parser.parse_args()
    numbers: dict[str, Any] = {}
    if given.checkpoints:
        given.checkpoints.mkdir(parents=True, exist_ok=True)
    print(_HEADER)
    for name in [given.only] if given.only else MESHES:
        file = given.checkpoints and given.checkpoints / f"s_rail {name}.h5"
        found = row(MESHES[name], given.stroke, given.release, file)
        print(line(name, found), flush=True)
        numbers |= {f"{name}: {key}": found[key] for key in ("force", "CPU s", "iterations")}
    record.write(given.json, "s_rail", numbers)


if __name__ == "__main__":
    main()
