"""Parameters of air bending, and the tools and limits that follow from them."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

from umform.elements.rolling import Vector, rolling_at
from umform.elements.technology import Element
from umform.materials import J2, Metal, Swift
from umform.processes.air_bending.checks import check_geometry, check_parameters
from umform.processes.air_bending.drawn_tools import DrawnDie, DrawnPunch, check_one_sided, drawn_sizes
from umform.surfaces import Extruded, Punch, VDie

#: Like DC04 across the rolling direction in shape and level; a curve of your own material is better.
DC04_LIKE = J2(E=210e3, nu=0.3, hardening=Swift(strength=520.0, offset=0.004, exponent=0.22))


@dataclass(frozen=True)
class AirBending:
    r"""Parameters of air bending in mm, N and MPa. ::

              |     |
              | \ / |  punch_angle, punch_radius
        =======  v  =======  sheet: thickness, width
        -----.       .-----  die_radius
              \     /
               \   /     die_angle
                 v
             |<----->|  opening

    Parameters
    ----------
    thickness : float
        Thickness of the sheet.
    opening : float
        Distance of the lines where the flanks of the die, drawn on as planes, meet its top.
    die_angle, die_radius : float
        Angle between the flanks of the die in degrees; radius of its shoulders.
    punch_angle, punch_radius : float
        Angle between the flanks of the punch in degrees; radius of its tip.
    width : float, optional
        Length of the bend. Without it, plane strain: a sheet so wide that nothing moves along the bend.
    punch_section : DrawnPunch, optional
        A punch from a drawing; ``punch_angle`` and ``punch_radius`` are then those of the drawing.
    die_section : DrawnDie, optional
        A die from a drawing; ``opening``, ``die_angle`` and ``die_radius`` are then those of the drawing.
    stroke : float, optional
        Way of the punch from where it touches the sheet; a search or a table does not need it.
    bottoming : bool
        Whether the punch may press the sheet onto the flanks of the die.
    punch_width : float, optional
        Width of the body of the punch; by default its flanks have no end.
    material : J2 or Metal
        Law of the sheet.
    rolling : float, optional
        Degrees from the bend line to the rolling direction, 0 along the line and 90 across it; a law with directions
        needs it.
    element : str or Element
        Name in the catalogue, or an element of your own.
    layers : int
        Elements stacked through the thickness.
    thickness_points : int
        Points through the thickness of each layer.
    elements_per_thickness : float
        Elements along the sheet on a length of one thickness, in the bend and where the shoulder touches; in dies wider
        than 16 thicknesses, on 1/16 of the opening.
    width_elements : int
        Elements over half of the width; without a width there is one.
    contact_points : int or "auto"
        Contact points per direction and facet; "auto": as many as the contact of each tool needs, eq. (4.31).
    penalty : float, optional
        Contact pressure per penetration; default: it follows from the allowed penetration, eq. (4.29).
    penetration : float, optional
        Allowed penetration, in place of a penalty; default thickness / 200.
    increment : float
        Way of the punch in one increment, over the opening.
    """

    thickness: float = 2.0
    opening: float = 16.0
    die_angle: float = 85.0
    die_radius: float = 2.0
    punch_angle: float = 85.0
    punch_radius: float = 1.5
    punch_section: DrawnPunch | None = None
    die_section: DrawnDie | None = None
    width: float | None = None
    stroke: float | None = None
    bottoming: bool = False
    punch_width: float | None = None
    material: J2 | Metal = DC04_LIKE
    rolling: float | None = None
    element: str | Element = "BEND18"
    layers: int = 2
    thickness_points: int = 6
    elements_per_thickness: float = 3.0
    width_elements: int = 3
    contact_points: int | str = "auto"
    penalty: float | None = None
    penetration: float | None = None
    increment: float = 0.00625

    def __post_init__(self) -> None:
        for name, value in drawn_sizes(self.punch_section, self.die_section).items():
            object.__setattr__(self, name, value)
        check_parameters(self.record())
        check_geometry(self)
        if self.punch_section is not None:
            check_one_sided(self.punch_section, self.half_length)

    def record(self) -> dict[str, Any]:
        """All parameters by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @cached_property
    def die(self) -> VDie | Extruded:
        """The die; its top is z = 0."""
        if self.die_section is not None:
            return Extruded(self.die_section.profile)
        return VDie(self.opening, self.die_angle, self.die_radius)

    @cached_property
    def punch(self) -> Punch | Extruded:
        """The punch, touching the sheet at z = thickness."""
        if self.punch_section is not None:
            return Extruded(self.punch_section.profile, origin=(0.0, 0.0, self.thickness))
        return Punch(self.punch_radius, self.punch_angle, self.punch_width, origin=(0.0, 0.0, self.thickness))

    @property
    def rolling_direction(self) -> Vector | None:
        """Unit vector of the rolling direction; the bend line is y."""
        return None if self.rolling is None else rolling_at(self.rolling)

    @property
    def plane_strain(self) -> bool | None:
        """Option of the element; None for a sheet of finite width, and for one that shears along the bend."""
        shears = getattr(self.material, "directional", False) and self.rolling not in (0.0, 90.0)
        return None if self.width is not None or shears or isinstance(self.element, Element) else True

    @property
    def way(self) -> float:
        """Way of the punch in one increment, in mm."""
        return self.increment * self.opening

    @property
    def shoulder(self) -> float:
        """Distance of the axis of the shoulder from the middle: where the sheet rests at first."""
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
        return (self.shoulder - self._radii * math.sin(a)) / math.cos(a)

    def rigid_stroke(self, slope: float) -> float:
        """Stroke at a slope of the leg in degrees, for a sheet that is wrapped around the tip: an upper bound."""
        a = math.radians(slope)
        return self.free_length(slope) * math.sin(a) + self._radii * (1.0 - math.cos(a))

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
        return max(self.shoulder, (self.punch_radius + 0.5 * self.thickness) * a + self.free_length(self.steepest))

    @property
    def half_length(self) -> float:
        """Half of the length of the sheet: it ends three thicknesses beyond the shoulder."""
        return self.reach + 3.0 * self.thickness

    @property
    def _radii(self) -> float:
        """Distance of the axes of tip and shoulder, measured across a leg."""
        return self.punch_radius + self.thickness + self.die_radius
