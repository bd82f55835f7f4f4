"""Parameters of a draw bead, and the tools that follow from them."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from umform.elements import element
from umform.elements.technology import Element
from umform.materials import J2, Metal
from umform.mesh import Mesh, strip
from umform.processes.draw_bead.checks import check_geometry, check_parameters
from umform.processes.limit import allowed_penetration
from umform.surfaces import Arc, Extruded, Line, Profile, UDie


@dataclass(frozen=True, kw_only=True)
class DrawBead:
    r"""Parameters of a draw bead in mm, N and MPa; a strip of plane strain is drawn to the right. ::

        ----------.         .----------   upper tool: flat with a bead
                   \       /              radius, height
        ============\     /============>  sheet: thickness, friction
        ---------.   \___/   .---------   groove_radius
                  |         |
                  |<groove->|

    Parameters
    ----------
    thickness : float
        Thickness of the sheet.
    material : J2 or Metal
        Law of the sheet.
    radius, height : float
        Radius of the tip of the bead, and its height above the flat. A bead higher than its radius has vertical sides.
    groove_radius : float
        Radius of both edges of the groove.
    groove : float, optional
        Width of the groove between its walls; default: that of the bead plus 2.1 thicknesses.
    gap : float, optional
        Clearance beside the sheet between the flats of the closed tools; default 5 % of the thickness.
    friction : float
        Coefficient of friction on both tools.
    draw : float, optional
        Travel of the strip; default: 1.5 times the length of the path through the bead.
    element : str or Element
        Name in the catalogue, or an element of your own.
    elements : float
        Elements along the sheet on a quarter turn of the sharper radius.
    contact_points : int
        Contact points per direction and facet.
    penalty : float, optional
        Pressure per penetration on both tools; default as for any contact, and on finer meshes by the penetration of
        the coarser ones.
    rolling : float, optional
        Degrees from the line of the bead to the rolling direction, 90 across it; required by an anisotropic law.
    """

    thickness: float
    material: J2 | Metal
    radius: float = 5.5
    height: float = 6.0
    groove_radius: float = 5.0
    groove: float | None = None
    gap: float | None = None
    friction: float = 0.1
    draw: float | None = None
    element: str | Element = "BEND8"
    elements: float = 14.0
    contact_points: int = 4
    penalty: float | None = None
    rolling: float | None = None

    def __post_init__(self) -> None:
        check_parameters(self.record())
        check_geometry(self)

    def record(self) -> dict[str, Any]:
        """All parameters by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def half_bead(self) -> float:
        """Half of the width of the bead where it leaves its flat."""
        above = max(self.radius - self.height, 0.0)
        return math.sqrt(self.radius**2 - above**2)

    @property
    def width(self) -> float:
        """Width of the groove."""
        return 2.0 * (self.half_bead + 1.1 * self.thickness) if self.groove is None else self.groove

    @property
    def air(self) -> float:
        """Clearance beside the sheet between the flats."""
        return 0.05 * self.thickness if self.gap is None else self.gap

    @property
    def reach(self) -> float:
        """Distance from the middle to where the edges of the groove begin to round."""
        return 0.5 * self.width + self.groove_radius

    @property
    def through(self) -> float:
        """Upper bound of the length of the sheet between both edges; sheet drawn this far has passed the whole bead."""
        return 2.0 * (self.reach + self.height)

    @property
    def way(self) -> float:
        """Travel of the strip."""
        return 1.5 * self.through if self.draw is None else self.draw

    @property
    def closing(self) -> float:
        """Travel of the upper tool from first contact with the sheet until the flats are closed."""
        return self.height - self.air

    @property
    def lower_tool(self) -> UDie:
        """The groove; its flat is z = 0."""
        return UDie(self.width, self.height + 5.0 * self.thickness, self.groove_radius)

    @property
    def profile(self) -> Profile:
        """Section of the upper tool with its flat at z = 0, from left to right."""
        half, R, far = self.half_bead, self.radius, 2.0 * (self.reach + self.way)
        upright = max(self.height - R, 0.0)
        centre = (0.0, R - self.height)
        tip = Arc((-half, -upright), (half, -upright), centre)
        left, right = Line((-far, 0.0), (-half, 0.0)), Line((half, 0.0), (far, 0.0))
        if upright == 0.0:
            return Profile([left, tip, right], closed=False)
        walls = Line((-half, 0.0), (-half, -upright)), Line((half, -upright), (half, 0.0))
        return Profile([left, walls[0], tip, walls[1], right], closed=False)

    @property
    def upper_tool(self) -> Extruded:
        """The bead, whose tip touches the sheet."""
        return Extruded(self.profile, origin=(0.0, 0.0, self.thickness + self.height))

    @property
    def size(self) -> float:
        """Length of an element."""
        return 0.5 * math.pi * min(self.radius, self.groove_radius) / self.elements

    @property
    def allowed(self) -> float:
        """Allowed penetration: half the rise of an arc over an element, 1/200 of the thickness at least. eq. (4.190)"""
        return allowed_penetration(self.size, min(self.radius, self.groove_radius), self.thickness)

    def sheet(self) -> Mesh:
        """A strip of the width one; its right end lies beside the groove, its left end is drawn up to there."""
        right = self.reach + 6.0 * self.thickness
        left = -(self.reach + 4.0 * self.thickness + self.way + 2.0 * self.height)
        flat = strip(
            right - left, 1.0, self.thickness, (round((right - left) / self.size), 1), cell=element(self.element).cell
        )
        return flat.transformed(lambda x: x + np.array([left, 0.0, 0.5 * self.thickness]))
