"""Air bending: its parameters, the tools and limits that follow from them, and what does not fit together."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cache, cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Gt, Le

from umform.errors import InvalidValue
from umform.processes.air_bending.stack import StackedSheet, bonded_sheets, check_stack
from umform.processes.rules import PLASTIC, WITHOUT_RATE, check_contact_points, check_rolling
from umform.spec import About, check_fields, listed, names_its_words, note_of, parameters
from umform.spec.types import ContactPoints, Degrees, Friction, Length, Positive, Rolling, Size

if TYPE_CHECKING:
    from umform.elements.technology import Element
    from umform.materials import J2, Metal
    from umform.processes.air_bending.drawn_tools import DrawnDie, DrawnPunch
    from umform.surfaces import Extruded, Punch, VDie


#: Range of opening over thickness for air bending; press brakes use 5 to 16.
_NARROWEST, _WIDEST = 1.0, 500.0
#: Units with their mm, and thickness and opening below which a sheet and its die are more likely measured in them.
_SMALL = (("metres", 1000.0, (0.012, 0.3)), ("inches", 25.4, (0.3, 3.0)))
#: Penalty times thickness over E beyond which Newton's method converges slowly.
_STIFFEST = 1e3


def dc04_like() -> J2:
    """Like DC04 across the rolling direction in shape and level; a curve of your own material is better."""
    from umform.materials import J2, Swift

    return J2(E=210e3, nu=0.3, hardening=Swift(strength=520.0, offset=0.004, exponent=0.22))


@dataclass(frozen=True)
class SizeOf:
    """Annotation of a parameter that is a size of a tool; a drawing of the tool has it too.

    Attributes
    ----------
    tool : str
        "punch" or "die".
    size : str
        Its name in `DrawnPunch` or `DrawnDie`.
    """

    tool: str
    size: str


@names_its_words
@dataclass(frozen=True)
class AirBending:
    r"""Air bending, in mm, N and MPa. ::

              |     |
              | \ / |  punch_angle, punch_radius
        =======  v  =======  sheet: thickness, width
        -----.       .-----  die_radius
              \     /
               \   /     die_angle
                 v
             |<----->|  opening

    The sheet lies on the shoulders of a V-die, and is bent by a punch.

    Examples
    --------
    >>> from umform.processes.air_bending import AirBending
    >>> case = AirBending(thickness=1.5, opening=12.0, punch_radius=1.0, stroke=4.0)
    >>> case.die_angle
    85.0
    """

    groups: ClassVar = {
        "thickness": "Sheet",
        "opening": "Tools",
        "width": "Sheet",
        "stroke": "What to do",
        "punch_width": "Tools",
        "element": "Solution",
    }
    """Group of the parameters from each of these on."""

    thickness: Annotated[float, Gt(0.0), Le(1000.0), About("mm", cause="another unit, or a sign")] = 2.0
    """Thickness of the sheet."""
    opening: Annotated[Length, SizeOf("die", "opening")] = 16.0
    """Opening of the die: distance of the lines where its flanks, drawn on as planes, meet its top."""
    die_angle: Annotated[Degrees, Gt(1.0), SizeOf("die", "angle")] = 85.0
    """Angle between the flanks of the die."""
    die_radius: Annotated[Size, SizeOf("die", "radius")] = 2.0
    """Radius of the shoulders of the die."""
    punch_angle: Annotated[Degrees, Gt(1.0), SizeOf("punch", "angle")] = 85.0
    """Angle between the flanks of the punch."""
    punch_radius: Annotated[Length, SizeOf("punch", "radius")] = 1.5
    """Radius of the tip of the punch."""
    punch_section: DrawnPunch | None = None
    """Drawn punch; ``punch_angle`` and ``punch_radius`` are then those of the drawing."""
    die_section: DrawnDie | None = None
    """Drawn die; ``opening``, ``die_angle`` and ``die_radius`` are then those of the drawing."""
    width: Length | None = None
    """Length of the bend; without it plane strain, a sheet so wide that nothing moves along the bend."""
    material: Annotated[J2 | Metal, PLASTIC, WITHOUT_RATE] = field(default_factory=dc04_like)
    """Law of the sheet."""
    rolling: Rolling | None = None
    """Angle from the bend line to the rolling direction; a law with directions needs it."""
    on_top: tuple[StackedSheet, ...] = ()
    """Further sheets, each on that before; the first lies on the die."""
    stroke: Length | None = None
    """Way of the punch from where it touches the sheet; a search or a table does not need it."""
    bottoming: bool = False
    """Whether the punch may press the sheet onto the flanks of the die."""
    punch_width: Annotated[Length, SizeOf("punch", "width")] | None = None
    """Width of the body of the punch above its flanks; without it they have no end."""
    friction: Friction = 0.0
    """Coefficient of friction of the sheet with punch and die."""
    element: str | Element = "BEND18"
    """Element of the catalogue, or one of your own."""
    layers: Annotated[int, Ge(1), Le(8)] = 2
    """Elements stacked through the thickness."""
    thickness_points: Annotated[int, Ge(2), Le(15)] = 6
    """Points through the thickness of each layer."""
    elements_per_thickness: Annotated[float, Ge(0.5), Le(100.0), About(cause="the number of all elements instead")] = (
        3.0
    )
    """Elements along the sheet per thickness, in the bend and where the shoulder touches; in dies wider than 16
    thicknesses, on 1/16 of the opening."""
    width_elements: Annotated[int, Ge(1), Le(1000)] = 3
    """Elements over half of the width; without a width there is one."""
    contact_points: Annotated[ContactPoints | Literal["auto"], About(remedy="auto, or such as 5")] = "auto"
    """Contact points per direction and facet; auto: as many as the contact of each tool needs, eq. (4.31)."""
    penalty: Positive | None = None
    """Contact pressure per penetration; without it, it follows from the allowed penetration, eq. (4.29)."""
    penetration: Length | None = None
    """Allowed penetration, in place of a penalty; without it, 1/200 of the thickness."""
    increment: Annotated[float, Ge(1e-5), Le(0.05), About(cause="a length in mm instead of a part of the opening")] = (
        0.00625
    )
    """Way of the punch in one increment, over the opening."""

    def __post_init__(self) -> None:
        if self.punch_section is not None or self.die_section is not None:
            from umform.processes.air_bending.drawn_tools import check_drawn  # it loads NumPy

            check_drawn(self.punch_section, self.die_section)
            for name, value in self.drawn_sizes.items():
                object.__setattr__(self, name, value)
        object.__setattr__(self, "on_top", listed(self.on_top))
        check_fields(self)
        check_contact_points(self.element, self.contact_points)
        _check_consistency(self)
        if self.punch_section is not None:
            from umform.processes.air_bending.drawn_tools import check_one_sided

            check_one_sided(self.punch_section, self.half_length)

    def record(self) -> dict[str, Any]:
        """All parameters by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def drawn_sizes(self) -> dict[str, float]:
        """Parameters that follow from drawn tools; no width is measured."""
        tools = {"punch": self.punch_section, "die": self.die_section}
        return {
            name: getattr(drawn, size)
            for tool, drawn in tools.items()
            if drawn is not None
            for size, name in sizes_of(tool).items()
            if hasattr(drawn, size)
        }

    def sizes(self, tool: str) -> dict[str, Any]:
        """Sizes of a tool, "punch" or "die"."""
        return {size: getattr(self, name) for size, name in sizes_of(tool).items()}

    @property
    def sheets(self) -> tuple[StackedSheet, ...]:
        """All sheets, from the die upwards."""
        return StackedSheet(self.thickness, self.material), *self.on_top

    @property
    def height(self) -> float:
        """Thickness of all sheets together."""
        return self.thickness + sum(sheet.thickness for sheet in self.on_top)

    @property
    def thickest(self) -> float:
        """Thickness of the thickest sheet; bonded ones are one sheet."""
        sheets = self.sheets
        return max(sum(sheets[number].thickness for number in bonded) for bonded in bonded_sheets(self))

    @cached_property
    def die(self) -> VDie | Extruded:
        """The die; its top is z = 0."""
        from umform.surfaces import Extruded, VDie

        if self.die_section is not None:
            return Extruded(self.die_section.profile)
        return VDie(self.opening, self.die_angle, self.die_radius)

    @cached_property
    def punch(self) -> Punch | Extruded:
        """The punch, touching the sheet at z = height."""
        from umform.surfaces import Extruded, Punch

        if self.punch_section is not None:
            return Extruded(self.punch_section.profile, origin=(0.0, 0.0, self.height))
        return Punch(self.punch_radius, self.punch_angle, self.punch_width, origin=(0.0, 0.0, self.height))

    @property
    def plane_strain(self) -> bool | None:
        """Option of the element; None for a sheet of finite width, and for one that shears along the bend."""
        own = not isinstance(self.element, str)
        return None if self.width is not None or self.shears or own else True

    @property
    def shears(self) -> bool:
        """Whether a section in plane strain shears along the bend: in an oblique rolling direction of a metal."""
        directional = any(getattr(sheet.material, "directional", False) for sheet in self.sheets)
        return self.width is None and directional and (self.rolling or 0.0) % 90.0 != 0.0

    @property
    def way(self) -> float:
        """Way of the punch in one increment, in mm."""
        return self.increment * self.opening

    @property
    def shoulder(self) -> float:
        """Distance of the axis of the shoulder from the middle: where the sheet rests at first."""
        from umform.surfaces import VDie

        return 0.5 * VDie(self.opening, self.die_angle, self.die_radius).tangent_width

    @property
    def steepest(self) -> float:
        """Slope of a leg in degrees at which it lies against a flank of punch or die: the end of air bending."""
        return 0.5 * (180.0 - max(self.die_angle, self.punch_angle))

    def free_length(self, slope: float) -> float:
        """Straight length of a leg between punch tip and shoulder if the sheet is wrapped around the tip, thin lines.

        Parameters
        ----------
        slope : float
            Slope of the leg in degrees.
        """
        a = math.radians(slope)
        return (self.shoulder - self.radii * math.sin(a)) / math.cos(a)

    def rigid_stroke(self, slope: float) -> float:
        """Stroke at a slope of the leg in degrees, for a sheet that is wrapped around the tip: an upper bound."""
        a = math.radians(slope)
        return self.free_length(slope) * math.sin(a) + self.radii * (1.0 - math.cos(a))

    @property
    def largest_stroke(self) -> float:
        """Stroke at which a sheet wrapped around the tip lies against a flank, or on the bottom of a drawn die."""
        return min(self.rigid_stroke(self.steepest), self.depth)

    @property
    def depth(self) -> float:
        """Depth of the die in its middle."""
        if self.die_section is not None:
            return self.die_section.depth
        return 0.5 * self.opening / math.tan(math.radians(0.5 * self.die_angle))

    @property
    def bottom_stroke(self) -> float:
        """Stroke at which tip and flanks of the angle of the die are one thickness from the die. eq. (5.90)"""
        flank = math.radians(90.0 - 0.5 * self.die_angle)
        tip = (self.punch_radius + self.thickness) / math.cos(flank) - 0.5 * self.opening * math.tan(flank)
        return self.thickness + self.punch_radius - tip

    @property
    def stroke_limit(self) -> float:
        """The largest stroke that is taken: the end of air bending, or half a thickness beyond the bottom."""
        return self.bottom_stroke + 0.5 * self.thickness if self.bottoming else self.largest_stroke

    @property
    def reach(self) -> float:
        """Length of half of the mid-surface from the middle to the shoulder, the largest that air bending needs."""
        a = math.radians(self.steepest)
        return max(self.shoulder, (self.punch_radius + 0.5 * self.height) * a + self.free_length(self.steepest))

    @property
    def half_length(self) -> float:
        """Half of the length of the sheet: it ends three thicknesses beyond the shoulder."""
        return self.reach + 3.0 * self.height

    @property
    def radii(self) -> float:
        """Distance of the axes of tip and shoulder, measured across a leg."""
        return self.punch_radius + self.height + self.die_radius


