"""Ram and bed of a press brake as beams on two supports. docs/theory, 5.16"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from umform.errors import InvalidValue
from umform.spec import About, check_fields
from umform.spec.types import Length

if TYPE_CHECKING:
    from umform.studies.deflection.beam import Floats


@dataclass(frozen=True)
class PressBrake:
    """Ram and bed of a press brake, steel plates that its side frames support.

    Examples
    --------
    >>> from umform.studies.deflection import PressBrake
    >>> brake = PressBrake(span=3100.0, ram_height=1400.0, ram_thickness=60.0)
    >>> round(float(brake.deflection([0.0], 3000.0, 98.0)[0]), 3)
    0.062
    """

    groups: ClassVar = {"span": "Press brake"}
    """Group of the parameters from each of these on."""

    span: Length | None = None
    """Distance of the side frames, which support ram and bed; without it, no deflection is computed."""
    ram_height: Length | None = None
    """Height of the plate of the ram; without it the ram is rigid."""
    ram_thickness: Length | None = None
    """Thickness of the plate of the ram."""
    bed_height: Length | None = None
    """Height of the plate of the bed; without it the bed is rigid."""
    bed_thickness: Length | None = None
    """Thickness of the plate of the bed."""
    crowning: Annotated[float, About("mm", cause="a parameter of the machine in place of a height")] = 0.0
    """Rise of the bed in the middle of the span, a parabola that is zero at the side frames."""

    def __post_init__(self) -> None:
        check_fields(self)
        for what in ("ram", "bed"):
            given = [getattr(self, f"{what}_{size}") is not None for size in ("height", "thickness")]
            if any(given) and not all(given):
                raise InvalidValue(
                    "a plate has a height and a thickness",
                    where=what,
                    cause="one of them is missing",
                    remedy=f"{what}_height and {what}_thickness, or neither for a rigid one",
                )
        if self.span is None and (self.plates or self.crowning):
            raise InvalidValue(
                "ram, bed and crowning need the distance of the side frames",
                where="span",
                cause="it is missing",
                remedy="span=3100, for instance",
            )
        if self.span is not None and not self.plates:
            raise InvalidValue(
                "a press brake without ram and bed does not deflect",
                where="span",
                value=self.span,
                cause="the heights of ram and bed are missing",
                remedy="ram_height and ram_thickness of its plate, or those of the bed",
            )

    @property
    def plates(self) -> list[tuple[float, float]]:
        """Height and thickness of what deflects."""
        sizes = ((self.ram_height, self.ram_thickness), (self.bed_height, self.bed_thickness))
        return [(height, thickness) for height, thickness in sizes if height is not None and thickness is not None]

    def deflection(self, y: Any, length: float, line_load: float) -> Floats:
        """Way by which ram and bed give under a bend in the middle, at distances from it; without crowning. eq. (5.95)

        Parameters
        ----------
        y : array_like, shape (n,)
            Distances from the middle.
        length : float
            Length of the bend.
        line_load : float
            Force per length of bend.
        """
        from umform.studies.deflection.beam import beams_deflection  # it loads NumPy

        return beams_deflection(y, self.span or length, self.plates, line_load, length)
