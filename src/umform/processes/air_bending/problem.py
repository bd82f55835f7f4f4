"""The problem of a bend: what a deck of it holds."""

from __future__ import annotations

from typing import Any

from umform.elements import element
from umform.mesh import grid
from umform.model import Model
from umform.model.contact.encounter import Layer
from umform.model.contact.settings import ContactOptions, ContactSettings, contact_settings
from umform.model.terms.control import Control
from umform.problem.keys import law_keys
from umform.problem.problem import Problem
from umform.problem.profiles import profile_table
from umform.processes.air_bending.foil import refuse_squeezed
from umform.processes.air_bending.goal import needed_stroke
from umform.processes.air_bending.loading import OPTIONS, loading, unloading_keys
from umform.processes.air_bending.sheet import lines_of, lines_through
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import between, name_of, of_sheet

#: Contact points per direction of the contact of sheets, whose meshes slide on each other: 6 cells give the same angle
#: to 0.001 degrees at 2.5 times the effort.
BETWEEN = 5


def build(case: AirBending) -> tuple[Model, Control]:
    """Model of a case, and the control that moves the punch down."""
    made = problem_of(case, case.way).build()
    return made.model, made.controls["stroke"]


def touching(case: AirBending) -> dict[str, ContactSettings]:
    """Penalty, allowed penetration and points of die and punch on the undeformed sheet, without a model."""
    sheet, faces = grid(*lines_of(case), element(case.element).cell), {"die": "lower", "punch": "upper"}
    how = ContactOptions(penalty=case.penalty, penetration=case.penetration, points=case.contact_points)
    return {
        name: contact_settings(sheet, face, getattr(case, name), [Layer(case.material)], how, f"contact {name}")
        for name, face in faces.items()
    }


def problem_of(case: AirBending, stroke: float | None = None) -> Problem:
    """Half of the sheet in its tools: down by a stroke, by default that of the case, and back to zero force.

    Raises
    ------
    InvalidValue
        There is no stroke, or a foil would be squeezed out.
    """
    refuse_squeezed(case)
    stroke = needed_stroke(case) if stroke is None else stroke
    if case.width is None:
        modelled, kind = case.thickest, "in plane strain"
    else:
        modelled, kind = 0.5 * case.width, f"{case.width:g} mm wide"
    sheets = " + ".join(f"{sheet.thickness:g}" for sheet in case.sheets)
    remarks = [
        f"Air bending of a sheet of {sheets} mm, {kind}, over an opening of {case.opening:g} mm: down by "
        f"{stroke:.6g} mm, and back to zero force. Units: mm, N, MPa.",
        f"Half of the sheet, {modelled:g} mm of its width: the force for each mm of the bend is stroke_force times "
        f"{2.0 / modelled:.6g}.",
    ]
    last = len(case.on_top)
    moves = [{"kind": "move", "to": {"stroke": end}, "increments": count} for end, count in loading(case, stroke)]
    tables = {
        "title": "Air bending",
        "mesh": _mesh(case),
        "element": {
            "name": case.element,
            "thickness_points": case.thickness_points,
            "plane_strain": case.plane_strain,
        },
        "material": _material(case, case.material),
        "tools": {"die": _die(case), "punch": _punch(case)},
        "contacts": {
            "die": _contact(case, "die", of_sheet(case, "lower")),
            "punch": _contact(case, "punch", of_sheet(case, "upper", last)),
        },
        "sheet_contacts": {
            between(number): _between(case, number) for number in range(last) if not case.on_top[number].bonded
        }
        or None,
        "supports": [
            *({"kind": "symmetry", "nodes": of_sheet(case, "x0", number), "normal": "x"} for number in range(last + 1)),
            *_across(case),
        ],
        "controls": {"stroke": {"kind": "tool", "contact": "punch", "direction": "-z"}},
        "steps": [*moves, {"kind": "release", "control": "stroke", **unloading_keys(case)}],
        "measures": None if case.on_top else {"legs": {"kind": "angle"}},
        "units": {"length": "mm", "force": "N"},
        "solution": {
            "residual": OPTIONS.residual,
            "increment": OPTIONS.increment,
            "line_search": OPTIONS.line_search,
            "extrapolate": OPTIONS.extrapolate,
        },
    }
    return Problem.of(tables, remarks)


def _mesh(case: AirBending) -> dict[str, Any]:
    """Half of the sheet on the die, or the sheets on each other."""
    x, y, z = (line.tolist() for line in lines_of(case))
    first = {"generator": "grid", "x": x, "y": y, "z": z, "thickness": case.thickness}
    if not case.on_top:
        return first
    sheets: dict[str, dict[str, Any]] = {name_of(0): {"mesh": first}}
    height = case.thickness
    for number, sheet in enumerate(case.on_top, 1):
        z = lines_through(case, number).tolist()
        sheets[name_of(number)] = {
            "mesh": {**first, "z": z, "thickness": sheet.thickness},
            "shift": (0.0, 0.0, height),
            "material": _material(case, sheet.material),
        }
        height += sheet.thickness
    bonds = [
        (of_sheet(case, "upper", number), of_sheet(case, "lower", number + 1))
        for number, sheet in enumerate(case.on_top)
        if sheet.bonded
    ]
    return {"generator": "together", "sheets": sheets, "bonds": bonds or None}


def _material(case: AirBending, law: object) -> dict[str, Any]:
    return law_keys(law, None if case.rolling is None else {"angle": float(case.rolling)})


def _between(case: AirBending, number: int) -> dict[str, Any]:
    """Contact of a sheet with the next one."""
    return {
        "faces": of_sheet(case, "upper", number),
        "others": of_sheet(case, "lower", number + 1),
        "points": BETWEEN,
        "friction": case.on_top[number].friction or None,
    }


def _contact(case: AirBending, tool: str, faces: str) -> dict[str, Any]:
    pressed = case.bottoming and tool == "punch"
    how = {"penalty": case.penalty, "penetration": case.penetration, "points": case.contact_points}
    return {"tool": tool, "faces": faces, **how, "friction": case.friction or None, "may_bottom": pressed or None}


def _die(case: AirBending) -> dict[str, Any]:
    if case.die_section is not None:
        return {"shape": "Extruded", "profile": profile_table(case.die_section.profile)}
    return {"shape": "VDie", "opening": case.opening, "angle": case.die_angle, "shoulder_radius": case.die_radius}


def _punch(case: AirBending) -> dict[str, Any]:
    if case.punch_section is not None:
        shape: dict[str, Any] = {"shape": "Extruded", "profile": profile_table(case.punch_section.profile)}
    else:
        tip = {"tip_radius": case.punch_radius, "angle": case.punch_angle, "width": case.punch_width}
        shape = {"shape": "Punch", **tip}
    return {**shape, "origin": case.punch.origin}


def _across(case: AirBending) -> list[dict[str, Any]]:
    """Supports along the bend."""
    if case.width is None:
        everywhere = {"min": [-float("inf")] * 3}
        return [{"kind": "fix", "nodes": everywhere, "directions": "y"}]
    edges = [of_sheet(case, "y0", number) for number in range(len(case.sheets))]
    return [{"kind": "symmetry", "nodes": edge, "normal": "y"} for edge in edges]
