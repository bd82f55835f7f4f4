"""Checks of a problem before its solution: supports, gaps, units, element sizes, thickness, effort."""

from __future__ import annotations

import time as clock
from collections.abc import Iterator
from functools import partial

import numpy as np

from umform.analysis.newton.newton import Newton
from umform.analysis.run.loose import carried, carried_motions
from umform.errors import NotFinite, RigidBodyMotion, SingularMatrix, ToolSwallowsSheet, UmformError
from umform.materials import Plastic
from umform.model.contact.encounter import sheet_thickness
from umform.problem.clearance import away, clearances
from umform.problem.contents import Contents
from umform.problem.controls import ControlPart, Displacement, Drive, MidLine, Moment, Press, Spring, Turn
from umform.problem.deck_in_checkpoint import Kept
from umform.problem.findings import Finding, error, ok, warning
from umform.problem.material import FromLibrary
from umform.problem.named_units import named_units
from umform.problem.placement import out_of_the_sheet
from umform.problem.planes import planes
from umform.problem.plausible import of_model
from umform.problem.prepared import Prepared
from umform.problem.previous_operation import STATE_KIND
from umform.problem.problem import Problem, load
from umform.problem.references import references
from umform.problem.resolution import resolution
from umform.problem.steps import Arc, Move
from umform.problem.tools_that_stay import changed_thickness
from umform.sheet_metals import get
from umform.surfaces import CadTool, Offset, OffsetByField, Placed, Triangulated

#: Tables of a deck that change its run by no more than its tolerances.
_SHOWS = ("title", "output", "measures", "derivatives", "units", "solution")
#: Mean number of iterations of an increment.
_ITERATIONS = 4


def check(deck: Problem, problem: Prepared) -> Iterator[Finding]:
    """Check a problem without solving it.

    Parameters
    ----------
    deck : Problem
        The deck.
    problem : Prepared
        The problem of the deck; its model is unchanged.

    Yields
    ------
    Finding
        Errors: refused by `umform.solve`, or certainly a mistake; warnings: rules of thumb.
    """
    with np.errstate(all="ignore"):
        yield supports(problem)
        yield from before_run(deck, problem)
        yield from changed_thickness(deck)
        with carried(problem.model, problem.steps):
            yield effort(deck.contents, problem)


def before_run(deck: Problem, problem: Prepared) -> Iterator[Finding]:
    """The fast part of :func:`check`, without the supports, which `umform.solve` checks."""
    with np.errstate(all="ignore"):
        for note in problem.notes:
            yield ok("deck", note)
        place = partial(out_of_the_sheet, deck.contents)
        millimetres = isinstance(deck.contents.material, FromLibrary)
        yield from of_model(problem.model, problem.steps, millimetres=millimetres, place=place)
        yield from named_units(deck)
        yield from metal_of_thickness(deck, problem)
        yield from resolution(deck, problem)
        yield from clearances(deck, problem)
        yield from away(deck, problem)
        yield from drawings(problem)
        yield from planes(deck.contents, problem.model)
        yield from forming_limit(deck.contents, problem)
        yield from idle(deck)
        yield from state_before(deck)


def metal_of_thickness(deck: Problem, problem: Prepared) -> Iterator[Finding]:
    """Warn if the standard of a metal of the library has other values for the thickness of the sheet."""
    part = deck.contents.material
    if not isinstance(part, FromLibrary):
        return
    thin, thick = get(part.library), get(part.library, sheet_thickness(problem.model.mesh) * (1.0 + 1e-9))
    if thick is not thin:
        values = f"R {thick.yield_stress:g}, Rm {thick.tensile_strength:g} MPa"
        yield warning(
            "material",
            f"{thin.name} with Rm {thin.tensile_strength:g} MPa ({thin.basis}); {thick.basis}: {values}",
            f'its curve as law = "J2": umform.sheet_metals.get("{thin.name}", thickness).law',
        )


def supports(problem: Prepared) -> Finding:
    """Whether supports and tools leave a rigid-body motion free, or a tool overlaps the sheet too much."""
    motions = carried_motions(problem.model, problem.steps)
    if motions:
        return ok("supports", f"free until tools hold the sheet, which rests on weak springs: {'; '.join(motions)}")
    try:
        problem.model.system.check()
    except (RigidBodyMotion, ToolSwallowsSheet) as refusal:
        text = "; ".join(part for part in (refusal.what, refusal.where, str(refusal.value or "")) if part)
        return error("supports" if isinstance(refusal, RigidBodyMotion) else "tools", text, refusal.remedy)
    return ok("supports", "no rigid-body motion is free")


def drawings(problem: Prepared) -> Iterator[Finding]:
    """Report on tools from drawings."""
    for name, tool in problem.tools.items():
        own: object = tool
        while isinstance(own, Placed | Offset | OffsetByField):
            own = own.tool
        if isinstance(own, CadTool | Triangulated):
            yield ok(f"tool {name}", str(own))


