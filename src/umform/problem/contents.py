"""The tables of a deck, and their JSON schema for editors."""

from __future__ import annotations

import json
from dataclasses import field
from typing import TYPE_CHECKING, Annotated, Any, get_args

from umform.problem.beads import BeadPart
from umform.problem.contacts import ContactPart
from umform.problem.controls import ControlPart
from umform.problem.element import ElementPart
from umform.problem.material import MaterialPart
from umform.problem.mesh import MeshPart, OneMesh
from umform.problem.notes import Field, Later
from umform.problem.parts import Name, Part
from umform.problem.previous_operation import Before, Cut, Placement
from umform.problem.settings import Derivatives, Output, Solution, Units
from umform.problem.sheet_contacts import SheetContactPart
from umform.problem.steps import StepPart
from umform.problem.supports import Support
from umform.problem.tools import ToolPart

if TYPE_CHECKING:
    from umform.problem.measures import AnyMeasure
else:

    def _measures() -> Any:
        from umform.problem.measures import AnyMeasure

        return AnyMeasure

    AnyMeasure = Annotated[Any, Later(_measures)]


class Contents(Part):
    """A problem of umform: mesh, material, element, tools, contacts, supports, controls, steps."""

    title: str = ""
    """Title of the problem."""
    before: Before | None = None
    """The previous operation, whose deck then defines mesh, material and element."""
    trim: list[Cut] = field(default_factory=list)
    """Cuts of the part of the previous operation, in order."""
    placement: Placement | None = None
    """Rigid motion of the part after the cuts, before the first step."""
    added: dict[Name, OneMesh] = field(default_factory=dict)
    """Flat sheets that are laid beside the placed part, by name, with its element and metal: the sets are then lower of
    part, upper of NAME, and so on."""
    mesh: MeshPart
    """Points and cells."""
    material: MaterialPart
    """Material law."""
    element: ElementPart = field(default_factory=ElementPart)
    """Element and points through the thickness."""
    tools: dict[Name, ToolPart] = field(default_factory=dict)
    """Rigid tools by name."""
    contacts: dict[Name, ContactPart] = field(default_factory=dict)
    """Contacts by name; the names are prefixes of history columns."""
    sheet_contacts: dict[Name, SheetContactPart] = field(default_factory=dict)
    """Contacts of sheets with each other and with themselves, by name; the names are prefixes of history columns."""
    beads: dict[Name, BeadPart] = field(default_factory=dict)
    """Equivalent draw beads by name; the names are prefixes of history columns."""
    supports: list[Support] = field(default_factory=list)
    """Supports."""
    controls: dict[Name, ControlPart] = field(default_factory=dict)
    """Quantities that steps move, by name: displacements, loads, tools; the names are history columns."""
    measures: dict[Name, AnyMeasure] = field(default_factory=dict)
    """Measures of the part by name; the names are those of files and fields."""
    derivatives: Derivatives | None = None
    """Derivatives of the results, for `umform derive`."""
    units: Units = field(default_factory=Units)
    """Names of the units."""
    steps: Annotated[list[StepPart], Field(min_length=1)]
    """Steps of the run, in order."""
    solution: Solution = field(default_factory=Solution)
    """Sparse solver and Newton's method."""
    output: Output = field(default_factory=Output)
    """Files of the results."""


def json_schema() -> str:
    """JSON schema (draft 2020-12) of a deck."""
    from umform.problem.tagged import describe, table  # pydantic takes long to import

    contents = get_args(table(Contents))[0]
    describe()
    schema = contents.model_json_schema()
    head = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Deck of umform",
        "description": schema.pop("description"),
    }
    schema.pop("title")
    return json.dumps(head | _with_whole_bounds(schema), indent=1) + "\n"


def _with_whole_bounds(schema: Any) -> Any:
    """The schema with bounds as 0, not 0.0: they are equal, and typing keeps the type that it has met before."""
    if isinstance(schema, list):
        return [_with_whole_bounds(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    return {
        key: int(one)
        if key.lower().endswith("imum") and isinstance(one, float) and one.is_integer()
        else _with_whole_bounds(one)
        for key, one in schema.items()
    }
