"""The metals of a deck: J2, and composed ones."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from umform import materials
from umform.materials import Material, RateFactor, YieldFunction
from umform.problem.elastic import Elastic
from umform.problem.hardening import Curve
from umform.problem.parts import NotNegative, Pair, Part, Positive
from umform.problem.rolling import RollingPart


class J2(Elastic):
    """J2 plasticity at finite strains."""

    law: Literal["J2"]
    """The word J2."""
    hardening: Curve
    """Yield stress over the plastic strain."""

    def build(self) -> Material:
        """The law."""
        return materials.J2(**self.constants(), hardening=self.hardening.build())


class Mises(Part):
    """Von Mises: isotropic."""

    function: Literal["Mises"]
    """The word Mises."""

    def build(self) -> YieldFunction:
        """The yield function."""
        return materials.Mises()


class Hill48(Part):
    """Hill (1948) from three r-values, four yield stresses relative to the hardening curve, or Hill's constants."""

    function: Literal["Hill48"]
    """The word Hill48."""
    r0: Positive | None = None
    """Ratio of width to thickness strain in tension along the rolling direction."""
    r45: Positive | None = None
    """At 45 degrees to it."""
    r90: Positive | None = None
    """Across it."""
    s0: Positive | None = None
    """Yield stress along the rolling direction, relative to that of the curve."""
    s45: Positive | None = None
    """At 45 degrees to it."""
    s90: Positive | None = None
    """Across it."""
    biaxial: Positive | None = None
    """In equibiaxial tension."""
    F: float | None = None
    """Constant of (s22 - s33)^2."""
    G: float | None = None
    """Constant of (s33 - s11)^2."""
    H: float | None = None
    """Constant of (s11 - s22)^2."""
    N: Positive | None = None
    """Constant of 2 s12^2."""
    L: Positive | None = None
    """Constant of 2 s23^2; 1.5 by default."""
    M: Positive | None = None
    """Constant of 2 s13^2; 1.5 by default."""

    @model_validator(mode="after")
    def _is_one_set(self) -> Hill48:
        sets = ({"r0", "r45", "r90"}, {"s0", "s45", "s90", "biaxial"}, set("FGHN"))
        if set(self._given()) - set("LM" if self.N is not None else "") not in sets:
            raise PydanticCustomError(
                "constants", "give r0, r45 and r90, or s0, s45, s90 and biaxial, or F, G, H and N, and no others"
            )
        return self

    def _given(self) -> dict[str, float]:
        return self.model_dump(exclude={"function"}, exclude_none=True)

    def build(self) -> YieldFunction:
        """The yield function."""
        given = self._given()
        if "r0" in given:
            return materials.Hill48(**given)
        return (materials.Hill48.from_constants if "F" in given else materials.Hill48.from_stresses)(**given)


Exponent = Annotated[float, Field(ge=2, le=20)]


class Hosford(Part):
    """Hosford (1972): isotropic, with less curved sides than von Mises."""

    function: Literal["Hosford"]
    """The word Hosford."""
    exponent: Exponent = 8
    """From 2 to 20: 6 for bcc metals, 8 for fcc metals."""

    def build(self) -> YieldFunction:
        """The yield function."""
        return materials.Hosford(self.exponent)


class Yld91(Part):
    """Barlat's Yld91."""

    function: Literal["Yld91"]
    """The word Yld91."""
    a: float
    """Factor of s22 - s33."""
    b: float
    """Factor of s33 - s11."""
    c: float
    """Factor of s11 - s22."""
    f: float = 1.0
    """Factor of the shear 23."""
    g: float = 1.0
    """Factor of the shear 13."""
    h: float = 1.0
    """Factor of the shear 12."""
    exponent: Exponent = 8
    """From 2 to 20: 6 for bcc metals, 8 for fcc metals."""

    def build(self) -> YieldFunction:
        """The yield function."""
        return materials.Yld91(**self.model_dump(exclude={"function"}))


class Transformation(Part):
    """Linear map of the stress deviator: 1 is the rolling direction, 3 the normal of the sheet."""

    c12: float = 1.0
    """S_11 = -c12 s_22 - c13 s_33."""
    c13: float = 1.0
    """See c12."""
    c21: float = 1.0
    """S_22 = -c21 s_11 - c23 s_33."""
    c23: float = 1.0
    """See c21."""
    c31: float = 1.0
    """S_33 = -c31 s_11 - c32 s_22."""
    c32: float = 1.0
    """See c31."""
    shear12: float = 1.0
    """Factor of the shear 12, c66 of printed tables."""
    shear23: float = 1.0
    """Factor of the shear 23, c44 of printed tables."""
    shear13: float = 1.0
    """Factor of the shear 13, c55 of printed tables."""


