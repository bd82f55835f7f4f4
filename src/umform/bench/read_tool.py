"""The process that reads a drawing: ``python -m umform.bench.read_tool KIND FILE LAYER`` prints the section as JSON."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from umform.bench.errors_as_json import error_record
from umform.bench.limits import limit_memory
from umform.bench.shelf import profile_record
from umform.errors import UmformError
from umform.processes.air_bending.drawn_tools import DrawnDie, DrawnPunch, read_section
from umform.surfaces.dxf import layers_and_unit


def read(kind: str, path: Path, layer: str) -> dict[str, Any]:
    """The section of a tool with layers and unit of its drawing, or the error.

    Parameters
    ----------
    kind : str
        "punch" or "die".
    path : Path
        The drawing.
    layer : str
        The layer with the section, or empty.
    """
    found: dict[str, Any] = {"layers": [], "unit": ""}
    try:
        found["layers"], found["unit"] = layers_and_unit(path)
        profile = read_section(path, layer or None, above=kind == "punch")
        (DrawnPunch if kind == "punch" else DrawnDie).of(profile)
    except UmformError as error:
        where = "layer" if error.what == "there is nothing on this layer" else "drawing"
        return found | {"problem": error_record(error) | {"where": where}}
    return found | profile_record(profile)


if __name__ == "__main__":
    limit_memory()
    print(json.dumps(read(sys.argv[1], Path(sys.argv[2]), sys.argv[3])))
