"""A law as a block of a deck and as Python, with six digits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import is_dataclass
from typing import Any

from umform.materials import J2, FallingModulus, Metal, YieldFunction
from umform.materials.yield_functions import Function
from umform.problem.deck_text import toml_line
from umform.problem.keys import given, keys_of, law_keys


def rounded_keys(law: J2 | Metal) -> dict[str, Any]:
    """Keys of the table [material], numbers with six digits; the rolling direction is x."""
    keys: dict[str, Any] = _rounded(law_keys(law, "x"))
    return keys


def deck_block(law: J2 | Metal) -> str:
    """The table [material] of a deck."""
    return "\n".join(["[material]", *(toml_line(key, value) for key, value in rounded_keys(law).items())]) + "\n"


def python_code(law: J2 | Metal) -> str:
    """Python that makes the law."""
    inside = "".join(f"    {one.name}={_code(value)},\n" for _, one, value in given(law))
    return f"import umform as uf\n\nmaterial = uf.{type(law).__name__}(\n{inside})\n"


def function_block(function: YieldFunction) -> tuple[str, str]:
    """A yield function without hardening: its line of a deck, and Python."""
    keys = _rounded(keys_of(Function, function))
    return toml_line("yield_function", keys) + "\n", f"yield_function = {_code(function)}\n"


def modulus_block(modulus: FallingModulus) -> tuple[str, str]:
    """A falling modulus: its line of a deck, and Python."""
    return toml_line("modulus", _rounded(vars(modulus))) + "\n", f"modulus = {_code(modulus)}\n"


def _code(value: Any) -> str:
    """A value in Python."""
    if not is_dataclass(value):
        return repr(_rounded(value))
    return f"uf.{type(value).__name__}({', '.join(f'{one.name}={_code(part)}' for _, one, part in given(value))})"


def _rounded(value: Any) -> Any:
    """Numbers of nested tables with six digits."""
    if isinstance(value, bool | str) or value is None:
        return value
    if isinstance(value, Mapping):
        return {name: _rounded(entry) for name, entry in value.items()}
    if isinstance(value, tuple | list):
        return [_rounded(entry) for entry in value]
    return float(f"{value:.6g}")
