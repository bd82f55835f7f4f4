"""The jobs of the corpus: their names, how they run and with which numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from corpus import parts, ready, sections
from corpus.answers import LEFT_RIGHT, Answer, unlike
from corpus.laws import LAWS
from corpus.sections import Sheet
from umform.processes.draw.cup import Cup
from umform.processes.draw.u_bend import UBend


@dataclass(frozen=True)
class Watched:
    """A job: its kind, what is special about it, how it runs; how with twice the increments, if it gives them."""

    kind: str
    special: str
    run: Callable[[], Answer]
    finer: Callable[[], Answer] | None = None

    @property
    def name(self) -> str:
        """Kind and what is special."""
        return f"{self.kind}, {self.special}"


def _of(function: Callable[..., Answer], kind: str) -> Callable[..., Watched]:
    """Jobs of a kind by their special keys; ``steps`` can be doubled, an ``increment`` halved."""

    def job(special: str, **keys: Any) -> Watched:
        halved = {name: factor * keys[name] for name, factor in (("steps", 2), ("increment", 0.5)) if name in keys}
        finer = partial(function, **keys | halved) if halved else None
        return Watched(kind, special, partial(function, **keys), finer)

    return job


_SHEET = Sheet()


def _section(function: Callable[..., Answer], kind: str) -> Callable[..., Watched]:
    """The same for sections of sheets; the keys of the sheet are those of `Sheet`."""

    def run(sheet: Sheet, **keys: Any) -> Answer:
        return function(sheet, **keys)

    def job(special: str, *, sheet: Sheet = _SHEET, **keys: Any) -> Watched:
        finer = None if sheet.steps is None else partial(run, replace(sheet, steps=2 * sheet.steps), **keys)
        return Watched(kind, special, partial(run, sheet, **keys), finer)

    return job


def twice(function: Callable[..., Answer], sheet: Sheet, other: Sheet, **keys: Any) -> Answer:
    """The same job reflected, or in other units: both balances, and how much the answers differ."""
    one, image = function(sheet, **keys), function(other, **keys)
    reflection = LEFT_RIGHT if other.mirrored else LEFT_RIGHT @ LEFT_RIGHT
    off = unlike(one.results[0].model, image.results[0].model, reflection, sheet.length / other.length)
    return Answer([*one.results, *image.results], [*one.symmetry, off], [*one.tools, *image.tools])


def _twice(kind: str, special: str, function: Callable[..., Answer], other: dict[str, Any], **keys: Any) -> Watched:
    sheet = keys.pop("sheet", Sheet())

    def of(sheet: Sheet) -> Callable[[], Answer]:
        return partial(twice, function, sheet, replace(sheet, **other), **keys)

    finer = None if sheet.steps is None else of(replace(sheet, steps=2 * sheet.steps))
    return Watched(kind, special, of(sheet), finer)


_air = _of(ready.air_bend, "air bend")
_bottoming = partial(_of(ready.air_bend, "bottoming"), travel=0.0)
_hem, _sequence = _of(ready.hem, "hem"), _of(ready.sequence, "two bends")
_bead, _beaded = _of(ready.bead, "draw bead"), _of(parts.beaded, "equivalent bead")
_draw = _of(ready.draw, "press")
_arch, _freed = _of(ready.arch, "arch"), _of(ready.freed, "bend and free")
_u, _l = _section(sections.u_bend, "U-bend"), _section(sections.l_bend, "L-bend with pad")
_z, _joggle = _section(sections.z_bend, "Z-bend with pad"), partial(_section(sections.z_bend, "joggle"), offset=2.0)
_wiping, _stretch = _section(sections.wiping, "wiping"), _section(sections.stretch_bend, "stretch bending")
_rolled = _section(sections.rolled, "turning tool")
_cup, _box, _dome = _of(parts.cup, "cup"), _of(parts.box, "box"), _of(parts.dome, "hemisphere")
_bulge, _plate, _flange = _of(parts.bulge, "bulge"), _of(parts.plate, "plate"), _of(parts.flange, "trim")
_wide = _of(parts.wide, "wide strip")

_EIGHTEEN = {"element": "BEND18", "size": 1.0}
_CELLS, _STIFF = {"cells": 3}, {"points": 3, "augmented": True}
_SMOOTH = Sheet(friction=None)
#: Nearly inches and psi, metres and pascals: powers of two, so that the answers have the same bits.
_INCHES, _METRES = {"length": 2.0**-5, "stress": 2.0**7}, {"length": 2.0**-10, "stress": 2.0**20}
_UBEND: dict[str, Any] = {
    "thickness": 0.78,
    "length": 120.0,
    "width": 35.0,
    "material": LAWS["swift"](1.0),
    "punch_width": 50.0,
    "punch_edge": 5.0,
    "opening": 52.0,
    "die_edge": 5.0,
    "holder_force": 2450.0,
    "stroke": 15.0,
    "turn": 24.0,
    "contact_points": 3,
}
_CUP: dict[str, Any] = {
    "thickness": 1.0,
    "blank_radius": 20.0,
    "material": LAWS["voce"](1.0),
    "punch_radius": 10.0,
    "punch_edge": 4.0,
    "die_radius": 11.2,
    "die_edge": 4.0,
    "stroke": 6.0,
    "around": 6,
    "turn": 24.0,
}

JOBS: tuple[Watched, ...] = (
    _air("DC04", stroke=5.0, element="BEND8"),
    _air("free edges", stroke=5.0, width=12.0, width_elements=3, element="BEND8"),
    _air("DP600, 18 nodes", stroke=5.0, metal="DP600", element="BEND18"),
    _bottoming("88 degrees"),
    _bottoming("8 nodes", element="BEND8"),
    _sequence("one after the other"),
    _hem("over an insert"),
    _u("no friction", stroke=8.0, sheet=_SMOOTH),
    _u("friction 0.2, released", sheet=replace(Sheet(), friction=0.2), end="release"),
    _u("whole", whole=True, stroke=8.0, sheet=replace(Sheet(), friction=0.05)),
    _u("whole, no friction, cells", whole=True, stroke=8.0, sheet=replace(_SMOOTH, rule=_CELLS)),
    _u("holder by force, opened", holder=20.0, end="free"),
    _u("holder at a gap", gap=0.04, sheet=replace(Sheet(), law="voce")),
    _u("holder by force, cells", holder=20.0, sheet=replace(Sheet(), rule=_CELLS)),
    _u("holder by force, 18 nodes", holder=20.0, sheet=replace(Sheet(), **_EIGHTEEN)),
    _u("spring pad", pad=30.0),
    _u("spring pad, opened", pad=30.0, end="free"),
    _u("spring pad, augmented", pad=30.0, sheet=replace(Sheet(), rule=_STIFF)),
    _u("spring pad, back stresses", pad=30.0, sheet=replace(Sheet(), law="chaboche")),
    _twice("U-bend", "units like inches and psi", sections.u_bend, _INCHES, holder=20.0, sheet=Sheet(steps=48)),
    _l("by force"),
    _l("by force, opened", end="free"),
    _l("spring, friction 0.2", held="spring", sheet=replace(Sheet(), friction=0.2)),
    _l("pad at a gap, no friction", held="gap", sheet=_SMOOTH),
    _l("18 nodes", sheet=replace(Sheet(), **_EIGHTEEN)),
    _l("Yoshida-Uemori, falling modulus", sheet=replace(Sheet(), law="yoshida")),
    _l("cells", sheet=replace(Sheet(), rule=_CELLS)),
    _twice("L-bend with pad", "mirrored", sections.l_bend, {"mirrored": True}),
    _wiping("friction 0.1"),
    _wiping("no friction, released", sheet=_SMOOTH, end="release"),
    _wiping("augmented", sheet=replace(Sheet(), rule=_STIFF)),
    _wiping("rate dependent", sheet=replace(Sheet(), law="rate")),
    _twice("wiping", "units like metres and pascals", sections.wiping, _METRES, sheet=Sheet(steps=40)),
    _z("friction 0.1"),
    _z("no friction, anisotropic", sheet=replace(_SMOOTH, law="hill")),
    _joggle("friction 0.1", width=3.5),
    _joggle("18 nodes, released", width=3.5, sheet=replace(Sheet(), **_EIGHTEEN), end="release"),
    _stretch("friction 0.1"),
    _stretch("under tension, no friction", tension=0.3, sheet=_SMOOTH),
    _stretch("under tension, friction 0.2, released", tension=0.3, sheet=replace(Sheet(), friction=0.2), end="release"),
    _rolled("friction 0.1", sheet=Sheet(steps=16)),
    _bead("friction 0.1"),
    _bead("friction 0.02", friction=0.02),
    _beaded("no friction"),
    _beaded("friction 0.05", friction=0.05),
    _draw("U-bend of NUMISHEET 93", case=UBend(**_UBEND)),
    _draw("cup of aluminium", case=Cup(**_CUP)),
    _cup("quarter, holder at a gap"),
    _cup("quarter, holder by force, anisotropic", law="yld2004", held="force"),
    _cup("quarter, spring, no friction", held="spring", friction=None),
    _cup("half, holder at a gap", part="half", stroke=6.0),
    _box("holder by force", held="force"),
    _dome("friction 0.1"),
    _dome("no friction, 18 nodes", friction=None, element="MI9K3DEAS", cells=(2, 4)),
    _bulge("unloaded", unload=True, steps=20),
    _bulge("in a die, arc length", die=True, arc=True, pressure=25.0),
    _plate("ball, clamped", steps=10),
    _plate(
        "on a ring under a plunger, augmented", edges="ring", tool="plunger", contact={"points": 2, "augmented": True}
    ),
    _wide("both halves", end="release"),
    _flange("edge on the line, on a bend"),
    _flange("elements as they are", edge="elements"),
    _arch("over two limit points", increment=0.005),
    _freed("18 nodes", element="MI9K3DEAS"),
)
