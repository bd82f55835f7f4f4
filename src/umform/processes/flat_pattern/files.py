"""The files of a flat pattern: drawing, picture, numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from umform.io.staging import staging
from umform.io.tables import write_json
from umform.processes.flat_pattern.drawing import svg, write_dxf
from umform.processes.flat_pattern.pattern import FlatBend, FlatPattern
from umform.report.versions import versions

#: Files of a flat pattern.
FILES = ("flat.dxf", "flat.svg", "flat.json")
RESULTS = FILES


def write_files(out: str | Path, pattern: FlatPattern) -> list[Path]:
    """Write flat.dxf, flat.svg and flat.json.

    Parameters
    ----------
    out : str or Path
        The folder.
    pattern : FlatPattern
        The pattern.
    """
    with staging(out, FILES) as stage:
        here = stage.waiting
        write_dxf(here / "flat.dxf", pattern)
        (here / "flat.svg").write_text(svg(pattern), encoding="utf-8")
        write_json(here / "flat.json", record(pattern))
        return stage.commit(FILES)


def record(pattern: FlatPattern) -> dict[str, Any]:
    """Numbers of the pattern as JSON data, in mm, mm² and degrees."""
    return {
        "part": pattern.path.name,
        "unit_of_the_file": pattern.unit,
        "thickness": pattern.thickness,
        "size": pattern.size.tolist(),
        "area": pattern.area,
        "holes": len(pattern.holes),
        "bends": [_bend(bend) for bend in pattern.bends],
        "order": list(pattern.order),
        "deviation_of_polylines": pattern.deviation,
        "folded_back": pattern.folded_back,
        "warnings": list(pattern.warnings),
        "versions": versions(),
    }


def _bend(bend: FlatBend) -> dict[str, Any]:
    allowance = bend.allowance
    return {
        "number": bend.number,
        "faces": list(bend.faces),
        "angle": bend.angle,
        "direction": bend.direction,
        "radius_of_the_drawing": bend.radius,
        "radius": allowance.radius,
        "allowance": allowance.length,
        "source": allowance.source,
        "stroke": allowance.stroke,
        "force_per_length": allowance.force,
        "lines": [line.tolist() for line in bend.lines],
    }
