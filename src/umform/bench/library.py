"""What the form offers: fields, sheet metals, dies and punches; and tools that reach an angle."""

from __future__ import annotations

from functools import cache
from typing import Any

from umform import sheet_metals
from umform.bench.form import DRAW_MESHES, DRAWS, MESHES, form_fields
from umform.bench.wanted import Wanted
from umform.errors import UmformError
from umform.processes.air_bending.spec import AirBending, sizes_of
from umform.processes.air_bending.usual_tools import usual_tools
from umform.processes.hemming.spec import ACUTE, scaled

#: What the default mesh has where others differ.
_USUAL_MESH = {name: getattr(AirBending, name) for mesh in MESHES.values() for name in mesh}
#: Sizes of the tools of a bend.
_USUAL_SIZES = {name: getattr(AirBending, name) for name in ACUTE}
#: Usual opening over the thickness.
RATIO = 8.0
#: Degrees between the wanted angle and that of the tools which leave room for springback.
ROOM = 4.0


@cache
def tools() -> dict[str, list[dict[str, Any]]]:
    """Usual dies and punches: their names, and their sizes by the names of the fields."""
    return {kind: [{"name": one.name, "sizes": one.sizes} for one in usual_tools(kind)] for kind in ("die", "punch")}


@cache
def library() -> dict[str, Any]:
    """All that the page offers: fields of the form, metals, tools, meshes."""
    metals = [
        {
            "name": metal.name,
            "number": metal.number,
            "aliases": list(metal.aliases),
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
        "meshes": {name: _USUAL_MESH | mesh | _of_draws(name) for name, mesh in MESHES.items()},
        "fields": [{**one.record(), "usual": _usual_sizes(one.name)} for one in form_fields().values()],
        "proportions": {"hem": ACUTE, "": scaled(_USUAL_SIZES, 1.0 / AirBending.thickness)},
    }


def _of_draws(mesh: str) -> dict[str, Any]:
    """What a mesh has for drawn parts, by the names of the fields."""
    found: dict[str, Any] = {}
    for work, meshes in DRAW_MESHES.items():
        names = {name for one in meshes.values() for name in one}
        usual = {name: getattr(DRAWS[work], name) for name in names}
        found |= {f"{work}_{name}": value for name, value in (usual | meshes[mesh]).items()}
    return found


def _usual_sizes(name: str) -> list[float]:
    """Sizes of the tools of the library that a field may have."""
    known = {one["sizes"][name] for kind in tools().values() for one in kind if name in one["sizes"]}
    return sorted(known)


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
    """Die and punch of the library that reach the wanted angle; the opening stays, if it has such a die.

    Returns
    -------
    dict of str to float, or None
        The parameters to change, without drawn tools; None if no tools reach it, or no angle is wanted.
    """
    wished = wanted.goal.angle
    if wished is None:
        return None
    names, tip, radius = sizes_of("die"), sizes_of("punch")["angle"], sizes_of("punch")["radius"]
    opening, thickness = float(wanted.values["opening"]), float(wanted.values["thickness"])
    dies = [one["sizes"] for one in tools()["die"] if one["sizes"][names["angle"]] <= wished - ROOM]
    if opening not in {die[names["opening"]] for die in dies}:  # any opening may be typed
        dies += [{**die, names["opening"]: opening} for die in _nearest(dies, opening)]
    punches = [one["sizes"] for one in tools()["punch"] if one["sizes"][tip] <= wished - ROOM]
    dies = [die for of in (opening, RATIO * thickness) for die in _nearest(dies, of)]
    for die in sorted(dies, key=lambda one: (abs(one[names["opening"]] - opening), -one[names["angle"]])):
        for punch in sorted(punches, key=lambda one: (-one[tip], abs(one[radius] - thickness))):
            change = {**die, **punch, "punch": None, "die": None}
            try:
                wanted.changed(change).case()
            except UmformError:
                continue
            return {name: value for name, value in change.items() if wanted.values.get(name) != value}
    return None


def _nearest(dies: list[dict[str, float]], opening: float) -> list[dict[str, float]]:
    """The dies whose opening is nearest to one."""
    name = sizes_of("die")["opening"]
    nearest = min((abs(die[name] - opening) for die in dies), default=0.0)
    return [die for die in dies if abs(die[name] - opening) == nearest]