@cache
def sizes_of(tool: str) -> Mapping[str, str]:
    """Parameters that are sizes of a tool, "punch" or "die", by the names of the sizes."""
    notes = {name: note_of(one.hint, SizeOf) for name, one in parameters(AirBending).items()}
    return {note.size: name for name, note in notes.items() if note is not None and note.tool == tool}


def _check_consistency(case: AirBending) -> None:
    """Refuse tools that leave no room for the sheet, and strokes beyond the end of air bending.

    Raises
    ------
    InvalidValue
        ``where`` is the parameter that is most likely wrong.
    """
    _check_penalty(case)
    _check_proportions(case)
    _check_room(case)
    _check_rolling(case)
    _check_bottoming(case)
    check_stack(case)
    if case.stroke is not None and not case.bottoming and case.stroke > case.largest_stroke:
        raise _unfit(
            case,
            "stroke",
            "the stroke goes beyond air bending: the sheet would be pressed against a flank",
            f"with these tools a leg lies against a flank at {case.largest_stroke:.4g} at the latest",
            "a smaller stroke, sharper angles of punch and die, or bottoming=True",
        )


def _check_penalty(case: AirBending) -> None:
    """Refuse a penalty together with the allowed penetration, and a penetration that is no contact."""
    if case.penalty is not None and case.penetration is not None:
        raise _unfit(
            case,
            "penetration",
            "the penalty follows from the penetration that is allowed",
            "both are given",
            "leave one of them out",
        )
    if case.penetration is not None and case.penetration > 0.5 * case.thickness:
        raise _unfit(
            case,
            "penetration",
            "the allowed penetration is more than half of the thickness of the sheet",
            "another unit, or a part of the thickness in per cent",
            f"{0.005 * case.thickness:.3g}, 1/200 of the thickness, or leave it out",
        )


