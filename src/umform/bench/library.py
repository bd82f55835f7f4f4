"""What the form offers: sheet metals, dies and punches; and the tools with which an angle can be reached."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib.resources import files
from typing import Any

from umform import sheet_metals
from umform.bench.wanted import MESHES, WORKS, Wanted
from umform.errors import UmformError

#: Degrees between the wanted angle and that of the tools which leave room for springback.
ROOM = 4.0


@cache
def tools() -> dict[str, Any]:
    """Dies, angles of dies, and punches."""
    return tomllib.loads(files("umform.bench").joinpath("tools.toml").read_text(encoding="utf-8"))


@cache
def library() -> dict[str, Any]:
    """All that the page offers: metals, tools, meshes, defaults."""
    metals = [
        {
            "name": metal.name,
            "number": metal.number,
            "yield_stress": metal.yield_stress,
            "tensile_strength": metal.tensile_strength,
            "uniform_elongation": round(100.0 * metal.uniform_elongation, 1),
            "directional": getattr(metal.law, "directional", False),
            "card": metal.name in sheet_metals.cards(),
            "source": metal.source,
            "basis": metal.basis,
            "caveat": metal.caveat,
            "thicker": [_thicker(metal.name, limit) for limit in sheet_metals.limits(metal.name)],
        }
        for metal in map(sheet_metals.get, (*sheet_metals.names(), *sheet_metals.cards()))
    ]
    return {
        "metals": metals,
        "tools": tools(),
        "meshes": list(MESHES),
        "works": list(WORKS),
        "defaults": Wanted().model_dump(),
        "units": _units(),
    }


def _units() -> dict[str, str]:
    """Units of the fields of the form by their names; degrees as a sign."""
    rows = Wanted.model_json_schema()["properties"]
    said = {
        name: next((arm["unit"] for arm in (row, *row.get("anyOf", ())) if "unit" in arm), "")
        for name, row in rows.items()
    }
    return {name: "°" if unit == "degrees" else unit for name, unit in said.items() if unit}


def _thicker(name: str, limit: float) -> dict[str, float]:
    """Values of a metal from a thickness on."""
    metal = sheet_metals.get(name, limit)
    return {
        "from": limit,
        "yield_stress": metal.yield_stress,
        "tensile_strength": metal.tensile_strength,
        "uniform_elongation": round(100.0 * metal.uniform_elongation, 1),
    }


def tools_for(wanted: Wanted) -> dict[str, float | None] | None:
    """Die and punch of the library, nearest to those at hand, with which the wanted angle can be reached.

    Returns
    -------
    dict of str to float, or None
        The parameters to change, drawn tools are put away; None if there are none, or if no angle is wanted.
    """
    if wanted.work != "bend" or wanted.angle is None:
        return None
    most = wanted.angle - ROOM
    angles = [angle for angle in tools()["die_angles"] if angle <= most] or tools()["die_angles"][-1:]
    punches = [punch for punch in tools()["punches"] if punch["angle"] <= most] or tools()["punches"][-1:]
    for angle in angles:
        for punch in sorted(punches, key=lambda one: -float(one["angle"])):
            sizes = {"die_angle": angle, "punch_angle": punch["angle"], "punch_radius": punch["radius"]}
            change = {name: float(value) for name, value in sizes.items()} | {"punch": None, "die": None}
            try:
                wanted.model_copy(update=change).case()
            except UmformError:
                continue
            return change
    return None
