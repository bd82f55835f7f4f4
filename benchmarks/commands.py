"""CPU seconds of commands, and what of them goes into files: tables, fields, pictures, report.

python benchmarks/commands.py --page docs/performance-runs.md
python benchmarks/commands.py --name "bend of the README" --repeat 5
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pages
import record
from umform.problem.templates import template_file

BEND = "bend --thickness 2 --opening 16 --die-radius 2 --punch-radius 1.5 --material DC04 --angle 90"
SEQUENCE = """
length = 100.0
[[bends]]
position = 25.0
angle = 90.0
[[bends]]
position = 75.0
angle = 90.0
direction = "down"
"""
COMMANDS = {
    "bend of the README": BEND,
    "bend --sequence, two bends": "bend --sequence z.toml --thickness 2 --opening 16 --material DC04",
    "hem, flat": "hem",
    "hem, over an insert": "hem --form insert --element BEND18 --elements-per-thickness 3",
    "draw u": "draw u",
    "draw u --coarse": "draw u --coarse",
    "draw cup --coarse": "draw cup --coarse",
    "run, template free-bending": "run free-bending.toml",
    "run, template hat-rail": "run hat-rail.toml",
}
#: What writes the files of a command, by its first word, or its option: modules and functions.
WRITERS = {
    "bend": [("umform.processes.air_bending.files", "write_files")],
    "--sequence": [("umform.processes.bend_sequence.files", "write_files")],
    "hem": [("umform.processes.hemming.files", "write_files")],
    "draw": [("umform.processes.draw.files", name) for name in ("draw_blank", "write_files")],
    "run": [("umform.problem.running", "write")],
}


def child(out: Path) -> None:
    """Run the command of this process, and write its CPU seconds and those of its files."""
    spent = [0.0]

    def clocked(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **named: Any) -> Any:
            start = time.process_time()
            try:
                return function(*arguments, **named)
            finally:
                spent[0] += time.process_time() - start

        return call

    for name, function in WRITERS["--sequence" if "--sequence" in sys.argv else sys.argv[1]]:
        module = importlib.import_module(name)
        setattr(module, function, clocked(getattr(module, function)))
    from umform.cli import main

    try:
        main()
    finally:
        out.write_text(json.dumps({"files": spent[0], "all": time.process_time()}))


def measured(command: str, folder: Path) -> dict[str, float]:
    """CPU seconds of a command on one thread."""
    times = folder / "times.json"
    here = [sys.executable, __file__, "--child", str(times), *command.split(), "--out", "out", "--overwrite"]
    environment = os.environ | {"OMP_NUM_THREADS": "1"}
    subprocess.run(here, cwd=folder, env=environment, capture_output=True, check=True)
    return dict(json.loads(times.read_text()))


def prepared(folder: Path) -> None:
    """Write the decks."""
    (folder / "z.toml").write_text(SEQUENCE)
    for name in ("free-bending", "hat-rail"):
        (folder / f"{name}.toml").write_text(template_file(name).read_text(encoding="utf-8"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--name", choices=COMMANDS, nargs="*", default=list(COMMANDS))
    parser.add_argument("--repeat", type=int, default=3, help="runs of each, of which the median counts")
    parser.add_argument("--page", type=Path, metavar="FILE", help="write the table into this page")
    record.add_option(parser)
    given = parser.parse_args()
    lines = ["| CPU seconds of | all | files | share |", "|---|---:|---:|---:|"]
    numbers = {}
    for name in given.name:
        with TemporaryDirectory() as folder:
            prepared(Path(folder))
            runs = [measured(COMMANDS[name], Path(folder)) for _ in range(given.repeat)]
        whole, files = (statistics.median(run[key] for run in runs) for key in ("all", "files"))
        lines.append(f"| {name} | {whole:.2f} | {files:.2f} | {100.0 * files / whole:.0f} % |")
        numbers |= {f"{name}, CPU s": whole, f"{name}, files, CPU s": files}
        print(lines[-1], flush=True)
    record.write(given.json, "commands", numbers)
    if given.page:
        pages.put(given.page, "commands", "\n".join(lines))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        place = Path(sys.argv[2])
        del sys.argv[1:3]
        child(place)
    else:
        main()
