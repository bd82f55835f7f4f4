"""Jobs of the studies of errors: small parts of each process, and their refinements, one source at a time and all.

The sources but the mesh are refined on a coarse mesh: their changes hardly depend on it, and it is cheap.
"""

from __future__ import annotations

import hashlib
import itertools
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import umform as uf
from umform import sheet_metals
from umform.analysis.steps import Pace
from umform.problem import Problem
from umform.problem.coarser import OF_PACE, coarser
from umform.problem.error_budget import numbers_of
from umform.problem.mesh import Grid
from umform.problem.steps import Move
from umform.problem.templates import template
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.air_bending.sheet import softness as softness_of
from umform.processes.bend_sequence import Bend, BendSequence, bend_sequence
from umform.processes.draw.case import draw
from umform.processes.draw.cup import Cup
from umform.processes.draw.two_meshes import coarser as coarser_u
from umform.processes.draw.u_bend import UBend
from umform.processes.hemming import Hemming, hemming
from umform.processes.hemming.spec import acute
from umform.results.outcome import Outcome
from umform.results.quantity import Quantity

#: Mesh of the case, a coarser one, and the finest of all.
DEFAULT, COARSE, FINEST = "default", "coarse", "finest"
#: Process of decks, whose bands are from their error budgets.
DECK = "deck"
#: Coarser mesh of a U-bend that gives its bands.
QUICK = "quick"
#: Refinements of one source each: of the mesh from that of the case, of others from the coarse one.
SOURCES = ("mesh", "layers", "increments", "thickness points", "contact points", "penalty", "tolerance")
#: Penalty and allowed penetration, and tolerances, of a refinement over those of the case.
_STIFFER, _TIGHTER = 3.0, 0.1
_STRAIN = "outer_strain"


@dataclass(frozen=True)
class Job:
    """A part.

    Attributes
    ----------
    process : str
        Its process.
    name : str
        What it is.
    case : object
        The parameters.
    single : bool
        Whether single refinements are run, too.
    """

    process: str
    name: str
    case: Any
    single: bool = True

    @property
    def cases(self) -> dict[str, Any]:
        """The parameters of its runs by the names of the refinements."""
        found = _KINDS[self.process](self.case)
        kept = ("mesh",) if self.process == "u-bend" else ()  # an extrapolation needs the errors that are left on it
        return {name: one for name, one in found if self.single or name in kept or name not in SOURCES}


@dataclass(frozen=True)
class Numbers:
    """What a deck has computed."""

    quantities: list[Quantity]


@dataclass(frozen=True)
class Deck:
    """A deck of `umform new` with other values of some keys.

    Attributes
    ----------
    template : str
        Its name.
    changes : mapping of str to object
        The values by path.
    """

    template: str
    changes: Mapping[str, Any]

    @property
    def problem(self) -> Problem:
        """The deck."""
        return Problem.read(template(self.template)).with_(self.changes)

    def run(self) -> Numbers:
        """Its numbers."""
        deck = self.problem
        built = deck.build()
        result = built.solve(progress=False)
        return Numbers(numbers_of(deck, built, result))


def run(case: Any) -> Outcome | Numbers:
    """Run one case."""
    if isinstance(case, AirBending):
        return air_bending(case, frames=1, progress=False)
    if isinstance(case, BendSequence):
        return bend_sequence(case, frames=1, progress=False)
    if isinstance(case, Hemming):
        return hemming(case, frames=1, progress=False)
    return case.run() if isinstance(case, Deck) else draw(case, progress=False)


def softness(case: Any, values: Mapping[str, float | None]) -> dict[str, float]:
    """Softness of the bends of a run by their names; empty for other processes."""
    if not isinstance(case, AirBending | BendSequence):
        return {}
    sheet = case if isinstance(case, AirBending) else case.sheet
    return {
        name.removesuffix(_STRAIN).removesuffix(": "): softness_of(sheet.material, strain)
        for name, strain in values.items()
        if name.endswith(_STRAIN) and strain is not None
    }


def length(case: Any) -> float:
    """Length that errors in mm are proportional to: the thickness of a hem or of a drawn part."""
    if isinstance(case, Cup | UBend):
        return case.thickness
    return case.sheet.thickness if isinstance(case, Hemming) else 1.0


