"""Check that drawings and metals of the library are in the units that a deck names."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from umform.problem.findings import Finding, warning
from umform.problem.lines import Path
from umform.problem.material import FromLibrary
from umform.problem.problem import Problem
from umform.surfaces import Drawing
from umform.surfaces.dxf import MILLIMETRE

#: Other names of the inch.
_INCH = dict.fromkeys(("inch", "inches"), "in")
#: Names of units of force, and a newton in each of them.
_NEWTON = {"N": 1.0, "mN": 1e3, "kN": 1e-3, "MN": 1e-6, "kgf": 1.0 / 9.80665, "lbf": 1.0 / 4.4482216}
#: Keys of profiles, and of a list of them.
_PROFILES, _LIST = ("profile", "outline", "line"), "holes"


def named_units(deck: Problem) -> Iterator[Finding]:
    """Warn of drawings, and of a metal of the library, that are read in other units than those of `[units]`."""
    named, force = deck.contents.units.length, deck.contents.units.force
    length = _INCH.get(named, named)
    if isinstance(deck.contents.material, FromLibrary):
        newton, millimetre = _NEWTON.get(force or "N"), MILLIMETRE.get(length or "mm")
        if newton and millimetre and abs(newton / millimetre**2 - 1.0) > 1e-3:
            both = " and ".join(filter(None, [named, force]))
            text = f"the library has MPa, which is N and mm, and [units] names {both}"
            yield warning("units", text, 'length = "mm" and force = "N", or the law with its numbers in other units')
    if length not in MILLIMETRE:
        return
    for name, part in deck.contents.tools.items():
        if isinstance(part.tool, Drawing) and not part.tool.file.lower().endswith(".stl"):
            scale = MILLIMETRE[length]
            if abs(part.tool.scale / scale - 1.0) > 1e-3:
                text = f"its drawing is read in mm times {part.tool.scale:g}, and [units] names {named}"
                yield warning(f"tool {name}", text, f"scale = {scale:.6g}")
    for path, unit in _drawn(deck.source.data):
        if unit != length:
            text = f"its drawing is converted to {unit}, and [units] names {named}"
            yield warning(".".join(map(str, path)), text, f'unit = "{length}" beside file')


def length_of(deck: Problem) -> str:
    """Unit of the lengths of a deck as drawings name it: mm where it names none, or one that they do not know."""
    named = deck.contents.units.length
    length = _INCH.get(named, named)
    return length if length in MILLIMETRE else "mm"


def _drawn(data: Any, path: Path = ()) -> Iterator[tuple[Path, str]]:
    """Places of profiles from DXF drawings, and the unit that each is converted to."""
    if len(path) > 1 and (path[-1] in _PROFILES or path[-2] == _LIST):
        if isinstance(data, str):
            yield path, "mm"
        elif isinstance(data, dict) and isinstance(data.get("file"), str):
            yield path, data.get("unit", "mm")
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, entry in entries:
        yield from _drawn(entry, (*path, key))
