"""The supports of a deck."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field
from typing import Annotated, Literal

from umform.errors import InvalidValue
from umform.model import Model
from umform.model.supports.axes import Axes, cylindrical
from umform.model.supports.support import Support as Held
from umform.model.supports.supports import Supports
from umform.problem.notes import Field
from umform.problem.parts import Axis, Name, Part
from umform.problem.selection import Selection, nodes_of


class Around(Part, of=cylindrical):
    """Cylindrical axes r, t, a around a line."""

    def build(self) -> Axes:
        """The axes."""
        return cylindrical(**self.of_spec())


class _Supporting(Part, of=Supports.fix, leave=("nodes", "normals", "here", "name")):
    """Common keys of supports with local axes."""

    nodes: Selection
    """Which nodes; for a mid-line or a director the lower and upper nodes of the edge."""
    directions: Annotated[str, Field(pattern=r"^[xyzrta]{1,3}$")] | None
    axes: Around | None
    """Cylindrical axes instead of x, y, z."""
    name: Name | None = None
    """Name, for a step that frees it."""

    def _hold(self, method: Callable[..., Held], model: Model, here: bool) -> Held:
        axes = None if self.axes is None else self.axes.build()
        nodes = nodes_of(model.mesh, self.nodes)
        return method(nodes, self.directions, axes=axes, name=self.name or "", here=here)


class Fix(_Supporting):
    """Held nodes."""

    kind: Literal["fix"]

    def add_to(self, model: Model, *, here: bool = False) -> Held:
        """Hold the nodes."""
        return self._hold(model.fix, model, here)


class Symmetry(Part, of=Supports.symmetry, leave=("nodes",)):
    """Nodes that stay in a plane, that in which they are in the blank."""

    kind: Literal["symmetry"]
    nodes: Selection
    """Which nodes."""
    normal: Axis

    def add_to(self, model: Model, *, here: bool = False) -> Held:
        """Hold the nodes in the plane."""
        return model.symmetry(nodes_of(model.mesh, self.nodes), self.normal)


class Hinge(_Supporting):
    """Held mid-line of an edge; the section may rotate about it."""

    kind: Literal["hinge"]

    def add_to(self, model: Model, *, here: bool = False) -> Held:
        """Hold the mid-line."""
        return self._hold(model.hinge, model, here)


class Director(_Supporting):
    """Director of an edge that stays in the planes normal to the directions, and may tilt and stretch there."""

    kind: Literal["director"]

    def add_to(self, model: Model, *, here: bool = False) -> Held:
        """Hold the director."""
        return self._hold(model.hold_director, model, here)


class Rigid(Part, of=Model.hold_rigid, leave=("name",)):
    """A statically determinate support for the motions that others leave free; a step activates it."""

    kind: Literal["rigid"]
    name: Name
    """Name, for the step that activates it."""
    nodes: Selection
    instead_of: list[Name] = field(default_factory=list)

    def add_to(self, model: Model, *, here: bool = False) -> Held:
        """Add the support, inactive until the step."""
        nodes = "all" if self.nodes == "all" else nodes_of(model.mesh, self.nodes)
        there = {support.name: support for support in model.supports}
        unknown = [name for name in self.instead_of if name not in there]
        if unknown:
            raise InvalidValue(
                "a rigid support takes the place of supports that the deck names",
                where=f"support {self.name}, instead_of",
                value=", ".join(unknown),
                cause="a name that no support has, or that of another rigid one",
                remedy=f"names of supports: {', '.join(there) or 'there are none'}",
            )
        return model.hold_rigid(nodes, self.name, instead_of=[there[name] for name in self.instead_of])


Support = Annotated[Fix | Symmetry | Hinge | Director | Rigid, Field(discriminator="kind")]