def fingerprint(case: Any) -> str:
    """Digest of all parameters of a case that are given: a stored run of other parameters is made again."""
    # a new parameter that is absent changes nothing, nor do the last digits, which differ between processors
    given = re.sub(r", (\w+=(None|\(\))|friction=0\.0)(?=[,)])", "", repr(case))
    given = re.sub(r"(?<![\w.])\d+\.\d+(?:e[-+]?\d+)?", lambda number: f"{float(number[0]):.10g}", given)
    return hashlib.sha256(given.encode()).hexdigest()[:12]


def _of_draw(case: Cup | UBend, meshes: Mapping[str, dict[str, Any]], contacts: int) -> Iterator[tuple[str, Any]]:
    """Meshes of a drawn part, and the other sources on the coarse one."""
    pace = case.pace
    slower = {name: 0.5 * getattr(pace, name) for name in ("first", "largest", "turn", "strain", "contact")}
    tight = {name: _TIGHTER * getattr(case.newton, name) for name in ("residual", "increment")}
    stiff = _STIFFER * max(pair.penalty for pair in case.build()[0].contacts if pair.name != "under_holder")
    points = case.build()[0].bodies.only.thickness_points
    sources: dict[str, dict[str, Any]] = {
        "increments": {"pace": replace(pace, **slower)},
        "thickness points": {"thickness_points": points + 2},
        "contact points": {"contact_points": contacts},
        "penalty": {"penalty": stiff},
        "tolerance": {"newton": replace(case.newton, **tight)},
    }
    every: dict[str, Any] = {name: value for source in sources.values() for name, value in source.items()}
    yield DEFAULT, case
    for name, mesh in meshes.items():
        yield name, replace(case, **mesh)
    yield FINEST, replace(case, **every | meshes["mesh"])
    for name, source in sources.items():
        yield name, replace(case, **meshes[COARSE] | source)


def _of_cup(case: Cup) -> Iterator[tuple[str, Any]]:
    meshes: dict[str, dict[str, Any]] = {COARSE: Cup.meshes["coarse"], "mesh": {"turn": 8.0, "around": 22}}
    return _of_draw(case, meshes, 3)


def _of_u_bend(case: UBend) -> Iterator[tuple[str, Any]]:
    meshes: dict[str, dict[str, Any]] = {
        COARSE: UBend.meshes["coarse"],
        "mesh": {"turn": 0.5 * case.turn},
    }
    yield from _of_draw(case, meshes, 5)
    yield QUICK, coarser_u(case)


def _finer(sheet: AirBending, **more: Any) -> dict[str, dict[str, Any]]:
    """Refinements of the sheet of a bend."""
    how: dict[str, Any] = {
        "increments": {"increment": 0.5 * sheet.increment},
        "thickness points": {"thickness_points": sheet.thickness_points + 2},
        "contact points": {"contact_points": 9},
        "penalty": {"penetration": sheet.thickness / 200.0 / _STIFFER},
    }
    return how | more


def _of_bend(case: AirBending) -> Iterator[tuple[str, Any]]:
    from umform.processes.air_bending.budget import refinements

    stack = refinements(case)["stack"]
    sources = _finer(case)
    coarse = replace(case, elements_per_thickness=0.5 * case.elements_per_thickness)
    yield DEFAULT, case
    yield COARSE, coarse
    yield "layers", stack
    yield "mesh", replace(case, elements_per_thickness=2.0 * case.elements_per_thickness)
    for name, source in sources.items():
        yield name, replace(coarse, **source)
    every = {name: value for source in sources.values() for name, value in source.items() if name != "thickness_points"}
    yield FINEST, replace(stack, **every | {"elements_per_thickness": 1.5 * stack.elements_per_thickness})


def _of_sequence(case: BendSequence) -> Iterator[tuple[str, Any]]:
    every = {name: value for source in _finer(case.sheet).values() for name, value in source.items()}
    size = case.sheet.elements_per_thickness
    finest = every | {"elements_per_thickness": 2.0 * size, "layers": 4}
    yield DEFAULT, case
    yield COARSE, replace(case, sheet=replace(case.sheet, elements_per_thickness=0.5 * size))
    yield FINEST, replace(case, sheet=replace(case.sheet, **finest))


def _of_hem(case: Hemming) -> Iterator[tuple[str, Any]]:
    sources = _finer(case.sheet)
    every = {name: value for source in sources.values() for name, value in source.items() if name != "thickness_points"}
    mesh = {"elements_per_thickness": 2.0 * case.sheet.elements_per_thickness, "layers": 4}
    coarse = {"elements_per_thickness": 0.5 * case.sheet.elements_per_thickness}

    def refined(sheet: dict[str, Any], times: int = 1) -> Hemming:
        return replace(case, sheet=replace(case.sheet, **sheet), increments=times * case.increments)

    yield DEFAULT, case
    yield COARSE, refined(coarse)
    for name, source in sources.items():
        yield name, refined(coarse | source, 2 if name == "increments" else 1)
    yield "mesh", refined(mesh)
    yield FINEST, refined(every | mesh, 2)


