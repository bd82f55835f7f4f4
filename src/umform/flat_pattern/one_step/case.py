"""What is asked of a one-step estimate: the sheet, and what holds it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from umform.errors import InvalidValue
from umform.materials import Plastic


@dataclass(frozen=True)
class Blank:
    """What is asked: the sheet and what holds it, in mm, N and MPa.

    Attributes
    ----------
    material : J2 or Metal
        Law of the sheet; its yield function is taken as that of Hill (1948) with the same r-values.
    thickness : float
        Of the blank.
    rolling : float
        Angle of the rolling direction to the x-axis of the part, degrees.
    holder_force : float
        Force of the blank holder.
    friction : float
        Coefficient of friction under the holder, and of punch and die where the sheet is curved.
    bead : float
        Restraining force of draw beads per length of the outer edge, N/mm.
    gap : float, optional
        Distance of the tools: walls are not thicker.
    clamped : bool
        Whether the outer edge is held as it lies, as in stretching.

    Examples
    --------
    >>> import umform as uf
    >>> aluminium = uf.sheet_metals.get("AA6016-T4").law
    >>> drawn = uf.Blank(aluminium, thickness=1.0, holder_force=40e3, friction=0.09, gap=1.2)
    """

    material: Plastic
    thickness: float
    rolling: float = 0.0
    holder_force: float = 0.0
    friction: float = 0.0
    bead: float = 0.0
    gap: float | None = None
    clamped: bool = False

    def __post_init__(self) -> None:
        for name in ("holder_force", "friction", "bead"):
            if not 0.0 <= getattr(self, name) < math.inf:
                raise InvalidValue(
                    f"{name} must not be negative", where=name, value=getattr(self, name), remedy="0 for none"
                )
        if not self.thickness > 0.0:
            raise InvalidValue("the sheet has no thickness", where="thickness", value=self.thickness, remedy="in mm")
        if self.gap is not None and not self.gap >= self.thickness:
            raise InvalidValue(
                "the tools are nearer to each other than the sheet is thick",
                where="gap",
                value=self.gap,
                cause="a clearance in place of the distance",
                remedy=f"about {1.1 * self.thickness:.4g}, or none",
            )
