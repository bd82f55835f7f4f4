"""Stability: eigenvalues in large strains, one element over the width, iterations of Newton's method, patch tests."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from umform.materials import J2, NeoHooke
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.printed import about
from umform_book.quality.patches import MESHES, fields_on, patch_error, patch_model
from umform_book.sharp_bends.candidates import BEND8, BEND18, Candidate, of_order, steel
from umform_book.sharp_bends.states import EDGE, STATES, Patch, first_loss, lowest_eigenvalues, stress_free
from umform_book.sharp_bends.strips import Bend, Strip, bend
from umform_book.variants import Variant, with_tying

#: The elements for bends, each after the one that it is made of.
PAIRS = (("ANS3DEAS", "BEND8"), ("MI9K3DEAS", "BEND18"))
#: Base element, element for bends, elements along the edge of the patch (lengths h and h/2, 2 h and h), distorted.
COMPARED = (
    ("ANS3DEAS", "BEND8", 4, False),
    ("ANS3DEAS", "BEND8", 8, False),
    ("ANS3DEAS", "BEND8", 4, True),
    ("MI9K3DEAS", "BEND18", 2, False),
    ("MI9K3DEAS", "BEND18", 4, False),
    ("MI9K3DEAS", "BEND18", 2, True),
)
#: Elements along the edge of the finer patches.
FINE = {"BEND8": 8, "BEND18": 4}
CONTINUUM = Patch(Variant("DISP9K3DEAS", {"thickness_order": 2}), 4, 2)
_LARGE = tuple(float(part) for part in np.linspace(0.0, 1.0, 21)[1:])
_SMALL = (*(float(part) for part in np.linspace(0.0, 0.998, 10)[1:]), 1.0)
#: Laws with the path to a state: the parts of it that are reached by the increments.
LAWS: dict[str, tuple[J2 | NeoHooke, tuple[float, ...]]] = {
    "plastic flow, H = 500, large increments": (steel(500.0), _LARGE),
    "plastic flow, H = 0, large increments": (steel(0.0), _LARGE),
    "plastic flow, H = 0, a small last increment": (steel(0.0), _SMALL),
    "elastic (neo-Hooke, nu = 0.3)": (NeoHooke(E=1000.0, nu=0.3), (1.0,)),
}
#: Lowest eigenvalue and number of negative ones by state.
Counts = dict[str, tuple[float, int]]
SQUEEZED = "through the thickness 0.5"
_CAUSES = {
    "flow": "the tangent of increments of 2 % strain is softer than that of the material; small increments show none",
    "squeezed": "compression through the thickness turns directors alternately, and tied E_33 acts on them in full",
    "elastic BEND8": "the tied shear does not see an alternating mode in large elastic compression",
    "elastic BEND18": "the same modes as MI9K3DEAS, on a mesh finer than that of the continuum",
}

_TYING = "Wriggers & Reese, Comput. Meth. Appl. Mech. Engng. 135 (1996) 201-209"

PAPER = Strip("cylinder", 60.0, 15.0, 500.0, steps=75)
HINGE = Strip("supports", 25.0, 20.0, 500.0)


# Eigenvalues ------------------------------------------------------------------------------------------------------


def _patches(law: str, short: bool) -> list[Patch]:
    """Finer meshes where plastic flow has no stiffness of its own, distorted ones where it has, both elastically."""
    hardening, perfect = "H = 500" in law, "H = 0" in law
    patches = [
        Patch(Variant(name), count, distorted=distorted)
        for base, bend_, count, distorted in COMPARED
        for name in (base, bend_)
        if not (distorted and perfect) and not (count == FINE[bend_] and hardening)
    ]
    if short:
        return [*(patch for patch in patches if patch.count not in FINE.values() or patch.length > 1), CONTINUUM]
    return [Patch(Variant("DISP3D"), 4), Patch(Variant("EAS3DEAS"), 4), *patches, CONTINUUM]


def _eigenvalues(page: Page) -> None:
    page.heading("Eigenvalues in large strains")
    for law in page.pick(tuple(LAWS), tuple(LAWS)[2:3]):
        material, path = LAWS[law]
        states = page.pick(STATES, (STATES[0], STATES[4]))
        stretches = {state.name: stress_free(state, material, path) for state in states}
        found = {
            patch: lowest_eigenvalues(patch, material, stretches, path)
            for patch in page.each(_patches(law, page.short), lambda patch: patch.label)
        }
        title = f"{law}: negative eigenvalues, and the lowest in MPa mm, of a clamped patch"
        rows = [(patch.label, *(f"{n}, {low:.0f}" for low, n in row.values())) for patch, row in found.items()]
        page.table(title, ("element", *stretches), rows)
        _check_eigenvalues(page, law, found)


def _check_eigenvalues(page: Page, law: str, found: dict[Patch, Counts]) -> None:
    """No more negative eigenvalues than the base element, nor than the continuum."""
    continuum = found[CONTINUUM]
    for base, name, count, distorted in COMPARED:
        patch = Patch(Variant(name), count, distorted=distorted)
        if patch not in found:
            continue
        mine, its = found[patch], found[replace(patch, variant=Variant(base))]
        what = f"{patch.label}, {law}: negative eigenvalues more than"
        page.at_most(f"{what} {base}, all states but {SQUEEZED}", _more(mine, its), 0.0)
        elastic = law.startswith("elastic")
        soft = law.startswith("plastic flow, H = 0, large") and (name, count) in (("BEND8", 8), ("BEND18", 4))
        allowed = {"BEND8": 110.0, "BEND18": 4.0}[name] if elastic else 1.0 if soft else 0.0
        cause = _CAUSES[f"elastic {name}" if elastic else "flow"] if allowed else ""
        more = _more(mine, continuum)
        theory = _TYING if elastic and name == "BEND8" else ""
        page.at_most(f"{what} the continuum, the same", more, 0.0, known=allowed, cause=cause, theory=theory)
        if SQUEEZED in mine:
            many = _more(mine, continuum, squeezed=True)
            known = 100.0 if elastic else 0.0 if law.endswith("small last increment") else 8.0
            cause = _CAUSES["squeezed"] if known else ""
            page.at_most(f"{what} the continuum, {SQUEEZED}", many, 0.0, known=known, cause=cause)


def _more(mine: Counts, other: Counts, squeezed: bool = False) -> int:
    """Negative eigenvalues beyond those of another patch, in all states but the squeezed one, or in that."""
    return sum(max(0, mine[s][1] - other[s][1]) for s in mine if (s == SQUEEZED) == squeezed)


def _squeezing(page: Page) -> None:
    """Stretch at which a patch, squeezed in large increments, loses its stability."""
    page.heading("Squeezed through the thickness")
    material, path = LAWS[next(iter(LAWS))]
    state = next(state for state in STATES if state.name == SQUEEZED)
    stretches = stress_free(state, material, path)
    rows: list[tuple[str | float, ...]] = []
    for base, name, count, distorted in page.each(COMPARED, lambda c: f"squeezed, {c[1]}"):
        patches = [Patch(Variant(which), count, distorted=distorted) for which in (name, base)]
        rows.append((patches[0].label, *(first_loss(patch, material, stretches, path) for patch in patches)))
    rows.append((CONTINUUM.label, first_loss(CONTINUUM, material, stretches, path), float("nan")))
    columns = ("patch", "thickness over h when lost", "base element")
    page.table("Plastic flow, H = 500, 20 increments to half the thickness; a dash: not lost", columns, rows)


# One element over the width ---------------------------------------------------------------------------------------


def _width(page: Page) -> None:
    page.heading("Elements over the width")
    meshes: list[tuple[Candidate, int, int]] = [(BEND8, 24, 1), (BEND8, 24, 2), (BEND8, 48, 2)]
    meshes += [(of_order("ANS3DEAS", 1), 24, 1), (BEND18, 12, 1), (BEND18, 24, 1), (BEND18, 24, 2)]
    marks = (2.0, 5.0, 10.0, 15.0)
    found: dict[tuple[str, int, int], Bend] = {}
    for candidate, along, across in page.each(meshes, lambda m: f"{m[0].label} {m[1]}x{m[2]}"):
        found[candidate.label, along, across] = bend(page, PAPER, candidate, along, across, frames=2)
    rows: list[tuple[str | float, ...]] = []
    rows += [(f"{label}, {n} x {m}", *(b.at(u) for u in marks)) for (label, n, m), b in found.items()]
    columns = ("run", *(f"F({u:g})" for u in marks))
    page.table("The paper's strip in three dimensions, H = 500 MPa, force in N of the width of 10 mm", columns, rows)
    one, two, fine = (found["BEND8", *size].at(15.0) for size in ((24, 1), (24, 2), (48, 2)))
    page.check("BEND8 24 x 2: F(15) against 48 x 2", two, fine, 0.05)
    cause = "one bilinear element over the width tilts across the strip; take two, plane strain, or BEND18"
    page.check("BEND8 24 x 1: F(15) against 24 x 2", one, two, 0.05, known=0.55, cause=cause)
    single, double = (found["BEND18", *size].at(15.0) for size in ((24, 1), (24, 2)))
    page.check("BEND18 24 x 1: F(15) against 24 x 2", single, double, 0.05)
    page.text(
        f"With one bilinear element over the width the section of BEND8 tilts across the strip: F(15) is {one:.1f} N, "
        f"with two {two:.1f} N. Order 1 hides the mode by locking ({found['order 1, 8 nodes', 24, 1].at(15.0):.1f} N); "
        f"its result is no more reliable. BEND18 does not tilt ({single:.1f} and {double:.1f} N)."
    )
    curves = [Curve(f"{label}, {n} x {m}", b.u, b.force) for (label, n, m), b in found.items()]
    page.figure("width", plot(curves, "displacement u, mm", "force F, N"), "Elements over the width, H = 500 MPa")
    title = "BEND8, one element over the width, at the end: the section has tilted"
    page.shape("tilted", found["BEND8", 24, 1].result, title, values="plastic_strain_max")


# Newton -----------------------------------------------------------------------------------------------------------


def _iterations(page: Page) -> None:
    page.heading("Iterations of Newton's method")
    chosen = [(of_order("ANS3DEAS", p), 25) for p in (1, 2, 3)] + [
        (BEND8, 25),
        (of_order("MI9K3DEAS", 1), 12),
        (BEND18, 12),
    ]
    chosen = list(page.pick(chosen, [chosen[0], chosen[3]]))
    rows, curves = [], []
    counts = {}
    for candidate, cells in page.each(chosen, lambda c: c[0].label):
        found = bend(page, HINGE, candidate, cells)
        increments = len(found.u) - 1
        counts[candidate.label] = found.iterations / increments
        rows.append(
            (
                candidate.label,
                increments,
                about(found.iterations),
                about(round(10 * found.iterations / increments)) / 10,
            )
        )
        curves.append(Curve(candidate.label, found.u, np.cumsum(found.result["iterations"])))
    page.table(
        "Three-point bending, H = 500 MPa", ("element", "increments", "iterations, about", "per increment"), rows
    )
    ratio = counts["BEND8"] / counts["order 1, 8 nodes"]
    page.at_most("BEND8: iterations more than those of order 1, as a fraction", ratio - 1.0, 0.25)
    page.figure("newton", plot(curves, "displacement u, mm", "iterations so far"), "Iterations in the three-point bend")


# Patch tests ------------------------------------------------------------------------------------------------------


def _patch_tests(page: Page) -> None:
    page.heading("Patch tests")
    passed = 1e-10
    rows: list[tuple[str, ...]] = []
    columns: list[str] = []
    for base, name in PAIRS:
        pair = with_tying(base), Variant(name)
        found: dict[str, list[str]] = {variant.label: [] for variant in pair}
        columns = []
        differ = 0
        for mesh in page.pick(tuple(MESHES), ("parallelograms", "distorted")):
            for field in fields_on(mesh):
                errors = []
                for variant in pair:
                    error = max(map(abs, patch_error(patch_model(mesh, variant.element), field)))
                    found[variant.label].append("pass" if error <= passed else f"{error:.1e}")
                    errors.append(error)
                differ += (errors[0] <= passed) != (errors[1] <= passed)
                columns.append(f"{mesh}: {field}")
        rows += [(which, *cells) for which, cells in found.items()]
        page.at_most(f"{name}: patch tests that it passes and {pair[0].label} does not, or the reverse", differ, 0.0)
    names = [row[0] for row in rows]
    by_test = [(test, *(row[k + 1] for row in rows)) for k, test in enumerate(columns)]
    page.table(
        "Errors of displacements or energy; meshes of the [patch tests](patch-tests.md)", ("test", *names), by_test
    )


def run(page: Page) -> None:
    """Fill the page."""
    _eigenvalues(page)
    page.text(
        "Neither the order nor distortion changes the count in these states; compression through the thickness does, "
        "by the tying. Compressed to half its length the elastic patch truly buckles (continuum); elements with tied "
        "shear have additional negative eigenvalues, also at order 1. In plastic flow the consistent tangent depends "
        "on the increment: a large one makes it softer across the flow, and small increments remove those negative "
        "eigenvalues (table with a small last increment). Switch tie_E33 off for coining."
    )
    if not page.short:
        _squeezing(page)
        _width(page)
    _iterations(page)
    _patch_tests(page)


CASE = Case(
    name="bend-stability",
    title="Stability of the elements for bends",
    problem=f"""
