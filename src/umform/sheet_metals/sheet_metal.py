"""A sheet metal with its source and its limits."""

from __future__ import annotations

from dataclasses import dataclass

from umform.materials import J2, Metal
from umform.sheet_metals.directional_fit import Directions


@dataclass(frozen=True)
class SheetMetal:
    """A sheet metal with its source and its limits. Units N, mm, MPa.

    Attributes
    ----------
    name : str
        Its name.
    number : str
        Material number, where it has one.
    aliases : tuple of str
        Other names.
    law : J2 or Metal
        Its law; an anisotropic one needs the rolling direction.
    young, poisson : float
        Elastic constants.
    yield_stress, tensile_strength : float
        Rp0.2 or the yield point, and Rm: values of the source; for a published card, tension along the rolling
        direction.
    uniform_elongation : float
        Ag, plastic elongation at the largest force as a fraction; derived.
    valid_strain : float
        Plastic strain at the largest force. Beyond it the curve is an extrapolation.
    basis : str
        Selected values of the source.
    source : str
        References; keys are those of ``references.bib``.
    derived : str
        Quantities that are not in the source, and their derivation.
    caveat : str
        Effects that the law omits, and the scatter between coils.
    measured : Directions, optional
        Yield stresses and r-values of the source.
    """

    name: str
    number: str
    aliases: tuple[str, ...]
    law: J2 | Metal
    young: float
    poisson: float
    yield_stress: float
    tensile_strength: float
    uniform_elongation: float
    valid_strain: float
    basis: str
    source: str
    derived: str
    caveat: str
    measured: Directions | None = None

    @property
    def note(self) -> str:
        """Name, source, limits, and the values in use."""
        used = f"used here: R {self.yield_stress:.4g}, Rm {self.tensile_strength:.4g} MPa ({self.basis})"
        return f"{self.name}: {self.source}; {self.caveat}; {used}"

    def __str__(self) -> str:
        lines = [
            f"{self.name}: R {self.yield_stress:.4g} MPa, Rm {self.tensile_strength:.4g} MPa, "
            f"Ag {100 * self.uniform_elongation:.1f} %, E {self.young:g} MPa, nu {self.poisson:g} ({self.basis})",
            f"  law:     {self.law.hardening}",
        ]
        if isinstance(self.law, Metal):
            parts = (self.law.yield_function, self.law.back_stress, self.law.modulus)
            lines += [f"           {part}" for part in parts if part is not None]
        notes = {"source": self.source, "derived": self.derived, "caveat": self.caveat}
        return "\n".join([*lines, *(f"  {what + ':':8s} {text}" for what, text in notes.items() if text)])
