"""The files of a flat pattern: drawing, picture, numbers, operator's sheet, and those of the simulated part."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

from umform.flat_pattern import FILES
from umform.flat_pattern.bending import BentPart
from umform.flat_pattern.drawing import svg, write_dxf
from umform.flat_pattern.operator_sheet import Step, steps_of, write_sheet
from umform.flat_pattern.order import Orders
from umform.flat_pattern.pattern import FlatBend
from umform.io.staging import staging
from umform.io.tables import write_json
from umform.processes.bend_sequence.files import write_files as write_sequence
from umform.report.versions import versions

RESULTS = FILES


def write_files(out: str | Path, orders: Orders, bent: BentPart | None = None, note: str = "") -> list[Path]:
    """Write flat.dxf, flat.svg, flat.json and sheet.html; of a simulated part its files in the folder sequence.

    Parameters
    ----------
    out : str or Path
        The folder.
    orders : Orders
        The pattern and its tools.
    bent : BentPart, optional
        The simulated part.
    note : str
        Source of the material data; may be empty.
    """
    pattern = orders.pattern
    with staging(out, FILES) as stage:
        here = stage.waiting
        write_dxf(here / "flat.dxf", pattern)
        (here / "flat.svg").write_text(svg(pattern), encoding="utf-8")
        write_json(here / "flat.json", record(orders, bent))
        write_sheet(here / "sheet.html", orders, bent, note)
        files = stage.commit(FILES)
    return files if bent is None else [*files, *write_sequence(Path(out) / "sequence", bent.part, note)]


def record(orders: Orders, bent: BentPart | None = None) -> dict[str, Any]:
    """Numbers of the pattern as JSON data, in mm, mm², N and degrees; forces of the steps in kN."""
    pattern = orders.pattern
    return {
        "part": pattern.path.name,
        "unit_of_the_file": pattern.unit,
        "thickness": pattern.thickness,
        "size": pattern.size.tolist(),
        "area": pattern.area,
        "holes": len(pattern.holes),
        "bends": [_bend(bend) for bend in pattern.bends],
        "order": list(pattern.order),
        "steps": [_step(step) for step in steps_of(orders, bent)],
        "flange_errors": None if bent is None else bent.errors,
        "deviation_of_polylines": pattern.deviation,
        "folded_back": pattern.folded_back,
        "warnings": list(pattern.warnings),
        "versions": versions(),
    }


def _step(step: Step) -> dict[str, Any]:
    numbers = {field.name: getattr(step, field.name) for field in fields(step)}
    return numbers | {"bend": step.bend.number}


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
