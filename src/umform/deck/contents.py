"""What stands in a deck: all its tables, and their JSON schema for editors."""

from __future__ import annotations

import json
from typing import Annotated

from pydantic import Field

from umform.deck.beads import BeadPart
from umform.deck.before import Before, Cut
from umform.deck.contacts import ContactPart
from umform.deck.controls import ControlPart
from umform.deck.element import ElementPart
from umform.deck.material import MaterialPart
from umform.deck.mesh import MeshPart
from umform.deck.parts import Name, Part
from umform.deck.settings import Output, Solution
from umform.deck.steps import StepPart
from umform.deck.supports import Support
from umform.deck.tools import ToolPart


class Contents(Part):
    """A problem of umform: mesh, material, element, tools, contacts, supports, controls, steps."""

    title: str = ""
    """What it is about."""
    before: Before | None = None
    """The deck of the operation before, whose mesh, material and element these are then."""
    trim: list[Cut] = []
    """What is cut off the part of the operation before, one cut after the other."""
    mesh: MeshPart
    """Points and cells."""
    material: MaterialPart
    """Material law."""
    element: ElementPart = ElementPart()
    """Element and points through the thickness."""
    tools: dict[Name, ToolPart] = {}
    """Rigid tools by name."""
    contacts: dict[Name, ContactPart] = {}
    """Contacts by name; their names begin columns of the history."""
    beads: dict[Name, BeadPart] = {}
    """Equivalent draw beads by name; their names begin columns of the history."""
    supports: list[Support] = []
    """What is held."""
    controls: dict[Name, ControlPart] = {}
    """What steps move, by name: displacements, loads, tools; their names are columns of the history."""
    steps: Annotated[list[StepPart], Field(min_length=1)]
    """What happens, in a row."""
    solution: Solution = Solution()
    """Sparse solver and Newton's method."""
    output: Output = Output()
    """What is written."""


def json_schema() -> str:
    """JSON schema (draft 2020-12) of all that may stand in a deck."""
    schema = Contents.model_json_schema()
    head = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Deck of umform",
        "description": schema.pop("description"),
    }
    schema.pop("title")
    return json.dumps(head | schema, indent=1) + "\n"
