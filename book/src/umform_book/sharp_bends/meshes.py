"""Meshes of sharp bends: the turn of an element, polynomials in its surface, distorted elements in a hinge."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.sharp_bends import calculix
from umform_book.sharp_bends.arc_bending import ArcBending
from umform_book.sharp_bends.candidates import BEND8, BEND18, Candidate
from umform_book.sharp_bends.strips import Distortion, Strip, bend
from umform_book.variants import Variant

Floats = NDArray[np.float64]

#: Bent to R/h = 2.5 an element of the length L turns by 0.4 L / h.
SURFACE_STRAIN = 0.2
HARDENING = 500.0
SHORT_LENGTH = 0.05
LENGTHS = (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5)
NOT_TIED = Candidate("order 4, 8 nodes, E_33 not tied", Variant("ANS3DEAS", {"thickness_order": 4}))

HINGE = Strip("supports", 25.0, 20.0, 500.0)
SOFT_HINGE = Strip("supports", 25.0, 20.0, 100.0)
MARKS = (5.0, 10.0, 15.0, 20.0)
DISTORTED = ((BEND8, 25), (BEND8, 50), (BEND18, 12), (BEND18, 25))
#: Expected of distorted elements of length h or less.
WITHIN = 0.03
LEAN = (
    "sides inclined by 45 degrees: the error grows with their span along the strip, not with the length of the "
    "elements; two elements over the width halve it"
)


def turn_factor(turn: float) -> float:
    """Work of the fibres of an element that turns by an angle over that of arcs. eq. (2.33)"""
    return 0.5 * turn / float(np.tan(0.5 * turn))


def _turns(page: Page) -> None:
    page.heading("How far an element may turn")
    found: dict[str, list[float]] = {}
    lengths = page.pick(LENGTHS, (0.5, 1.0))
    turns = [2.0 * SURFACE_STRAIN * length for length in lengths]
    for candidate in page.each(page.pick((BEND8, NOT_TIED, BEND18), (BEND8,)), lambda c: f"turn, {c.label}"):
        short, *others = (
            float(ArcBending(candidate, HARDENING, length=length).moments([SURFACE_STRAIN])[-1])
            for length in (SHORT_LENGTH, *lengths)
        )
        found[candidate.label] = [100.0 * (moment / short - 1.0) for moment in others]
    degrees = [f"{np.degrees(turn):.0f}°" for turn in turns]
    rows: list[tuple[str | float, ...]] = [("length / h", *lengths)]
    rows.append(("chords for arcs, (2.33)", *(100.0 * (turn_factor(turn) - 1.0) for turn in turns)))
    rows += [(label, *errors) for label, errors in found.items()]
    title = f"Moment at R/h = 2.5, H = {HARDENING:g} MPa: error in % of that of an element of length h/20, by the turn"
    page.table(title, ("element", *degrees), rows)
    for label, errors in found.items():
        limit = 50.0 if label == "BEND18" else 20.0
        worst = max((abs(e) for e, turn in zip(errors, turns, strict=True) if np.degrees(turn) < limit), default=0.0)
        if label != NOT_TIED.label:
            page.at_most(f"{label}: worst moment, turn under {limit:g}°", worst / 100.0, 0.02)
    if not page.short:
        curves = [Curve(label, np.degrees(turns), errors, "o-") for label, errors in found.items()]
        figure = plot(curves, "turn of an element, degrees", "error of the moment, %", level=0.0)
        page.figure("turns", figure, "Error of the moment by the turn of an element, R/h = 2.5")


def _in_plane(page: Page) -> None:
    """One, four or nine polynomials in the surface with each order above 1."""
    page.heading("18 nodes: polynomials in the surface")
    rows: list[tuple[str | float, ...]] = []
    forces: dict[int, list[float]] = {}
    for count in page.each((1, 4, 9), lambda n: f"{n} polynomials"):
        candidate = Candidate(f"BEND18, {count} a term", Variant("BEND18", {"order_modes": count}))
        for cells in (6, 12, 25):
            b = bend(page, SOFT_HINGE, candidate, cells)
            rows.append((candidate.label, HINGE.length / cells, *(b.at(u) for u in MARKS), b.radius))
            forces.setdefault(count, []).append(b.at(MARKS[-1]))
    columns = ("element", "length / h", *(f"F({u:g})" for u in MARKS), "least R/h at the end")
    page.table("Three-point bend, H = 100 MPa, force in N on a width of 10 mm", columns, rows)
    spread = {n: max(row[1:]) / min(row[1:]) - 1.0 for n, row in forces.items()}
    page.at_most("nine polynomials: F(20) on lengths 2 h and h, difference", spread[9], 0.02)
    page.text(
        "F(20) with elements of length 4 h, 2 h and h: "
        + "; ".join(f"{n} a term {', '.join(f'{f:.2f}' for f in row)}" for n, row in forces.items())
        + " N."
    )


def _trapezoids(X: Floats, length: float) -> Floats:
    """Lines across the strip lean alternately to the left and to the right: parallel sides of 1/2 and 3/2 length."""
    return X + np.outer(0.5 * length * _turn_by_turn(X, length) * (X[:, 1] - 0.5), [1, 0, 0])


def _parallelograms(X: Floats, length: float) -> Floats:
    """All lines across the strip lean by 45 degrees, but for the ends."""
    return X + np.outer(_inside(X, length) * (X[:, 1] - 0.5), [1, 0, 0])


def _leaning(X: Floats, length: float) -> Floats:
    """Directors lean alternately to the left and to the right, by a quarter of the length over the thickness."""
    return X + np.outer(0.25 * length * _turn_by_turn(X, length) * X[:, 2], [1, 0, 0])


def _at_length(move: Callable[[Floats, float], Floats], length: float) -> Callable[[Floats], Floats]:
    return lambda X: move(X, length)


def _inside(X: Floats, length: float) -> Floats:
    """1 away from the ends, 0 at them, linear over two elements."""
    return np.asarray(np.clip(np.minimum(X[:, 0], HINGE.length - X[:, 0]) / (2.0 * length), 0.0, 1.0))


def _turn_by_turn(X: Floats, length: float) -> Floats:
    """Alternately 1 and -1 at the lines between elements, linear between them, 0 at the ends."""
    lines = np.linspace(0.0, HINGE.length, round(HINGE.length / length) + 1)
    values = (-1.0) ** np.arange(len(lines))
    values[[0, -1]] = 0.0
    return np.asarray(np.interp(X[:, 0], lines, values))


#: name -> move, elements over the width
SHAPES: dict[str, tuple[Callable[[Floats, float], Floats], int]] = {
    "trapezoids": (_trapezoids, 1),
    "parallelograms": (_parallelograms, 1),
    "parallelograms, two over the width": (_parallelograms, 2),
    "leaning directors": (_leaning, 1),
}


def _distorted(page: Page) -> None:
    page.heading("Distorted elements in the hinge")
    u, force, _ = calculix.forces(next(m for m in calculix.STORED if m.hardening == HARDENING and m.layers == 6))
    rows: list[tuple[str | float | None, ...]] = [
        ("CalculiX, 6 layers", None, "", *(float(np.interp(mark, u, force)) for mark in MARKS), None)
    ]
    for candidate, cells in page.each(page.pick(DISTORTED, DISTORTED[:1]), lambda c: f"{c[0].label}, {c[1]}"):
        length = HINGE.length / cells
        regular = bend(page, HINGE, candidate, cells)
        found = {"rectangles": regular}
        for name, (move, over_width) in SHAPES.items():
            if over_width > 1 and candidate is BEND18:
                continue  # biquadratic sides need no more over the width
            distortion = Distortion(name, _at_length(move, length), over_width)
            found[name] = bend(page, HINGE, candidate, cells, frames=2, distortion=distortion)
            far = max(abs(found[name].at(mark) / regular.at(mark) - 1.0) for mark in MARKS)
            what = f"{candidate.label}, length {length:.2g} h, {name}: worst force against rectangles"
            known, cause = (0.07, LEAN) if candidate is BEND8 and name.startswith("parallelograms") else (0.0, "")
            # twice the length, four times the error
            page.at_most(what, far, WITHIN if cells > 12 else 0.05, known=known, cause=cause)
        rows += [(candidate.label, length, name, *map(b.at, MARKS), b.radius) for name, b in found.items()]
        if (candidate, cells) == DISTORTED[0]:
            shape = found["trapezoids"].result
            title = f"{candidate.label} as trapezoids, at the end of the stroke"
            page.shape("trapezoids", shape, title, values="plastic_strain_max", view=(-60.0, 40.0))
    columns = ("run", "length / h", "elements", *(f"F({u:g})" for u in MARKS), "least R/h at the end")
    page.table("Three-point bend, H = 500 MPa, force in N on a width of 10 mm", columns, rows)


def run(page: Page) -> None:
    """Fill the page."""
    _turns(page)
    if not page.short:
        _in_plane(page)
    _distorted(page)


CASE = Case(
    name="bend-meshes",
    title="Meshes of sharp bends: length, turn, distortion",
    problem="""
* (a) One element in pure plastic bending, thickness free ([moment](bend-moment.md)), H = 500 MPa, bent to R/h = 2.5;
  length h/4 to 2.5 h, so it turns by 0.4 times its length over h.
* (b) The [three-point bend](bend-hinge.md), H = 100 MPa, BEND18 with one, four or nine polynomials in the surface for
  each order above 1.
* (c) The three-point bend, H = 500 MPa, plane strain, distorted meshes, one element over a width of h: trapezoids with
  sides 1 to 3; parallelograms at 45 degrees; directors inclined alternately by up to a quarter of the length over h.
""",
    reference="""
(a) The same element of length h/20, and eq. (2.33). (b), (c) CalculiX, six layers, 1.2 % from four layers
([hinge](bend-hinge.md)); in (c) also the same element as rectangles.
""",
    own="for (a), the same element of length h/20, umform itself; (b) and (c) are CalculiX",
    run=run,
    cost=60.0,
)
