"""The supports of a deck, and its controls: all that steps move, by name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field

from umform.deck.parts import Axis, Directions, Name, Part, Vector, Way
from umform.deck.selection import Selection, faces_of, nodes_of
from umform.model import Model
from umform.model.contact import Contact
from umform.model.control import Control

Contacts = Mapping[str, Contact]


class Fix(Part):
    """Nodes that are held."""

    kind: Literal["fix"]
    """The word fix."""
    nodes: Selection
    """Which nodes."""
    directions: Directions = "xyz"
    """Letters of the directions."""

    def add_to(self, model: Model) -> None:
        """Hold the nodes."""
        model.fix(nodes_of(model.mesh, self.nodes), self.directions)


class Symmetry(Part):
    """Nodes that stay in a plane."""

    kind: Literal["symmetry"]
    """The word symmetry."""
    nodes: Selection
    """Which nodes."""
    normal: Axis
    """Normal of the plane."""

    def add_to(self, model: Model) -> None:
        """Hold the nodes in the plane."""
        model.symmetry(nodes_of(model.mesh, self.nodes), self.normal)


class Hinge(Part):
    """Mid-line of an edge that is held; the edge may turn about it."""

    kind: Literal["hinge"]
    """The word hinge."""
    nodes: Selection
    """Lower and upper nodes of the edge."""
    directions: Directions = "xyz"
    """Letters of the directions."""

    def add_to(self, model: Model) -> None:
        """Hold the mid-line."""
        model.hinge(nodes_of(model.mesh, self.nodes), self.directions)


Support = Annotated[Fix | Symmetry | Hinge, Field(discriminator="kind")]

# Controls ----------------------------------------------------------------------------------------------------


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
    """Displacement of the mid-line of an edge, which may turn about it."""

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
        return model.body_force(self.force, name)


class Drive(Part):
    """Translation of the tool of a contact; its force is that of the sheet on the tool."""

    kind: Literal["tool"]
    """The word tool."""
    contact: Name
    """Name of the contact."""
    direction: Way
    """Direction."""

    def add_to(self, model: Model, name: str, contacts: Contacts) -> Control:
        """The control."""
        return model.drive(contacts[self.contact], self.direction, name)


ControlPart = Annotated[
    Displacement | MidLine | Force | Traction | LineLoad | Pressure | BodyForce | Drive, Field(discriminator="kind")
]
