"""The sheet of a deck: its mesh, element and material, or that of the deck before, with what was cut off."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

from umform.analysis.run import Result
from umform.analysis.run.stages import continued
from umform.elements import Rolling
from umform.elements.technology import Element
from umform.errors import InvalidValue, UmformError
from umform.materials import Material
from umform.mesh import Mesh
from umform.model import Model
from umform.model.bodies.body import Body
from umform.model.contact.kept_history import KeptContact
from umform.model.transfer.beside import laid_beside
from umform.problem.contents import Contents
from umform.problem.errors import DeckError
from umform.problem.material import LawPart
from umform.problem.mesh import Together
from umform.problem.outline import Outlined
from umform.problem.places import Place
from umform.problem.rolling import direction
from umform.problem.selection import sets_in
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
            motion = self.contents.placement.motion
            self.kept = {name: kept.moved((motion.rotation, motion.shift)) for name, kept in self.kept.items()}
            with self.at("placement"):
                self.contents.placement.apply(model)
        return model if model is None or not self.contents.added else self._with_added(model)

    def _with_added(self, model: Model) -> Model | None:
        """The part with the sheets that are laid beside it."""
        sheets: dict[str, Mesh] = {}
        for name, one in self.contents.added.items():
            with self.at("added", name):
                sheets[name] = one.build(model.mesh.cell, self.source.folder)
        with self.at("added"):
            return laid_beside(model, **sheets) if len(sheets) == len(self.contents.added) else None
        return None

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
        element, mesh = self._element(), None
        material, rolling = self.contents.material.law, self._rolling(self.contents.material, "material", "rolling")
        with self.at("mesh"):
            mesh = self._mesh(element.cell if element else "hex8")
        if element is None or mesh is None or any("rolling" in e.where for e in self.errors):
            return None
        bodies = self._bodies(mesh, material, rolling)
        with self.at("element"):
            if bodies is not None:
                return Model(mesh, bodies=bodies)
            return Model(mesh, part.name, material=material, rolling=rolling, **part.of_spec())
        return None

    def _bodies(self, mesh: Mesh, material: Material, rolling: Rolling | None) -> list[Body] | None:
        """A body for each of the sheets, if one has a law of its own."""
        part, element = self.contents.mesh, self.contents.element
        if not isinstance(part, Together) or all(sheet.material is None for sheet in part.sheets.values()):
            return None
        bodies = []
        for name, sheet in part.sheets.items():
            law, way = material, rolling
            if sheet.material is not None:
                law = sheet.material.law
                way = self._rolling(sheet.material, "mesh", "sheets", name, "material", "rolling")
            with self.at("element"):
                bodies.append(Body(element.name, material=law, cells=name, name=name, rolling=way, **element.of_spec()))
        return bodies

    def _mesh(self, cell: str) -> Mesh | None:
        """The mesh; that of an outline may follow the radii of the tools. None if one of these has failed."""
        part, folder, tools = self.contents.mesh, self.source.folder, self.tools
        if not isinstance(part, Outlined) or part.turn is None:
            return part.build(cell, folder)
        touching = set()
        for name, contact in self.contents.contacts.items():
            sides = {"lower", "upper"} & sets_in(contact.faces)
            touching |= {(contact.tool, side) for side in sides or {""}}
            with self.at("contacts", name):
                if not sides:
                    raise InvalidValue(
                        "it is not known on which side of the blank this tool lies, whose radii the elements follow",
                        where="faces",
                        cause="turn in [mesh], and faces that are no part of the set lower or upper",
                        remedy='faces = "lower", or { intersection = ["lower", { min = [0, 0, 0] }] }',
                    )
        if any(tool not in tools or not side for tool, side in touching):
            return None
        below, above = ([tools[tool] for tool, on in sorted(touching) if on == side] for side in ("lower", "upper"))
        self.sizes = part.sizes(below, above, folder)
        made = part.build(cell, folder, self.sizes)
        self.notes.append(f"mesh: {self.sizes.on(made)}")
        return made

    def _rolling(self, material: LawPart, *path: str) -> Rolling | None:
        """The rolling direction of a metal that has one."""
        if material.rolling is None:
            return None
        with self.at(*path):
            return direction(material.rolling, self.source.folder)
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
