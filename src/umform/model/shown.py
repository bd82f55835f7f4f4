"""What is shown of a model: a line, and in a notebook a table of its parts."""

from __future__ import annotations

from typing import Any

from umform.model.tools.tool_controls import ToolWay
from umform.notebook import Display, InNotebook

#: Characters of a law that are shown.
_LONG = 120


class ShownModel(InNotebook):
    """How a model is shown."""

    def __repr__(self) -> str:
        model: Any = self
        elements = ", ".join(dict.fromkeys(body.element.name for body in model.bodies))
        counts = (
            (len(model.tools), "tools"),
            (len(model.contacts), "contacts"),
            (len(list(model.supports)), "supports"),
            (len(model.controls), "controls"),
        )
        parts = ", ".join(f"{count} {noun[:-1] if count == 1 else noun}" for count, noun in counts if count)
        shown = f"{len(model.mesh.points)} points, {len(model.mesh.connectivity)} {elements}"
        return f"Model({shown}{'; ' if parts else ''}{parts})"

    def _display(self) -> Display:
        model: Any = self
        mesh = model.mesh
        rows = [["part", "name", "what it is"]]
        rows.append(["mesh", "", f"{len(mesh.points)} points, {len(mesh.connectivity)} {mesh.cell}"])
        for body in model.bodies:
            law = repr(body.material)
            short = law if len(law) <= _LONG else f"{law[: _LONG - 3]}..."
            rows.append(["body", body.name, f"{body.element.name}, {short}"])
        rows += [
            ["support", one.name, f"{one.kind} {one.directions}, {len(one.nodes)} nodes"] for one in model.supports
        ]
        rows += [["tool", one.name, type(one.surface).__name__] for one in model.tools]
        for pair in model.contacts:
            friction = ", friction" if pair.has_friction else ""
            rows.append(["contact", pair.name, f"{len(pair.facets)} facets with {pair.tool.name}{friction}"])
        rows += [["contact", pair.name, "between sheets"] for pair in model.system.sheet_contacts]
        for control in model.controls:
            of = "of a tool, " if isinstance(control, ToolWay) else ""
            rows.append(["control", control.name, f"{of}now {control.value:.6g}"])
        return Display("Model", {"": rows})
