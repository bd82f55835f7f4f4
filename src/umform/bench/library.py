"""What the form offers: fields, sheet metals, dies and punches; and tools that reach an angle."""

from __future__ import annotations

import tomllib
from functools import cache
from importlib.resources import files
from typing import Any

from umform import sheet_metals
from umform.bench.form import MESHES, form_fields
from umform.bench.wanted import Wanted
from umform.errors import UmformError
from umform.processes.air_bending.spec import AirBending, sizes_of
from umform.processes.hemming.spec import ACUTE, scaled

#: What the default mesh has where others differ.
_USUAL_MESH = {name: getattr(AirBending, name) for mesh in MESHES.values() for name in mesh}
#: Sizes of the tools of a bend.
_USUAL_SIZES = {name: getattr(AirBending, name) for name in ACUTE}
#: Degrees between the wanted angle and that of the tools which leave room for springback.
ROOM = 4.0


@cache
def tools() -> dict[str, Any]:
    """Dies, angles of dies, and punches."""
    return tomllib.loads(files("umform.bench").joinpath("tools.toml").read_text(encoding="utf-8"))


@cache
def library() -> dict[str, Any]:
    """All that the page offers: fields of the form, metals, tools, meshes."""
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
        "meshes": {name: _USUAL_MESH | mesh for name, mesh in MESHES.items()},
        "fields": [{**one.record(), "usual": _usual_sizes(one.name)} for one in form_fields().values()],
        "proportions": {"hem": ACUTE, "": scaled(_USUAL_SIZES, 1.0 / AirBending.thickness)},
    }


def _usual_sizes(name: str) -> list[float]:
    """Sizes of the tools of the library that a field may have."""
    known = tools()
    offered = {
        sizes_of("die")["opening"]: [die["opening"] for die in known["dies"]],
        sizes_of("die")["angle"]: known["die_angles"],
        **{sizes_of("punch")[size]: [punch[size] for punch in known["punches"]] for size in ("angle", "radius")},
    }
    return list(dict.fromkeys(offered.get(name, [])))


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
    """Die and punch of the library that reach the wanted angle.

    Returns
    -------
    dict of str to float, or None
        The parameters to change, without drawn tools; None if no tools reach it, or no angle is wanted.
    """
    wished = wanted.goal.angle
    if wished is None:
        return None
    most = wished - ROOM
    angles = [angle for angle in tools()["die_angles"] if angle <= most] or tools()["die_angles"][-1:]
    punches = [punch for punch in tools()["punches"] if punch["angle"] <= most] or tools()["punches"][-1:]
    for angle in angles:
        for punch in sorted(punches, key=lambda one: -float(one["angle"])):
            sizes = {sizes_of("punch")[size]: float(value) for size, value in punch.items()}
            change = {sizes_of("die")["angle"]: float(angle), **sizes, "punch": None, "die": None}
            try:
                wanted.changed(change).case()
            except UmformError:
                continue
            return change
    return None
