"""What is checked of a problem before it is solved: supports, gaps, units, element sizes, thickness, effort."""

from __future__ import annotations

import time as clock
from collections.abc import Iterator

import numpy as np

from umform.deck.contents import Contents
from umform.deck.deck import Deck
from umform.deck.findings import Finding, error, ok, warning
from umform.deck.material import FromLibrary
from umform.deck.problem import Problem
from umform.deck.references import references
from umform.deck.resolution import resolution
from umform.deck.units import units
from umform.errors import NotFinite, RigidBodyMotion, SingularMatrix, ToolSwallowsSheet
from umform.mesh.quality import jacobians
from umform.model import Model
from umform.model.contact.encounter import sheet_thickness
from umform.solution.newton import Newton

#: An overlap of more than this part of the thickness at the start sends a jolt through the sheet; of more than the
#: second, the tool is not where it was meant to be.
_OVERLAP, _DEEP = 0.02, 0.2
#: Iterations of an increment, on an average.
_ITERATIONS = 4
#: Smallest Jacobian of a cell over its largest one.
_DISTORTED = 0.2


def check(deck: Deck, problem: Problem) -> Iterator[Finding]:
    """Check a problem without solving it.

    Parameters
    ----------
    deck : Deck
        The deck.
    problem : Problem
        What was built from it; its model is left as it was.

    Yields
    ------
    Finding
        Errors are what `umform.solve` would refuse, and what cannot be meant; warnings are rules of thumb.
    """
    with np.errstate(all="ignore"):
        yield supports(problem.model)
        yield from before_run(deck, problem)
        yield effort(deck.contents, problem)


def before_run(deck: Deck, problem: Problem) -> Iterator[Finding]:
    """All of :func:`check` but what takes time, and the supports, which `umform.solve` checks itself."""
    with np.errstate(all="ignore"):
        yield from of_model(problem.model, millimetres=isinstance(deck.contents.material, FromLibrary))
        yield from resolution(deck, problem)
        yield from idle(deck)


def of_model(model: Model, *, millimetres: bool = False) -> Iterator[Finding]:
    """Mesh, gaps and units of a model, wherever it comes from.

    Parameters
    ----------
    model : Model
        The model; it is left as it was.
    millimetres : bool
        Units are known to be mm, N and MPa.
    """
    yield mesh(model)
    yield from gaps(model)
    yield from units(model, millimetres=millimetres)


def mesh(model: Model) -> Finding:
    """Size of the model, and its most distorted cell."""
    points, cells = model.mesh.points, model.mesh.connectivity
    text = f"{len(cells)} {model.mesh.cell}, {len(points)} nodes, {model.unknown_count} unknowns"
    J = jacobians(points, cells)
    ratios = J.min(axis=1) / J.max(axis=1)
    worst = int(np.argmin(ratios))
    if ratios[worst] >= _DISTORTED:
        return ok("mesh", text)
    text += f"; in cell {worst} the Jacobian falls to {ratios[worst]:.2g} of its largest value"
    return warning("mesh", text, "cells nearer to parallelograms, mid-side nodes nearer to the middle")


def supports(model: Model) -> Finding:
    """Whether supports and tools leave a rigid-body motion free, or a tool swallows the sheet."""
    try:
        model.check()
    except (RigidBodyMotion, ToolSwallowsSheet) as refusal:
        text = "; ".join(part for part in (refusal.what, refusal.where, str(refusal.value or "")) if part)
        return error("supports" if isinstance(refusal, RigidBodyMotion) else "tools", text, refusal.remedy)
    return ok("supports", "no rigid-body motion is free")


def gaps(model: Model) -> Iterator[Finding]:
    """Gap or overlap of each contact pair at the start."""
    thickness, size = sheet_thickness(model.mesh), float(np.ptp(model.mesh.points, axis=0).max())
    for contact in model.contacts:
        gap = contact.locate(model.u, contact.pose).gap
        about = f"contact {contact.name}"
        if not np.isfinite(gap).all():
            remedy = "move the tool so that it just touches the sheet"
            yield error(about, "a contact point lies on the axis or the centre of the tool", remedy)
            continue
        deepest, inside = float(gap.min()), int((gap <= 0.0).sum())
        text = (
            f"gap {deepest:.4g}" if deepest > 0 else f"{inside} of {gap.size} points touch, overlap {abs(deepest):.4g}"
        )
        if deepest < -_OVERLAP * thickness:
            found = error if deepest < -_DEEP * thickness else warning
            remedy = "move the tool out of the sheet; an overlap is pressed out in the first increment"
            yield found(about, f"{text}: {-100 * deepest / thickness:.3g} % of the thickness", remedy)
        elif deepest > size:
            remedy = "check the place of the tool and the units"
            yield warning(about, f"{text}: farther away than the sheet is long", remedy)
        else:
            yield ok(about, text)


def idle(deck: Deck) -> Iterator[Finding]:
    """Tools that touch nothing, controls that nothing moves."""
    used = {(kind, name) for kind, name, _ in references(deck.source.data)}
    for name in deck.contents.tools:
        if ("tools", name) not in used:
            yield warning(f"tool {name}", "no contact has it", "add a contact, or take it out")
    for name in deck.contents.controls:
        if ("controls", name) not in used:
            yield warning(f"control {name}", "no step moves it: it stays at 0", "add it to a step, or take it out")


def effort(contents: Contents, problem: Problem) -> Finding:
    """Time that the run may take, from one evaluation and one factorisation."""
    model = problem.model
    newton = Newton(model, problem.options, problem.solver)
    try:
        solver = newton.ready_solver()
        seconds = np.inf
        for _ in range(2):  # the first one is slow: memory is new, and libraries wake up
            start = clock.perf_counter()
            solver.factor(model.evaluate(model.x))
            seconds = min(seconds, clock.perf_counter() - start)
    except (SingularMatrix, NotFinite) as refusal:
        remedy = "let tools touch the sheet at the start, or hold it"
        return warning("effort", f"there is no tangent at the start: {refusal.what}", remedy)
    finally:
        model.revert()
    increments = sum(step.expected for step in contents.steps)
    text = (
        f"about {increments} increments; {1e3 * seconds:.3g} ms an iteration with {solver.solver.name}: "
        f"about {_spell(seconds * increments * _ITERATIONS)}"
    )
    return ok("effort", text)


def _spell(seconds: float) -> str:
    if seconds < 120:
        return f"{max(seconds, 1.0):.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
