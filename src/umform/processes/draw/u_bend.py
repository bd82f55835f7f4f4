"""A U-bend in plane strain: parameters, strip, tools, model and steps."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from umform.elements import element
from umform.errors import InvalidValue
from umform.materials.j2 import Plastic
from umform.mesh import Bent, Mesh, Sizes, bending_sizes, grid
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
from umform.processes.limit import allowed_penetration
from umform.processes.rules import check_rules, length
from umform.results.forming.u_bend import HEIGHTS
from umform.solution.options import NewtonOptions
from umform.steps import Pace
from umform.surfaces import Box, Plane, UDie

#: Usual clearance beside the punch in thicknesses, that of NUMISHEET 93: 1 mm for a sheet of 0.78 mm.
CLEARANCE = 1.0 / 0.78
#: A given penalty of the holder over that of the other tools, and its allowed penetration in thicknesses by which it is
#: chosen otherwise, eq. (4.29). A stiff plane touches the sheet only in front of the edge of the die; the rest of the
#: flange then lies without pressure between two planes, its contact is not determined, and Newton's method fails.
_HOLDER, _GIVEN_WAY = 0.06, 1.0 / 100.0
_RULES = COMMON | {
    "length": length("the length of the blank", "in mm, such as 350"),
    "punch_width": length("the width of the punch", "in mm, such as 50"),
    "opening": length("the opening of the die", "in mm, such as 52"),
    "width": length("the width of the blank", "in mm, such as 35; forces are those on it"),
}


@dataclass(frozen=True, kw_only=True)
class UBend:
    r"""Parameters of a U-bend in mm, N and MPa; half of it is computed, in plane strain. ::

                    | punch |            punch_width, punch_edge
        holder      |       |     holder
        =========   |       |   ========
        -------------------------------- blank: length, width, thickness
        ---------.  punch_edge  .-------
           die    |            |         opening, die_edge

    Parameters
    ----------
    thickness, length, width : float
        The blank.
    material : J2 or Metal
        Law of the sheet.
    punch_width, punch_edge, opening, die_edge : float
        Widths of the punch and of the opening of the die, and the radii of their edges.
    holder_force : float
        Force on the whole holder.
    friction : float
        Coefficient of friction on all tools.
    stroke : float, optional
        Travel of the punch; default: a fifth of the length of the blank.
    element : str
        Name in the catalogue.
    turn : float
        Largest angle in degrees that an element turns over the edge of the punch or of the die.
    layers, thickness_points, contact_points
        As for :class:`Cup`.
    penalty : float, optional
        Pressure per penetration on die and punch; on the holder 0.06 of it. Default: by the allowed penetration, eqs.
        (4.29) and (4.190).
    newton, pace
        As for :class:`Cup`. The parabola suits the steady flow over the edge of the die.
    """

    kind: ClassVar[str] = "u-bend"
    thickness: float
    length: float
    width: float
    material: Plastic
    punch_width: float
    punch_edge: float
    opening: float
    die_edge: float
    holder_force: float
    friction: float = 0.144
    stroke: float | None = None
    element: str = "BEND18"
    turn: float = 17.0
    layers: int | None = 1
    thickness_points: int | None = None
    contact_points: int = 4
    penalty: float | None = None
    newton: NewtonOptions = replace(OPTIONS, extrapolate=2)
    pace: Pace = Pace()

    def __post_init__(self) -> None:
        values = self.record()
        check_rules({name: values[name] for name in _RULES}, _RULES)
        check_stiffness(self.material)
        if self.holder_force is None:
            raise InvalidValue("a U-bend has a holder that is pressed", where="holder_force", remedy="a force in N")
        wanted = self.punch_width + 2.0 * CLEARANCE * self.thickness
        remedy = f"about {wanted:.4g}"
        check_clearance(self.clearance, self.thickness, where="opening", value=self.opening, remedy=remedy)
        if not 0.5 * self.length > 0.5 * self.opening + self.die_edge + self.way:
            raise InvalidValue(
                "the blank is drawn off the die before the end of the stroke",
                where="stroke",
                value=self.way,
                cause=f"half of the blank is {0.5 * self.length:.4g}, {0.5 * self.opening + self.die_edge:.4g} of it "
                "over the opening",
                remedy="a shorter stroke, or a longer blank",
            )

    def record(self) -> dict[str, Any]:
        """All parameters by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def clearance(self) -> float:
        """Gap beside the punch in the die."""
        return 0.5 * (self.opening - self.punch_width)

    @property
    def warnings(self) -> list[str]:
        """Unusual parameters."""
        wanted = self.punch_width + 2.0 * CLEARANCE * self.thickness
        flange = self.width * (self.length - self.opening - 2.0 * self.die_edge)
        pressure = unusual_pressure(self.holder_force, flange, self.material)
        return [*tight(self.clearance, self.thickness, what="an opening", wanted=wanted), *pressure]

    @property
    def way(self) -> float:
        """Travel of the punch."""
        return 0.2 * self.length if self.stroke is None else self.stroke

    @property
    def heights(self) -> tuple[float, float, float] | None:
        """Heights at which the wall is measured: those of NUMISHEET 93 if it is long enough; None without a wall."""
        low, high = self.punch_edge + self.thickness, self.way - self.die_edge - self.thickness
        if low < HEIGHTS[0] and HEIGHTS[2] < high:
            return HEIGHTS
        if high - low < 5.0 * self.thickness:
            return None
        return (low + 0.15 * (high - low), 0.5 * (low + high), high - 0.15 * (high - low))

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
        """Ends of the elements along half of the blank, which follow the radii of the tools."""
        half = 0.5 * self.thickness
        flat = 0.5 * self.punch_width - self.punch_edge
        nose, edge = self.punch_edge + half, self.die_edge + half
        bent = (
            Bent(flat, flat + 0.5 * math.pi * nose, nose, "the edge of the punch"),
            Bent(0.5 * self.opening, 0.5 * self.opening + self.die_edge + self.way, edge, "the edge of the die"),
        )
        largest = max(3.0 * math.radians(self.turn) * edge, 2.0 * self.thickness)
        return bending_sizes(0.0, 0.5 * self.length, bent, turn=self.turn, largest=largest)

    @property
    def allowed(self) -> float:
        """Penetration allowed on the edges of punch and die. eq. (4.190)"""
        radius = min(self.punch_edge, self.die_edge)
        chords = 1 if element(self.element).cell == "hex8" else 2
        spacing = math.radians(self.turn) * (radius + 0.5 * self.thickness) / chords
        return allowed_penetration(spacing, radius, self.thickness)

    def blank(self) -> Mesh:
        """Half of a strip of unit width, its lower face at z = 0."""
        heights = np.linspace(0.0, self.thickness, self.stacked + 1)
        return grid(self.sizes.ends, (0.0, 1.0), heights, element(self.element).cell)

    def build(self) -> tuple[Model, Press]:
        """Model of half of the blank, and the press with its steps."""
        t = self.thickness
        points = {} if self.thickness_points is None else {"thickness_points": self.thickness_points}
        rolling = {"rolling": (1.0, 0.0, 0.0)} if getattr(self.material, "directional", False) else {}
        model = Model(self.blank(), self.element, material=self.material, **points, **rolling)  # type: ignore[arg-type]
        model.symmetry("x0", "x")
        model.fix(np.arange(len(model.mesh.points)), "y")
        deep = 2.0 * self.way + 20.0 * t
        edges, flat = self._contacts()
        die = model.tool("die", UDie(self.opening, deep, self.die_edge, self.die_edge))
        model.contact("lower", die, name="on_die", **edges)
        holder = model.tool("holder", Plane((0.0, 0.0, t), (0.0, 0.0, -1.0)))
        hold = held_by(model, holder, 0.5 * self.holder_force / self.width, blocks=False)
        under = model.contact("upper", holder, name="under_holder", **flat)
        under.allowed = None  # it does not grow, see _HOLDER
        punch = Box((0.0, 0.0, t + deep), (self.punch_width, 10.0 * t + 100.0, 2.0 * deep), self.punch_edge)
        ram = model.tool("punch", punch)
        model.contact("upper", ram, name="under_punch", **edges)
        stroke = model.drive(ram, "-z", name="stroke")
        gauge = model.hold_rigid(lambda x, y, z: x < 1e-9, name="gauge")
        return model, Press(hold, stroke, self.way, gauge, pace=self.pace)

    def _contacts(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """Settings of the contacts with the edges of punch and die, and with the holder."""
        rule: dict[str, Any] = {"points": self.contact_points, "friction": self.friction}
        if self.penalty is None:
            return rule | {"penetration": self.allowed}, rule | {"penetration": _GIVEN_WAY * self.thickness}
        return rule | {"penalty": self.penalty}, rule | {"penalty": _HOLDER * self.penalty}

    @property
    def parts(self) -> float:
        """Ratio of the whole blank to the computed part: both halves, and the width."""
        return 2.0 * self.width

    #: Normal of the plane of symmetry of the computed half.
    mirrored: ClassVar[tuple[int, ...]] = (0,)
    #: Node set of the edge of the blank.
    edge: ClassVar[str] = "x1"
