"""The material of a deck: a law with its constants, or a sheet metal of the library, and the rolling direction."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass, field
from typing import Annotated, Any, ClassVar

from annotated_types import MinLen

from umform import sheet_metals
from umform.errors import InvalidValue
from umform.materials import Material
from umform.materials.laws import laws
from umform.problem.notes import Discriminator, Tag
from umform.problem.rolling import RollingPart
from umform.spec import OneOf


@dataclass(frozen=True)
class LawPart:
    """A law with its rolling direction."""

    inside: ClassVar = "law"
    law: Material
    """The law."""
    _: KW_ONLY
    rolling: RollingPart | None = None
    """Rolling direction, required by a material with directions: a direction, an angle to the bend line, or a file."""

    def __post_init__(self) -> None:
        if self.rolling is None and getattr(self.law, "directional", False):
            raise InvalidValue(
                "a material with directions needs rolling",
                where="rolling",
                cause="it was left out",
                remedy='rolling = "x", or { angle = 0 } to the bend line',
            )


@dataclass(frozen=True)
class FromLibrary(LawPart):
    """A sheet metal of the library."""

    law: Material = field(init=False)
    library: Annotated[str, MinLen(1)]
    """Its name."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "law", sheet_metals.get(self.library).law)
        super().__post_init__()

    @property
    def note(self) -> str:
        """Name, source and caveat of the metal."""
        return sheet_metals.get(self.library).note


def _kind(value: Any) -> str:
    return "library" if isinstance(value, FromLibrary) or (isinstance(value, dict) and "library" in value) else "law"


MaterialPart = Annotated[
    Annotated[LawPart, OneOf("law", laws, LawPart), Tag("law")] | Annotated[FromLibrary, Tag("library")],
    Discriminator(_kind),
]
