"""The bodies of a model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np

from umform.errors import InvalidValue, ModelError, UmformError
from umform.mesh import Ids, Mesh
from umform.model.bodies.body import Body


class Bodies(list[Body]):
    """The bodies of a model."""

    @classmethod
    def on(cls, mesh: Mesh, bodies: Sequence[Body]) -> Self:
        """Put bodies on a mesh.

        Raises
        ------
        InvalidValue
            If a cell belongs to no body or to two, or two bodies have the same name.
        """
        if not isinstance(bodies, list | tuple) or any(not isinstance(body, Body) for body in bodies):
            raise InvalidValue(
                "bodies are a list of bodies",
                where="Model",
                value=bodies,
                cause="one body, or a material in place of a body",
                remedy="bodies=[Body(...)]",
            )
        made = cls()
        try:
            for body in bodies:
                made.append(body.on(mesh))
            made._check(mesh)
        except UmformError:
            for body in made:  # for another model
                body.leave()
            raise
        return made

    def _check(self, mesh: Mesh) -> None:
        """Refuse equal names, and cells of no body or of two."""
        names = [body.name for body in self]
        if len(set(names)) < len(names):
            raise InvalidValue(
                "two bodies have the same name",
                where="Model, bodies",
                value=", ".join(names),
                cause="no names were given, or one twice",
                remedy="Body(..., name=...)",
            )
        count = np.zeros(len(mesh.connectivity), dtype=int)
        for body in self:
            count[body.cells] += 1
        wrong = np.flatnonzero(count != 1)
        if len(wrong):
            raise InvalidValue(
                "each cell belongs to one body",
                where=f"cell {wrong[0]} (one of {len(wrong)})",
                value=f"{count[wrong[0]]} bodies",
                cause="predicates that overlap, or leave a gap",
                remedy="choose the cells of the bodies so that they share none and leave none out",
            )

    def of(self, cells: Ids) -> Body:
        """Body that most of some cells belong to."""
        return max(self, key=lambda body: int(np.isin(cells, body.cells).sum()))

    @property
    def only(self) -> Body:
        """The only body.

        Raises
        ------
        ModelError
            If there are several.
        """
        if len(self) != 1:
            raise ModelError(
                "the model has several bodies",
                where="Model.bodies",
                value=", ".join(body.name for body in self),
                cause="what each of them has was asked of the model",
                remedy="ask the bodies themselves: model.bodies",
            )
        return self[0]
