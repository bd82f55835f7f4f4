"""A law as a block of a deck and as Python, with six digits."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from umform.materials import J2, Metal, Perfect, YieldFunction
from umform.problem.material_keys import law_keys
from umform.problem.written import toml_line


def rounded_keys(law: J2 | Metal) -> dict[str, Any]:
    """Keys of the table [material], numbers with six digits; the rolling direction is x."""
    keys: dict[str, Any] = _rounded(law_keys(law, "x"))
    keys["hardening"] = _named(keys["hardening"])
    return keys


def _named(curve: dict[str, Any]) -> dict[str, Any]:
    """A curve of both parts of Voce by the name of the part that it has."""
    if curve["curve"] != "LinearVoce":
        return curve
    saturates = curve["rate"] > 0.0 and curve["saturation"] > curve["yield_stress"]
    if saturates and curve["modulus"] > 0.0:
        return curve
    linear = "Linear" if curve["modulus"] > 0.0 else "Perfect"
    name = "Voce" if saturates else linear
    kept = {"Voce": ("yield_stress", "saturation", "rate"), "Linear": ("yield_stress", "modulus")}
    return {"curve": name} | {key: curve[key] for key in kept.get(name, ("yield_stress",))}


def deck_block(law: J2 | Metal) -> str:
    """The table [material] of a deck."""
    return "\n".join(["[material]", *(toml_line(key, value) for key, value in rounded_keys(law).items())]) + "\n"


def python_code(law: J2 | Metal) -> str:
    """Python that makes the law."""
    keys = rounded_keys(law)
    arguments = [f"{name}={keys[name]!r}" for name in ("E", "nu", "kappa", "mu") if name in keys]
    arguments.append(f"hardening={_call(keys['hardening'], 'curve')}")
    if "yield_function" in keys:
        arguments.append(f"yield_function={_function(keys['yield_function'])}")
    if "back_stress" in keys:
        back = dict(keys["back_stress"])
        parts = ", ".join(f"({C!r}, {gamma!r})" for C, gamma in back.pop("parts"))
        arguments.append(f"back_stress=uf.Chaboche([{parts}]{''.join(f', {k}={v!r}' for k, v in back.items())})")
    for name, made in (("two_surfaces", "back_stress=uf.YoshidaUemori"), ("modulus", "modulus=uf.FallingModulus")):
        if name in keys:
            arguments.append(f"{made}({_arguments(keys[name])})")
    if "rate" in keys:
        arguments.append(f"rate={_call(keys['rate'], 'factor')}")
    inside = "".join(f"    {argument},\n" for argument in arguments)
    return f"import umform as uf\n\nmaterial = uf.{keys['law']}(\n{inside})\n"


def function_block(function: YieldFunction) -> tuple[str, str]:
    """A yield function without hardening: its line of a deck, and Python."""
    law = Metal(2e5, 0.3, hardening=Perfect(1.0), yield_function=function)
    keys = rounded_keys(law)["yield_function"]
    return toml_line("yield_function", keys) + "\n", f"yield_function = {_function(keys)}\n"


def _function(keys: Mapping[str, Any]) -> str:
    given = dict(keys)
    name = given.pop("function")
    if name == "Yld2004":
        first, second = (f"uf.Transformation({_arguments(given[which])})" for which in ("first", "second"))
        return f"uf.Yld2004({first}, {second}, {given['exponent']!r})"
    if "F" in given:
        return f"uf.Hill48.from_constants({_arguments(given)})"
    return f"uf.{name}({_arguments(given)})"


def _call(keys: Mapping[str, Any], kind: str) -> str:
    given = dict(keys)
    return f"uf.{given.pop(kind)}({_arguments(given)})"


def _arguments(constants: Mapping[str, Any]) -> str:
    return ", ".join(f"{name}={value!r}" for name, value in constants.items())


def _rounded(value: Any) -> Any:
    """Numbers of nested tables with six digits."""
    if isinstance(value, bool | str) or value is None:
        return value
    if isinstance(value, Mapping):
        return {name: _rounded(entry) for name, entry in value.items() if entry is not None}
    if isinstance(value, tuple | list):
        return [_rounded(entry) for entry in value]
    return float(f"{value:.6g}")
