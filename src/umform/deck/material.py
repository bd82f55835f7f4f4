"""The material of a deck: a law with its constants, or a sheet metal of the library."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from umform import materials, sheet_metals
from umform.deck.parts import NotNegative, Part, Positive, tagged_by
from umform.materials import Hardening, Material

Fraction = Annotated[float, Field(ge=0, le=1)]


class Elastic(Part):
    """Elastic constants: E and nu, or kappa and mu."""

    E: Positive | None = None
    """Young's modulus."""
    nu: Annotated[float, Field(gt=-1, lt=0.5)] | None = None
    """Poisson's ratio."""
    kappa: Positive | None = None
    """Bulk modulus."""
    mu: Positive | None = None
    """Shear modulus."""

    @model_validator(mode="after")
    def _is_one_pair(self) -> Elastic:
        given = {name for name in ("E", "nu", "kappa", "mu") if getattr(self, name) is not None}
        if given not in ({"E", "nu"}, {"kappa", "mu"}):
            raise PydanticCustomError("constants", "give E and nu, or kappa and mu, and no others")
        return self

    def _constants(self) -> dict[str, Any]:
        return self.model_dump(include={"E", "nu", "kappa", "mu"}, exclude_none=True)


class SVK(Elastic):
    """St. Venant-Kirchhoff, for small strains."""

    law: Literal["SVK"]
    """The word SVK."""

    def build(self) -> Material:
        """The law."""
        return materials.SVK(**self._constants())


class NeoHooke(Elastic):
    """Compressible neo-Hooke, logarithmic form."""

    law: Literal["NeoHooke"]
    """The word NeoHooke."""

    def build(self) -> Material:
        """The law."""
        return materials.NeoHooke(**self._constants())


class NeoHookePower(Elastic):
    """Compressible neo-Hooke, power form."""

    law: Literal["NeoHookePower"]
    """The word NeoHookePower."""

    def build(self) -> Material:
        """The law."""
        return materials.NeoHookePower(**self._constants())


class Perfect(Part):
    """Perfect plasticity: y = yield_stress."""

    curve: Literal["Perfect"]
    """The word Perfect."""
    yield_stress: Positive
    """First yield stress."""

    def build(self) -> Hardening:
        """The curve."""
        return materials.Perfect(self.yield_stress)


class Linear(Part):
    """Linear hardening: y = yield_stress + modulus e."""

    curve: Literal["Linear"]
    """The word Linear."""
    yield_stress: Positive
    """First yield stress."""
    modulus: NotNegative
    """Slope over the plastic strain."""

    def build(self) -> Hardening:
        """The curve."""
        return materials.Linear(self.yield_stress, self.modulus)


class Voce(Part):
    """Voce hardening: y = saturation - (saturation - yield_stress) exp(-rate e)."""

    curve: Literal["Voce"]
    """The word Voce."""
    yield_stress: Positive
    """First yield stress."""
    saturation: Positive
    """Last yield stress."""
    rate: NotNegative
    """How fast the curve saturates."""

    def build(self) -> Hardening:
        """The curve."""
        return materials.Voce(self.yield_stress, self.saturation, self.rate)


class LinearVoce(Part):
    """Linear and Voce hardening together."""

    curve: Literal["LinearVoce"]
    """The word LinearVoce."""
    yield_stress: Positive
    """First yield stress."""
    modulus: NotNegative
    """Slope of the linear part."""
    saturation: Positive
    """Last yield stress of the Voce part."""
    rate: NotNegative
    """How fast the Voce part saturates."""

    def build(self) -> Hardening:
        """The curve."""
        return materials.LinearVoce(self.yield_stress, self.modulus, self.saturation, self.rate)


class Swift(Part):
    """Swift hardening: y = strength (offset + e)^exponent."""

    curve: Literal["Swift"]
    """The word Swift."""
    strength: Positive
    """K."""
    offset: Positive
    """e0."""
    exponent: Fraction
    """n."""

    def build(self) -> Hardening:
        """The curve."""
        return materials.Swift(self.strength, self.offset, self.exponent)


class Table(Part):
    """Points of a measured curve with straight lines between them, constant behind the last one."""

    curve: Literal["Table"]
    """The word Table."""
    eqps: Annotated[list[float], Field(min_length=2)]
    """Plastic strains, from 0."""
    stress: Annotated[list[float], Field(min_length=2)]
    """Yield stresses."""

    def build(self) -> Hardening:
        """The curve."""
        return materials.Table(tuple(self.eqps), tuple(self.stress))


Curve = Annotated[
    Perfect | Linear | Voce | LinearVoce | Swift | Table,
    Field(discriminator="curve"),
]


class J2(Elastic):
    """J2 plasticity at finite strains."""

    law: Literal["J2"]
    """The word J2."""
    hardening: Curve
    """Yield stress over the plastic strain."""

    def build(self) -> Material:
        """The law."""
        return materials.J2(**self._constants(), hardening=self.hardening.build())


class FromLibrary(Part):
    """A sheet metal of the library."""

    library: Annotated[str, Field(min_length=1)]
    """Its name."""

    def build(self) -> Material:
        """The law of the sheet metal."""
        return sheet_metals.get(self.library).law


MaterialPart = Annotated[
    Annotated[SVK, Tag("SVK")]
    | Annotated[NeoHooke, Tag("NeoHooke")]
    | Annotated[NeoHookePower, Tag("NeoHookePower")]
    | Annotated[J2, Tag("J2")]
    | Annotated[FromLibrary, Tag("library")],
    Discriminator(
        tagged_by("law", "library"),
        custom_error_type="law",
        custom_error_message="a material has law = SVK, NeoHooke, NeoHookePower or J2, or library = a name",
        custom_error_context={"key": "law", "expected_tags": "'SVK', 'NeoHooke', 'NeoHookePower', 'J2'"},
    ),
]
