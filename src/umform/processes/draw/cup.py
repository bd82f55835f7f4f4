"""A round cup: parameters, blank, tools, model and steps."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, ClassVar

from umform.elements import element
from umform.errors import InvalidValue
from umform.materials.j2 import Plastic
from umform.mesh import Bent, Mesh, Sizes, bending_sizes, disc
from umform.model import Model
from umform.processes.draw.press import OPTIONS, Press, held_by
from umform.processes.draw.rules import (
    COMMON,
    check_clearance,
    check_stiffness,
    layers_by_rule,
    tight,
    unusual_pressure,
)
from umform.processes.rules import check_rules, length, whole
from umform.solution.options import NewtonOptions
from umform.steps import Pace
from umform.surfaces import Plane, Profile, Revolved

#: Usual clearance beside the punch in thicknesses, that of the ESAFORM benchmark 2021: the rim thickens.
CLEARANCE = 1.2
#: Way of the punch beyond that at which the rim has left the edge of the die, in thicknesses.
_BEYOND = 4.0
_RULES = COMMON | {
    "blank_radius": length("the radius of the blank", "in mm, such as 53.75"),
    "punch_radius": length("the radius of the punch", "in mm, such as 30"),
    "die_radius": length("the radius of the opening of the die", "in mm, such as 31.2"),
    "holder_gap": length("the distance of the holder from the die", "in mm, such as 1.04; default 1.04 t").optional(),
}


@dataclass(frozen=True, kw_only=True)
class Cup:
    r"""Parameters of a round cup in mm, N and MPa; a quarter of it is computed, the rolling direction is x. ::

                   |  punch  |
        holder     |         |     holder
        =======    |         |    =======    holder_gap above the die, on distance blocks
        -----------\_________/-----------    blank: blank_radius, thickness
        --------.    punch_edge  .--------
          die    \               /           die_edge
                 |<- die_radius

    Parameters
    ----------
    thickness, blank_radius : float
        The blank, a disc.
    material : J2 or Metal
        Law of the sheet.
    punch_radius, punch_edge, die_radius, die_edge : float
        Radii of the punch and of the opening of the die, and of their edges.
    holder_force : float, optional
        Force on the whole holder, which rests on its distance blocks unless the sheet pushes harder. Without it the
        holder keeps its distance.
    holder_gap : float, optional
        Distance of the holder on its blocks from the die; default 1.04 thicknesses.
    friction : float
        Coefficient of friction on all tools.
    stroke : float, optional
        Travel of the punch; default: until the rim has left the edge of the die.
    element : str
        Name in the catalogue.
    turn : float
        Largest angle in degrees that an element turns over the edge of the punch or of the die.
    around : int
        Elements on a quarter of the rim; an even number.
    layers : int or None
        Layers of elements; None: as many as the sharpest radius needs, eq. (2.29).
    thickness_points : int
        Points through the thickness of each layer; default: that of the law.
    contact_points : int
        Contact points per direction and facet.
    penalty : float, optional
        Pressure per penetration; default: by the allowed penetration, eqs. (4.29) and (4.200).
    newton : NewtonOptions
        Tolerances and predictor.
    pace : Pace
        Increments of the stroke.
    """

    kind: ClassVar[str] = "cup"
    thickness: float
    blank_radius: float
    material: Plastic
    punch_radius: float
    punch_edge: float
    die_radius: float
    die_edge: float
    holder_force: float | None = None
    holder_gap: float | None = None
    friction: float = 0.09
    stroke: float | None = None
    element: str = "ANS3DEAS"
    turn: float = 15.0
    around: int = 12
    layers: int | None = 1
    thickness_points: int | None = None
    contact_points: int = 2
    penalty: float | None = None
    newton: NewtonOptions = OPTIONS
    pace: Pace = Pace()

    def __post_init__(self) -> None:
        values = self.record()
        check_rules({name: values[name] for name in _RULES}, _RULES)
        check_stiffness(self.material)
        if not (whole(self.around, 2) and self.around % 2 == 0):
            raise InvalidValue(
                "the number of elements on a quarter of the rim is even, two at least",
                where="around",
                value=self.around,
                cause="the core of the mesh has half of them on each of its sides",
                remedy="12, or 8 for a coarse mesh",
            )
        self._check_tools()

    def _check_tools(self) -> None:
        wanted = self.punch_radius + CLEARANCE * self.thickness
        remedy = f"about {wanted:.4g}, a diameter of {2.0 * wanted:.4g}"
        check_clearance(self.clearance, self.thickness, where="die_radius", value=self.die_radius, remedy=remedy)
        if not self.punch_edge < 0.9 * self.punch_radius:
            raise InvalidValue(
                "the edge of the punch is larger than the punch",
                where="punch_edge",
                value=self.punch_edge,
                cause="a hemispherical punch, or a diameter",
                remedy=f"less than {0.9 * self.punch_radius:.4g}",
            )
        if not self.blank_radius > self.die_radius + 0.5 * self.die_edge:
            raise InvalidValue(
                "the blank does not lie on the die",
                where="blank_radius",
                value=self.blank_radius,
                cause=f"the die begins at {self.die_radius + self.die_edge:.4g}",
                remedy=f"a larger blank: a diameter above {2.0 * self.die_radius + self.die_edge:.4g}",
            )
        if self.gap < self.thickness:
            raise InvalidValue(
                "the holder on its blocks is nearer to the die than the sheet is thick",
                where="holder_gap",
                value=self.gap,
                remedy=f"{1.04 * self.thickness:.4g}, a little more than the thickness",
            )

    def record(self) -> dict[str, Any]:
        """All parameters by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def clearance(self) -> float:
        """Gap beside the punch in the die."""
        return self.die_radius - self.punch_radius

    @property
    def warnings(self) -> list[str]:
        """Unusual parameters."""
        wanted = 2.0 * (self.punch_radius + CLEARANCE * self.thickness)
        flange = math.pi * (self.blank_radius**2 - (self.die_radius + self.die_edge) ** 2)
        pressure = unusual_pressure(self.holder_force, flange, self.material)
        return [*tight(self.clearance, self.thickness, what="an opening", wanted=wanted), *pressure]

    @property
    def gap(self) -> float:
        """Distance of the holder on its blocks from the die."""
        return 1.04 * self.thickness if self.holder_gap is None else self.holder_gap

    @property
    def constant_thickness_height(self) -> float:
        """Height of the cup for constant thickness: the blank has the area of the mid-surface of the cup."""
        t, r = self.thickness, self.punch_edge + 0.5 * self.thickness
        flat, wall = self.punch_radius - self.punch_edge, self.punch_radius + 0.5 * t
        edge = 2.0 * math.pi * (0.5 * math.pi * flat * r + r * r)
        left = math.pi * (self.blank_radius**2 - flat**2) - edge
        return left / (2.0 * math.pi * wall) + r + 0.5 * t

    @property
    def way(self) -> float:
        """Travel of the punch."""
        full = self.constant_thickness_height + self.die_edge + _BEYOND * self.thickness
        return full if self.stroke is None else self.stroke

    @cached_property
    def needed_layers(self) -> int:
        """Layers by the rule for sharp bends: eq. (2.29) for the smallest radius of the tools."""
        radius = min(self.punch_edge, self.die_edge)
        return layers_by_rule(self.element, self.material, self.thickness_points, self.thickness, radius)

    @property
    def stacked(self) -> int:
        """Layers of elements."""
        return self.needed_layers if self.layers is None else self.layers

    @cached_property
    def sizes(self) -> Sizes:
        """Rings of the blank, which follow the radii of the tools."""
        half = 0.5 * self.thickness
        flat = self.punch_radius - self.punch_edge
        nose, edge = self.punch_edge + half, self.die_edge + half
        bent = (
            Bent(flat, flat + 0.5 * math.pi * nose, nose, "the edge of the punch"),
            Bent(self.punch_radius, self.blank_radius, edge, "the edge of the die"),
        )
        largest = math.pi * flat / self.around
        return bending_sizes(self._core, self.blank_radius, bent, turn=self.turn, largest=largest)

    @property
    def _core(self) -> float:
        """Half of the side of the core of the blank, which stays on the flat of the punch."""
        return max(0.75 * (self.punch_radius - self.punch_edge), 0.1 * self.blank_radius)

    def blank(self) -> Mesh:
        """A quarter of a disc."""
        return disc(
            self.blank_radius,
            self.thickness,
            (self.around // 2, 1),
            part="quarter",
            cell=element(self.element).cell,
            layers=self.stacked,
            core=self._core / self.blank_radius,
            radii=self.sizes.ends.tolist(),
        )

    def build(self) -> tuple[Model, Press]:
        """Model of a quarter, and the press with its steps."""
        t, far = self.thickness, 2.0 * self.blank_radius
        deep = self.way + self.constant_thickness_height
        points = {} if self.thickness_points is None else {"thickness_points": self.thickness_points}
        model = Model(self.blank(), self.element, material=self.material, rolling=(1.0, 0.0, 0.0), **points)  # type: ignore[arg-type]
        model.symmetry("x0", "x")
        model.symmetry("y0", "y")
        die = Profile.from_corners(
            [(far, -t / 2), (self.die_radius, -t / 2), (self.die_radius, -deep)],
            radii=[0, self.die_edge, 0],
            closed=False,
        )
        punch = Profile.from_corners(
            [(0, t / 2), (self.punch_radius, t / 2), (self.punch_radius, deep)],
            radii=[0, self.punch_edge, 0],
            closed=False,
        )
        rule: dict[str, Any] = {
            "points": self.contact_points,
            "penalty": self.penalty,
            "friction": self.friction,
        }
        model.contact("lower", model.tool("die", Revolved(die)), name="on_die", **rule)
        holder = model.tool("holder", Plane((0.0, 0.0, self.gap - t / 2), (0.0, 0.0, -1.0)))
        hold = held_by(model, holder, None if self.holder_force is None else 0.25 * self.holder_force)
        model.contact("upper", holder, name="under_holder", **rule)
        ram = model.tool("punch", Revolved(punch))
        model.contact("upper", ram, name="under_punch", **rule)
        stroke = model.drive(ram, "-z", name="stroke")
        # On the axis: while the punch still holds the part, the gauge may carry a force, and must keep the symmetry.
        gauge = model.hold_rigid(lambda x, y, z: x**2 + y**2 < 1e-18, name="gauge")
        # On the punch, an ironed wall cannot buckle while the forces of the die decrease, see theory 4.18.
        return model, Press(hold, stroke, self.way, gauge, (("die", "holder"), ("punch",)), self.pace)

    #: Ratio of the whole cup to the computed part.
    parts: ClassVar[float] = 4.0
    #: Normals of the planes of symmetry of the computed part.
    mirrored: ClassVar[tuple[int, ...]] = (0, 1)
    #: Node set of the edge of the blank.
    edge: ClassVar[str] = "rim"
