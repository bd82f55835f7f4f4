"""Instructions per element of the main kernels, counted by callgrind, against the stored counts.

Times on a shared machine lie; instructions do not. Without options the installed kernels are counted and compared with
``instructions.json`` beside this file; ``--write`` stores what was counted. Where valgrind is missing the check says so
and passes.

Only what runs inside of `evaluate` of a block is counted, on one thread, with the processor that valgrind shows (AVX2
and FMA, no AVX-512, so that the C library takes the same paths everywhere). Counts of another compiler or instruction
set are not comparable: then each kernel is compared with the mean of all, against a wider tolerance.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import umform as uf
from sheets import sheet
from umform import _core

STORED = Path(__file__).with_suffix(".json")
#: The same kernels may not need more, and a smaller number should be stored.
TOLERANCE = 0.02
#: For the shares of the kernels when compiler or instruction set are others than those stored.
TOLERANCE_OF_SHARES = 0.25
#: Instructions are counted inside of these; each call ends with a dump, for which callgrind wants the whole name.
EVALUATE = "::evaluate(double const*, umform::Scatter const&, umform::Target const&)"
BLOCKS = ("umform::ShellBlockOf<8>", "umform::ShellBlockOf<18>")
CELLS = 4

KERNELS = [(name, law) for name in ("ANS3DEAS", "MI9K3DEAS") for law in ("SVK", "J2 elastic", "J2 plastic")]
KERNELS += [("DISP3D", "NeoHooke"), ("EAS3DEAS", "SVK"), ("BEND8", "J2 Voce"), ("BEND18", "J2 Voce")]


def drive() -> None:
    """Evaluate every kernel twice: the first time pays for the workspaces. Runs inside of valgrind."""
    uf.set_threads(1)
    for name, law in KERNELS:
        model, u = sheet(name, law, (CELLS, CELLS), side=10.0)
        for _ in range(2):
            model.evaluate(u)


def count() -> dict[str, float]:
    """Instructions per element, by kernel."""
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONHASHSEED": "0"}
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", "--collect-atstart=no", f"--callgrind-out-file={folder}/out"]
        command += [f"--toggle-collect=umform::ShellBlockOf*{EVALUATE}"]
        command += [f"--dump-after={block}{EVALUATE}" for block in BLOCKS]
        command += [sys.executable, __file__, "--drive"]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f"valgrind failed:\n{done.stderr[-2000:]}")
        dumps = sorted(Path(folder).glob("out.*"), key=lambda path: int(path.suffix[1:]))
        counts = [int(match[1]) for dump in dumps if (match := re.search(r"^totals: (\d+)", dump.read_text(), re.M))]
    counts = [number for number in counts if number > 0]
    if len(counts) != 2 * len(KERNELS):
        raise SystemExit(f"callgrind saw {len(counts)} evaluations instead of {2 * len(KERNELS)}: is _core stripped?")
    return {
        f"{name}, {law}": round(number / CELLS**2, 1) for (name, law), number in zip(KERNELS, counts[1::2], strict=True)
    }


def deviations(counts: dict[str, float], stored: dict[str, float], *, absolute: bool) -> dict[str, float]:
    """Relative deviation of each kernel: of its count, or of its share of the (geometric) mean."""

    def scale(table: dict[str, float]) -> float:
        return 1.0 if absolute else math.exp(sum(math.log(table[name]) for name in stored) / len(stored))

    return {name: counts[name] / scale(counts) / (stored[name] / scale(stored)) - 1.0 for name in stored}


def compare(counts: dict[str, float]) -> int:
    """Print a table and the verdict; 1 if a kernel has changed."""
    stored = json.loads(STORED.read_text())
    absolute = stored["build"] == _core.build()
    tolerance = TOLERANCE if absolute else TOLERANCE_OF_SHARES
    if not absolute:
        print(f"stored with {stored['build']}, this is {_core.build()}: shares are compared instead of counts")
    of_kernel = deviations(counts, stored["counts"], absolute=absolute)
    for name, deviation in of_kernel.items():
        mark = "" if abs(deviation) <= tolerance else "   <-"
        print(f"{name:<24}{counts[name]:>12.0f}{stored['counts'][name]:>12.0f}{100 * deviation:>+9.2f} %{mark}")
    changed = [name for name, deviation in of_kernel.items() if abs(deviation) > tolerance]
    if changed:
        print(f"Beyond {100 * tolerance:.0f} %: {', '.join(changed)}.")
        print("If that is meant, store the new counts: python benchmarks/instructions.py --write")
    return int(bool(changed))


def main() -> int:
    """Count, and compare or store."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="store the counts")
    parser.add_argument("--drive", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.drive:
        drive()
        return 0
    if shutil.which("valgrind") is None:
        print("valgrind is not installed: the instructions of the kernels are not checked (apt-get install valgrind)")
        return 0
    counts = count()
    if arguments.write:
        STORED.write_text(json.dumps({"build": _core.build(), "counts": counts}, indent=1) + "\n")
    return compare(counts)


if __name__ == "__main__":
    raise SystemExit(main())
