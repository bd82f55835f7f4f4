"""Reference values in files, each with its source in its first lines."""

from __future__ import annotations

import csv
import json
from importlib.resources import files
from typing import Any

import numpy as np
from numpy.typing import NDArray

_FOLDER = files("umform_book") / "reference"


def table(name: str) -> dict[str, NDArray[np.float64]]:
    """Columns of a reference table in CSV; lines that begin with # name the source; an empty cell is NaN."""
    lines = [line for line in (_FOLDER / name).read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return {column: np.array([float(row[column] or "nan") for row in rows]) for column in rows[0]}


def record(name: str) -> dict[str, Any]:
    """A reference file in JSON; its field "source" names the source."""
    content: dict[str, Any] = json.loads((_FOLDER / name).read_text(encoding="utf-8"))
    return content
