"""The file that all benchmarks write: machine, commit, versions, and the numbers of each benchmark by name."""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from umform.report.versions import versions


def add_option(parser: argparse.ArgumentParser) -> None:
    """Add ``--json FILE``."""
    parser.add_argument("--json", type=Path, metavar="FILE", help="add the numbers to this file")


def write(path: Path | None, name: str, numbers: Mapping[str, float]) -> None:
    """Put the numbers of a benchmark into a file beside those of others; numbers of its own from before are replaced.

    Parameters
    ----------
    path : Path or None
        The file, made if it is missing, with its folder; None writes nothing.
    name : str
        The benchmark.
    numbers : mapping of str to float
        What was measured; the unit is in the name.
    """
    if path is None:
        return
    known: dict[str, Any] = json.loads(path.read_text()) if path.is_file() else {}
    known = {
        "benchmarks": known.get("benchmarks", {}),
        "machine": machine(),
        "commit": commit(),
        "versions": versions(),
    }
    known["benchmarks"][name] = {"when": f"{datetime.now(UTC):%Y-%m-%dT%H:%M:%SZ}", "numbers": dict(numbers)}
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(known, indent=1) + "\n")


def machine() -> dict[str, str | int]:
    """Processor, how many of them, memory, system."""
    facts: dict[str, str | int] = {"system": platform.platform(), "processors": os.cpu_count() or 1}
    info = Path("/proc/cpuinfo")
    if info.is_file():
        models = [line.split(":", 1)[1].strip() for line in info.read_text().splitlines() if "model name" in line]
        facts["processor"] = models[0] if models else platform.machine()
    if hasattr(os, "sysconf") and "SC_PHYS_PAGES" in os.sysconf_names:
        facts["memory_bytes"] = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return facts


def commit() -> str:
    """The commit of the folder that this file is in, with a plus sign where files differ from it."""
    here = Path(__file__).parent

    def git(*words: str) -> str:
        return subprocess.run(["git", "-C", str(here), *words], capture_output=True, text=True, check=False).stdout

    name = git("rev-parse", "HEAD").strip()
    return name + ("+" if name and git("status", "--porcelain", "--untracked-files=no").strip() else "")
