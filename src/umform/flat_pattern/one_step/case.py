"""Input of a one-step estimate: the sheet, and what holds it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from umform.errors import InvalidValue
from umform.materials import Plastic
from umform.spec import About, check_fields
from umform.spec.types import Friction, Length, NotNegative, Rolling


@dataclass(frozen=True)
class Blank:
    """Input of a one-step estimate: the sheet and what holds it, in mm, N and MPa.

    Examples
    --------
    >>> import umform as uf
    >>> aluminium = uf.sheet_metals.get("AA6016-T4").law
    >>> drawn = uf.Blank(aluminium, thickness=1.0, holder_force=40e3, friction=0.09, gap=1.2)
    """

    material: Plastic
    """Law of the sheet; its yield function is taken as that of Hill (1948) with the same r-values."""
    thickness: Length
    """Thickness of the blank."""
    rolling: Annotated[Rolling, About(remedy="0 along x, 90 along y")] = 0.0
    """Angle of the rolling direction to the x-axis of the part."""
    holder_force: NotNegative = 0.0
    """Force of the blank holder."""
    friction: Friction = 0.0
    """Coefficient of friction under the holder, and of punch and die where the sheet is curved; none if clamped."""
    bead: NotNegative = 0.0
    """Restraining force of draw beads per length of the outer edge, N/mm."""
    gap: Length | None = None
    """Distance of the tools: walls are not thicker."""
    clamped: bool = False
    """Whether the outer edge is held as it lies, as in stretching."""

    def __post_init__(self) -> None:
        check_fields(self)
        if self.gap is not None and self.gap < self.thickness:
            raise InvalidValue(
                "the tools are nearer to each other than the sheet is thick",
                where="gap",
                value=self.gap,
                cause="a clearance in place of the distance",
                remedy=f"about {1.1 * self.thickness:.4g}, or none",
            )
        for name in ("holder_force", "bead"):
            if self.clamped and getattr(self, name):
                raise InvalidValue(
                    "an edge that is held as it lies does not slide under a holder or through a bead",
                    where=name,
                    value=getattr(self, name),
                    cause="clamped=True beside it",
                    remedy="leave one of them out",
                )
        if self.clamped and self.friction:
            raise InvalidValue(
                "the estimate of a part whose edge is held as it lies has no friction",
                where="friction",
                value=self.friction,
                cause="clamped=True beside it",
                remedy="leave it out; a run of the part has friction of the punch",
            )
