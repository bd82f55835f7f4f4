"""A draw bead: its parameters, the tools that follow from them, and what does not fit together."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Self

from annotated_types import Ge, Le

from umform.errors import InvalidValue
from umform.processes.extrapolation import allowed_penetration
from umform.processes.rules import PLASTIC, WITHOUT_RATE, check_contact_points, check_rolling
from umform.processes.solution import drawing_options, usual_pace
from umform.spec import About, check_fields, names_its_words
from umform.spec.types import ContactPoints, Friction, Length, Penalty, Rolling

if TYPE_CHECKING:
    from umform.analysis.newton.options import NewtonOptions
    from umform.analysis.steps import Pace
    from umform.elements.technology import Element
    from umform.materials import J2, Metal
    from umform.surfaces import Extruded, Profile, UDie

#: Range of the radii in thicknesses: sharper ones crush the sheet, larger ones are no bead.
_SHARPEST, _ROUNDEST = 1.0, 200.0
#: Fewest elements on a quarter turn.
FEWEST = 2.0


def _options() -> NewtonOptions:
    """Forces in balance to a ten-thousandth: they are what a bead is drawn for."""
    return replace(drawing_options(), residual=1e-4, increment=1e-3)


@names_its_words
@dataclass(frozen=True, kw_only=True)
class DrawBead:
    r"""A draw bead, in mm, N and MPa. ::

        ----------.         .----------   upper tool: flat with a bead
                   \       /              radius, height
        ============\     /============>  sheet: thickness, friction
        ---------.   \___/   .---------   groove_radius
                  |         |
                  |<groove->|

    A strip of plane strain is drawn through it to the right.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.processes.draw_bead import DrawBead
    >>> bead = DrawBead(material=uf.sheet_metals.get("DC04").law, thickness=0.8, height=4.0)
    >>> bead.radius
    5.5
    """

    groups: ClassVar = {"thickness": "Sheet", "radius": "Tools", "draw": "Solution", "rolling": "Sheet"}
    """Group of the parameters from each of these on."""

    thickness: Length = 0.8
    """Thickness of the sheet."""
    material: Annotated[J2 | Metal, PLASTIC, WITHOUT_RATE]
    """Law of the sheet."""
    radius: Length = 5.5
    """Radius of the tip of the bead."""
    height: Length = 6.0
    """Height of the bead above its flat; higher than its radius, it has vertical sides."""
    groove_radius: Length = 5.0
    """Radius of both edges of the groove."""
    groove: Length | None = None
    """Width of the groove between its walls; without it, that of the bead plus 2.2 thicknesses."""
    gap: (
        Annotated[float, Ge(0.0), About("mm", cause="a sign, or the distance of the flats instead of the air")] | None
    ) = None
    """Clearance beside the sheet between the flats of the closed tools; without it, 5 % of the thickness."""
    friction: Friction = 0.1
    """Coefficient of friction on both tools."""
    draw: Length | None = None
    """Travel of the strip; without it, 1.5 times the length of the path through the bead."""
    element: str | Element = "BEND8"
    """Element of the catalogue, or one of your own."""
    elements: Annotated[float, Ge(FEWEST), Le(100.0), About(cause="the number of all elements instead")] = 14.0
    """Number of elements along the sheet on a quarter turn of the sharper radius."""
    contact_points: ContactPoints = 4
    """Number of contact points per direction and facet."""
    penalty: Penalty | None = None
    """Contact pressure per penetration; without it, as for any contact."""
    newton: NewtonOptions = field(default_factory=_options)
    """Tolerances and predictor."""
    pace: Pace = field(default_factory=usual_pace)
    """Increments."""
    rolling: Annotated[Rolling, About(remedy="0 along the bead, 90 across it")] | None = None
    """Angle from the line of the bead to the rolling direction; a law with directions needs it."""

    def __post_init__(self) -> None:
        check_fields(self)
        check_contact_points(self.element, self.contact_points)
        check_rolling(self.material, self.rolling)
        _check_geometry(self)

    def record(self) -> dict[str, Any]:
        """All parameters by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @property
    def as_made(self) -> Self:
        """The same with groove and travel as numbers: made once, they stay."""
        return replace(self, groove=self.width, draw=self.way)

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
        from umform.surfaces import UDie

        return UDie(self.width, self.height + 5.0 * self.thickness, self.groove_radius)

    @property
    def profile(self) -> Profile:
        """Section of the upper tool with its flat at z = 0, from left to right."""
        from umform.surfaces import Arc, Line, Profile

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
        from umform.surfaces import Extruded

        return Extruded(self.profile, origin=(0.0, 0.0, self.thickness + self.height))

    @property
    def plane_strain(self) -> bool | None:
        """Option of the element; None for one of your own, and for a strip that shears along the bead."""
        shears = getattr(self.material, "directional", False) and (self.rolling or 0.0) % 90.0 != 0.0
        return None if shears or not isinstance(self.element, str) else True

    @property
    def size(self) -> float:
        """Length of an element."""
        return 0.5 * math.pi * min(self.radius, self.groove_radius) / self.elements

    @property
    def allowed(self) -> float:
        """Allowed penetration: half the rise of an arc over an element, 1/200 of the thickness at least. eq. (4.190)"""
        return allowed_penetration(self.size, min(self.radius, self.groove_radius), self.thickness)

    @property
    def ends(self) -> tuple[float, float]:
        """Where the strip lies along x: its right end beside the groove, its left end is drawn up to there."""
        left = -(self.reach + 4.0 * self.thickness + self.way + 2.0 * self.height)
        return left, self.reach + 6.0 * self.thickness


def _check_geometry(case: DrawBead) -> None:
    """Reject tools that leave no room for the sheet, and a travel that ends before the force is steady.

    Raises
    ------
    InvalidValue
        ``where`` is the parameter that is most likely wrong.
    """
    for name in ("radius", "groove_radius"):
        ratio = getattr(case, name) / case.thickness
        if not _SHARPEST <= ratio <= _ROUNDEST:
            raise InvalidValue(
                "a radius of the bead does not fit the thickness of the sheet",
                where=name,
                value=getattr(case, name),
                cause=f"it is {ratio:.3g} thicknesses; another unit, or the two exchanged",
                remedy=f"{_SHARPEST:g} to {_ROUNDEST:g} thicknesses; 4 to 10 are usual",
            )
    least = 2.0 * (case.half_bead + case.thickness)
    if case.width <= least:
        raise InvalidValue(
            "the groove has no room for the bead and the sheet on both sides of it",
            where="groove",
            value=case.width,
            cause=f"bead and two thicknesses take {least:.4g}",
            remedy="a wider groove, or omit it",
        )
    if case.closing <= 0.0:
        raise InvalidValue(
            "the closed bead does not reach the sheet",
            where="gap",
            value=case.air,
            cause=f"the bead is {case.height:g} high; the distance of the flats instead of the air beside the sheet",
            remedy="less than the height of the bead, or omit it",
        )
    if case.draw is not None and case.draw < 1.2 * case.through:
        raise InvalidValue(
            "the strip is not drawn far enough for a steady force",
            where="draw",
            value=case.draw,
            cause=f"the way through the bead is {case.through:.4g}",
            remedy=f"{1.2 * case.through:.4g} at least, or omit it",
        )
