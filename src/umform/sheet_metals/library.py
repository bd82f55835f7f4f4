"""The sheet metals themselves: read from ``metals.toml``, with their flow curves derived."""

from __future__ import annotations

import difflib
import math
import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from umform.errors import InvalidValue
from umform.materials import J2, Hardening
from umform.sheet_metals.tensile_test import swift_from_tensile_test, voce_from_tensile_test

_CURVES: dict[str, Callable[[float, float, float, float], Hardening]] = {
    "Swift": swift_from_tensile_test,
    "Voce": voce_from_tensile_test,
}

_RULES = {
    "n": "true strain n at the largest force",
    "steel": "strain 0.6 (1 - R/Rm) at the largest force [YunGardner2017]",
    "stainless": "strain 1 - R/Rm at the largest force [EN1993_4_2006]",
    "aluminium": "strain 0.30 - 0.22 R/400 at the largest force [EN1999_2007]",
}


@dataclass(frozen=True)
class SheetMetal:
    """A sheet metal with what is known of it. Units N, mm, MPa.

    Attributes
    ----------
    name : str
        Its name.
    number : str
        Material number, where it has one.
    aliases : tuple of str
        Other names.
    law : J2
        The law that a model takes.
    young, poisson : float
        Elastic constants.
    yield_stress, tensile_strength : float
        Rp0.2 or the yield point, and Rm: numbers of the source.
    uniform_elongation : float
        Ag, plastic elongation at the largest force as a fraction; derived.
    valid_strain : float
        Plastic strain at the largest force. Beyond it the curve is an extrapolation.
    basis : str
        Which of the values of the source are taken.
    source : str
        Where they stand; keys are those of ``references.bib``.
    derived : str
        What is not in the source, and how it was derived.
    caveat : str
        What the law leaves out, and how far coils differ.
    """

    name: str
    number: str
    aliases: tuple[str, ...]
    law: J2
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

    def __str__(self) -> str:
        return "\n".join(
            [
                f"{self.name}: R {self.yield_stress:g} MPa, Rm {self.tensile_strength:g} MPa, "
                f"Ag {100 * self.uniform_elongation:.1f} %, E {self.young:g} MPa, nu {self.poisson:g} ({self.basis})",
                f"  law:     {self.law.hardening}",
                f"  source:  {self.source}",
                f"  derived: {self.derived}",
                f"  caveat:  {self.caveat}",
            ]
        )


def names() -> tuple[str, ...]:
    """Names of all sheet metals of the library."""
    return tuple(_data())


def get(name: str) -> SheetMetal:
    """Sheet metal of a name.

    Parameters
    ----------
    name : str
        Name, material number or another name, as ``"DC04"``, ``"1.0338"``, ``"AISI 304"``, ``"AlMg3"``; spaces, hyphens
        and capitals do not matter.

    Returns
    -------
    SheetMetal
        Its ``law`` is what a model takes; N, mm, MPa.

    Raises
    ------
    InvalidValue
        If the library has no such metal; the message names the nearest one.
    """
    known = _known()
    key = _plain(name)
    if key in known:
        return _made(known[key])
    near = difflib.get_close_matches(key, known, n=1, cutoff=0.5)
    raise InvalidValue(
        "the library has no sheet metal of that name",
        where="sheet_metals",
        value=name,
        cause=f"perhaps {known[near[0]]} is meant" if near else "",
        remedy=f"choose one of {', '.join(names())}, or make a law from a certificate: swift_from_tensile_test",
    )


def _plain(name: str) -> str:
    return re.sub(r"[\s_-]+", "", str(name)).casefold()


@cache
def _data() -> dict[str, dict[str, Any]]:
    text = resources.files("umform.sheet_metals").joinpath("metals.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


@cache
def _known() -> dict[str, str]:
    """Plain form of all names and aliases, with the name of the metal."""
    return {
        _plain(other): name
        for name, row in _data().items()
        for other in (name, row["number"], *row["aliases"])
        if other
    }


def _strain_at_largest_force(row: dict[str, Any]) -> float:
    """Total elongation at the largest force, by the rule of the metal."""
    R = float(row["yield_stress"])
    ratio = R / float(row["tensile_strength"])
    match row["uniform"]:
        case "n":
            return math.expm1(float(row["n"]))
        case "steel":
            return 0.6 * (1.0 - ratio)
        case "stainless":
            return 1.0 - ratio
        case _:
            return 0.30 - 0.22 * R / 400.0


@cache
def _made(name: str) -> SheetMetal:
    row = _data()[name]
    young, strength = float(row["young"]), float(row["tensile_strength"])
    elongation = _strain_at_largest_force(row) - strength / young
    curve = _CURVES[row["curve"]](float(row["yield_stress"]), strength, elongation, young)
    law = J2(E=young, nu=float(row["poisson"]), hardening=curve)
    stretch = 1.0 + elongation + strength / young
    return SheetMetal(
        name=name,
        number=row["number"],
        aliases=tuple(row["aliases"]),
        law=law,
        young=young,
        poisson=float(row["poisson"]),
        yield_stress=float(row["yield_stress"]),
        tensile_strength=strength,
        uniform_elongation=elongation,
        valid_strain=math.log(stretch) - strength * stretch / young,
        basis=row["basis"],
        source=row["source"],
        derived=f"{_RULES[row['uniform']]}; {row['curve']} curve through R, Rm and this strain",
        caveat=row["caveat"],
    )
