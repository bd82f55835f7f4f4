"""The table ``[material]`` of a deck from a law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, fields, is_dataclass
from typing import Any

from umform.errors import InvalidValue
from umform.materials import (
    J2,
    Chaboche,
    CowperSymonds,
    Hill48,
    JohnsonCook,
    LinearVoce,
    Metal,
    Mises,
    Swift,
    Table,
    YieldFunction,
    Yld2004,
    YoshidaUemori,
)


def law_keys(law: J2 | Metal, rolling: object = None) -> dict[str, Any]:
    """Keys of the table ``[material]`` for a law, exact to the last bit; defaults are left out.

    Parameters
    ----------
    law : J2 or Metal
        The law.
    rolling : optional
        Deck value of the rolling direction of an anisotropic law: "x", or { angle = 45 } as a mapping.

    Raises
    ------
    InvalidValue
        If a deck cannot express its hardening or its yield function.
    """
    keys: dict[str, Any] = {"law": type(law).__name__, **_elastic(law), "hardening": _hardening(law)}
    if not isinstance(law, Metal):
        return keys
    keys["yield_function"] = _yield_function(law.yield_function)
    if law.directional:
        keys["rolling"] = rolling
    if isinstance(law.back_stress, Chaboche):
        constants = asdict(law.back_stress)
        keys["back_stress"] = constants if law.back_stress.rate else {"parts": constants["parts"]}
    elif isinstance(law.back_stress, YoshidaUemori):
        keys["two_surfaces"] = asdict(law.back_stress)
    if law.modulus is not None:
        keys["modulus"] = asdict(law.modulus)
    if isinstance(law.rate, CowperSymonds | JohnsonCook):
        keys["rate"] = {"factor": type(law.rate).__name__, **asdict(law.rate)}
    return keys


def written_out(material: Any) -> Any:
    """The table of a sheet metal of the library with its law in place of its name; any other as it is."""
    from umform import sheet_metals

    if not isinstance(material, Mapping) or not isinstance(material.get("library"), str):
        return material
    law = sheet_metals.get(material["library"]).law
    assert isinstance(law, J2 | Metal)
    return law_keys(law, material.get("rolling"))


def _elastic(law: J2 | Metal) -> dict[str, float]:
    E, nu = float(f"{law.E:.12g}"), float(f"{law.nu:.12g}")
    again = J2(E, nu, hardening=law.hardening)
    same = (again.kappa, again.mu) == (law.kappa, law.mu)
    return {"E": E, "nu": nu} if same else {"kappa": law.kappa, "mu": law.mu}


def _hardening(law: J2 | Metal) -> dict[str, Any]:
    curve = law.hardening
    if not isinstance(curve, LinearVoce | Swift | Table) or not is_dataclass(curve):
        raise _no_words("hardening", "hardening curve", curve, "a curve of your own", "give its points as a Table")
    return {"curve": type(curve).__name__} | {part.name: getattr(curve, part.name) for part in fields(curve)}


def _yield_function(function: YieldFunction) -> dict[str, Any]:
    match function:
        case Mises():
            return {"function": "Mises"}
        case Hill48():
            return {"function": "Hill48", **_hill48(function)}
        case Yld2004():
            first, second = _shortened(asdict(function.first)), _shortened(asdict(function.second))
            if not function.directional:
                return {"function": "Hosford", "exponent": function.exponent}
            return {"function": "Yld2004", "exponent": function.exponent, "first": first, "second": second}
        case _:
            raise _no_words("yield_function", "yield function", function, "a function of your own", "run it in Python")


def _hill48(function: Hill48) -> dict[str, float]:
    """Its r-values if they give the same function to the last bit, else its constants."""
    r0, r45, r90 = function.r_values
    rounded = {"r0": float(f"{r0:.12g}"), "r45": float(f"{r45:.12g}"), "r90": float(f"{r90:.12g}")}
    return rounded if Hill48(**rounded) == function else asdict(function)


def _shortened(coefficients: Mapping[str, float]) -> dict[str, float]:
    """Coefficients other than 1."""
    return {name: value for name, value in coefficients.items() if value != 1.0}


def _no_words(where: str, what: str, value: object, cause: str, remedy: str) -> InvalidValue:
    return InvalidValue(f"a deck has no words for this {what}", where=where, value=value, cause=cause, remedy=remedy)
