"""Patch tests: is a constant state found exactly on any mesh? A matrix of who passes what."""

from __future__ import annotations

from umform.elements import element
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.page import Page
from umform_book.quality.known_failures import Row, known_failure
from umform_book.quality.patches import (
    FIELDS,
    MESHES,
    THICKNESS,
    bending_field,
    fields_on,
    patch_error,
    patch_model,
    plastic_patch_model,
)

#: What round-off leaves at most in plates of 24 thicknesses.
ROUND_OFF = 1e-10

_MODES = (
    ("DISP3D", (0,)),
    ("DISP3DEAS", (1, 4)),
    ("ANS3DEAS", (1, 4)),
    ("EAS3DEAS", (1, 4)),
    ("DISP9K3D", (0,)),
    ("DISP9K3DEAS", (1, 4, 9)),
    ("MI9K3DEAS", (1, 4, 9)),
)
ROWS = [Row(name, modes, tied) for name, counts in _MODES for modes in counts for tied in (False, True)]
ROWS += [Row("MI9K3DEAS", modes, tied, compatible_E12=True) for modes in (4, 9) for tied in (False, True)]


def failure(row: Row, mesh: str, field: str) -> float:
    """Largest error of displacements or energy over the thickness orders, and with what a plastic law takes."""
    models = [patch_model(mesh, row.name, **options) for options in row.options()]
    if row.modes == element(row.name).options["thickness_modes"]:  # that of the catalogue
        models.append(plastic_patch_model(mesh, row.name, **row.common()))
    return max(abs(error) for model in models for error in patch_error(model, field))


def run(page: Page) -> None:
    """Fill the page."""
    rows = page.pick(ROWS, [row for row in ROWS if row.modes != 1 and row.tied])
    for mesh in page.each(list(MESHES)):
        found = {(row, field): failure(row, mesh, field) for row in rows for field in fields_on(mesh)}
        _check(page, mesh, found)
        matrix = [(row.label, *(_cell(found.get((row, field))) for field in FIELDS)) for row in rows]
        page.table(f"Mesh: {mesh}", ("element", *FIELDS), matrix)
    _pictures(page)


def _check(page: Page, mesh: str, found: dict[tuple[Row, str], float]) -> None:
    """One check for all that must pass, and one for all known failures of the same cause and size."""
    groups: dict[tuple[float, str] | None, dict[str, list[float]]] = {}
    for (row, field), error in found.items():
        known = known_failure(row, mesh, field)
        groups.setdefault(known, {}).setdefault(f"{row.name}, {field}" if known else "", []).append(error)
    for known, errors in groups.items():
        largest, count = max(max(e) for e in errors.values()), sum(len(e) for e in errors.values())
        what = f"{mesh}, {count} tests: "
        if known is None:
            page.at_most(what + "all that must pass", largest, ROUND_OFF)
        else:
            page.at_most(what + "; ".join(errors), largest, ROUND_OFF, known=known[0], cause=known[1])


def _cell(error: float | None) -> str:
    if error is None:
        return "-"
    return "pass" if error <= ROUND_OFF else f"**{error:.1e}**"


def _pictures(page: Page) -> None:
    for mesh in ("distorted", "uneven stack"):
        plate = MESHES[mesh]("hex8", THICKNESS)
        u = 400.0 * bending_field(plate.points, THICKNESS)
        name = mesh.replace(" ", "-")
        page.shape(name, Shape.displaced(plate, u), f"Mesh: {mesh}, the exact bending field 400 times enlarged")


CASE = Case(
    name="patch-tests",
    title="Patch tests",
    problem=f"""
A plate 0.24 x 0.12, thickness {THICKNESS:g} (ten times that of the literature, so that round-off stays below
{ROUND_OFF:g}), E = 1e6, nu = 0.25. Constant states, strain 1e-3: membrane; bending with curvatures 1, 1 and twist 1/2;
stress through the thickness; transverse shear in xz and in yz. All nodes of the lateral faces are prescribed, the
stress S n stands as a traction on the lower and upper face. Meshes: 3 x 2 rectangles; parallelograms; the five
distorted quadrilaterals of MacNeal & Harder; rectangles whose inner nodes lie half a thickness above and below the
plane (warped: constant strain in three dimensions, bending is no exact state there); two layers of rectangles; the
same with the inner nodes of the interface a fifth of the thickness above and below (uneven). Each number is the larger
of the errors of the displacements (over the largest one) and of the energy, for thickness orders 1 and 3, and for the
complete order and the points of a plastic law (one that does not flow).
""",
    reference="""
The states are exact solutions of linear elasticity, so there is no uncertainty. Plate: MacNeal & Harder, Finite Elem.
Anal. Des. 1 (1985) 3-20; bending fields: Vu-Quoc & Tan, Comput. Meth. Appl. Mech. Engng. 192 (2003) 975-1016.
""",
    run=run,
    cost=10.0,
)
