"""A U-bend in plane strain: parameters, strip, tools and steps."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

from umform.errors import InvalidValue
from umform.processes.draw.spec import Draw, Turn, check_clearance, tight, unusual_pressure
from umform.processes.extrapolation import allowed_penetration
from umform.processes.solution import drawing_options
from umform.spec import names_its_words
from umform.spec.types import ContactPoints, Force, Friction, Penalty, Size

if TYPE_CHECKING:
    from umform.analysis.newton.options import NewtonOptions
    from umform.mesh import Mesh, Sizes
    from umform.problem.problem import Problem

#: Tools and blank of the NUMISHEET benchmark 93.
NUMISHEET: dict[str, Any] = {
    "thickness": 0.78,
    "length": 350.0,
    "width": 35.0,
    "punch_width": 50.0,
    "punch_edge": 5.0,
    "die_edge": 5.0,
    "holder_force": 2450.0,
}
#: Usual clearance beside the punch in thicknesses, that of NUMISHEET 93: 1 mm for a sheet of 0.78 mm.
CLEARANCE = 1.0 / 0.78
#: A given penalty of the holder over that of the other tools, and its allowed penetration in thicknesses by which it is
#: chosen otherwise, eq. (4.29). A stiff plane touches the sheet only in front of the edge of the die; the rest of the
#: flange then lies without pressure between two planes, its contact is not determined, and Newton's method fails.
_HOLDER, _GIVEN_WAY = 0.06, 1.0 / 100.0
#: Size of equal increments, a fraction of the stroke.
_SIZE = 1.0 / 400.0
#: Tolerances that change no angle by more than a hundredth of a degree.
_TIGHT: dict[str, Any] = {"residual": 1e-6, "increment": 1e-5}


def _options() -> NewtonOptions:
    """The parabola suits the steady flow over the edge of the die."""
    return replace(drawing_options(), extrapolate=2)


@names_its_words
@dataclass(frozen=True, kw_only=True)
class UBend(Draw):
    r"""A U-bend, in mm, N and MPa. ::

                    | punch |            punch_width, punch_edge
        holder      |       |     holder
        =========   |       |   ========
        -------------------------------- blank: length, width, thickness
        ---------.  punch_edge  .-------
           die    |            |         opening, die_edge

    Half of it is computed, in plane strain; the strip is cut along the rolling direction.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.processes.draw import UBend
    >>> steel = uf.sheet_metals.get("DC04").law
    >>> case = UBend(
    ...     material=steel, thickness=0.8, length=150.0, width=35.0, punch_width=50.0, opening=52.0, punch_edge=5.0,
    ...     die_edge=5.0, holder_force=2.5e3, stroke=40.0,
    ... )
    """

    kind: ClassVar[str] = "u-bend"
    groups: ClassVar = Draw.groups | {"length": "Sheet", "punch_width": "Tools"}
    meshes: ClassVar = {"coarse": {"element": "BEND8", "turn": 20.0, "contact_points": 3}, "fine": {"turn": 12.0}}

    length: Size
    """Length of the blank."""
    width: Size
    """Width of the blank."""
    punch_width: Size
    """Width of the punch."""
    opening: Size | None = None
    """Width of the opening of the die; without it, that of the punch plus 2.56 thicknesses."""
    holder_force: Force
    """Force on the whole holder: both sides, all of the width."""
    friction: Friction = 0.144
    stroke: Size | None = None
    """Travel of the punch; without it, a fifth of the length of the blank."""
    element: str = "BEND18"
    turn: Turn = 17.0
    contact_points: ContactPoints = 4
    penalty: Penalty | None = None
    """Contact pressure per penetration on die and punch, 0.06 of it on the holder; without it, by the allowed
    penetration, eqs. (4.29) and (4.190)."""
    newton: NewtonOptions = field(default_factory=_options)

    def __post_init__(self) -> None:
        super().__post_init__()
        wanted = self.punch_width + 2.0 * CLEARANCE * self.thickness
        remedy = f"about {wanted:.4g}"
        check_clearance(self.clearance, self.thickness, where="opening", value=self.throat, remedy=remedy)
        if not self.punch_edge <= 0.5 * self.punch_width:
            raise InvalidValue(
                "the edge of the punch is larger than half of the punch",
                where="punch_edge",
                value=self.punch_edge,
                cause="a narrow punch, or a diameter",
                remedy=f"at most {0.5 * self.punch_width:.4g}",
            )
        if not 0.5 * self.length > 0.5 * self.throat + self.die_edge + self.way:
            raise InvalidValue(
                "the blank is drawn off the die before the end of the stroke",
                where="stroke",
                value=self.way,
                cause=f"half of the blank is {0.5 * self.length:.4g}, {0.5 * self.throat + self.die_edge:.4g} of it "
                "over the opening",
                remedy="a shorter stroke, or a longer blank",
            )

    def steady(self) -> UBend:
        """The same with equal increments and tight tolerances, so that results are smooth functions of the parameters.

        With increments that adapt, a small change of a parameter gives others, which change angles by up to a tenth of
        a degree.
        """
        from umform.analysis.steps import Pace  # not for the help of the command

        equal = Pace(first=_SIZE, largest=_SIZE, turn=90.0, strain=10.0, contact=1e3, iterations=1000)
        return replace(self, pace=equal, newton=replace(self.newton, **_TIGHT))

    @property
    def title(self) -> str:
        """Heading of tables and pages."""
        from umform.sheet_metals import sheet_text  # not for the help of the command

        return f"U-bend: {sheet_text(self.material, self.thickness)}, punch of {self.punch_width:g} mm"

    @property
    def as_made(self) -> Self:
        """The same with opening and stroke as numbers."""
        return replace(self, opening=self.throat, stroke=self.way)

    @property
    def clearance(self) -> float:
        """Gap beside the punch in the die."""
        return 0.5 * (self.throat - self.punch_width)

    @property
    def throat(self) -> float:
        """Width of the opening of the die."""
        return self.punch_width + 2.0 * CLEARANCE * self.thickness if self.opening is None else self.opening

    @property
    def warnings(self) -> list[str]:
        """Unusual parameters."""
        wanted = self.punch_width + 2.0 * CLEARANCE * self.thickness
        flange = self.width * (self.length - self.throat - 2.0 * self.die_edge)
        pressure = unusual_pressure(self.holder_force, flange, self.material)
        return [*tight(self.clearance, self.thickness, what="an opening", wanted=wanted), *pressure]

    @property
    def way(self) -> float:
        """Travel of the punch."""
        return 0.2 * self.length if self.stroke is None else self.stroke

    @property
    def heights(self) -> tuple[float, float, float] | None:
        """Heights at which the wall is measured: those of NUMISHEET 93 if it is long enough; None without a wall."""
        from umform.results.forming.u_bend import HEIGHTS

        low, high = self.punch_edge + self.thickness, self.way - self.die_edge - self.thickness
        if low < HEIGHTS[0] and HEIGHTS[2] < high:
            return HEIGHTS
        if high - low < 5.0 * self.thickness:
            return None
        return (low + 0.15 * (high - low), 0.5 * (low + high), high - 0.15 * (high - low))

    @cached_property
    def sizes(self) -> Sizes:
        """Ends of the elements along half of the blank, which follow the radii of the tools."""
        from umform.mesh import Bent, bending_sizes

        half = 0.5 * self.thickness
        flat = 0.5 * self.punch_width - self.punch_edge
        nose, edge = self.punch_edge + half, self.die_edge + half
        bent = (
            Bent(flat, flat + 0.5 * math.pi * nose, nose, "the edge of the punch"),
            Bent(0.5 * self.throat, 0.5 * self.throat + self.die_edge + self.way, edge, "the edge of the die"),
        )
        largest = max(3.0 * math.radians(self.turn) * edge, 2.0 * self.thickness)
        return bending_sizes(0.0, 0.5 * self.length, bent, turn=self.turn, largest=largest)

    @property
    def allowed(self) -> float:
        """Penetration allowed on the edges of punch and die. eq. (4.190)"""
        from umform.elements import element

        radius = min(self.punch_edge, self.die_edge)
        chords = 1 if element(self.element).cell == "hex8" else 2
        spacing = math.radians(self.turn) * (radius + 0.5 * self.thickness) / chords
        return allowed_penetration(spacing, radius, self.thickness)

    def problem(self) -> Problem:
        """Half of the blank in its tools: held, drawn, released."""
        import numpy as np

        from umform.problem.problem import Problem
        from umform.processes.draw.press import press_steps, pressed

        t = self.thickness
        deep = 2.0 * self.way + 20.0 * t
        force = 0.5 * self.holder_force / self.width
        rule = {"points": self.contact_points, "friction": self.friction}
        given = self.penalty is not None
        edges = rule | ({"penalty": self.penalty} if given else {"penetration": self.allowed})
        flat = rule | ({"penalty": _HOLDER * self.penalty} if given else {"penetration": _GIVEN_WAY * t})  # type: ignore[operator]
        tables = {
            "title": "A U-bend",
            "mesh": {
                "generator": "grid",
                "x": self.sizes.ends.tolist(),
                "y": (0.0, 1.0),
                "z": np.linspace(0.0, t, self.stacked + 1).tolist(),
            },
            **self._sheet(),
            "tools": {
                "die": {
                    "shape": "UDie",
                    "opening": self.throat,
                    "depth": deep,
                    "shoulder_radius": self.die_edge,
                    "bottom_radius": self.die_edge,
                    "shared": True,
                },
                "holder": {"shape": "Plane", "point": (0.0, 0.0, t), "normal": "-z", "shared": True},
                "punch": {
                    "shape": "Box",
                    "centre": (0.0, 0.0, t + deep),
                    "size": (self.punch_width, 10.0 * t + 100.0, 2.0 * deep),
                    "radius": self.punch_edge,
                    "shared": True,
                },
            },
            "contacts": {
                "on_die": {"tool": "die", "faces": "lower", **edges},
                "under_holder": {"tool": "holder", "faces": "upper", **flat, "allowed": "any"},  # see _HOLDER
                "under_punch": {"tool": "punch", "faces": "upper", **edges},
            },
            "supports": [
                {"kind": "symmetry", "nodes": "x0", "normal": "x"},
                {"kind": "fix", "nodes": {"min": [-math.inf] * 3}, "directions": "y"},
                {"kind": "rigid", "name": "gauge", "nodes": "x0"},
            ],
            "controls": {
                **pressed("under_holder", force),
                "stroke": {"kind": "tool", "contact": "under_punch", "direction": "-z"},
            },
            "steps": press_steps(
                force, self.way, self.pace, (("on_die", "under_holder", "under_punch"),), blocks=False
            ),
        }
        about = "Half of a U-bend in plane strain, 1 mm of its width: held, drawn, released. Units: mm, N, MPa."
        return Problem.of(tables, [about])

    def blank(self) -> Mesh:
        """Half of a strip of unit width, its lower face at z = 0."""
        return self.problem().sheet().mesh

    @property
    def parts(self) -> float:
        """Ratio of the whole blank to the computed part: both halves, and the width."""
        return 2.0 * self.width

    #: Normal of the plane of symmetry of the computed half.
    mirrored: ClassVar[tuple[int, ...]] = (0,)
    #: Node set of the edge of the blank.
    edge: ClassVar[str] = "x1"
