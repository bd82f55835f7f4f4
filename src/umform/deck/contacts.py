"""The contacts of a deck: faces, a tool, a penalty, and what moves the tool in time."""

from __future__ import annotations

import inspect
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from umform.contact import Contact, Motion
from umform.deck.parts import Name, Part, Positive, Vector
from umform.deck.selection import Selection, faces_of
from umform.errors import InvalidValue
from umform.model import Model
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
        """Function of time."""
        times = np.array(self.time)

        def at(rows: list[tuple[float, float, float]] | None, time: float) -> Floats:
            if rows is None:
                return np.zeros(3)
            return np.array([np.interp(time, times, column) for column in zip(*rows)])

        return lambda time: (at(self.translation, time), np.radians(at(self.rotation, time)))


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
    """Contact pressure per penetration."""
    penetration: Positive | None = None
    """Penetration that is allowed, from which the penalty follows."""
    augmented: bool = False
    """Multipliers take the penetration away that is not allowed."""
    points: Points = 2
    """Contact points per direction of a face, 1 to 10, or at the nodes."""
    motion: MotionPart | None = None
    """Motion in time."""

    @model_validator(mode="after")
    def _is_one(self) -> ContactPart:
        if self.penalty is not None and self.penetration is not None and not self.augmented:
            raise PydanticCustomError("penalty", "give the penalty or the penetration, and not both")
        return self

    def add_to(self, model: Model, tool: Tool, name: str) -> Contact:
        """Let the model touch the tool."""
        given = {"penalty": self.penalty, "penetration": self.penetration, "augmented": self.augmented or None}
        options: dict[str, Any] = {key: value for key, value in given.items() if value is not None}
        known = inspect.signature(model.contact).parameters
        for key, value in options.items():
            if key not in known:
                raise InvalidValue(
                    "this version of umform does not know that of a contact",
                    where=key,
                    value=value,
                    cause="an older version than the deck",
                    remedy="penalty = expected contact pressure / penetration that you allow",
                )
        if "penalty" not in options and known["penalty"].default is inspect.Parameter.empty:
            raise InvalidValue(
                "the key penalty is missing: contact pressure per penetration",
                cause="it was left out",
                remedy="penalty = expected contact pressure / penetration that you allow",
            )
        contact = model.contact(faces_of(model.mesh, self.faces), tool, points=self.points, name=name, **options)
        if self.motion is not None:
            model.set_motion(contact, self.motion.build(), self.motion.about)
        return contact
