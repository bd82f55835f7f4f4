"""The same work in umform and in other codes: CPU seconds, iterations and memory side by side, as ratios.

Codes that are not installed are skipped; nothing is installed. Each run is a process of its own on one thread; its CPU
seconds (user and system) and its peak memory are those of the whole process, imports of Python included.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import bent_strip
import hemisphere
import sheet
import wide_strip
from codes import codes
from entries import Entry, Outcome, Peer
from measure import Crashed
from ratios import HEADER, Found, costs, markdown, ratios

import record

CASES = {"a": bent_strip, "w": wide_strip, "b": hemisphere, "c": sheet}
#: Runs that take no more than so many CPU seconds are made so many times.
LONG, ROUNDS = 12.0, 3


def run_case(
    case: ModuleType, here: Mapping[str, Peer], short: bool, keep: Path | None
) -> dict[str, tuple[Entry, Outcome]]:
    """Make the runs of a case, one after the other; a run that fails is reported and left out.

    Others use the machine too, and short runs tell it most: after all runs have been made once, those that are not long
    are made again, in turns, and the fastest one counts.
    """
    made: dict[str, list[Outcome]] = {}
    entries = {entry.key: entry for entry in case.entries(short) if entry.peer in here}
    for again in range(1 if short else ROUNDS):
        for key, entry in entries.items():
            if again and (key not in made or made[key][0].cost.cpu > LONG):
                continue
            outcome = _once(entry, here[entry.peer], keep)
            if outcome is not None:
                made.setdefault(key, []).append(outcome)
    least = {key: min(outcomes, key=lambda outcome: outcome.cost.cpu) for key, outcomes in made.items()}
    return {key: (entries[key], outcome) for key, outcome in least.items()}


def _once(entry: Entry, peer: Peer, keep: Path | None) -> Outcome | None:
    """Make a run; None if it fails."""
    with _folder(entry, keep) as folder:
        try:
            outcome = peer.solve(entry, entry.build(), Path(folder))
        except Crashed as failure:
            print(f"  {entry.key}: FAILED: {failure}", flush=True)
            return None
    cost = outcome.cost
    print(f"  {entry.key}: {cost.cpu:.2f} CPU s, {outcome.iterations} iterations, {cost.memory:.0f} MB", flush=True)
    return outcome


def _folder(entry: Entry, keep: Path | None) -> AbstractContextManager[str | Path]:
    """Folder of a run: a temporary one, or one of its name that stays."""
    if keep is None:
        return tempfile.TemporaryDirectory()
    folder = keep / re.sub(r"[^\w.]+", "-", entry.key)
    folder.mkdir(parents=True, exist_ok=True)
    return nullcontext(folder)


def compare(name: str, here: Mapping[str, Peer], said: str, short: bool, keep: Path | None = None) -> dict[str, Any]:
    """Run a case; its tables and numbers, ready for JSON."""
    case = CASES[name]
    print(case.TITLE, flush=True)
    found = run_case(case, here, short, keep)
    made = {"title": case.TITLE, "machine": record.machine(), "codes": said} | tables(name, found, short)
    print(markdown(made["table"]), flush=True)
    return made | {"runs": record.runs(found)}


def tables(name: str, found: Found, short: bool) -> dict[str, Any]:
    """Tables of the costs and of the ratios of a case; goals are for large runs."""
    case = CASES[name]
    compared = [replace(c, goal=None if short else c.goal) for c in case.comparisons(found)]
    return {"table": costs(found, case.measures(found)), "ratios": ratios(name, found, compared)}


def _pair(word: str) -> tuple[str, str]:
    """Code and interpreter of ``CODE=PATH``."""
    name, equal, path = word.partition("=")
    if not equal:
        raise argparse.ArgumentTypeError(f"{word!r} is not CODE=PATH, such as Kratos=/opt/venv/bin/python")
    return name, path


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the comparison."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("cases", nargs="*", metavar="case", help=f"of {', '.join(CASES)}; default: all")
    parser.add_argument("--short", action="store_true", help="small meshes, umform and CalculiX alone: some seconds")
    parser.add_argument(
        "--python",
        action="append",
        default=[],
        metavar="CODE=PATH",
        type=_pair,
        help="interpreter that has the package of a code",
    )
    parser.add_argument("--out", type=Path, help="file for the tables; the cases that are not run are kept in it")
    parser.add_argument("--page", type=Path, help="page that gets the table of ratios between its marks")
    parser.add_argument("--keep", type=Path, help="folder in which problems, decks and logs of all runs stay")
    parser.add_argument("--tables", action="store_true", help="run nothing: tables from the runs beside --out")
    told = parser.parse_args(arguments)
    if unknown := set(told.cases) - set(CASES):
        parser.error(f"there is no case {', '.join(sorted(unknown))}; the cases are {', '.join(CASES)}")
    kept = record.load(told.out) if told.out else {}
    if told.tables:
        for name, case in kept.items():
            case |= tables(name, record.restored(case, CASES[name].entries(False)), False)
    else:
        _run(told, kept)
    kept = {name: kept[name] for name in CASES if name in kept}
    print(markdown([HEADER, *(row for case in kept.values() for row in case["ratios"])]))
    if told.out:
        record.write(told.out, kept)
    if told.page:
        record.write_page(told.page, kept)
    return 0


def _run(told: argparse.Namespace, kept: dict[str, Any]) -> None:
    """Run the cases, and keep each as soon as it is there."""
    every = codes(dict(told.python))
    versions = {name: code.version() for name, code in every.items()}
    for name, version in versions.items():
        print(f"{name} {version}" if version else f"{name}: not installed, skipped; install with {every[name].remedy}")
    here = {name: code for name, code in every.items() if versions[name]}
    said = ", ".join(f"{name} {versions[name]}" for name in here)
    for name in told.cases or CASES:
        kept[name] = compare(name, here, said, told.short, told.keep)
        if told.out:
            record.write(told.out, kept)


if __name__ == "__main__":
    sys.exit(main())
