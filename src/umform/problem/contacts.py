"""The contacts of a deck: faces, a tool, a penalty or the allowed penetration, and the motion of the tool."""

from __future__ import annotations

from functools import partial
from itertools import pairwise
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Discriminator, Field, Strict, Tag, model_validator
from pydantic_core import PydanticCustomError

from umform.model import Model
from umform.model.contact import Contact
from umform.model.contact.friction import Friction, FrictionByRegion, Region
from umform.model.tool import Motion
from umform.model.tool import Tool as RigidTool
from umform.problem.parts import Name, NotNegative, Part, Positive, Vector, number_or_array
from umform.problem.selection import Selection, faces_of
from umform.surfaces import Tool

Floats = NDArray[np.float64]


class MotionPart(Part):
    """Motion of a tool in time, in addition to the steps: linear between the points of a table.

    The first step goes from time 0 to 1, the second from 1 to 2, and so on.
    """

    time: Annotated[list[float], Field(min_length=2)]
    """Times, increasing."""
    translation: list[Vector] | None = None
    """Translation at each time."""
    rotation: list[Vector] | None = None
    """Rotation vector in degrees at each time."""
    about: Vector = (0.0, 0.0, 0.0)
    """Point of the tool about which it rotates."""

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
        """Motion as a picklable function of time."""
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

Cells = Annotated[
    Annotated[int, Field(ge=1, le=20), Tag("number")] | Annotated[Literal["auto"], Tag("word")],
    Discriminator(_points),
]


Coefficient = Annotated[float, Field(ge=0, le=2)]
_Coordinate = Annotated[float, Field(allow_inf_nan=True)]
Corner = Annotated[tuple[_Coordinate, _Coordinate, _Coordinate], Strict(False)]


_Row = Annotated[tuple[NotNegative, Coefficient], Strict(False)]


class FrictionPart(Part):
    """A friction law: t <= min(mu p, cap)."""

    mu: Annotated[
        Annotated[Coefficient, Tag("number")] | Annotated[list[_Row], Tag("array")], Discriminator(number_or_array)
    ]
    """Coefficient, or pairs of pressure and coefficient, linear in between."""
    kinetic: Coefficient | None = None
    """Coefficient of a sliding point; with a table its first entry falls to it, and all others in proportion."""
    decay: Positive | None = None
    """Distance slid after which 1/e of the difference to the kinetic coefficient remains."""
    cap: Positive | None = None
    """Largest tangential traction."""

    def build(self) -> Friction:
        """The law."""
        return Friction(self.mu, self.kinetic, self.decay, self.cap)


class FrictionRegionPart(FrictionPart):
    """Another friction law within a box in the frame of the tool."""

    lower: Corner
    """Lower corner; inf and -inf are numbers in TOML."""
    upper: Corner
    """Upper corner."""


class FrictionsPart(FrictionPart):
    """A friction law, and others in regions of the tool."""

    regions: list[FrictionRegionPart] = []
    """The first region that contains a point applies."""

    def build(self) -> Friction | FrictionByRegion:  # type: ignore[override]
        """The law."""
        if not self.regions:
            return super().build()
        regions = [Region(part.lower, part.upper, part.build()) for part in self.regions]
        return FrictionByRegion(super().build(), regions)


def _friction(value: Any) -> str:
    return "number" if isinstance(value, int | float) else "law"


AnyFriction = Annotated[
    Annotated[Coefficient, Tag("number")] | Annotated[FrictionsPart, Tag("law")], Discriminator(_friction)
]


class ContactPart(Part):
    """Contact of lower or upper faces with one tool."""

    tool: Name
    """Name of the tool."""
    faces: Selection
    """Lower or upper faces of the sheet."""
    penalty: Positive | None = None
    """Contact pressure per penetration; by default it follows from the allowed penetration."""
    penetration: Positive | None = None
    """Allowed penetration; by default 1/200 of the thickness."""
    allowed: (
        Annotated[Annotated[Positive, Tag("number")] | Annotated[Literal["any"], Tag("word")], Discriminator(_points)]
        | None
    ) = None
    """Penetration above which a penalty grows, or the run warns; by default that of penetration; any: no limit."""
    augmented: bool = False
    """Remove excess penetration by multipliers."""
    points: Points | None = None
    """Contact points per direction of a face, 1 to 10, by default 2; at the nodes; or as many as are needed (auto)."""
    cells: Cells | None = None
    """Instead of points: cells per direction of a face, over which the pressure is integrated, 1 to 20, or auto."""
    ripple: Positive | None = None
    """Allowed ripple for cells = auto, as a fraction of the force; default 0.001."""
    friction: AnyFriction | None = None
    """Coefficient of friction, or a law."""
    slip: Positive | None = None
    """Allowed elastic slip; by default 1/200 of the thickness."""
    motion: MotionPart | None = None
    """Motion in time."""
    may_bottom: bool = False
    """Whether the tool may press the sheet onto another one: no warning that it bottoms."""

    @model_validator(mode="after")
    def _is_one(self) -> ContactPart:
        if self.penalty is not None and self.penetration is not None and not self.augmented:
            raise PydanticCustomError("penalty", "give the penalty or the penetration, and not both, unless augmented")
        if self.points is not None and self.cells is not None:
            raise PydanticCustomError("cells", "give points or cells, and not both")
        if self.ripple is not None and (self.cells != "auto" or self.ripple >= 1.0):
            raise PydanticCustomError("ripple", "a ripple needs cells = auto and must be below 1")
        return self

    def add_to(self, model: Model, tool: Tool | RigidTool, name: str) -> Contact:
        """Add the contact to the model, with a tool of its own or a shared one."""
        contact = model.contact(
            faces_of(model.mesh, self.faces),
            tool,
            penalty=self.penalty,
            penetration=self.penetration,
            augmented=self.augmented,
            points=self.points,
            cells=self.cells,
            ripple=self.ripple,
            friction=self.friction.build() if isinstance(self.friction, FrictionsPart) else self.friction,
            slip=self.slip,
            name=name,
        )
        if self.allowed is not None:
            contact.allowed = None if isinstance(self.allowed, str) else self.allowed
        contact.tool.may_bottom |= self.may_bottom
        if self.motion is not None:
            model.set_motion(contact, self.motion.build(), self.motion.about)
        return contact