def _of_deck(case: Deck) -> Iterator[tuple[str, Any]]:
    """The coarser variants of the error budget, and a finer deck."""
    deck = case.problem
    built = deck.build()
    yield DEFAULT, case
    for name, change in coarser(deck, built).items():
        yield name, replace(case, changes=case.changes | change)
    part = deck.contents.mesh
    finer: dict[str, Any] = {"element.thickness_points": built.model.bodies.only.thickness_points + 2}
    if isinstance(part, Grid):
        finer |= {f"mesh.{name}": _halved(part.of_spec()[name]) for name in "xy"}
    else:
        finer |= {"mesh.cells": [2 * count if count > 1 else 1 for count in part.of_spec()["cells"]]}
    for number, step in enumerate(deck.contents.steps):
        if isinstance(step, Move):
            finer |= {f"steps.{number}.pace.{name}": 0.5 * getattr(Pace(), name) for name in OF_PACE}
    for name, contact in built.contacts.items():
        finer[f"contacts.{name}.points"] = contact.points + 1
        finer |= {
            f"contacts.{name}.{key}": value
            for key, value in (
                ("penalty", _STIFFER * (deck.contents.contacts[name].of_spec()["penalty"] or 0.0)),
                ("penetration", (contact.allowed or 0.0) / _STIFFER),
            )
            if value and (key == "penalty" or not deck.contents.contacts[name].of_spec()["penalty"])
        }
    finer |= {f"solution.{name}": _TIGHTER * getattr(built.options, name) for name in ("residual", "increment")}
    yield FINEST, replace(case, changes=case.changes | finer)


def _halved(lines: Sequence[float]) -> list[float]:
    """Lines with those in the middle between them."""
    return sorted([*lines, *(0.5 * (a + b) for a, b in itertools.pairwise(lines))])


_KINDS: dict[str, Callable[[Any], Iterator[tuple[str, Any]]]] = {
    "air bending": _of_bend,
    "bend sequence": _of_sequence,
    **dict.fromkeys(("hem, flat", "hem, filled", "hem, open", "hem, rope", "hem by force"), _of_hem),
    "cup": _of_cup,
    "u-bend": _of_u_bend,
    DECK: _of_deck,
}


#: A steel with ears, by its r-values.
EARS = "steel with r of 1.8, 1.2 and 2.2"


def _law(metal: str) -> Any:
    if metal == EARS:
        ears = uf.Hill48(r0=1.8, r45=1.2, r90=2.2)
        return uf.Metal(210e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.22), yield_function=ears)
    return sheet_metals.get(metal).law


def _air(metal: str, thickness: float, opening: float, stroke: float, *, single: bool = True, **keys: Any) -> Job:
    name = f"{metal}, {thickness:g} mm, opening {opening:g}"
    case = AirBending(material=_law(metal), thickness=thickness, opening=opening, stroke=stroke, **keys)
    return Job("air bending", name, case, single)


def _cup(
    metal: str,
    thickness: float,
    punch: float,
    ratio: float,
    edges: tuple[float, float],
    stroke: float,
    *,
    single: bool = True,
    **keys: Any,
) -> Job:
    case = Cup(
        material=_law(metal),
        thickness=thickness,
        blank_radius=ratio * punch,
        punch_radius=punch,
        punch_edge=edges[0],
        die_edge=edges[1],
        stroke=stroke,
        **keys,
    )
    return Job("cup", f"{metal}, {thickness:g} mm, punch {2 * punch:g}", case, single)


def _u(
    metal: str,
    thickness: float,
    punch: float,
    length: float,
    edges: tuple[float, float],
    stroke: float,
    force: float,
    *,
    single: bool = True,
) -> Job:
    case = UBend(
        material=_law(metal),
        thickness=thickness,
        length=length,
        width=30.0,
        punch_width=punch,
        punch_edge=edges[0],
        die_edge=edges[1],
        stroke=stroke,
        holder_force=force,
    )
    return Job("u-bend", f"{metal}, {thickness:g} mm, edges {edges[0]:g} and {edges[1]:g}", case, single)


