"""Published cards of sheet metals: anisotropy, back stress and falling modulus, read from ``cards.toml``."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any

from umform import materials
from umform.materials import Hardening, Metal, YieldFunction
from umform.materials.known import known
from umform.sheet_metals.directional_fit import Directions
from umform.sheet_metals.sheet_metal import SheetMetal
from umform.sheet_metals.tension_test import tension_test

Row = Mapping[str, Any]


@cache
def card_rows() -> dict[str, Row]:
    """Content of the file, by the name of the metal."""
    return tomllib.loads(resources.files("umform.sheet_metals").joinpath("cards.toml").read_text(encoding="utf-8"))


def made_card(name: str) -> SheetMetal:
    """The sheet metal of a card."""
    row = card_rows()[name]
    law = _law(row)
    test = tension_test(law)
    stretch = 1.0 + test.uniform_elongation + test.tensile_strength / law.E
    return SheetMetal(
        name=name,
        number="",
        aliases=tuple(row.get("aliases", ())),
        law=law,
        young=float(row["E"]),
        poisson=float(row["nu"]),
        yield_stress=test.yield_stress,
        tensile_strength=test.tensile_strength,
        uniform_elongation=test.uniform_elongation,
        valid_strain=math.log(stretch) - test.tensile_strength * stretch / law.E,
        basis=row["basis"],
        source=row["source"],
        derived="R, Rm and Ag: tension along the rolling direction with this law",
        caveat=row["caveat"],
        measured=_measured(row.get("measured")),
    )


def _law(row: Row) -> Metal:
    parts: dict[str, Any] = {"yield_function": _yield_function(row.get("yield_function", {"function": "Mises"}))}
    if "two_surfaces" in row:
        parts["back_stress"] = materials.YoshidaUemori(**row["two_surfaces"])
    if "back_stress" in row:
        parts["back_stress"] = materials.Chaboche(row["back_stress"])
    if "modulus" in row:
        parts["modulus"] = materials.FallingModulus(**row["modulus"])
    constants = dict(row["hardening"])
    hardening = known(Hardening)[constants.pop("curve")](**constants)
    return Metal(E=float(row["E"]), nu=float(row["nu"]), hardening=hardening, **parts)


def _yield_function(row: Row) -> YieldFunction:
    constants = dict(row)
    kind = known(YieldFunction)[constants.pop("function")]
    parts = {
        name: materials.Transformation(**value) if isinstance(value, Mapping) else value
        for name, value in constants.items()
    }
    function: YieldFunction = kind(**parts)
    return function


def _measured(row: Row | None) -> Directions | None:
    if row is None:
        return None
    stress, r = ({float(angle): value for angle, value in row[which].items()} for which in ("stress", "r"))
    return Directions(stress, r, row.get("biaxial"), row.get("r_biaxial"))
