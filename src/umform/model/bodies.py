"""The bodies of a model; a model with one body exposes the body's element and law directly."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from umform import _core
from umform.elements import Element
from umform.errors import InvalidValue, ModelError
from umform.materials import Material
from umform.mesh import Mesh
from umform.model.body import Body


class Embodied:
    """Something that consists of bodies."""

    mesh: Mesh
    bodies: list[Body]

    def _embody(self, bodies: Sequence[Body]) -> None:
        """Attach bodies to the mesh.

        Raises
        ------
        InvalidValue
            If a cell belongs to no body or to two, or two bodies have the same name.
        """
        self.bodies = [body.on(self.mesh) for body in bodies]
        names = [body.name for body in bodies]
        if len(set(names)) < len(names):
            raise InvalidValue("two bodies have the same name", value=", ".join(names), remedy="Body(..., name=...)")
        count = np.zeros(len(self.mesh.connectivity), dtype=int)
        for body in self.bodies:
            count[body.cells] += 1
        wrong = np.flatnonzero(count != 1)
        if len(wrong):
            raise InvalidValue(
                "each cell belongs to one body",
                where=f"cell {wrong[0]} (one of {len(wrong)})",
                value=f"{count[wrong[0]]} bodies",
                remedy="choose the cells of the bodies so that they share none and leave none out",
            )

    @property
    def body(self) -> Body:
        """The only body.

        Raises
        ------
        ModelError
            If there are several.
        """
        if len(self.bodies) != 1:
            raise ModelError(
                "the model has several bodies",
                value=", ".join(body.name for body in self.bodies),
                remedy="ask the bodies themselves: model.bodies",
            )
        return self.bodies[0]

    @property
    def element(self) -> Element:
        """Element of the only body."""
        return self.body.element

    @property
    def material(self) -> Material:
        """Law of the only body."""
        return self.body.material

    @property
    def thickness_points(self) -> int:
        """Points through the thickness of the only body."""
        return self.body.thickness_points

    @property
    def thickness_rule(self) -> str:
        """Their rule."""
        return self.body.thickness_rule

    @property
    def block(self) -> _core.ShellBlock:
        """Elements of the only body with their history."""
        return self.body.block
