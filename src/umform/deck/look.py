"""A look at the physics of a problem before it is solved: motions, gaps, element sizes, thickness, units, effort."""

from __future__ import annotations

import time as clock
from collections.abc import Iterator

import numpy as np

from umform.deck import bends, fineness
from umform.deck.contents import Contents
from umform.deck.deck import Deck
from umform.deck.findings import Finding, error, ok, warning
from umform.deck.material import FromLibrary
from umform.deck.problem import Problem
from umform.deck.references import references
from umform.errors import NotFinite, RigidBodyMotion, SingularMatrix, ToolSwallowsSheet
from umform.materials import J2, Elastic
from umform.mesh.quality import jacobians
from umform.model import Model
from umform.model.contact.encounter import sheet_thickness
from umform.solution.newton import Newton

#: An overlap of more than this part of the thickness at the start sends a jolt through the sheet.
_OVERLAP = 0.02
#: Iterations of an increment, on an average.
_ITERATIONS = 4
#: Smallest Jacobian of a cell over its largest one.
_DISTORTED = 0.2
#: A penalty stiffer than the sheet across its thickness by more than this spoils the condition of the tangent.
_STIFF = 100.0
#: Strain at first yield of sheet metals, with some room on both sides.
_YIELD_STRAIN = (1e-4, 3e-2)


def look(deck: Deck, problem: Problem) -> Iterator[Finding]:
    """Look at a problem without solving it.

    Parameters
    ----------
    deck : Deck
        The deck.
    problem : Problem
        What was built from it; its model is left as it was.

    Yields
    ------
    Finding
        Errors first refuse what `umform.solve` would refuse; warnings are rules of thumb.
    """
    with np.errstate(all="ignore"):
        yield mesh(problem.model)
        yield motions(problem.model)
        yield from gaps(problem)
        yield from bends.look(deck, problem)
        yield from fineness.look(deck, problem)
        yield from units(problem.model, deck.contents)
        yield from idle(deck)
        yield effort(deck.contents, problem)


def mesh(model: Model) -> Finding:
    """Size of the model, and its most distorted cell."""
    points, cells = model.mesh.points, model.mesh.connectivity
    sizes = " x ".join(f"{size:.4g}" for size in np.ptp(points, axis=0))
    text = f"{len(cells)} {model.mesh.cell}, {len(points)} nodes, {model.pattern.n} unknowns; the sheet spans {sizes}"
    J = jacobians(points, cells)
    ratios = J.min(axis=1) / J.max(axis=1)
    worst = int(np.argmin(ratios))
    if ratios[worst] >= _DISTORTED:
        return ok("mesh", text)
    text += f"; in cell {worst} the Jacobian falls to {ratios[worst]:.2g} of its largest value"
    return warning("mesh", text, "cells nearer to parallelograms, mid-side nodes nearer to the middle")


def motions(model: Model) -> Finding:
    """Whether supports and tools leave a rigid-body motion free, or a tool swallows the sheet."""
    try:
        model.check()
    except (RigidBodyMotion, ToolSwallowsSheet) as refusal:
        text = "; ".join(part for part in (refusal.what, refusal.where, str(refusal.value or "")) if part)
        return error("supports" if isinstance(refusal, RigidBodyMotion) else "tools", text, refusal.remedy)
    return ok("supports", "no rigid-body motion is free")


def gaps(problem: Problem) -> Iterator[Finding]:
    """Gap or overlap of each contact pair at the start."""
    model = problem.model
    thickness = sheet_thickness(model.mesh)
    for name, contact in problem.contacts.items():
        gap = contact.locate(model.u, contact.pose).gap
        about = f"contact {name}"
        if not np.isfinite(gap).all():
            remedy = "move the tool so that it just touches the sheet"
            yield error(about, "a contact point lies on the axis or the centre of the tool", remedy)
            continue
        deepest, inside = float(gap.min()), int((gap <= 0.0).sum())
        text = (
            f"gap {deepest:.4g}" if deepest > 0 else f"{inside} of {gap.size} points touch, overlap {abs(deepest):.4g}"
        )
        if deepest < -_OVERLAP * thickness:
            remedy = "move the tool out of the sheet; an overlap is pressed out in the first increment"
            yield warning(about, f"{text}: {-100 * deepest / thickness:.3g} % of the thickness", remedy)
        elif deepest > float(np.ptp(model.mesh.points, axis=0).max()):
            remedy = "look at the place of the tool and at the units"
            yield warning(about, f"{text}: farther away than the sheet is long", remedy)
        else:
            yield ok(about, text)


def units(model: Model, contents: Contents) -> Iterator[Finding]:
    """Whether stiffness, lengths, yield stress and penalties are in the same units, as far as metals tell."""
    material: object = model.material
    if not isinstance(material, Elastic):
        return
    length, thickness = float(np.ptp(model.mesh.points, axis=0).max()), sheet_thickness(model.mesh)
    text = f"E = {material.E:.4g}, thickness {thickness:.4g}, length {length:.4g}"
    if material.E > 1e9 and length > 1.0:
        yield warning("units", f"{text}: Pa with mm?", "with mm and N stresses are in MPa: E of steel is 210e3")
    elif 1e3 < material.E < 1e7 and length < 0.05 and not isinstance(contents.material, FromLibrary):
        yield warning("units", f"{text}: MPa with m?", "with m and N stresses are in Pa: E of steel is 210e9")
    else:
        yield ok("units", text)
    if isinstance(material, J2):
        first = bends.first_yield(material)
        strain, (low, high) = first / material.E, _YIELD_STRAIN
        if not low <= strain <= high:
            remedy = "give yield stress and elastic constants in one unit"
            yield warning("units", f"first yield at a strain of {strain:.3g}: yield stress {first:.4g}", remedy)
    for contact in model.contacts:
        ratio = contact.penalty * thickness / material.E
        if ratio > _STIFF:
            remedy = "a softer penalty: expected pressure / penetration that you allow"
            yield warning(f"contact {contact.name}", f"the penalty is {ratio:.3g} times E / thickness", remedy)


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
