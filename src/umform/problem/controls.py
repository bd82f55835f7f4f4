"""The controls of a deck: quantities that steps move, by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Annotated, Literal

from umform.model import Model
from umform.model.contact import Contact
from umform.model.terms.control import Control
from umform.model.tools.tool_controls import ToolForce, ToolWay
from umform.problem.notes import Field
from umform.problem.parts import Axis, Name, Part, Positive, Vector, Way
from umform.problem.selection import Selection, faces_of, nodes_of

Contacts = Mapping[str, Contact]


class Displacement(Part):
    """Displacement of nodes; its force is the sum of the reactions."""

    kind: Literal["displacement"]
    """The word displacement."""
    nodes: Selection
    """Which nodes."""
    direction: Axis
    """Direction."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.prescribe(nodes_of(model.mesh, self.nodes), self.direction, name)


class MidLine(Part):
    """Displacement of the mid-line of an edge; the section may rotate about it."""

    kind: Literal["midline"]
    """The word midline."""
    nodes: Selection
    """Lower and upper nodes of the edge."""
    direction: Axis
    """Direction."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.prescribe_midline(nodes_of(model.mesh, self.nodes), self.direction, name)


class Force(Part):
    """The same dead force on each node of a set."""

    kind: Literal["force"]
    """The word force."""
    nodes: Selection
    """Which nodes."""
    force: Vector
    """Force on each node for the value 1."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.force(nodes_of(model.mesh, self.nodes), self.force, name)


class Traction(Part):
    """Dead traction on faces, lateral ones too."""

    kind: Literal["traction"]
    """The word traction."""
    faces: Selection
    """Which faces."""
    traction: Vector
    """Force per reference area for the value 1."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.traction(faces_of(model.mesh, self.faces), self.traction, name)


class LineLoad(Part):
    """Dead load on the lower or upper edge of lateral faces."""

    kind: Literal["line_load"]
    """The word line_load."""
    faces: Selection
    """Which lateral faces."""
    side: Literal["lower", "upper"]
    """Which of their edges."""
    load: Vector
    """Force per reference length for the value 1."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.line_load(faces_of(model.mesh, self.faces), self.side, self.load, name)


class Pressure(Part):
    """Follower pressure on lower or upper faces; its value is the pressure."""

    kind: Literal["pressure"]
    """The word pressure."""
    faces: Selection
    """Which faces."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.pressure(faces_of(model.mesh, self.faces), name)


class BodyForce(Part):
    """Dead force in the volume."""

    kind: Literal["body_force"]
    """The word body_force."""
    force: Vector
    """Force per reference volume for the value 1."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.loads.body_force(self.force, name)


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


class Drive(_OfTool):
    """Translation of the tool of a contact; its force is that of the tool on the sheet, along the direction."""

    kind: Literal["tool"]
    """The word tool."""
    direction: Way
    """Direction."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return self._followed(model, model.drive(contacts[self.contact], self.direction, name), contacts)


class Turn(_OfTool):
    """Rotation of the tool of a contact about an axis, in radians; its force is the moment of the tool on the sheet."""

    kind: Literal["turn"]
    """The word turn."""
    axis: Way
    """Axis."""
    about: Vector = (0.0, 0.0, 0.0)
    """Point of the axis."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return self._followed(model, model.turn(contacts[self.contact], self.axis, self.about, name), contacts)


class StopPart(Part):
    """A stop of a pressed tool: distance blocks, the end of a spring."""

    at: float
    """Displacement at which the tool meets it."""
    stiffness: Positive | None = None
    """Force per length beyond; by default it is rigid."""
    below: bool = False
    """Whether it is a lower bound of the displacement; by default an upper bound."""


class GapPart(Part):
    """Gap between a pressed tool and another one: rigid distance blocks between both."""

    to: Name
    """Contact of the other tool."""
    least: Positive
    """Smallest distance of both tools."""


class _Pressed(Part):
    """Common keys of controls of pressed tools."""

    contact: Name
    """Name of the contact."""
    stops: list[StopPart] = field(default_factory=list)
    """Limits of the displacement."""

    def _stopped(self, model: Model, force: ToolForce) -> ToolForce:
        for stop in self.stops:
            model.stop(force, stop.at, stop.stiffness, below=stop.below)
        return force


class Press(_Pressed):
    """Force on the tool of a contact along a direction; the displacement is an unknown."""

    kind: Literal["press"]
    """The word press."""
    direction: Way
    """Direction."""
    gap: GapPart | None = None
    """Gap between the tool and another one; the force is then an upper bound."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        force = self._stopped(model, model.press(contacts[self.contact], self.direction, name))
        if self.gap is not None:
            model.keep_gap(force, contacts[self.gap.to], self.gap.least)
        return force


class Spring(_Pressed):
    """A spring that holds the tool of a contact, and an additional force; the displacement is an unknown."""

    kind: Literal["spring"]
    """The word spring."""
    direction: Way
    """Direction in which the spring pushes the tool."""
    stiffness: Positive
    """Force per length."""
    preload: float = 0.0
    """Force of the spring at the initial position of the tool."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        contact = contacts[self.contact]
        return self._stopped(model, model.spring(contact, self.direction, self.stiffness, self.preload, name))


class Moment(_Pressed):
    """Moment on the tool of a contact about an axis; the angle is an unknown."""

    kind: Literal["moment"]
    """The word moment."""
    axis: Way
    """Axis."""
    about: Vector = (0.0, 0.0, 0.0)
    """Point of the axis."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return self._stopped(model, model.press_turn(contacts[self.contact], self.axis, self.about, name))


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
