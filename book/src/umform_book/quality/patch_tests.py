"""Patch tests: does an element find a constant state exactly on any mesh?"""

from __future__ import annotations

from umform.elements import element
from umform.results.shape import Shape
from umform_book.case import Case
from umform_book.page import Page
from umform_book.quality.known_failures import ExpectedFailure, Row, known_failure
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


#: An element, a mesh and a state.
Test = tuple[Row, str, str]


def failure(row: Row, mesh: str, field: str) -> float:
    """Largest error of displacements or energy over the thickness orders, and with the setting of a plastic law."""
    models = [patch_model(mesh, row.name, **options) for options in row.options()]
    if row.modes == element(row.name).options["thickness_modes"]:  # that of the catalogue
        models.append(plastic_patch_model(mesh, row.name, **row.common()))
    return max(abs(error) for model in models for error in patch_error(model, field))


def run(page: Page) -> None:
    """Fill the page."""
    rows = page.pick(ROWS, [row for row in ROWS if row.modes != 1 and row.tied])
    found = {
        (row, mesh, field): failure(row, mesh, field)
        for mesh in page.each(list(MESHES))
        for row in rows
        for field in fields_on(mesh)
    }
    _by_element(page, found)
    for mesh in MESHES:
        matrix = [(row.label, *(_cell(found.get((row, mesh, field))) for field in FIELDS)) for row in rows]
        page.table(f"Mesh: {mesh}", ("element", *FIELDS), matrix)
    _pictures(page)


def _by_element(page: Page, found: dict[Test, float]) -> None:
    """What each element must pass and need not pass; a check for each group of the same cause and size."""
    table = []
    for name in dict.fromkeys(row.name for row, _, _ in found):
        must: list[Test] = []
        groups: dict[ExpectedFailure, list[Test]] = {}
        for test in (test for test in found if test[0].name == name):
            known = known_failure(*test)
            (must if known is None else groups.setdefault(known, [])).append(test)
        largest = max(found[test] for test in must)
        page.at_most(f"{name}: {len(must)} tests that it must pass", largest, ROUND_OFF)
        need_not = {expected: _named(tests) for expected, tests in groups.items()}
        for expected, tests in groups.items():
            worst = max(found[test] for test in tests)
            what = f"{name}, {need_not[expected]}, {len(tests)} test{'s' * (len(tests) > 1)}"
            limit, cause, theory = expected
            page.at_most(what, worst, ROUND_OFF, known=limit, cause=cause, theory=theory)
        passed = sum(found[test] <= ROUND_OFF for tests in groups.values() for test in tests)
        page.at_most(f"{name}: tests that it should fail and passes", passed, 0.0)
        good = sum(found[test] <= ROUND_OFF for test in must)
        table.append((name, f"{good} of {len(must)}", "; ".join(dict.fromkeys(need_not.values())) or "-"))
    page.table(
        "What each element must pass, and need not", ("element", "passes of those it must", "need not pass"), table
    )


def _named(tests: list[Test]) -> str:
    """States and meshes of some tests."""
    fields = dict.fromkeys(field for _, _, field in tests)
    meshes = dict.fromkeys(mesh for _, mesh, _ in tests)
    return f"{', '.join(fields)} ({', '.join(meshes)})"


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
Plate 0.24 x 0.12, thickness {THICKNESS:g} (ten times that of the literature, to keep round-off below {ROUND_OFF:g}),
E = 1e6, nu = 0.25.

* States, strain 1e-3: membrane; bending with curvatures 1, 1 and twist 1/2; stress through the thickness; transverse
  shear xz and yz. All nodes of the lateral faces are prescribed; the lower and upper faces carry the traction S n.
* Meshes: 3 x 2 rectangles; parallelograms; five distorted quadrilaterals; warped (inner nodes half a thickness off the
  plane, where bending is not exact); two layers; two layers with an uneven interface (nodes a fifth of the thickness
  off).

The error is the larger one of displacements (over the largest) and energy, for thickness orders 1 and 3, and for the
complete order and the points of a plastic law (one that does not flow).
""",
    reference="""
Exact solutions of linear elasticity. Plate and meshes: MacNeal & Harder, Finite Elem. Anal. Des. 1 (1985) 3-20. Bending
fields: Vu-Quoc & Tan, Comput. Meth. Appl. Mech. Engng. 192 (2003) 975-1016. What each element must pass:
[theory 2.9](../theory/2-elements.md).
""",
    run=run,
    cost=10.0,
)