class Yld2004(Part):
    """Yld2004-18p of Barlat et al. (2005)."""

    function: Literal["Yld2004"]
    """The word Yld2004."""
    first: Transformation
    """S'."""
    second: Transformation
    """S''."""
    exponent: Exponent = 8
    """From 2 to 20: 6 for bcc metals, 8 for fcc metals."""

    def build(self) -> YieldFunction:
        """The yield function."""
        first, second = (materials.Transformation(**part.model_dump()) for part in (self.first, self.second))
        return materials.Yld2004(first, second, self.exponent)


class BackStress(Part):
    """Back stresses of Chaboche."""

    parts: Annotated[list[Pair], Field(min_length=1, max_length=4)]
    """Modulus and recall of each: [C, gamma]."""
    first: Positive = 1.0
    """Initial factor of the moduli."""
    rate: NotNegative = 0.0
    """Rate of the change of the moduli with the plastic strain."""

    def build(self) -> materials.Chaboche:
        """The back stresses."""
        return materials.Chaboche(tuple(self.parts), self.first, self.rate)


class TwoSurfaces(Part):
    """Yoshida and Uemori (2002); the hardening curve is Perfect."""

    C: Positive
    """Rate of the translation of the yield surface relative to the bounding surface."""
    B: Positive
    """Initial size of the bounding surface, above the yield stress."""
    growth: NotNegative
    """R_sat: saturation value of the isotropic hardening of the bounding surface."""
    b: Positive
    """Saturation value of the back stress of the bounding surface."""
    m: Positive
    """Rate of both."""
    h: Annotated[float, Field(ge=0, le=1)]
    """Ratio of isotropic to kinematic hardening of the stagnation surface."""

    def build(self) -> materials.YoshidaUemori:
        """The back stress."""
        return materials.YoshidaUemori(**self.model_dump())


class Modulus(Part):
    """Young's modulus that falls with the plastic strain."""

    saturated: Positive
    """Limit of the modulus."""
    rate: Positive
    """Rate of the decrease."""


class CowperSymonds(Part):
    """Cowper and Symonds: 1 + (rate / reference)^(1 / exponent)."""

    factor: Literal["CowperSymonds"]
    """The word CowperSymonds."""
    reference: Positive
    """Plastic strain rate at which the yield stress is twice the static one."""
    exponent: Annotated[float, Field(ge=1, le=20)]
    """From 1 to 20."""

    def build(self) -> RateFactor:
        """The factor."""
        return materials.CowperSymonds(self.reference, self.exponent)


class JohnsonCook(Part):
    """Johnson and Cook: 1 + strength ln(rate / reference), 1 below the reference rate."""

    factor: Literal["JohnsonCook"]
    """The word JohnsonCook."""
    reference: Positive
    """Plastic strain rate of the hardening curve."""
    strength: Annotated[float, Field(ge=1e-3, le=1)]
    """C."""

    def build(self) -> RateFactor:
        """The factor."""
        return materials.JohnsonCook(self.reference, self.strength)


class Metal(Elastic):
    """Plasticity with a yield function, back stresses, a falling modulus and a rate factor."""

    law: Literal["Metal"]
    """The word Metal."""
    hardening: Curve
    """Size of the yield surface over the plastic strain."""
    yield_function: Annotated[
        Mises | Hill48 | Hosford | Yld91 | Yld2004, Field(discriminator="function", default=Mises(function="Mises"))
    ]
    """Shape of the yield surface."""
    rolling: RollingPart | None = None
    """Rolling direction: a direction, an angle to the bend line, or a file."""
    back_stress: BackStress | None = None
    """Motion of the yield surface."""
    two_surfaces: TwoSurfaces | None = None
    """The same by Yoshida and Uemori."""
    modulus: Modulus | None = None
    """Decrease of Young's modulus."""
    rate: Annotated[CowperSymonds | JohnsonCook, Field(discriminator="factor")] | None = None
    """Factor of the yield stress as a function of the plastic strain rate; time is that of the steps."""

    @model_validator(mode="after")
    def _knows_its_directions(self) -> Metal:
        if self.rolling is None and not isinstance(self.yield_function, Mises | Hosford):
            raise PydanticCustomError("rolling", 'a yield function with directions needs rolling: rolling = "x"')
        if self.back_stress is not None and self.two_surfaces is not None:
            raise PydanticCustomError("motion", "give back_stress or two_surfaces, not both")
        return self

    def build(self) -> Material:
        """The law."""
        parts: dict[str, Any] = {"hardening": self.hardening.build(), "yield_function": self.yield_function.build()}
        motion = self.back_stress or self.two_surfaces
        if motion is not None:
            parts["back_stress"] = motion.build()
        if self.modulus is not None:
            parts["modulus"] = materials.FallingModulus(**self.modulus.model_dump())
        if self.rate is not None:
            parts["rate"] = self.rate.build()
        return materials.Metal(**self.constants(), **parts)
