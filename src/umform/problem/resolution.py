"""Check that mesh, element, hardening curve, contact points and increments resolve the tools.

A sheet of thickness h on a radius R strains by h / (2 R + h) at its surfaces. Rules of thumb: an element should span
some 10 degrees of the smallest radius, twice as much if it is curved itself, and the false moment of sharp-bend locking
should stay below a few per cent of the plastic one (docs/theory, section 2.8). An increment of more than half a
thickness may jump over contact; a facet with too few contact points for its order makes the force rise in steps
(docs/theory, section 4.5).
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from umform.elements.locking import HIGHEST, LOCKING, MOST, locking_moment
from umform.elements.technology import Element
from umform.materials import Plastic, Table
from umform.model import Model
from umform.model.bodies.body import Body
from umform.model.contact import Contact
from umform.model.contact.encounter import sheet_thickness
from umform.problem.controls import Displacement, Drive, MidLine, Turn
from umform.problem.findings import Finding, ok, warning
from umform.problem.prepared import Prepared
from umform.problem.problem import Problem
from umform.problem.sizes import sheet_length, size_near
from umform.problem.steps import Move
from umform.problem.units import first_yield
from umform.surfaces import Tool

#: Degrees of a tool radius per element: with 4 nodes a face, and with 9, which follow an arc.
_ARC = {4: 12.0, 9: 24.0}
#: Elements for bends.
_FOR_BENDS = {"hex8": "BEND8", "hex18": "BEND18"}
#: Points through the thickness that plastic bending needs, and sharp bends (strain above 0.1).
_POINTS, _SHARP_POINTS, _SHARP = 5, 7, 0.1
#: Radius of the mid-surface over the thickness below which one layer, whose director is straight, errs in springback
#: (docs/theory, section 2.10).
_STRAIGHT = 2.0
#: Travel in an increment, in thicknesses.
_WAY = 0.5
#: Contact points, and cells, per direction of a facet with 4 and with 9 nodes.
_LEAST, _LEAST_CELLS = {4: 2, 9: 3}, {4: 3, 9: 5}


def resolution(deck: Problem, problem: Prepared) -> Iterator[Finding]:
    """Elements and thickness against the radii of the tools, contact points, increments."""
    yield from bends(deck, problem)
    yield from contact_points(problem)
    yield from ways(deck, problem)


def bends(deck: Problem, problem: Prepared) -> Iterator[Finding]:
    """Element sizes on all tools, and the thickness on the sharpest one."""
    h = sheet_thickness(problem.model.mesh)
    sharpest: tuple[float, str] | None = None
    for name, part in deck.contents.contacts.items():
        tool = problem.tools[part.tool]
        radius = min(tool.convex_radii(), default=None)
        if radius is None:
            continue
        yield element_size(problem.contacts[name], problem.model, tool, radius)
        if radius > 0 and (sharpest is None or radius < sharpest[0]):
            sharpest = (radius, part.tool)
    for body in problem.model.bodies:
        if sharpest is not None and isinstance(body.material, Plastic):
            yield from through_thickness(problem.model, body, body.material, h, *sharpest)


def coarse(deck: Problem, problem: Prepared) -> list[str]:
    """Warning of a mesh whose elements are too long for the radii that bend the sheet."""
    found = []
    for name, part in deck.contents.contacts.items():
        tool = problem.tools[part.tool]
        radius = min(tool.convex_radii(), default=None)
        if not radius:
            continue
        contact = problem.contacts[name]
        degrees, most = math.degrees(size_near(contact, problem.model, tool.along()) / radius), _arc(contact)
        if degrees > most:
            found.append(f"{degrees:.3g} degrees of the radius {radius:.4g} at contact {name} ({most:g} at most)")
    if not found:
        return []
    return [
        f"coarse mesh: an element spans {', '.join(found)}. Forces, thinning, strains and springback are those of this "
        "mesh and their error is unknown: repeat with finer elements"
    ]


def _arc(contact: Contact) -> float:
    """Most degrees of a radius per element."""
    return _ARC[contact.facets.shape[1]]


def element_size(contact: Contact, model: Model, tool: Tool, radius: float) -> Finding:
    """Angle of the smallest radius of a tool per element where the tool is nearest."""
    about = f"contact {contact.name}"
    size = size_near(contact, model, tool.along())
    if radius == 0.0:
        remedy = "round it: the finer the mesh, the deeper an edge cuts into the sheet"
        return warning(about, "the tool has a sharp edge", remedy)
    degrees = math.degrees(size / radius)
    text = f"an element is {size:.3g} long and spans {degrees:.3g} degrees of the radius {radius:.4g}"
    most = _arc(contact)
    if degrees <= most:
        return ok(about, text)
    wanted = most / 1.2
    fine = f"elements of {math.radians(wanted) * radius:.2g} or less where this radius bends the sheet"
    remedy = f"{fine}: {wanted:.3g} degrees of it each, the warning begins at {most:g}"
    return warning(about, text, remedy)


def through_thickness(
    model: Model, body: Body, material: Plastic, h: float, radius: float, tool: str
) -> Iterator[Finding]:
    """Thickness points and thickness order against the strain that the smallest radius asks for."""
    strain, layers = h / (2.0 * radius + h), layers_of(model, h)
    order, stiffness = max(body.element.thickness_order, 1), material.kappa / first_yield(material)
    follows = min(order, HIGHEST)
    text = f"the radius {radius:.4g} of {tool} strains a sheet of {h:.4g} by {100 * strain:.3g} %"
    if locking_moment(follows, strain, stiffness, layers) > LOCKING:
        remedy = against_locking(body.element, strain, stiffness, layers)
        yield warning("element", f"{text}: at thickness order {order} it locks", remedy)
    else:
        note = "; one layer makes the springback of so sharp a bend 2 to 7 % too large: four layers where it matters"
        sharp = layers == 1 and radius + 0.5 * h < _STRAIGHT * h
        yield ok("element", f"{text}: thickness order {order} can follow{note if sharp else ''}")
    least = _SHARP_POINTS if strain > _SHARP else _POINTS
    points = layers * body.section_points
    if points < least and strain > first_yield(material) / material.E:
        remedy = f"take {math.ceil(least / layers)}" + (" in each layer" if layers > 1 else "")
        yield warning("element", f"{points} thickness points for a strain of {100 * strain:.3g} %", remedy)
    curve = material.hardening
    if isinstance(curve, Table) and curve.eqps[-1] < strain:
        text = f"the hardening curve ends at a plastic strain of {curve.eqps[-1]:.3g}, the bend asks for {strain:.3g}"
        yield warning("material", text, "go on with the curve: behind its end the yield stress stays as it is")


def against_locking(element: Element, strain: float, stiffness: float, layers: int) -> str:
    """Remedy: a higher order of the thickness strain if possible, else layers."""
    for order in range(max(element.thickness_order, 1) + 1, HIGHEST + 1):
        if locking_moment(order, strain, stiffness, layers) <= LOCKING:
            if element.thickness_order == 0:
                return f"name = '{_FOR_BENDS[element.cell]}'"
            return f"leave thickness_order out, or give {order} or more"
    for more in range(layers + 1, MOST + 1):
        if locking_moment(HIGHEST, strain, stiffness, more) <= LOCKING:
            return f"{more} layers of BEND18: no order follows so sharp a bend in fewer"
    return f"a larger radius, or a yield stress in the unit of E: {MOST} layers do not follow it either"


def layers_of(model: Model, h: float) -> int:
    """Number of stacked cells in a sheet of a thickness."""
    lower, upper = np.split(model.mesh.points[model.mesh.connectivity], 2, axis=1)
    cell = float(np.median(np.linalg.norm(upper - lower, axis=-1)))
    return max(1, round(h / cell)) if math.isfinite(h / cell) else 1


def contact_points(problem: Prepared) -> Iterator[Finding]:
    """Contact points or cells of all contacts against the order of their facets."""
    for name, contact in problem.contacts.items():
        if contact.cells is not None:
            least = _LEAST_CELLS[contact.facets.shape[1]]
            if contact.cells < least:
                text = f"contact cells {contact.cells} x {contact.cells}: the contact is stiffer than its penalty"
                yield warning(f"contact {name}", text, f"cells = {least} or more")
            continue
        least = _LEAST[contact.facets.shape[1]]
        if isinstance(contact.points, str) or contact.points < least:
            points = "at the nodes only" if isinstance(contact.points, str) else f"{contact.points} x {contact.points}"
            text = f"contact points {points}: the force climbs in stairs where the sheet slides"
            yield warning(f"contact {name}", text, f"points = {least} or more, or auto")


def _turn(about: str, name: str, way: float) -> Finding:
    """Rotation of a tool in a step."""
    text = f"{name} turns by {way:.4g} radians, {math.degrees(way):.4g} degrees"
    if way <= 2.0 * math.pi:
        return ok(about, text)
    return warning(about, f"{text}: more than a full turn", f"{math.radians(way):.4g} turns by {way:.4g} degrees")


def ways(deck: Problem, problem: Prepared) -> Iterator[Finding]:
    """Travel of the controls that are lengths, in total and per increment, and rotations of tools."""
    thickness, span = sheet_thickness(problem.model.mesh), sheet_length(problem.model)
    controls = deck.contents.controls
    stands = dict.fromkeys(controls, 0.0)
    for number, step in enumerate(deck.contents.steps):
        about = f"step {number + 1}"
        if not isinstance(step, Move):  # its end is unknown
            moved = [] if step.kind == "free" else step.to if step.kind == "arc" else [step.control]
            for name in moved:
                stands[name] = np.nan
            continue
        for name, to in step.to.items():
            if not isinstance(controls.get(name), Displacement | MidLine | Drive | Turn):
                continue
            way, stands[name] = abs(to - stands[name]), to
            if not np.isfinite(way):
                continue
            if isinstance(controls[name], Turn):
                yield _turn(about, name, way)
                continue
            part = way / step.increments if step.increments is not None else 0.0
            each = "increments chosen during the run" if step.increments is None else f"{part:.3g} in an increment"
            text = f"{name} moves by {way:.4g}, {each}"
            if way > span:
                yield warning(about, f"{text}: farther than the sheet is long", "check the units and the target")
            elif problem.contacts and part > _WAY * thickness:
                least = int(np.ceil(way / (_WAY * thickness)))
                yield warning(about, f"{text}: {part / thickness:.3g} thicknesses", f"increments = {least} or more")
            else:
                yield ok(about, text)
