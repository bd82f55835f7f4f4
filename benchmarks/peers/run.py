"""The same work in umform and in other codes: CPU seconds, iterations and memory side by side, as ratios.

Codes that are not installed are skipped; nothing is installed. Each run is a process of its own on one thread; its CPU
seconds (user and system) and its peak memory are those of the whole process, imports of Python included.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from types import ModuleType
from typing import Any

import bent_strip
import hemisphere
import numpy as np
import sheet
from calculix_peer import CalculiX
from entries import Entry, Outcome, Peer
from measure import Crashed
from ratios import HEADER, costs, markdown, ratios
from scripted import Scripted

CASES = {"a": bent_strip, "b": hemisphere, "c": sheet}
KRATOS = ("KratosStructuralMechanicsApplication", "KratosLinearSolversApplication")
RESULTS = Path(__file__).parent / "results.md"


def peers(python: str) -> dict[str, Peer]:
    """The codes; those that are packages of Python but umform live in the environment of ``python``."""
    every: list[Peer] = [
        Scripted("umform", "import umform; print(umform.__version__)", "pip install ."),
        CalculiX(),
        Scripted("felupe", "import felupe; print(felupe.__version__)", "pip install felupe", python),
        Scripted(
            "Kratos",
            f"import importlib.metadata as m; print(m.version({KRATOS[0]!r}))",
            f"pip install {' '.join(KRATOS)}",
            python,
        ),
        Scripted("GetFEM", "import getfem; print(getfem.__version__)", "apt install python3-getfem", python),
    ]
    return {peer.name: peer for peer in every}


def run_case(case: ModuleType, here: dict[str, Peer], short: bool) -> dict[str, tuple[Entry, Outcome]]:
    """Make the runs of a case, one after the other; a run that fails is told and left out."""
    found = {}
    for entry in case.entries(short):
        if entry.peer not in here:
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                outcome = here[entry.peer].solve(entry, entry.build(), Path(folder))
            except Crashed as failure:
                print(f"  {entry.key}: FAILED: {failure}", flush=True)
                continue
        found[entry.key] = entry, outcome
        cost = outcome.cost
        print(f"  {entry.key}: {cost.cpu:.2f} CPU s, {outcome.iterations} iterations, {cost.memory:.0f} MB", flush=True)
    return found


def machine() -> str:
    """Processor, cores, system, Python."""
    info = Path("/proc/cpuinfo")
    lines = info.read_text().splitlines() if info.exists() else []
    names = [line.split(":")[1].strip() for line in lines if line.startswith("model name")] or [platform.machine()]
    return f"{names[0]}, {os.cpu_count()} cores, {platform.system()}, Python {platform.python_version()}"


def write(path: Path, text: str, record: dict[str, Any]) -> None:
    """The tables in Markdown, all numbers in JSON beside them."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    path.with_suffix(".json").write_text(json.dumps(record, indent=1, default=_plain) + "\n", encoding="utf-8")


def _plain(value: object) -> object:
    return value.tolist() if isinstance(value, np.ndarray) else str(value)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the comparison."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "cases", nargs="*", choices=[*CASES, []], help="a: bent strip, b: hemisphere, c: sheet; default all"
    )
    parser.add_argument("--short", action="store_true", help="small meshes, umform and CalculiX alone: some seconds")
    parser.add_argument("--python", default=sys.executable, help="interpreter that has the other codes' packages")
    parser.add_argument("--out", type=Path, help=f"file for the tables, such as {RESULTS.name}; default: print only")
    told = parser.parse_args(arguments)
    every = peers(told.python)
    versions = {name: peer.version() for name, peer in every.items()}
    here = {name: peer for name, peer in every.items() if versions[name]}
    said = [
        f"{name} {version}" if version else f"{name}: not installed, skipped; {every[name].remedy}"
        for name, version in versions.items()
    ]
    print(machine(), *said, sep="\n")
    lines = [f"Machine: {machine()}; one thread.", "", *(f"* {line}" for line in said)]
    record: dict[str, Any] = {"machine": machine(), "versions": versions}
    compared = [HEADER]
    for name in told.cases or list(CASES):
        case = CASES[name]
        print(case.TITLE, flush=True)
        found = run_case(case, here, told.short)
        table = costs(found, case.measures(found))
        lines += ["", f"## {case.TITLE}", "", markdown(table)]
        compared += ratios(name, found, case.comparisons(found))
        record[name] = {key: asdict(outcome) for key, (_, outcome) in found.items()}
    lines += ["", "## Other code over umform", "", markdown(compared)]
    print("\n".join(lines))
    if told.out:
        write(told.out, "\n".join(lines) + "\n", record)
    return 0


if __name__ == "__main__":
    sys.exit(main())
