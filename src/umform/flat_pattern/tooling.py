"""Dies and punches for the bends of a part, and their computed allowances."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

from umform.errors import placed
from umform.flat_pattern.allowance import Allowance, outside
from umform.io.store import Store
from umform.problem.metal_file import metal_of
from umform.processes.air_bending.formulas import INNER_RADIUS
from umform.processes.air_bending.spec import AirBending
from umform.processes.plausible import accepted
from umform.spec import check_fields
from umform.spec.types import Length
from umform.studies.bend_table import bend as stored_bend

#: Openings of dies in mm that shops have.
OPENINGS = (4.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0, 32.0, 40.0, 50.0, 63.0, 80.0, 100.0, 125.0, 160.0, 200.0)
#: Openings over the thickness that are chosen.
NARROWEST, WIDEST = 8.0, 12.0
#: Angles of punch and die in degrees for parts that those of the sheet do not bend far enough.
ACUTE = (60.0, 45.0, 30.0)
#: Radius of the punch over the thickness, at least, whatever radius is drawn.
_SHARPEST = 0.5
#: Degrees below the angle of the part that the tools leave for springback.
_SPRINGBACK = 3.0


@dataclass(frozen=True)
class Tooling:
    """Tools for each bend of a part."""

    sheet: AirBending = field(default_factory=AirBending)
    """Mesh and tools, and the metal if none is named; the thickness is that of the part."""
    metal: str | None = None
    """Name of the metal in the library of sheet metals, or the path of a file of one."""
    opening: Length | None = None
    """Opening of the die in mm; without it, one of `OPENINGS` of 8 to 12 thicknesses whose usual inside radius, 0.16 of
    the opening, is nearest to that of the drawing."""

    def __post_init__(self) -> None:
        check_fields(self)

    def case(self, angle: float, radius: float, thickness: float) -> AirBending:
        """Sheet and tools of a bend.

        Parameters
        ----------
        angle : float
            Angle by which the sheet is bent, in degrees.
        radius, thickness : float
            Inside radius of the drawing, thickness, in mm.
        """
        opening = self.opening
        if opening is None:
            fits = [v for v in OPENINGS if NARROWEST * thickness <= v <= WIDEST * thickness]
            opening = min(fits or [8.0 * thickness], key=lambda v: abs(INNER_RADIUS * v - radius))
        changes: dict[str, Any] = {"thickness": thickness, "opening": opening}
        if 180.0 - angle < max(self.sheet.die_angle, self.sheet.punch_angle) + _SPRINGBACK:
            acute = next((one for one in ACUTE if 180.0 - angle >= one + _SPRINGBACK), ACUTE[-1])
            changes |= {"die_angle": acute, "punch_angle": acute}
        if self.sheet.die_radius == AirBending.die_radius and thickness < self.sheet.die_radius:
            changes |= {"die_radius": thickness}
        if self.sheet.punch_radius == AirBending.punch_radius and radius < self.sheet.punch_radius:
            changes |= {"punch_radius": max(radius, _SHARPEST * thickness)}
        if self.metal is not None:
            changes |= {"material": _law(self.metal, thickness)}
        return replace(self.sheet, stroke=None, **changes)


@lru_cache(maxsize=16)
def _law(metal: str, thickness: float) -> Any:
    return metal_of(metal, thickness).law


@dataclass(frozen=True)
class ComputedBends:
    """Allowances of computed air bends: from the store, or from a run that goes into the store.

    An air bend gets the inside radius that the die gives, not that of the drawing. The allowance is the length between
    the tangent lines of the drawing that leaves its outer lengths: 2 (R + t) tan(angle / 2) less the computed bend
    deduction.
    """

    tooling: Tooling = field(default_factory=Tooling)
    """Tools of each bend."""
    store: Store | None = None
    """Where bends are kept; default: that of the user."""

    def __post_init__(self) -> None:
        check_fields(self)

    def __call__(self, angle: float, radius: float, thickness: float) -> Allowance:
        """The allowance of a bend.

        Raises
        ------
        InvalidValue
            If the tools do not bend so far.
        DeckError
            If stresses or lengths are certainly in another unit.
        """
        case = self.tooling.case(angle, radius, thickness)
        warnings = accepted(case)
        with placed(f"the bend by {angle:.4g} degrees", "angle"):
            found = stored_bend(case, 180.0 - angle, store=self.store)
        drawn = 2.0 * outside(angle, radius, thickness)
        words = [
            self.tooling.metal or "",
            f"V {case.opening:g}",
            f"punch R {case.punch_radius:g}",
            f"bend {found.key[:12]}",
        ]
        source = "computed: " + ", ".join(word for word in words if word)
        return Allowance(
            drawn - found.deduction,
            source,
            found.radius,
            found.measures.stroke,
            found.measures.largest_force,
            (*warnings, *found.notes),
        )
