"""The sheet of a deck: its mesh, element and material, or that of the deck before, with what was cut off."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

from umform.analysis.run import Result
from umform.analysis.run.stages import continued
from umform.elements import Rolling
from umform.elements.technology import Element
from umform.errors import UmformError
from umform.mesh import Mesh
from umform.model import Model
from umform.model.contact.kept import KeptContact
from umform.problem.contents import Contents
from umform.problem.errors import DeckError
from umform.problem.outline import Outlined
from umform.problem.places import Place
from umform.problem.rolling import direction
from umform.problem.source import Source
from umform.surfaces import Tool, ToolSizes


class Earlier(Protocol):
    """The deck of the previous operation."""

    def sheet(self) -> Model:
        """Its model without tools and supports."""


@dataclass
class SheetBuilder:
    """Builds tools and sheet; errors are collected, each with its place in the deck."""

    contents: Contents
    source: Source
    before: Earlier | None = None
    start: Result | None = None
    errors: list[UmformError] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    sizes: ToolSizes | None = None
    kept: dict[str, KeptContact] = field(default_factory=dict)

    @cached_property
    def tools(self) -> dict[str, Tool]:
        """Tools by name, without those that have an error."""
        tools: dict[str, Tool] = {}
        for name, part in self.contents.tools.items():
            with self.at("tools", name):
                tool = part.build(self.source.folder)
                tool.kernel()
                tools[name] = tool
        return tools

    @property
    def is_deformed(self) -> bool:
        """Whether the part does not lie as its mesh."""
        return self.before is not None or self.start is not None or self.contents.placement is not None

    def sheet(self) -> Model | None:
        """The model without tools and supports, in its initial state."""
        model = self._formed()
        if model is not None and self.contents.placement is not None:
            with self.at("placement"):
                self.contents.placement.apply(model)
        return model

    def _formed(self) -> Model | None:
        """The model in the state after the previous operation."""
        if self.before is None:
            model = self._model()
            return model if model is None or self.start is None else continued(model, self.start)
        part, folder = self.contents.before, self.source.folder
        assert part is not None
        with self.at("before"):
            model = self.before.sheet()
            part.restore(model, folder, self.source.data)
            self.kept = part.kept(folder)
            for number, cut in enumerate(self.contents.trim):
                with self.at("trim", number):
                    left = cut.build(folder).of(model)
                    self.notes.append(f"trim {number + 1}: {left}")
                    model = left.model
                    self.kept = {name: kept.left(left.cells, left.same) for name, kept in self.kept.items()}
            return model
        return None

    def _model(self) -> Model | None:
        part = self.contents.element
        element, mesh, material, rolling = self._element(), None, self.contents.material.law, self._rolling()
        with self.at("mesh"):
            mesh = self._mesh(element.cell if element else "hex8")
        if element is None or mesh is None or any("rolling" in e.where for e in self.errors):
            return None
        with self.at("element"):
            return Model(mesh, part.name, material=material, rolling=rolling, **part.of_spec())
        return None

    def _mesh(self, cell: str) -> Mesh | None:
        """The mesh; that of an outline may follow the radii of the tools. None if one of these has failed."""
        part, folder, tools = self.contents.mesh, self.source.folder, self.tools
        if not isinstance(part, Outlined) or part.turn is None:
            return part.build(cell, folder)
        touching = {(contact.tool, str(contact.faces)) for contact in self.contents.contacts.values()}
        if any(tool not in tools for tool, _ in touching):
            return None
        below, above = ([tools[tool] for tool, on in sorted(touching) if on == side] for side in ("lower", "upper"))
        self.sizes = part.sizes(below, above, folder)
        made = part.build(cell, folder, self.sizes)
        self.notes.append(f"mesh: {self.sizes.on(made)}")
        return made

    def _rolling(self) -> Rolling | None:
        """The rolling direction of a metal that has one."""
        rolling = self.contents.material.rolling
        if rolling is None:
            return None
        with self.at("material", "rolling"):
            return direction(rolling, self.source.folder)
        return None

    def _element(self) -> Element | None:
        with self.at("element"):
            return self.contents.element.build()
        return None

    def at(self, *path: str | int) -> Place:
        """Context for a part of the deck: errors get its place."""
        return Place(path, self.source, self.errors)

    def _raise(self) -> None:
        if self.errors:
            raise DeckError(self.errors)