def _check_bottoming(case: AirBending) -> None:
    """Refuse tools that cannot bottom, and strokes that squeeze the sheet by more than half of its thickness."""
    if not case.bottoming:
        return
    if case.punch_angle > case.die_angle:
        raise _unfit(
            case,
            "punch_angle",
            "a punch cannot press the sheet onto the flanks of a sharper die",
            f"the flanks of the die have {case.die_angle:g} degrees: the punch meets its shoulders first",
            "an angle of the punch up to that of the die; 88 and 88, or 90 and 90 are usual",
        )
    if case.stroke is not None and case.stroke > case.stroke_limit:
        raise _unfit(
            case,
            "stroke",
            "the stroke squeezes the sheet by more than half of its thickness",
            f"half a thickness beyond the bottom is {case.stroke_limit:.4g}",
            "a smaller stroke, or a force",
        )


def _check_rolling(case: AirBending) -> None:
    """Refuse an anisotropic law without rolling direction, and one that breaks the symmetry of a half width."""
    check_rolling(case.material, case.rolling)
    anisotropic = getattr(case.material, "directional", False)
    if anisotropic and case.width is not None and (case.rolling or 0.0) % 90.0 != 0.0:
        raise _unfit(
            case,
            "rolling",
            "with a width, the rolling direction must be along or across the bend line",
            "a quarter of the sheet is modelled, and a sheet that is bent at another angle has no such symmetry",
            "rolling=0 or rolling=90, or no width: plane strain takes all angles",
        )


