"""Bands of numbers: runs of a corpus of small parts, the errors they show, and whether the finest answers lie in them.

python benchmarks/bands.py --page docs/bands.md
python benchmarks/bands.py --process cup --only-runs
python benchmarks/bands.py --stored --page docs/bands.md

Runs that are in bands.jsonl with the same parameters are not repeated; without that file all are.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from band_jobs import DECK, DEFAULT, JOBS, Job, fingerprint, length, run, softness
from band_studies import SEQUENCE, SINGLE, parts_of, studied
from bands_page import page
from umform.errors import UmformError
from umform.results.studies import STUDIES

#: Where the package keeps the studies.
_DATA = Path(__file__).parents[1] / "src" / "umform" / "results" / STUDIES.name
#: The runs so far, and the significant digits of their numbers.
_ROWS, _DIGITS = Path(__file__).with_name("bands.jsonl"), 8


def main() -> None:
    """Run what is missing, write the studies and the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", type=Path, default=_ROWS, help="numbers of each run, a line each")
    parser.add_argument("--page", type=Path, help="the page to write")
    parser.add_argument("--process", action="append", help="processes to run; default: all")
    parser.add_argument("--only-runs", action="store_true", help="write neither the studies nor the page")
    parser.add_argument("--stored", action="store_true", help="run nothing; a process with missing runs stays as it is")
    given = parser.parse_args()
    processes = list(dict.fromkeys(job.process for job in JOBS))
    if not given.stored:
        run_missing(given.rows, given.process or processes)
    if given.only_runs:
        return
    rows = known_rows(given.rows)
    missing = {job.process for job in JOBS if not set(job.cases) <= {row["run"] for row in rows if _is_of(row, job)}}
    found = {process: parts_of(rows, process) for process in processes if process not in missing}
    units = {process: units_of(parts) for process, parts in found.items()}
    data: dict[str, Any] = json.loads(_DATA.read_text(encoding="utf-8"))
    for process, parts in found.items():
        if process != DECK:
            data[process] = studied(list(parts.values()), units[process])
    if SEQUENCE in found:  # its bends have the bands of single ones
        rows_of_part = data[SEQUENCE]["quantities"]
        data[SEQUENCE]["quantities"] = {
            name: row for name, row in rows_of_part.items() if name not in data[SINGLE]["quantities"]
        }
    _DATA.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8")
    if given.page is not None:
        given.page.write_text(page(rows, found, units, data), encoding="utf-8")


def _is_of(row: Mapping[str, Any], job: Job) -> bool:
    return (row["process"], row["job"]) == (job.process, job.name)


def read(path: Path) -> list[dict[str, Any]]:
    """The rows of a file; none if there is no file."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.is_file() else []


def known_rows(path: Path) -> list[dict[str, Any]]:
    """The rows of the present jobs, with the softness of their bends, and the length that errors in mm follow."""
    cases = {(job.process, job.name, name): case for job in JOBS for name, case in job.cases.items()}
    found = []
    for row in read(path):
        case = cases.get((row["process"], row["job"], row["run"]))
        if case is not None and fingerprint(case) == row["case"]:
            found.append(row | {"softness": softness(case, row["values"]), "length": length(case)})
    return found


def run_missing(path: Path, processes: list[str]) -> None:
    """Run what the file has no row of, and add it."""
    known = {(row["process"], row["job"], row["run"], row["case"]) for row in read(path)}
    path.parent.mkdir(parents=True, exist_ok=True)
    for job in JOBS:
        if job.process not in processes:
            continue
        for name, case in job.cases.items():
            row: dict[str, Any] = {"process": job.process, "job": job.name, "run": name, "case": fingerprint(case)}
            if tuple(row.values()) in known:
                continue
            began = time.process_time()
            row |= {"error": None, "values": {}, "units": {}}
            try:
                done = run(case)
            except UmformError as error:
                row["error"] = str(error)
            else:
                row["values"] = {one.name: _rounded(one.value) for one in done.quantities}
                row["units"] = {one.name: one.unit for one in done.quantities} if name == DEFAULT else {}
            row["cpu"] = round(time.process_time() - began, 1)
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
            print(f"{job.process}, {job.name}, {name}: {row['cpu']:.1f} s {row['error'] or ''}", flush=True)


def _rounded(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.{_DIGITS}g}")


def units_of(parts: Mapping[str, Mapping[str, Mapping[str, Any]]]) -> dict[str, str]:
    """Unit of each number of a process."""
    return {name: unit for part in parts.values() for name, unit in part[DEFAULT].get("units", {}).items()}


if __name__ == "__main__":
    main()
