"""Materials of a deck that are functions of a shared library: a UMAT, or a C function."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag

from umform import materials
from umform.materials import Material
from umform.problem.parts import Part, number_or_table
from umform.problem.rolling import RollingPart

Variables = Annotated[
    Annotated[Annotated[int, Field(ge=0)], Tag("number")]
    | Annotated[dict[str, Annotated[int, Field(ge=1)]], Tag("table")],
    Discriminator(number_or_table),
]
Points = Annotated[int, Field(ge=2, le=20)]


class Foreign(Part):
    """Common keys of laws of a library."""

    file: Annotated[str, Field(min_length=1)]
    """Shared library, a path from the folder of the deck."""
    state: Variables = 0
    """Number of state variables, or their names and sizes in their order; fields have these names."""
    properties: list[float] = []
    """Constants of the law."""
    initial: list[float] = []
    """State of the virgin material; default zeros."""
    symmetric: bool = True
    """Whether the tangent is symmetric; an asymmetric one then raises an error."""
    rolling: RollingPart | None = None
    """Rolling direction."""

    def build(self, folder: Path) -> Material:
        """The law, whose library is found from a folder."""
        raise NotImplementedError


class Umat(Foreign):
    """A UMAT, the interface of Abaqus, for three-dimensional small strains; it receives logarithmic strains."""

    law: Literal["UMAT"]
    """The word UMAT."""
    energies: bool = False
    """Whether it fills SSE, SPD and SCD."""
    parallel: bool = False
    """Whether several threads may call it at the same time."""
    directional: bool = True
    """Whether it is anisotropic and needs rolling."""
    symbol: Annotated[str, Field(min_length=1)] | None = None
    """Name of the function; by default the usual names that compilers give to UMAT."""
    name: Annotated[str, Field(min_length=1, max_length=80)] = "UMAT"
    """CMNAME."""

    def build(self, folder: Path) -> Material:
        """The law, whose library is found from a folder."""
        given = self.model_dump(exclude={"law", "rolling", "file"})
        return materials.Umat(folder / self.file, **given)


class Compiled(Foreign):
    """A C function, see umform.CompiledLaw."""

    law: Literal["Compiled"]
    """The word Compiled."""
    function: Annotated[str, Field(min_length=1)]
    """Its name in the library."""
    energy: Annotated[str, Field(min_length=1)] | None = None
    """Name of the function of its energies."""
    strain: Literal["logarithmic", "green-lagrange"] = "logarithmic"
    """Strain that it receives."""
    parallel: bool = True
    """Whether several threads may call it at the same time."""
    sees_points: bool = False
    """Whether it uses axes and length of the cell."""
    directional: bool = False
    """Whether it is anisotropic and needs rolling."""

    def build(self, folder: Path) -> Material:
        """The law, whose library is found from a folder."""
        given = self.model_dump(exclude={"law", "rolling", "file", "function"})
        return materials.CompiledLaw(self.function, folder / self.file, **given, name=self.function)
