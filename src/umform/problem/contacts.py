"""The contacts of a deck: faces, a tool, a penalty or the allowed penetration, and the motion of the tool."""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.model import Model
from umform.model.contact import Contact, ContactOptions, friction
from umform.model.tools.tool import Motion
from umform.model.tools.tool import Tool as RigidTool
from umform.problem.notes import Discriminator, Field, InTable, Tag
from umform.problem.parts import Name, Part, Positive, Vector
from umform.problem.reading import write_as
from umform.problem.selection import Selection, faces_of
from umform.surfaces import Tool

Floats = NDArray[np.float64]


class MotionPart(Part):
    """Motion of a tool in time, in addition to the steps: linear between the points of a table.

    The first step of the deck goes from time 0 to 1, the second from 1 to 2, and so on, if they have no time of their
    own.
    """

    time: Annotated[list[float], Field(min_length=2)]
    """Times, increasing."""
    translation: list[Vector] | None = None
    """Translation at each time."""
    rotation: list[Vector] | None = None
    """Rotation vector in degrees at each time."""
    about: Vector = (0.0, 0.0, 0.0)
    """Point of the tool about which it rotates."""

    def __post_init__(self) -> None:
        """Refuse times that do not increase, and tables of other lengths."""
        if any(b <= a for a, b in pairwise(self.time)):
            raise InvalidValue(
                "the times of a motion must increase",
                where="time",
                value=self.time,
                cause="a time twice, or out of order",
                remedy="sort the rows by time; a jump takes a short time",
            )
        for name in ("translation", "rotation"):
            rows = getattr(self, name)
            if rows is not None and len(rows) != len(self.time):
                raise InvalidValue(
                    f"a motion needs one {name} for each time: there are {len(rows)} for {len(self.time)}",
                    where=name,
                    cause="a row too many, or one left out",
                    remedy="one row of three numbers for each time",
                )

    def build(self, start: float) -> Motion:
        """Motion as a picklable function of the time of a model, which is ``start`` at the beginning of the deck."""
        return partial(_motion, [start + time for time in self.time], self.translation, self.rotation)


def _motion(
    times: list[float], translation: list[Vector] | None, rotation: list[Vector] | None, time: float
) -> tuple[Floats, Floats]:
    """Translation and rotation vector at a time, from tables of them."""

    def at(rows: list[Vector] | None) -> Floats:
        return np.zeros(3) if rows is None else np.array([np.interp(time, times, column) for column in zip(*rows)])

    return at(translation), np.radians(at(rotation))


def _notation(value: object) -> str:
    return "word" if isinstance(value, str) else "number"


_Coordinate = Annotated[float, Field(allow_inf_nan=True)]
write_as(friction.Corner, tuple[_Coordinate, _Coordinate, _Coordinate])
write_as(friction.Region, Annotated[friction.Region, InTable(friction.Friction, friction.Region)])
write_as(
    friction.AnyFriction,
    Annotated[
        Annotated[friction.Coefficient, Tag("number")]
        | Annotated[friction.FrictionByRegion, InTable(friction.Friction, friction.FrictionByRegion), Tag("law")],
        Discriminator(lambda value: "number" if isinstance(value, int | float) else "law"),
    ],
)


class ContactPart(Part, of=ContactOptions, leave=("law",)):
    """Contact of lower or upper faces with one tool."""

    tool: Name
    """Name of the tool."""
    faces: Selection
    """Lower or upper faces of the sheet."""
    allowed: (
        Annotated[Annotated[Positive, Tag("number")] | Annotated[Literal["any"], Tag("word")], Discriminator(_notation)]
        | None
    ) = None
    """Penetration above which a penalty grows, or the run warns; by default that of penetration; any: no limit."""
    motion: MotionPart | None = None
    """Motion in time."""
    may_bottom: bool = False
    """Whether the tool may press the sheet onto another one: no warning that it bottoms."""

    def __post_init__(self) -> None:
        """Refuse options that do not belong together."""
        ContactOptions(**self.of_spec())

    def add_to(self, model: Model, tool: Tool | RigidTool, name: str) -> Contact:
        """Add the contact to the model, with a tool of its own or a shared one."""
        contact = model.contact(faces_of(model.mesh, self.faces), tool, name=name, **self.of_spec())
        if self.allowed is not None:
            contact.allowed = math.inf if isinstance(self.allowed, str) else self.allowed
        contact.tool.may_bottom |= self.may_bottom
        if self.motion is not None:
            if contact.tool.motion is not None:
                raise InvalidValue(
                    "a shared tool has one motion in time",
                    where="motion",
                    value=f"tool {contact.tool.name}",
                    cause="another contact of this tool has given its motion",
                    remedy="take one of them out, or give the contacts a tool each",
                )
            model.set_motion(contact, self.motion.build(model.system.time), self.motion.about)
        return contact
