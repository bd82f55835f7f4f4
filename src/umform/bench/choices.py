"""Fields of the form beside the parameters of the processes, as Specs of the bench."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Gt, Le

from umform.spec import About
from umform.spec.types import Degrees, Length, Positive, Stress


@dataclass(frozen=True)
class Choices:
    """Fields of the form beside the parameters of the processes."""

    groups: ClassVar = {
        "work": "What to do",
        "die": "Tools",
        "second_material": "Second sheet",
        "yield_stress": "Sheet",
        "mesh": "Solution",
    }
    """Group of the parameters from each of these on."""

    work: Literal["bend", "bottom", "outside", "sequence", "hem", "correct", "cup", "u", "flat", "table"] = "bend"
    """Kind of work."""
    material: str = "DC04"
    """Material; a sheet metal of the library."""
    length: Length = 1000.0
    """Length of the bend, for the force in kN."""
    die: str | None = None
    """Die; by numbers, or from a drawing."""
    punch: str | None = None
    """Punch; by numbers, or from a drawing."""
    second_material: str | None = None
    """Second sheet; a sheet metal of the library, on the first."""
    yield_stress: Stress | None = None
    """Yield stress Re or Rp0.2 of the coil; without it, that of the library."""
    tensile_strength: Stress | None = None
    """Tensile strength Rm of the coil; without it, that of the library."""
    uniform_elongation: Annotated[float, Gt(0.0), Le(80.0), About("%", cause="another unit")] | None = None
    """Uniform elongation Ag of the coil; without it, that of the library."""
    mesh: Literal["quick", "usual", "fine"] = "usual"
    """Mesh; it determines the parameters below that are empty."""
    budget: bool = False
    """Error budget; the bend is repeated with refinements."""
    whole: bool = False
    """Free ends; the whole length is modelled, in place of plane strain."""


@dataclass(frozen=True)
class Measured:
    """Measurements of a bend, which correct its metal."""

    groups: ClassVar = {"measured_angle": "Measured bend"}
    """Group of the parameters from each of these on."""

    measured_angle: Degrees | None = None
    """Measured angle between the legs after springback."""
    measured_force: Annotated[Positive, About("kN/m")] | None = None
    """Measured force at the stroke; without it, only the flow stress is corrected."""
    measured_radius: Length | None = None
    """Measured inside radius."""
    issue_again: str | None = None
    """Bend table to issue again; a finished table of this metal."""


@dataclass(frozen=True)
class FlatChoices:
    """Fields of the form for a part to unfold."""

    groups: ClassVar = {"part": "Flat pattern"}
    """Group of the parameters from each of these on."""

    part: str | None = None
    """Part; a STEP file of one bent part."""
    die_opening: Length | None = None
    """Opening of the dies; without it, 8 to 12 thicknesses, by the radius of the drawing."""
    k_factor: Annotated[float, Ge(0.0), Le(1.0), About(cause="the factor of DIN 6935, or percent")] | None = None
    """K-factor of ANSI in place of computed bends; without it, bends are computed."""
    simulated: bool = False
    """Whether the whole part is bent by simulation."""


@dataclass(frozen=True)
class TableChoices:
    """Fields of the form for a bend table."""

    groups: ClassVar = {"check": "Bend table"}
    """Group of the parameters from each of these on."""

    check: bool = False
    """Whether the errors between the angles are measured by more runs."""
