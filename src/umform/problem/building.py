"""Build the problem of a deck: model, contacts, supports, controls and steps; all mistakes are reported together."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import dataclass

import numpy as np

from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import Result
from umform.analysis.run.checked import check_step
from umform.analysis.steps import Step
from umform.model import Model
from umform.model.changes.removal import refuse_elsewhere
from umform.model.contact import Contact
from umform.model.supports.support import Support
from umform.model.terms.control import Control
from umform.model.tools.tool import Tool as RigidTool
from umform.problem.contents import Contents
from umform.problem.errors import DeckError
from umform.problem.measure_checks import check_measures
from umform.problem.prepared import Prepared
from umform.problem.sheet_building import Earlier, SheetBuilder
from umform.problem.source import Source
from umform.problem.steps import Free, Named
from umform.problem.supports import Rigid
from umform.surfaces import Tool


def build(
    contents: Contents,
    source: Source,
    solver: str | None = None,
    before: Earlier | None = None,
    start: Result | None = None,
) -> Prepared:
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
    start : Result, optional
        The run of the previous operation.

    Raises
    ------
    DeckError
        With all mistakes.
    """
    with np.errstate(all="ignore"):
        return _Builder(contents, source, before, start, solver=solver or contents.solution.solver).problem()


def sheet(contents: Contents, source: Source, before: Earlier | None, start: Result | None = None) -> Model:
    """Only the model, without tools and supports; see :func:`build`."""
    with np.errstate(all="ignore"):
        builder = SheetBuilder(contents, source, before, start)
        model = builder.sheet()
    if model is None:
        raise DeckError(builder.errors)
    return model


@dataclass
class _Builder(SheetBuilder):
    """Builds the parts in order; after a failure it continues with all parts that do not depend on the failed one."""

    solver: str = ""

    def problem(self) -> Prepared:
        tools = self.tools
        model = self.sheet()
        if model is None:
            raise DeckError(self.errors)
        contacts = self._contacts(model, tools)
        supports = self._supports(model, rigid=False)
        controls = self._controls(model, contacts)
        supports |= self._supports(model, rigid=True)
        controls |= self._missing_forces(model, supports, contacts)
        if self.is_deformed and not self.errors:
            with self.at("placement" if self.before is None and self.start is None else "before"):
                refuse_elsewhere(model.system, "supports, controls")
        self._rest(model)
        options = self._options(model)
        self._raise()
        steps = self._steps(model, Named(controls, supports, contacts))
        check_measures(self.contents, model, self.at)
        self._raise()
        return Prepared(
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

    def _missing_forces(
        self, model: Model, supports: dict[str, Support], contacts: dict[str, Contact]
    ) -> dict[str, Control]:
        """Unbalanced forces of removed tools, supports and metal; supports that no step activates are activated now."""
        part = self.contents.before
        if part is None or self.errors:
            return {}
        named = {step.on for step in self.contents.steps if isinstance(step, Free)}
        with self.at("before"):
            for name, support in supports.items():
                if support.waits and name not in named:
                    model.put_back(support)
            sheets = {contact.name: contact for contact in model.system.sheet_contacts}
            part.keep_friction(model, self.kept, {**contacts, **sheets})
            return {} if part.control is None else {part.control: model.unbalanced(part.control)}
        return {}

    def _contacts(self, model: Model, tools: dict[str, Tool]) -> dict[str, Contact]:
        contacts: dict[str, Contact] = {}
        shared: dict[str, RigidTool] = {}
        for name, part in self.contents.contacts.items():
            if part.tool not in tools:
                continue  # it has failed, with an error of its own
            with self.at("contacts", name):
                tool: Tool | RigidTool = tools[part.tool]
                if self.contents.tools[part.tool].shared:
                    tool = shared.get(part.tool) or shared.setdefault(
                        part.tool, model.tool(part.tool, tools[part.tool])
                    )
                contacts[name] = part.add_to(model, tool, name)
        for name, touching in self.contents.sheet_contacts.items():
            with self.at("sheet_contacts", name):
                touching.add_to(model, name)
        for name, bead in self.contents.beads.items():
            if bead.contact in contacts:
                with self.at("beads", name):
                    bead.add_to(model, contacts[bead.contact], name)
        return contacts

    def _supports(self, model: Model, *, rigid: bool) -> dict[str, Support]:
        """The supports by name: statically determinate ones, or all others."""
        supports: dict[str, Support] = {}
        for number, part in enumerate(self.contents.supports):
            if isinstance(part, Rigid) != rigid:
                continue
            with self.at("supports", number):
                support = part.add_to(model, here=self.is_deformed)
                supports[support.name] = support
        return supports

    def _controls(self, model: Model, contacts: dict[str, Contact]) -> dict[str, Control]:
        controls: dict[str, Control] = {}
        for name, part in self.contents.controls.items():
            touched = [getattr(part, "contact", None), *getattr(part, "followers", [])]
            touched.append(getattr(getattr(part, "gap", None), "to", None))
            if any(contact not in (None, *contacts) for contact in touched):
                continue  # likewise
            with self.at("controls", name):
                controls[name] = part.add_to(model, name, contacts)
        return controls

    def _rest(self, model: Model) -> None:
        """Springs under a loose sheet: automatic, never, or with the stiffness of the deck."""
        rest = self.contents.solution.rest
        model.carries_loose_sheet = rest == "auto"
        if (rest == "on" or isinstance(rest, float)) and not self.errors:
            with self.at("solution"):
                model.rest(rest if isinstance(rest, float) else None)

    def _options(self, model: Model) -> NewtonOptions:
        options = NewtonOptions()
        with self.at("solution"):
            options = self.contents.solution.build()
        if self.source.made:
            return options
        if self.solver == "petsc":  # each rank has the pattern of its share
            from umform.parallel.petsc import petsc

            with self.at("solution", "solver"):
                petsc()
            return options
        if not self.errors and any(body.rolling is not None for body in model.bodies):
            with self.at("material", "rolling"):
                _ = [body.block for body in model.bodies]  # the elements check the rolling direction
        if not self.errors:
            with self.at("supports"):
                _ = model.system.pattern
        if not self.errors:
            with self.at("solution", "solver") if self.solver == self.contents.solution.solver else nullcontext():
                _ = Newton(model.system, options, self.solver).solver
        return options

    def _steps(self, model: Model, named: Named) -> list[Step]:
        steps: list[Step] = []
        for number, part in enumerate(self.contents.steps):
            with self.at("steps", number):
                steps.append(part.build(named))
                if len(steps) == number + 1:  # none before has failed
                    check_step(model, steps, number)
        return steps
