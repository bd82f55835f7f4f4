"""The hardening curves of a deck."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from umform import materials
from umform.materials import Hardening
from umform.problem.parts import NotNegative, Part, Positive

Fraction = Annotated[float, Field(ge=0, le=1)]


class Perfect(Part):
    """Perfect plasticity: y = yield_stress."""

    curve: Literal["Perfect"]
    """The word Perfect."""
    yield_stress: Positive
    """Initial yield stress."""

    def build(self) -> Hardening:
        """The curve."""
        return materials.Perfect(self.yield_stress)


class Linear(Part):
    """Linear hardening: y = yield_stress + modulus e."""

    curve: Literal["Linear"]
    """The word Linear."""
    yield_stress: Positive
    """Initial yield stress."""
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
    """Initial yield stress."""
    saturation: Positive
    """Saturation stress."""
    rate: NotNegative
    """Rate of saturation."""

    def build(self) -> Hardening:
        """The curve."""
        return materials.Voce(self.yield_stress, self.saturation, self.rate)


class LinearVoce(Part):
    """Sum of linear and Voce hardening."""

    curve: Literal["LinearVoce"]
    """The word LinearVoce."""
    yield_stress: Positive
    """Initial yield stress."""
    modulus: NotNegative
    """Slope of the linear part."""
    saturation: Positive
    """Saturation stress of the Voce part."""
    rate: NotNegative
    """Rate of saturation of the Voce part."""

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
    """Piecewise linear curve through measured points, constant beyond the last one."""

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