* (a) Square patches with edges of {EDGE:g} h, h = 1, brought homogeneously to the stretches in the head of the table
  (free stress elsewhere); then the lateral sides are clamped and the negative eigenvalues of the tangent counted. Also
  with corners moved in the plane by up to 0.3 h, sides straight. J2 with kappa = 175000, mu = 80770, y0 = 160, in 20
  equal logarithmic increments or with a last increment of 0.2 % of the path; neo-Hooke with E = 1000, nu = 0.3.
* (b) The strip of the [paper](bending-reproduction.md), H = 500, 10 wide, in three dimensions.
* (c) The [three-point bend](bend-hinge.md), H = 500, 50 increments, elements of length h (18 nodes: 2 h).
* (d) The [patch tests](patch-tests.md).
""",
    reference="""
(a) A continuum: two layers of DISP9K3DEAS of order 2 on the same patch (its own buckling is physical; its number of
negative eigenvalues is a lower bound, since finer meshes have more modes); and the base element of BEND8 or BEND18. The
alternating mode of tied or enhanced elements in large compression is known: Wriggers & Reese, Comput. Meth. Appl. Mech.
Engng. 135 (1996) 201-209. (b) The force of a strip does not depend on the elements over its width. (c) Order 1. (d) The
base element with E_33 tied.
""",
    own="for (a), two layers of DISP9K3DEAS of order 2, umform itself",
    run=run,
    cost=70.0,
)
