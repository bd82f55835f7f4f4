"""The sheet metals by name: those of ``metals.toml``, with their flow curves derived, and the published cards."""

from __future__ import annotations

import difflib
import math
import re
import tomllib
from collections.abc import Callable
from functools import cache
from importlib import resources
from typing import Any

from umform.errors import InvalidValue
from umform.materials import J2, Hardening, Metal
from umform.sheet_metals.cards import card_rows, made_card
from umform.sheet_metals.sheet_metal import SheetMetal
from umform.sheet_metals.tensile_test import swift_from_tensile_test, voce_from_tensile_test
from umform.spec import check_arguments
from umform.spec.types import Positive

_CURVES: dict[str, Callable[[float, float, float, float], Hardening]] = {
    "Swift": swift_from_tensile_test,
    "Voce": voce_from_tensile_test,
}

_RULES = {
    "n": "true strain n at the largest force",
    "steel": "strain 0.6 (1 - R/Rm) at the largest force [YunGardner2017]",
    "stainless": "strain 1 - R/Rm at the largest force [EN1993_4_2006]",
    "aluminium": "strain 0.30 - 0.22 R/400 at the largest force [EN1999_2007]",
    "measured": "Ag as it was measured",
}


def names() -> tuple[str, ...]:
    """Names of the isotropic sheet metals, whose flow curves are derived from standards."""
    return tuple(_data())


def cards() -> tuple[str, ...]:
    """Names of the published cards: anisotropy, back stress, falling modulus."""
    return tuple(card_rows())


def get(name: str, thickness: Positive | None = None) -> SheetMetal:
    """Sheet metal by name.

    Parameters
    ----------
    name : str
        Name, material number or another name, as ``"DC04"``, ``"1.0338"``, ``"AISI 304"``, ``"AA6016-T4"``; spaces,
        hyphens and capitals do not matter.
    thickness : float, optional
        Thickness of the sheet in mm, where the values of the standard depend on it; default: those of thin sheet.

    Returns
    -------
    SheetMetal
        Its ``law`` is for a model; N, mm, MPa.

    Raises
    ------
    InvalidValue
        If the library has no such metal; the message names the most similar one. If the thickness is not positive.
    """
    check_arguments(get, thickness=thickness)
    known = _known()
    key = _plain(name)
    if key in known:
        return _made(known[key], _range(known[key], thickness))
    near = difflib.get_close_matches(key, known, n=1, cutoff=0.5)
    raise InvalidValue(
        "the library has no sheet metal of that name",
        where="sheet_metals",
        value=name,
        cause=f"perhaps {known[near[0]]} is meant" if near else "",
        remedy=f"choose one of {', '.join((*names(), *cards()))}, or make a law from a certificate: "
        "swift_from_tensile_test",
    )


def name_of(law: object) -> str:
    """Name of the metal whose law this is; empty if the library has none."""
    if not isinstance(law, J2 | Metal):
        return ""
    rows = card_rows() if isinstance(law, Metal) else _data()
    young = "E" if isinstance(law, Metal) else "young"
    near = [name for name, row in rows.items() if float(row[young]) == law.E]  # to derive a curve takes milliseconds
    ranges = [(name, n) for name in near for n in range(len(rows[name].get("thicker", [])) + 1)]
    return next((name for name, n in ranges if _made(name, n).law == law), "")


def sheet_text(law: object, thickness: float) -> str:
    """A sheet in a title: "DC04, 2 mm", or "2 mm sheet" if the library does not know its law."""
    name = name_of(law)
    return f"{name}, {thickness:g} mm" if name else f"{thickness:g} mm sheet"


def _plain(name: str) -> str:
    return re.sub(r"[\s_-]+", "", str(name)).casefold()


@cache
def _data() -> dict[str, dict[str, Any]]:
    text = resources.files("umform.sheet_metals").joinpath("metals.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


@cache
def _known() -> dict[str, str]:
    """Plain form of all names and aliases, with the name of the metal."""
    rows = {**_data(), **card_rows()}
    return {
        _plain(other): name
        for name, row in rows.items()
        for other in (name, row.get("number", ""), *row.get("aliases", ()))
        if other
    }


def _strain_at_largest_force(row: dict[str, Any]) -> float:
    """Total elongation at the largest force, by the empirical rule of the metal."""
    R = float(row["yield_stress"])
    ratio = R / float(row["tensile_strength"])
    match row["uniform"]:
        case "n":
            return math.expm1(float(row["n"]))
        case "steel":
            return 0.6 * (1.0 - ratio)
        case "stainless":
            return 1.0 - ratio
        case "measured":
            return float(row["measured"])
        case _:
            return 0.30 - 0.22 * R / 400.0


def of_certificate(
    name: str, yield_stress: float, tensile_strength: float, uniform_elongation: float | None = None
) -> SheetMetal:
    """Sheet metal of the library with R, Rm and Ag of a coil; a Voce curve if no Swift curve meets them.

    Parameters
    ----------
    name : str
        Metal of the coil; one whose curve is derived from a standard.
    yield_stress, tensile_strength : float
        Re or Rp0.2, and Rm of the certificate, in MPa.
    uniform_elongation : float, optional
        Ag as a fraction; default: by the rule of the metal, from R and Rm.

    Raises
    ------
    InvalidValue
        If the metal is a published card, or no curve of its kind has these properties.

    Examples
    --------
    >>> coil = of_certificate("DC04", 160, 295)
    >>> coil.tensile_strength
    295.0
    """
    metal = get(name)
    if metal.name in card_rows():
        raise InvalidValue(
            "a published card has a law of its own, which R and Rm do not determine",
            where="material",
            value=name,
            cause="the numbers of a coil are given beside it",
            remedy=f"one of {', '.join(names())}",
        )
    row = {**_data()[metal.name], "yield_stress": yield_stress, "tensile_strength": tensile_strength}
    if uniform_elongation is not None:
        row |= {"uniform": "measured", "measured": uniform_elongation + tensile_strength / float(row["young"])}
    row |= {"basis": "values of a coil", "source": f"R and Rm of a coil; the rest as {metal.name}: {metal.source}"}
    try:
        return _from_row(metal.name, row)
    except InvalidValue:
        if row["curve"] == "Voce":
            raise
        return _from_row(metal.name, row | {"curve": "Voce"})


def limits(name: str) -> list[float]:
    """Thicknesses in mm from which on the standard has other values, ascending."""
    return [float(row["from"]) for row in _data().get(get(name).name, {}).get("thicker", [])]


def _range(name: str, thickness: float | None) -> int:
    """Number of ranges of thickness below the one of a sheet."""
    rows = _data().get(name, {}).get("thicker", [])
    return 0 if thickness is None else sum(thickness >= row["from"] for row in rows)


@cache
def _made(name: str, thicker: int) -> SheetMetal:
    if name in card_rows():
        return made_card(name)
    row = _data()[name]
    for change in row.get("thicker", [])[:thicker]:
        row = row | change
    return _from_row(name, row)


def _from_row(name: str, row: dict[str, Any]) -> SheetMetal:
    """Sheet metal whose curve goes through R, Rm and the strain at the largest force."""
    young, strength = float(row["young"]), float(row["tensile_strength"])
    elongation = _strain_at_largest_force(row) - strength / young
    curve = _CURVES[row["curve"]](float(row["yield_stress"]), strength, elongation, young)
    law = J2(E=young, nu=float(row["poisson"]), hardening=curve)
    stretch = 1.0 + elongation + strength / young
    return SheetMetal(
        name=name,
        number=row["number"],
        aliases=tuple(row.get("aliases", ())),
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
