"""The process that reads a part: ``python -m umform.bench.read_part FILE VIEW`` prints thickness and bends as JSON.

It writes a page with the 3D view of the part, also of one that does not unfold.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

from umform.bench.errors_as_json import error_record
from umform.bench.form import ABOUT_K
from umform.bench.limits import limit_memory
from umform.errors import UmformError
from umform.flat_pattern.allowance import KFactor
from umform.flat_pattern.pattern import pattern_of
from umform.report.solid_page import write_solid
from umform.surfaces.cad.read_solid import read_solid


def read(path: Path, view: Path) -> dict[str, Any]:
    """Unit, thickness and bends of a part, its approximate flat size, or the error that says why it does not unfold."""
    try:
        write_solid(view, read_solid(path), path.name)
        pattern = pattern_of(path, KFactor(ABOUT_K))
    except UmformError as error:
        record = error_record(error)
        return {"problem": record | {"where": "part", "value": record["value"].replace(f"{path.parent}/", "")}}
    return {
        "unit": pattern.unit,
        "thickness": pattern.thickness,
        "size": pattern.size.tolist(),
        "holes": len(pattern.holes),
        "bends": [{"angle": bend.angle, "radius": bend.radius, "direction": bend.direction} for bend in pattern.bends],
    }


if __name__ == "__main__":
    limit_memory()
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # OpenCASCADE prints there
    answer.write(json.dumps(read(Path(sys.argv[1]), Path(sys.argv[2]))))
    answer.close()
