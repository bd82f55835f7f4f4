"""Settings of the solution, and the output."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Literal

from umform.analysis.newton.options import NewtonOptions
from umform.errors import InvalidValue
from umform.problem.notes import Field
from umform.problem.parts import Pair, Part, Positive
from umform.results.history import FRAMES


class Solution(Part, of=NewtonOptions):
    """Sparse solver and Newton's method."""

    solver: Annotated[str, Field(min_length=1)] = "auto"
    """auto, multifrontal, banded, pardiso, superlu, or petsc for many ranks."""
    rest: Literal["auto", "off", "on"] | Positive = "auto"
    """Springs under an initially loose sheet: auto where needed, off, on, or their total stiffness."""

    def build(self) -> NewtonOptions:
        """Options of Newton's method."""
        return NewtonOptions(**self.of_spec())


class Units(Part):
    """Names of the units of a deck in tables and pictures of its measures; nothing is converted."""

    length: str = ""
    """Name of the unit of length."""
    force: str = ""
    """Name of the unit of force."""


class Output(Part):
    """Output files and folder."""

    folder: Annotated[str, Field(min_length=1)] | None = None
    """Folder, relative to the working directory; by default results/ and the name of the deck."""
    frames: Annotated[int, Field(ge=1, le=100_000)] = FRAMES
    """Approximate number of states that each step keeps for pictures and fields."""
    csv: bool = True
    """History as history.csv."""
    vtkhdf: bool = True
    """Fields as fields.vtkhdf."""
    report: bool = True
    """A page, report.html."""
    pictures: bool = True
    """Force over displacement as curve.png, the final shape as shape.png."""
    state: bool = False
    """Final state as state.h5, the start of a deck with a table before."""
    forming: bool = False
    """Strains of both skins and of the middle, thinning and wrinkling among the fields."""
    forming_limit: Literal["Keeler-Brazier"] | list[Pair] | None = None
    """Forming limit: logarithmic minor and major strains, the minor ones ascending, or Keeler-Brazier (of the thickness
    in mm and the hardening of a plastic material); adds the margin as a field."""

    def __post_init__(self) -> None:
        """Refuse a curve of less than two points, one that does not ascend, and strains in per cent."""
        if self.forming_limit is None or isinstance(self.forming_limit, str):
            return
        minor = [pair[0] for pair in self.forming_limit]
        if len(minor) < 2 or sorted(set(minor)) != minor:
            raise InvalidValue(
                "a forming limit has two points or more, pairs of minor and major strain, the minor ones ascending",
                where="forming_limit",
                value=self.forming_limit,
                cause="a point twice or out of order, or major strains first",
                remedy="[[-0.2, 0.5], [0.0, 0.26], [0.2, 0.36]], or Keeler-Brazier",
            )
        from umform.results.forming.limits import LARGEST_STRAIN  # NumPy loads slowly

        if any(abs(strain) > LARGEST_STRAIN for pair in self.forming_limit for strain in pair):
            raise InvalidValue(
                "the strains of a forming limit are logarithmic, not per cent",
                where="forming_limit",
                value=self.forming_limit,
                cause=f"one is larger than {LARGEST_STRAIN:g}",
                remedy="0.262 = ln(1.3) for 30 %",
            )


class Derivatives(Part):
    """Derivatives of the results of a deck, for `umform derive`."""

    by: Annotated[list[str], Field(min_length=1)]
    """Paths of the parameters, such as tools.die.radius: `umform paths` lists them."""
    results: list[str] = field(default_factory=list)
    """Measures, or columns of the history such as punch_force:max; without any all measures, else forces."""
    hold: dict[str, str] = field(default_factory=dict)
    """Results that stay constant, and the path of the parameter that follows each."""
