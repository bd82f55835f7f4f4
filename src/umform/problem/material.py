"""The material of a deck: a law with its constants, or a sheet metal of the library."""

from __future__ import annotations

from contextlib import suppress
from typing import Annotated, Literal

from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from umform import materials, sheet_metals
from umform.errors import UmformError
from umform.materials import Material
from umform.problem.elastic import Elastic
from umform.problem.foreign import Compiled, Umat
from umform.problem.metal import J2, Metal
from umform.problem.parts import Part, tagged_by
from umform.problem.rolling import RollingPart


class SVK(Elastic):
    """St. Venant-Kirchhoff, for small strains."""

    law: Literal["SVK"]
    """The word SVK."""

    def build(self) -> Material:
        """The law."""
        return materials.SVK(**self.constants())


class NeoHooke(Elastic):
    """Compressible neo-Hooke, logarithmic form."""

    law: Literal["NeoHooke"]
    """The word NeoHooke."""

    def build(self) -> Material:
        """The law."""
        return materials.NeoHooke(**self.constants())


class NeoHookePower(Elastic):
    """Compressible neo-Hooke, power form."""

    law: Literal["NeoHookePower"]
    """The word NeoHookePower."""

    def build(self) -> Material:
        """The law."""
        return materials.NeoHookePower(**self.constants())


class FromLibrary(Part):
    """A sheet metal of the library."""

    library: Annotated[str, Field(min_length=1)]
    """Its name."""
    rolling: RollingPart | None = None
    """Rolling direction, required by an anisotropic metal: a direction, an angle to the bend line, or a file."""

    @model_validator(mode="after")
    def _knows_its_directions(self) -> FromLibrary:
        with suppress(UmformError):  # an unknown name is refused when the law is built
            if self.rolling is None and getattr(sheet_metals.get(self.library).law, "directional", False):
                raise PydanticCustomError("rolling", 'a metal with directions needs rolling: rolling = "x"')
        return self

    def build(self) -> Material:
        """The law of the sheet metal."""
        return sheet_metals.get(self.library).law

    @property
    def note(self) -> str:
        """Name, source and caveat of the metal."""
        return sheet_metals.get(self.library).note


MaterialPart = Annotated[
    Annotated[SVK, Tag("SVK")]
    | Annotated[NeoHooke, Tag("NeoHooke")]
    | Annotated[NeoHookePower, Tag("NeoHookePower")]
    | Annotated[J2, Tag("J2")]
    | Annotated[Metal, Tag("Metal")]
    | Annotated[Umat, Tag("UMAT")]
    | Annotated[Compiled, Tag("Compiled")]
    | Annotated[FromLibrary, Tag("library")],
    Discriminator(
        tagged_by("law", "library"),
        custom_error_type="law",
        custom_error_message="a material has law = SVK, NeoHooke, NeoHookePower, J2, Metal, UMAT or Compiled, or "
        "library = a name",
        custom_error_context={
            "key": "law",
            "expected_tags": "'SVK', 'NeoHooke', 'NeoHookePower', 'J2', 'Metal', 'UMAT', 'Compiled'",
        },
    ),
]