def _hem(metal: str, thickness: float, form: Any, *, single: bool = False, sheet: Any = (), **keys: Any) -> Job:
    """A hem, that is closed to its height or with a force; with other keys of its sheet."""
    strip = acute(thickness, material=_law(metal), **dict(sheet))
    case = Hemming(form=form, base=14.0 * thickness, sheet=strip, **keys)
    name = ", ".join([f"{metal}, {thickness:g} mm, {form}", *(f"{key} {value:g}" for key, value in keys.items())])
    return Job(case.study, name, case, single)


def _sequence(
    metal: str, thickness: float, opening: float, strokes: Sequence[float], directions: str = "", **keys: Any
) -> Job:
    """Bends at 2.5 openings from each other; a direction is u for up, or d for down."""
    sheet = AirBending(material=_law(metal), thickness=thickness, opening=opening, **keys)
    bends = tuple(
        Bend((2.0 + 2.5 * number) * opening, stroke=stroke, direction="down" if way == "d" else "up")
        for number, (stroke, way) in enumerate(itertools.zip_longest(strokes, directions))
    )
    name = f"{metal}, {thickness:g} mm, {len(bends)} bends"
    return Job("bend sequence", name, BendSequence((1.5 + 2.5 * len(bends)) * opening, bends, sheet))


#: Sides of a quarter of the blank of a square cup.
_SIDES = [0.0, 15.0, 27.0, 32.0, 37.0, 42.0, 48.0, 58.0, 75.0]
_STEEL = {"curve": "Swift", "strength": 565.3, "offset": 0.0071, "exponent": 0.259}
_ALUMINIUM = {"curve": "Voce", "yield_stress": 125.95, "saturation": 314.98, "rate": 12.22}


def _box(name: str, stroke: float, friction: float, **material: Any) -> Job:
    contacts = {
        f"contacts.{tool}.{key}": value
        for tool in ("die", "holder", "punch")
        for key, value in (("penalty", 8e3), ("friction", friction))
    }
    keys = {"element.name": "BEND8", "mesh.x": _SIDES, "mesh.y": _SIDES, "steps.1.to.stroke": stroke}
    law = {f"material.{key}": value for key, value in material.items()}
    return Job(DECK, name, Deck("square-cup", keys | contacts | law))


def _rail(name: str, stroke: float, force: float, **material: Any) -> Job:
    keys = {"mesh.length": 75.0, "mesh.cells": [50, 1], "steps.0.force": -force, "steps.1.to.stroke": stroke}
    heights = [0.3 * stroke, 0.5 * stroke, 0.7 * stroke]
    law = {f"material.{key}": value for key, value in material.items()}
    return Job(DECK, name, Deck("hat-rail", keys | {"measures.springback.heights": heights} | law))


