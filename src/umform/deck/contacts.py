"""The contacts of a deck: faces, a tool, a penalty or the penetration that is allowed, and what moves the tool."""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from umform.deck.parts import Name, Part, Positive, Vector
from umform.deck.selection import Selection, faces_of
from umform.model import Model
from umform.model.contact import Contact
from umform.model.tool import Motion
from umform.surfaces import Tool

Floats = NDArray[np.float64]


class MotionPart(Part):
    """Motion of a tool in time, in addition to what steps do to it: straight lines between points of a table.

    The first step goes from time 0 to 1, the second from 1 to 2, and so on.
    """

    time: Annotated[list[float], Field(min_length=2)]
    """Times, increasing."""
    translation: list[Vector] | None = None
    """Translation at each time."""
    rotation: list[Vector] | None = None
    """Rotation vector in degrees at each time."""
    about: Vector = (0.0, 0.0, 0.0)
    """Point of the tool that the rotation is about."""

    @model_validator(mode="after")
    def _is_table(self) -> MotionPart:
        if any(b <= a for a, b in pairwise(self.time)):
            raise PydanticCustomError("motion", "the times of a motion must increase")
        for name in ("translation", "rotation"):
            rows = getattr(self, name)
            if rows is not None and len(rows) != len(self.time):
                raise PydanticCustomError(
                    "motion",
                    "a motion needs one {name} for each time: there are {rows} for {times}",
                    {"name": name, "rows": len(rows), "times": len(self.time)},
                )
        return self

    def build(self) -> Motion:
        """Function of time, which can be sent to other processes."""
        return partial(_motion, self.time, self.translation, self.rotation)


def _motion(
    times: list[float], translation: list[Vector] | None, rotation: list[Vector] | None, time: float
) -> tuple[Floats, Floats]:
    """Translation and rotation vector at a time, from tables of them."""

    def at(rows: list[Vector] | None) -> Floats:
        return np.zeros(3) if rows is None else np.array([np.interp(time, times, column) for column in zip(*rows)])

    return at(translation), np.radians(at(rotation))


def _points(value: Any) -> str:
    return "word" if isinstance(value, str) else "number"


Points = Annotated[
    Annotated[int, Field(ge=1, le=10), Tag("number")] | Annotated[Literal["nodes", "auto"], Tag("word")],
    Discriminator(_points),
]


class ContactPart(Part):
    """Contact of lower or upper faces with one tool."""

    tool: Name
    """Name of the tool."""
    faces: Selection
    """Lower or upper faces of the sheet."""
    penalty: Positive | None = None
    """Contact pressure per penetration; without it, it follows from the penetration that is allowed."""
    penetration: Positive | None = None
    """Penetration that is allowed; by default 1/200 of the thickness."""
    augmented: bool = False
    """Multipliers take the penetration away that is not allowed."""
    points: Points | None = None
    """Contact points per direction of a face, 1 to 10; at the nodes; or as many as the tool needs (auto). 2 by default."""
    cells: Annotated[int, Field(ge=1, le=20)] | None = None
    """Instead of points: cells per direction of a face that the pressure is integrated over, with the edge of contact."""
    motion: MotionPart | None = None
    """Motion in time."""

    @model_validator(mode="after")
    def _is_one(self) -> ContactPart:
        if self.penalty is not None and self.penetration is not None and not self.augmented:
            raise PydanticCustomError("penalty", "give the penalty or the penetration, and not both, unless augmented")
        if self.points is not None and self.cells is not None:
            raise PydanticCustomError("cells", "give points or cells, and not both")
        return self

    def add_to(self, model: Model, tool: Tool, name: str) -> Contact:
        """Let the model touch the tool."""
        contact = model.contact(
            faces_of(model.mesh, self.faces),
            tool,
            penalty=self.penalty,
            penetration=self.penetration,
            augmented=self.augmented,
            points=self.points,
            cells=self.cells,
            name=name,
        )
        if self.motion is not None:
            model.set_motion(contact, self.motion.build(), self.motion.about)
        return contact
