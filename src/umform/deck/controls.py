"""The supports of a deck, and its controls: all that steps move, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Literal

from pydantic import Field

from umform.deck.parts import Axis, Name, Part, Vector, Way
from umform.deck.selection import Selection, faces_of, nodes_of
from umform.model import Model
from umform.model.axes import Axes, cylindrical
from umform.model.contact import Contact
from umform.model.control import Control
from umform.model.support import Support as Held

Contacts = Mapping[str, Contact]


class Around(Part):
    """Cylindrical axes r, t, a around a line."""

    origin: Vector
    """A point of the axis."""
    axis: Way
    """Direction of the axis."""

    def build(self) -> Axes:
        """The axes."""
        return cylindrical(self.origin, self.axis)


class _Supporting(Part):
    """What supports in axes of their own have in common."""

    nodes: Selection
    """Which nodes; for a mid-line or a director the lower and upper nodes of the edge."""
    directions: Annotated[str, Field(pattern=r"^[xyzrta]{1,3}$")] | None = None
    """Letters of the directions: x, y, z, or r, t, a of the axes; by default all three."""
    axes: Around | None = None
    """Cylindrical axes instead of x, y, z."""
    name: Name | None = None
    """Name, by which a step may free it."""

    def _hold(self, method: Callable[..., Held], model: Model) -> Held:
        axes = None if self.axes is None else self.axes.build()
        return method(nodes_of(model.mesh, self.nodes), self.directions, axes=axes, name=self.name or "")


class Fix(_Supporting):
    """Nodes that are held."""

    kind: Literal["fix"]
    """The word fix."""

    def add_to(self, model: Model) -> Held:
        """Hold the nodes."""
        return self._hold(model.fix, model)


class Symmetry(Part):
    """Nodes that stay in a plane."""

    kind: Literal["symmetry"]
    """The word symmetry."""
    nodes: Selection
    """Which nodes."""
    normal: Axis
    """Normal of the plane."""

    def add_to(self, model: Model) -> Held:
        """Hold the nodes in the plane."""
        return model.symmetry(nodes_of(model.mesh, self.nodes), self.normal)


class Hinge(_Supporting):
    """Mid-line of an edge that is held; the edge may turn about it."""

    kind: Literal["hinge"]
    """The word hinge."""

    def add_to(self, model: Model) -> Held:
        """Hold the mid-line."""
        return self._hold(model.hinge, model)


class Director(_Supporting):
    """Director of an edge that stays in the planes normal to the directions, and may tilt and stretch there."""

    kind: Literal["director"]
    """The word director."""

    def add_to(self, model: Model) -> Held:
        """Hold the director."""
        return self._hold(model.hold_director, model)


Support = Annotated[Fix | Symmetry | Hinge | Director, Field(discriminator="kind")]

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