def forming_limit(contents: Contents, problem: Prepared) -> Iterator[Finding]:
    """Refuse the curve of Keeler and Brazier without a flow curve that gives its n, and without millimetres."""
    named, remedy = contents.output.forming_limit, "forming_limit = [[-0.2, 0.5], [0.0, 0.3], [0.2, 0.4]], of a test"
    if not isinstance(named, str):
        return
    laws = [body.material for body in problem.model.bodies]
    if not (len(laws) == 1 and isinstance(laws[0], Plastic)):
        yield error("output", f"{named} needs the hardening of one plastic material", remedy)
    if contents.units.length not in ("", "mm"):
        yield error("output", f"{named} takes the thickness in mm, the deck has {contents.units.length}", remedy)


def idle(deck: Problem) -> Iterator[Finding]:
    """Tools without contact, controls that no step moves."""
    used = {(kind, name) for kind, name, _ in references(deck.source.data)}
    for name in deck.contents.tools:
        if ("tools", name) not in used:
            yield warning(f"tool {name}", "no contact has it", "add a contact, or take it out")
    for name, part in deck.contents.controls.items():
        if ("controls", name) not in used:
            yield unmoved(f"control {name}", part)
    before = deck.contents.before
    if before is not None and before.control is not None and ("controls", before.control) not in used:
        text = "no step moves it to 0: forces of the operation before stay on the part as dead loads"
        yield warning(f"control {before.control}", text, f"to = {{ {before.control} = 0.0 }} in the first step")
    elif before is not None and before.control is not None:
        name = before.control
        ends = [step.to[name] for step in deck.contents.steps if isinstance(step, Move | Arc) and name in step.to]
        followed = any(isinstance(step, Move) and name in step.follow for step in deck.contents.steps)
        if ends and ends[-1] != 0.0 and not followed:
            text = f"the last step that moves it ends at {ends[-1]:g}: this part of the previous forces stays"
            yield warning(f"control {name}", text, f"to = {{ {name} = 0.0 }} in its last step, if the part is released")


def state_before(deck: Problem) -> Iterator[Finding]:
    """Warn of a state of the operation before that a run with other values has written."""
    part = deck.contents.before
    if part is None:
        return
    source, path = deck.source, deck.source.folder / part.state
    try:
        run = Kept.read(path, source.trust, STATE_KIND).deck.source.data
    except UmformError:  # written without a deck, or of another version
        return
    now = load(source.folder / part.deck, trust=source.trust).source.data
    other = [name for name in sorted(run.keys() | now.keys()) if name not in _SHOWS and run.get(name) != now.get(name)]
    if other:
        yield warning(
            "before",
            f"{part.state} is of a run with other values than {part.deck} has now: {', '.join(other)}",
            "run the deck before again, and name the state in the folder that this run writes to",
        )


def unmoved(about: str, part: ControlPart) -> Finding:
    """Finding on a control that no step moves."""
    add = "add it to a step"
    if isinstance(part, Spring):
        return ok(about, "a spring with its preload holds the tool; no step adds a force")
    if isinstance(part, Press | Moment):
        return warning(about, "no step applies it: nothing holds the tool", f"{add}; without it the tool is fixed")
    if isinstance(part, Displacement | MidLine):
        return warning(about, "no step moves it: it holds its nodes", f"{add}, or fix the nodes in [[supports]]")
    still = "the tool stays where it is" if isinstance(part, Drive | Turn) else "it stays at 0"
    return warning(about, f"no step moves it: {still}", f"{add}, or take it out")


def effort(contents: Contents, problem: Prepared) -> Finding:
    """Estimated time of the run, from one evaluation and one factorisation."""
    model = problem.model
    newton = Newton(model.system, problem.options, problem.solver)
    try:
        solver = newton.ready_solver()
        seconds = np.inf
        for _ in range(2):  # the first one is slow: new memory, lazy libraries
            start = clock.perf_counter()
            solver.factor(model.system.evaluate(model.system.x))
            seconds = min(seconds, clock.perf_counter() - start)
    except (SingularMatrix, NotFinite) as refusal:
        remedy = "let tools touch the sheet at the start, or hold it"
        return warning("effort", f"there is no tangent at the start: {refusal.what}", remedy)
    finally:
        model.system.revert()
    increments = sum(step.expected for step in contents.steps)
    adapts = any(isinstance(step, Move) and step.increments is None for step in contents.steps)
    about = "at least" if adapts else "about"  # contact may halve an increment many times
    text = (
        f"{about} {increments} increments; {1e3 * seconds:.3g} ms an iteration with {solver.solver.name}: "
        f"{about} {_spell(seconds * increments * _ITERATIONS)}"
    ) + ("; an adaptive step may take several times as many" if adapts else "")
    return ok("effort", text)


def _spell(seconds: float) -> str:
    if seconds < 120:
        return f"{max(seconds, 1.0):.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