JOBS = (
    _air("DC04", 2.0, 16.0, 6.2),
    _air("S355", 3.0, 24.0, 8.0, punch_radius=3.0, die_radius=3.0),
    _air("DP600", 1.2, 10.0, 4.0, punch_radius=1.0),
    _air("EN AW-5754", 1.5, 12.0, 4.4, punch_radius=2.0),
    _air("1.4301", 1.0, 16.0, 6.5, punch_radius=1.0),
    _air("DC04", 1.0, 8.0, 2.2, punch_radius=1.0, die_radius=1.0),
    _air("DP600", 1.0, 8.0, 3.0, single=False, punch_radius=1.0, die_radius=1.0),
    _air("DP600", 1.5, 16.0, 5.5, single=False, punch_radius=2.0),
    _air("S355", 2.0, 12.0, 4.2, single=False, punch_radius=1.0),
    _air("1.4301", 1.5, 12.0, 4.5, single=False, punch_radius=1.0),
    _air("EN AW-5754", 2.0, 16.0, 6.0, single=False, punch_radius=1.5),
    _cup("DC04", 1.0, 18.0, 2.0, (5.0, 6.0), 14.0, holder_force=15e3),
    _cup("EN AW-5754", 1.2, 20.0, 1.9, (6.0, 7.0), 16.0, holder_force=12e3),
    _cup("1.4301", 0.8, 16.0, 1.9, (4.0, 5.0), 10.0, holder_force=20e3, single=False),
    _cup("AA6016-T4", 1.0, 20.0, 1.75, (6.0, 8.0), 30.0, holder_force=10e3, single=False),
    _cup("DC04", 1.5, 25.0, 1.8, (8.0, 10.0), 20.0, holder_force=30e3, single=False),
    _cup("DP600", 1.0, 20.0, 1.8, (6.0, 6.0), 12.0, holder_force=25e3, single=False),
    _cup("AA6016-T4 Hill48", 1.0, 16.0, 1.8, (5.0, 6.0), 26.0, holder_force=6e3, single=False),
    _cup(EARS, 0.8, 16.0, 1.8, (5.0, 6.0), 26.0, holder_force=12e3),
    _cup("1.4301", 1.2, 20.0, 1.7, (6.0, 7.0), 13.0, holder_force=25e3, single=False),
    _cup("EN AW-5754", 1.0, 18.0, 1.7, (6.0, 6.0), 24.0, holder_force=10e3, single=False),
    _cup(EARS, 1.0, 18.0, 1.65, (6.0, 6.0), 24.0, holder_force=15e3, single=False),
    _cup("AA6016-T4 Hill48", 1.2, 18.0, 1.7, (6.0, 7.0), 26.0, holder_force=8e3, single=False),
    _u("DP600", 1.2, 40.0, 140.0, (6.0, 6.0), 28.0, 4000.0),
    _u("DC04", 0.8, 40.0, 120.0, (5.0, 5.0), 24.0, 2000.0),
    _u("EN AW-5754", 1.5, 40.0, 140.0, (8.0, 8.0), 30.0, 3000.0, single=False),
    _u("S355", 2.0, 50.0, 160.0, (8.0, 10.0), 30.0, 10000.0, single=False),
    _u("1.4301", 1.0, 40.0, 120.0, (5.0, 7.0), 22.0, 5000.0, single=False),
    _hem("DC04", 1.0, "insert", single=True),
    _hem("EN AW-5754", 1.5, "insert", gap=1.0),
    _hem("DP600", 1.2, "insert", gap=2.0),
    _hem("DC04", 1.0, "inner", gap=0.8, sheet={"element": "BEND8"}),
    _hem("DC04", 1.0, "flat"),
    _hem("AA6016-T4", 1.0, "flat", sheet={"rolling": 90.0}),
    _hem("DP600", 1.2, "flat"),
    _hem("EN AW-5754", 1.2, "open"),
    _hem("DC04", 1.5, "open", gap=1.2),
    _hem("DP600", 1.0, "open", gap=0.8),
    _hem("DP600", 0.8, "rope"),
    _hem("AA6016-T4", 0.8, "rope", sheet={"rolling": 90.0}),
    _hem("DC04", 1.0, "rope"),
    _hem("DC04", 1.0, "insert", force=300.0, single=True),
    _hem("DC04", 1.0, "flat", force=300.0),
    _hem("EN AW-5754", 1.2, "flat", force=300.0),
    _sequence("DC04", 2.0, 16.0, (5.0, 6.0)),
    _sequence("DP600", 1.0, 8.0, (3.0, 2.5)),
    _sequence("EN AW-5754", 1.5, 12.0, (4.4, 3.5), punch_radius=2.0),
    _sequence("1.4301", 1.0, 16.0, (6.5, 5.0), punch_radius=1.0),
    _sequence("S355", 3.0, 24.0, (8.0, 7.0), punch_radius=3.0, die_radius=3.0),
    _sequence("DC04", 1.0, 8.0, (2.2, 3.0), "ud", punch_radius=1.0, die_radius=1.0),
    _sequence("DP600", 1.5, 16.0, (5.5, 4.5), "ud", punch_radius=2.0),
    _sequence("EN AW-5754", 2.0, 16.0, (6.0, 5.0), "ud", punch_radius=1.5),
    _sequence("1.4301", 1.5, 12.0, (4.5, 3.5), "du", punch_radius=1.0),
    _sequence("S355", 2.0, 12.0, (4.2, 3.8), "ud", punch_radius=1.0),
    _sequence("DC04", 1.5, 12.0, (4.0, 3.0, 3.5), "udu", punch_radius=1.5),
    _sequence("EN AW-5754", 1.0, 8.0, (3.0, 2.5, 2.2), "uud", punch_radius=1.0, die_radius=1.0),
    _rail("hat rail, steel", 20.0, 20.0),
    _box("square cup, aluminium", 8.0, 0.162),
    Job(DECK, "wiping, steel", Deck("wiping", {"mesh.cells": [50, 1], "steps.0.to.stroke": 16.0})),
    _box("square cup, steel", 7.0, 0.1, E=206e3, nu=0.3, hardening=_STEEL),
    _rail("hat rail, aluminium", 22.0, 10.0, E=70e3, nu=0.33, hardening=_ALUMINIUM),
)