def _unfit(case: AirBending, name: str, what: str, cause: str, remedy: str) -> InvalidValue:
    """Error for a parameter that does not agree with the others."""
    return InvalidValue(what, where=name, value=getattr(case, name), cause=cause, remedy=remedy)


def _check_proportions(case: AirBending) -> None:
    """Refuse an opening and a penalty of an unlikely order of magnitude."""
    if not _NARROWEST <= case.opening / case.height <= _WIDEST:
        raise _unfit(
            case,
            "opening",
            "the opening of the die does not fit the thickness of the sheet",
            f"it is {case.opening / case.height:.3g} thicknesses; another unit, or the two exchanged",
            f"{_NARROWEST:g} to {_WIDEST:g} thicknesses; press brakes take 5 to 16",
        )
    if case.penalty is not None and case.penalty > _STIFFEST * case.material.E / case.thickness:
        raise _unfit(
            case,
            "penalty",
            "the penalty is so stiff that the run would creep",
            f"it is {case.penalty * case.thickness / case.material.E:.3g} times E / thickness",
            "omit it: it follows from the penetration that is allowed",
        )


def _unit(case: AirBending) -> tuple[str, float] | None:
    """The unit that thickness and opening look like, in mm, if these are small for mm."""
    for name, mm, (thickness, opening) in _SMALL:
        if case.thickness < thickness and case.opening < opening:
            return name, mm
    return None


def _check_room(case: AirBending) -> None:
    """Refuse a tip that is wider than the die, shoulders without flanks, and a sheet that would be drawn in."""
    tip = 2.0 * case.punch_radius * math.cos(math.radians(0.5 * case.punch_angle))
    if tip >= case.opening:
        unit = _unit(case)
        raise _unfit(
            case,
            name := "punch_radius",
            "the tip of the punch is wider than the opening of the die",
            f"the tip is round on a width of {tip:.4g}, the opening is {case.opening:.4g}",
            (
                f"lengths in mm; if these are {unit[0]}: thickness {unit[1] * case.thickness:.3f}, "
                f"opening {unit[1] * case.opening:.2f}"
            )
            if unit
            else f"a smaller {name}, or a wider opening",
        )
    if case.punch_width is not None and case.punch_width <= tip:
        raise _unfit(
            case,
            "punch_width",
            "the body of the punch is narrower than its round tip",
            f"the tip is round on a width of {tip:.4g}",
            "a wider body, or a smaller punch_radius",
        )
    flank = 0.5 * case.opening / math.sin(math.radians(0.5 * case.die_angle))  # from the top to the apex of the V
    setback = case.die_radius * math.tan(math.radians(0.25 * (180.0 - case.die_angle)))
    if setback >= flank:
        raise _unfit(
            case,
            name := "die_radius",
            "the shoulders of the die are rounder than its flanks are long",
            f"each takes {setback:.4g} of a flank of {flank:.4g}",
            f"a smaller {name}, or a wider opening",
        )
    if case.free_length(case.steepest) <= 0.0:
        raise _unfit(
            case,
            "opening",
            "the sheet does not find room between punch and shoulders: it would be drawn, not bent",
            f"bent to {180.0 - 2.0 * case.steepest:.4g} degrees around the tip, a leg is longer than the flank",
            "an opening of 6 to 12 thicknesses, or smaller radii",
        )
