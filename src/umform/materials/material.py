"""Interface between a model and its material."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from umform import _core
from umform.errors import InvalidValue


@runtime_checkable
class Material(Protocol):
    """Interface of a material: the law of the kernels and the default number of thickness points."""

    @property
    def thickness_points(self) -> int | None:
        """Default number of Gauss points through the thickness; None: 2, or those of the element with a history."""

    def law(self) -> _core.Material:
        """The law as the kernels take it."""


def check_material(material: object, where: str) -> None:
    """Refuse what is no law of a material."""
    if not isinstance(material, Material) or isinstance(material, type):
        raise InvalidValue(
            "material must be a material law",
            where=where,
            value=type(material).__name__,
            cause="none, a class, a function, or a sheet metal or its name in place of its law",
            remedy="SVK, NeoHooke, NeoHookePower, J2 or Metal; umform.sheet_metals.get('DC04').law; UserLaw(function)",
        )
