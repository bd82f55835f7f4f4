"""A round cup: parameters, blank, tools and steps."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

from annotated_types import Ge, Le

from umform.errors import InvalidValue
from umform.processes.draw.spec import Draw, Turn, check_clearance, tight, unusual_pressure
from umform.spec import About, Rule, names_its_words
from umform.spec.types import ContactPoints, Force, Friction, Size

if TYPE_CHECKING:
    from umform.mesh import Mesh, Sizes
    from umform.problem.problem import Problem

#: Tools and blank of the ESAFORM benchmark 2021.
ESAFORM: dict[str, Any] = {
    "thickness": 1.0,
    "blank_radius": 53.75,
    "punch_radius": 30.0,
    "punch_edge": 5.0,
    "die_edge": 10.0,
    "holder_force": 40e3,
}
#: Usual clearance beside the punch in thicknesses, that of the ESAFORM benchmark 2021: the rim thickens.
CLEARANCE = 1.2
#: Way of the punch beyond that at which the rim has left the edge of the die, in thicknesses.
_BEYOND = 4.0
#: Largest rise of a chord over the edge of the die, over the clearance under a holder that keeps its distance.
_CHORD = 0.5
_EVEN = Rule(
    lambda count: count % 2 == 0,
    "the number of elements on a quarter of the rim is even",
    "the core of the mesh has half of them on each of its sides",
    "12, or 8 for a coarse mesh",
)


@names_its_words
@dataclass(frozen=True, kw_only=True)
class Cup(Draw):
    r"""A round cup, in mm, N and MPa. ::

                   |  punch  |
        holder     |         |     holder
        =======    |         |    =======    holder_gap above the die, on distance blocks
        -----------\_________/-----------    blank: blank_radius, thickness
        --------.    punch_edge  .--------
          die    \               /           die_edge
                 |<- die_radius

    A quarter of it is computed; the rolling direction is x.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.processes.draw import Cup
    >>> steel = uf.sheet_metals.get("DC04").law
    >>> cup = Cup(material=steel, thickness=1.0, blank_radius=45.0, punch_radius=30.0, punch_edge=6.0, die_edge=8.0)
    >>> cup.throat
    31.2
    """

    kind: ClassVar[str] = "cup"
    groups: ClassVar = Draw.groups | {"blank_radius": "Sheet", "punch_radius": "Tools", "around": "Solution"}
    diameters: ClassVar = {"punch_radius": "punch", "die_radius": "opening", "blank_radius": "blank"}
    """Names of the radii whose diameters are usual."""
    meshes: ClassVar = {"coarse": {"turn": 30.0, "around": 8}, "fine": {"turn": 9.0, "around": 24}}

    blank_radius: Size
    """Radius of the blank, a disc."""
    punch_radius: Size
    """Radius of the punch."""
    die_radius: Size | None = None
    """Radius of the opening of the die; without it, that of the punch plus 1.2 thicknesses."""
    holder_force: (
        Annotated[
            Force, About(remedy="in N, such as 40e3; None, on the command line 0, for a holder that keeps its distance")
        ]
        | None
    ) = None
    """Force on the whole holder, which rests on its distance blocks unless the sheet pushes harder; without it, on the
    command line with 0, the holder keeps its distance."""
    holder_gap: Size | None = None
    """Distance of the holder on its blocks from the die; without it, 1.04 thicknesses."""
    friction: Friction = 0.09
    stroke: Size | None = None
    """Travel of the punch; without it, until the rim has left the edge of the die."""
    element: str = "ANS3DEAS"
    turn: Turn = 15.0
    around: Annotated[int, Ge(2), Le(1000), _EVEN] = 12
    """Number of elements on a quarter of the rim, which is even."""
    contact_points: ContactPoints = 2

    def __post_init__(self) -> None:
        super().__post_init__()
        self._check_tools()

    @property
    def title(self) -> str:
        """Heading of tables and pages."""
        from umform.sheet_metals import sheet_text  # not for the help of the command

        return f"Cup: {sheet_text(self.material, self.thickness)}, punch of {2.0 * self.punch_radius:g} mm"

    def _check_tools(self) -> None:
        wanted = self.punch_radius + CLEARANCE * self.thickness
        remedy = f"about {wanted:.4g}, a diameter of {2.0 * wanted:.4g}"
        check_clearance(self.clearance, self.thickness, where="die_radius", value=self.throat, remedy=remedy)
        if not self.punch_edge < 0.9 * self.punch_radius:
            raise InvalidValue(
                "the edge of the punch is larger than the punch",
                where="punch_edge",
                value=self.punch_edge,
                cause="a hemispherical punch, or a diameter",
                remedy=f"less than {0.9 * self.punch_radius:.4g}",
            )
        least = self.throat + 0.5 * self.die_edge
        if not self.blank_radius > least:
            raise InvalidValue(
                "the blank does not lie on the die",
                where="blank_radius",
                value=self.blank_radius,
                cause=f"the flat of the die begins at a diameter of {2.0 * (self.throat + self.die_edge):.4g}",
                remedy=f"a larger blank: a diameter above {2.0 * least:.4g}",
            )
        if self.gap < self.thickness:
            raise InvalidValue(
                "the holder on its blocks is nearer to the die than the sheet is thick",
                where="holder_gap",
                value=self.gap,
                remedy=f"{1.04 * self.thickness:.4g}, a little more than the thickness",
            )

    @property
    def as_made(self) -> Self:
        """The same with opening, holder gap and stroke as numbers."""
        return replace(self, die_radius=self.throat, holder_gap=self.gap, stroke=self.way)

    @property
    def clearance(self) -> float:
        """Gap beside the punch in the die."""
        return self.throat - self.punch_radius

    @property
    def throat(self) -> float:
        """Radius of the opening of the die."""
        return self.punch_radius + CLEARANCE * self.thickness if self.die_radius is None else self.die_radius

    @property
    def warnings(self) -> list[str]:
        """Unusual parameters."""
        wanted = 2.0 * (self.punch_radius + CLEARANCE * self.thickness)
        flange = math.pi * (self.blank_radius**2 - (self.throat + self.die_edge) ** 2)
        pressure = unusual_pressure(self.holder_force, flange, self.material)
        return [*tight(self.clearance, self.thickness, what="an opening", wanted=wanted), *pressure, *self._squeezed()]

    def _squeezed(self) -> list[str]:
        """Warning of chords over the edge of the die that a holder at a fixed distance squeezes."""
        from umform.elements import element

        chords = 1 if element(self.element).cell == "hex8" else 2
        rise = (math.radians(self.turn) / chords) ** 2 * self.die_edge / 8.0
        air = self.gap - self.thickness
        if self.holder_force is not None or rise <= _CHORD * air:
            return []
        what = (
            f"elements are chords {rise:.2g} off the edge of the die, and a holder that keeps its distance leaves "
            f"{air:.2g} beside the sheet: it squeezes the mesh; its force, the punch force and the draw-in are wrong"
        )
        wider = f"a holder gap above {self.thickness + rise / _CHORD:.4g}, or a holder force"
        fits = math.floor(chords * math.degrees(math.sqrt(8.0 * _CHORD * air / self.die_edge)))
        return [f"{what}; smaller elements: --turn {fits}, {wider}" if fits >= 1 else f"{what}; {wider}"]

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
    def sizes(self) -> Sizes:
        """Rings of the blank, which follow the radii of the tools."""
        from umform.mesh import Bent, bending_sizes

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

    def problem(self) -> Problem:
        """A quarter of the blank in its tools: held, drawn, released."""
        from umform.problem.problem import Problem
        from umform.processes.draw.press import press_steps, pressed

        t, far = self.thickness, 2.0 * self.blank_radius
        deep = self.way + self.constant_thickness_height
        force = None if self.holder_force is None else 0.25 * self.holder_force
        die = {
            "corners": [(far, -t / 2), (self.throat, -t / 2), (self.throat, -deep)],
            "radii": [0.0, self.die_edge, 0.0],
            "closed": False,
        }
        punch = {
            "corners": [(0.0, t / 2), (self.punch_radius, t / 2), (self.punch_radius, deep)],
            "radii": [0.0, self.punch_edge, 0.0],
            "closed": False,
        }
        rule = {"points": self.contact_points, "penalty": self.penalty, "friction": self.friction}
        axis = [0.0, 0.0]
        tables = {
            "title": "A round cup",
            "mesh": {
                "generator": "disc",
                "radius": self.blank_radius,
                "thickness": t,
                "cells": (self.around // 2, 1),
                "part": "quarter",
                "layers": self.stacked,
                "core": self._core / self.blank_radius,
                "radii": self.sizes.ends.tolist(),
            },
            **self._sheet(),
            "tools": {
                "die": {"shape": "Revolved", "profile": die, "shared": True},
                "holder": {
                    "shape": "Plane",
                    "point": (0.0, 0.0, self.gap - t / 2),
                    "normal": "-z",
                    "shared": True,
                },
                "punch": {"shape": "Revolved", "profile": punch, "shared": True},
            },
            "contacts": {
                "on_die": {"tool": "die", "faces": "lower", **rule},
                "under_holder": {"tool": "holder", "faces": "upper", **rule},
                "under_punch": {"tool": "punch", "faces": "upper", **rule},
            },
            "supports": [
                {"kind": "symmetry", "nodes": "x0", "normal": "x"},
                {"kind": "symmetry", "nodes": "y0", "normal": "y"},
                # On the axis: while the punch still holds the part, the gauge may carry a force, and must keep the
                # symmetry.
                {"kind": "rigid", "name": "gauge", "nodes": {"min": [*axis, -math.inf], "max": [*axis, math.inf]}},
            ],
            "controls": {
                **pressed("under_holder", force, blocks_for=t),
                "stroke": {"kind": "tool", "contact": "under_punch", "direction": "-z"},
            },
            # On the punch, an ironed wall cannot buckle while the forces of the die decrease, see theory 4.18.
            "steps": press_steps(force, self.way, self.pace, (("on_die", "under_holder"), ("under_punch",))),
        }
        return Problem.of(tables, ["A quarter of a round cup: held, drawn, released. Units: mm, N, MPa."])

    def blank(self) -> Mesh:
        """A quarter of a disc."""
        return self.problem().sheet().mesh

    #: Ratio of the whole cup to the computed part.
    parts: ClassVar[float] = 4.0
    #: Normals of the planes of symmetry of the computed part.
    mirrored: ClassVar[tuple[int, ...]] = (0, 1)
    #: Node set of the edge of the blank.
    edge: ClassVar[str] = "rim"
