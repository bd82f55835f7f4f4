"""Build the problem of a deck: model, contacts, supports, controls and steps; all mistakes are reported together."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import numpy as np

from umform.deck.contents import Contents
from umform.deck.drawn_tools import Profiled
from umform.deck.errors import DeckError
from umform.deck.foreign import Foreign
from umform.deck.measure_checks import check_measures
from umform.deck.metal import J2, Metal
from umform.deck.outline import Outlined
from umform.deck.places import Place
from umform.deck.problem import Problem
from umform.deck.profiles import profile_of
from umform.deck.rolling import direction
from umform.deck.source import Source
from umform.deck.steps import Free, Named
from umform.deck.supports import Rigid
from umform.elements import Rolling
from umform.elements.technology import Element
from umform.errors import UmformError
from umform.materials import Material
from umform.mesh import Mesh
from umform.model import Model
from umform.model.contact import Contact
from umform.model.contact.kept import KeptContact
from umform.model.control import Control
from umform.model.support import Support
from umform.solution.newton import Newton
from umform.solution.options import NewtonOptions
from umform.steps import Step
from umform.surfaces import Tool, ToolSizes


class Earlier(Protocol):
    """The deck of the previous operation."""

    def sheet(self) -> Model:
        """Its model without tools and supports."""


def build(contents: Contents, source: Source, solver: str | None = None, before: Earlier | None = None) -> Problem:
    """Build the problem of a deck.

    Parameters
    ----------
    contents : Contents
        Content of the deck.
    source : Source
        Its source.
    solver : str, optional
        Another sparse solver than that of the deck.
    before : Earlier, optional
        The deck of the previous operation.

    Raises
    ------
    DeckError
        With all mistakes.
    """
    with np.errstate(all="ignore"):
        return _Builder(contents, source, solver or contents.solution.solver, before).problem()


def sheet(contents: Contents, source: Source, before: Earlier | None) -> Model:
    """Only the model, without tools and supports; see :func:`build`."""
    with np.errstate(all="ignore"):
        builder = _Builder(contents, source, contents.solution.solver, before)
        model = builder.sheet()
    if model is None:
        raise DeckError(builder.errors)
    return model


@dataclass
class _Builder:
    """Builds the parts in order; after a failure it continues with all parts that do not depend on the failed one."""

    contents: Contents
    source: Source
    solver: str
    before: Earlier | None = None
    errors: list[UmformError] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    sizes: ToolSizes | None = None
    kept: dict[str, KeptContact] = field(default_factory=dict)

    def problem(self) -> Problem:
        tools = self._tools
        model = self.sheet()
        if model is None:
            raise DeckError(self.errors)
        contacts = self._contacts(model, tools)
        supports = self._supports(model, rigid=False)
        controls = self._controls(model, contacts)
        supports |= self._supports(model, rigid=True)
        controls |= self._missing_forces(model, supports, contacts)
        self._rest(model)
        options = self._options(model)
        self._raise()
        steps = self._steps(Named(controls, supports, contacts))
        check_measures(self.contents, model, self._at)
        self._raise()
        return Problem(
            model=model,
            contacts=contacts,
            controls=controls,
            steps=steps,
            tools=tools,
            options=options,
            solver=self.solver,
            frames=self.contents.output.frames,
            notes=self.notes,
            sizes=self.sizes,
        )

    @cached_property
    def _tools(self) -> dict[str, Tool]:
        tools: dict[str, Tool] = {}
        for name, part in self.contents.tools.items():
            before = len(self.errors)
            if isinstance(part, Profiled):
                with self._at("tools", name, "profile"):
                    profile_of(part.profile, self.source.folder)
            if len(self.errors) > before:
                continue
            with self._at("tools", name):
                tool = part.build(self.source.folder)
                tool.kernel()
                tools[name] = tool
        return tools

    def sheet(self) -> Model | None:
        """The model without tools and supports, in its initial state."""
        if self.before is None:
            return self._model()
        part, folder = self.contents.before, self.source.folder
        assert part is not None
        with self._at("before"):
            model = self.before.sheet()
            part.restore(model, folder, self.source.data)
            self.kept = part.kept(folder)
            for number, cut in enumerate(self.contents.trim):
                with self._at("trim", number):
                    left = cut.build(folder).of(model)
                    self.notes.append(f"trim {number + 1}: {left}")
                    model = left.model
                    self.kept = {name: kept.left(left.cells, left.same) for name, kept in self.kept.items()}
            return model
        return None

    def _missing_forces(
        self, model: Model, supports: dict[str, Support], contacts: dict[str, Contact]
    ) -> dict[str, Control]:
        """Unbalanced forces of removed tools, supports and metal; supports that no step activates are activated now."""
        part = self.contents.before
        if part is None or self.errors:
            return {}
        named = {step.on for step in self.contents.steps if isinstance(step, Free)}
        with self._at("before"):
            for name, support in supports.items():
                if support.waits and name not in named:
                    model.put_back(support)
            part.keep_friction(model, self.kept, contacts)
            return {part.control: model.unbalanced(part.control)}
        return {}

    def _model(self) -> Model | None:
        part = self.contents.element
        element, mesh, material, rolling = self._element(), None, self._material(), self._rolling()
        with self._at("mesh"):
            mesh = self._mesh(element.cell if element else "hex8")
        if element is None or mesh is None or material is None or any("rolling" in e.where for e in self.errors):
            return None
        with self._at("element"):
            return Model(
                mesh,
                element,
                material=material,
                thickness_points=part.thickness_points,
                thickness_rule=part.thickness_rule,
                rolling=rolling,
            )
        return None

    def _mesh(self, cell: str) -> Mesh | None:
        """The mesh; that of an outline may follow the radii of the tools. None if one of these has failed."""
        part, folder, tools = self.contents.mesh, self.source.folder, self._tools
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
        rolling = getattr(self.contents.material, "rolling", None)
        if rolling is None:
            return None
        with self._at("material", "rolling"):
            return direction(rolling, self.source.folder)
        return None

    def _element(self) -> Element | None:
        with self._at("element"):
            return self.contents.element.build()
        return None

    def _material(self) -> Material | None:
        part, before = self.contents.material, len(self.errors)
        if isinstance(part, J2 | Metal):
            with self._at("material", "hardening"):
                part.hardening.build()
        if len(self.errors) > before:
            return None
        with self._at("material"):
            return part.build(self.source.folder) if isinstance(part, Foreign) else part.build()
        return None

    def _contacts(self, model: Model, tools: dict[str, Tool]) -> dict[str, Contact]:
        contacts = {}
        for name, part in self.contents.contacts.items():
            if part.tool not in tools:
                continue  # it has failed, with an error of its own
            with self._at("contacts", name):
                contacts[name] = part.add_to(model, tools[part.tool], name)
        for name, bead in self.contents.beads.items():
            if bead.contact in contacts:
                with self._at("beads", name):
                    bead.add_to(model, contacts[bead.contact], name)
        return contacts

    def _supports(self, model: Model, *, rigid: bool) -> dict[str, Support]:
        """The supports by name: statically determinate ones, or all others."""
        supports: dict[str, Support] = {}
        for number, part in enumerate(self.contents.supports):
            if isinstance(part, Rigid) != rigid:
                continue
            with self._at("supports", number):
                support = part.add_to(model, here=self.before is not None)
                supports[support.name] = support
        return supports

    def _controls(self, model: Model, contacts: dict[str, Contact]) -> dict[str, Control]:
        controls: dict[str, Control] = {}
        for name, part in self.contents.controls.items():
            touched = [getattr(part, "contact", None), *getattr(part, "followers", [])]
            touched.append(getattr(getattr(part, "gap", None), "to", None))
            if any(contact not in (None, *contacts) for contact in touched):
                continue  # likewise
            with self._at("controls", name):
                controls[name] = part.add_to(model, name, contacts)
        return controls

    def _rest(self, model: Model) -> None:
        """Springs under a loose sheet: automatic, never, or with the stiffness of the deck."""
        rest = self.contents.solution.rest
        model.carries_loose_sheet = rest == "auto"
        if isinstance(rest, float) and not self.errors:
            with self._at("solution"):
                model.rest(rest)

    def _options(self, model: Model) -> NewtonOptions:
        options = NewtonOptions()
        with self._at("solution"):
            options = self.contents.solution.build()
        if self.solver == "petsc":  # each rank has the pattern of its share
            from umform.parallel.petsc import petsc

            with self._at("solution", "solver"):
                petsc()
            return options
        if not self.errors and any(body.rolling is not None for body in model.bodies):
            with self._at("material", "rolling"):
                _ = [body.block for body in model.bodies]  # the elements check the rolling direction
        if not self.errors:
            with self._at("supports"):
                _ = model.pattern
        if not self.errors:
            with self._at("solution", "solver"):
                _ = Newton(model, options, self.solver).solver
        return options

    def _steps(self, named: Named) -> list[Step]:
        steps: list[Step] = []
        for number, part in enumerate(self.contents.steps):
            with self._at("steps", number):
                steps.append(part.build(named))
        return steps

    def _at(self, *path: str | int) -> Place:
        """Context for a part of the deck: errors get its place."""
        return Place(path, self.source, self.errors)

    def _raise(self) -> None:
        if self.errors:
            raise DeckError(self.errors)
