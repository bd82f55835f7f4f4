"""The controls of a deck: quantities that steps move, by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated, Literal

from umform.model import Model
from umform.model.contact import Contact
from umform.model.contact.tools import Tools
from umform.model.supports.supports import Supports
from umform.model.terms.control import Control
from umform.model.terms.loads import Loads
from umform.model.tools.tool_controls import ToolForce, ToolWay
from umform.problem.notes import Field
from umform.problem.parts import Axis, Name, Part
from umform.problem.selection import Selection, faces_of, nodes_of

Contacts = Mapping[str, Contact]


class Displacement(Part, of=Supports.prescribe, leave=("nodes", "name", "axes")):
    """Displacement of nodes; its force is the sum of the reactions."""

    kind: Literal["displacement"]
    nodes: Selection
    """Which nodes."""
    direction: Axis

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.prescribe(nodes_of(model.mesh, self.nodes), name=name, **self.of_spec())


class MidLine(Part, of=Supports.prescribe_midline, leave=("nodes", "name", "axes")):
    """Displacement of the mid-line of an edge; the section may rotate about it."""

    kind: Literal["midline"]
    nodes: Selection
    """Lower and upper nodes of the edge."""
    direction: Axis

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.prescribe_midline(nodes_of(model.mesh, self.nodes), name=name, **self.of_spec())


class Force(Part, of=Loads.force, leave=("nodes", "name")):
    """The same dead force on each node of a set."""

    kind: Literal["force"]
    nodes: Selection
    """Which nodes."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.force(nodes_of(model.mesh, self.nodes), name=name, **self.of_spec())


class Traction(Part, of=Loads.traction, leave=("faces", "name")):
    """Dead traction on faces, lateral ones too."""

    kind: Literal["traction"]
    faces: Selection
    """Which faces."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.traction(faces_of(model.mesh, self.faces), name=name, **self.of_spec())


class LineLoad(Part, of=Loads.line_load, leave=("faces", "name")):
    """Dead load on the lower or upper edge of lateral faces."""

    kind: Literal["line_load"]
    faces: Selection
    """Which lateral faces."""
    side: Literal["lower", "upper"]

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.line_load(faces_of(model.mesh, self.faces), name=name, **self.of_spec())


class Pressure(Part):
    """Follower pressure on lower or upper faces; its value is the pressure."""

    kind: Literal["pressure"]
    faces: Selection
    """Which faces."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.pressure(faces_of(model.mesh, self.faces), name)


class BodyForce(Part, of=Loads.body_force, leave=("name",)):
    """Dead force in the volume."""

    kind: Literal["body_force"]

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.loads.body_force(name=name, **self.of_spec())


class _OfTool(Part):
    """Common keys of controls of tools."""

    contact: Name
    """Name of the contact."""
    followers: list[Name] = field(default_factory=list)
    """Contacts whose tools move together with this one."""

    def _followed(self, model: Model, way: ToolWay, contacts: Contacts) -> ToolWay:
        for name in self.followers:
            model.attach(contacts[name], way)
        return way


class Drive(_OfTool, of=Tools.drive, leave=("tool", "name")):
    """Translation of the tool of a contact; its force is that of the tool on the sheet, along the direction."""

    kind: Literal["tool"]

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return self._followed(model, model.drive(contacts[self.contact], name=name, **self.of_spec()), contacts)


class Turn(_OfTool, of=Tools.turn, leave=("tool", "name")):
    """Rotation of the tool of a contact about an axis, in radians; its force is the moment of the tool on the sheet."""

    kind: Literal["turn"]

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return self._followed(model, model.turn(contacts[self.contact], name=name, **self.of_spec()), contacts)


class StopPart(Part, of=Tools.stop, leave=("force",)):
    """A stop of a pressed tool: distance blocks, the end of a spring."""


class GapPart(Part, of=Model.keep_gap, leave=("force", "to"), called={"gap": "least"}):
    """Gap between a pressed tool and another one: rigid distance blocks between both."""

    to: Name
    """Contact of the other tool."""


class _Pressed(Part):
    """Common keys of controls of pressed tools."""

    contact: Name
    """Name of the contact."""
    stops: list[StopPart] = field(default_factory=list)
    """Limits of the displacement."""

    def _stopped(self, model: Model, force: ToolForce) -> ToolForce:
        for stop in self.stops:
            model.stop(force, **stop.of_spec())
        return force


class Press(_Pressed, of=Tools.press, leave=("tool", "name")):
    """Force on the tool of a contact along a direction; the displacement is an unknown."""

    kind: Literal["press"]
    gap: GapPart | None = None
    """Gap between the tool and another one; the force is then an upper bound."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        force = self._stopped(model, model.press(contacts[self.contact], name=name, **self.of_spec()))
        if self.gap is not None:
            model.keep_gap(force, contacts[self.gap.to], **self.gap.of_spec())
        return force


class Spring(_Pressed, of=Tools.spring, leave=("tool", "name")):
    """A spring that holds the tool of a contact, and an additional force; the displacement is an unknown."""

    kind: Literal["spring"]

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return self._stopped(model, model.spring(contacts[self.contact], name=name, **self.of_spec()))


class Moment(_Pressed, of=Tools.press_turn, leave=("tool", "name")):
    """Moment on the tool of a contact about an axis; the angle is an unknown."""

    kind: Literal["moment"]

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return self._stopped(model, model.press_turn(contacts[self.contact], name=name, **self.of_spec()))


ControlPart = Annotated[
    Displacement
    | MidLine
    | Force
    | Traction
    | LineLoad
    | Pressure
    | BodyForce
    | Drive
    | Turn
    | Press
    | Spring
    | Moment,
    Field(discriminator="kind"),
]
