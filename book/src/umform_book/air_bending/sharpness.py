"""Blunt and sharp bends in the air: force and outer strain against order, points and layers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from umform.processes.air_bending import AirBending
from umform_book.air_bending.causes import ONE_LAYER, ONE_LAYER_THEORY
from umform_book.air_bending.runs import INCREMENT, Loading, load, outer_strain
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.variants import Variant

OPENING = 16.0


@dataclass(frozen=True)
class Bluntness:
    """Approximate R/h of a thickness and a stroke."""

    ratio: float
    thickness: float
    stroke: float

    @property
    def label(self) -> str:
        """Name in tables and checks."""
        return f"R/h about {self.ratio:g}"


#: The inside radius is about 16 % of the opening at 90 degrees, and larger before.
BENDS = (
    Bluntness(1.0, 2.56, 5.5),
    Bluntness(2.0, 1.28, 5.5),
    Bluntness(5.0, 0.8, 4.2),
    Bluntness(10.0, 0.5, 3.3),
    Bluntness(20.0, 0.35, 2.5),
)


@dataclass(frozen=True)
class Sheet:
    """Elements, layers and points of the sheet.

    Attributes
    ----------
    label : str
        Name in tables.
    variant : Variant
        Element.
    layers, points : int
        Elements through the thickness, and thickness points of each.
    along : float
        Elements per thickness along the bend.
    """

    label: str
    variant: Variant
    layers: int
    points: int
    along: float = 3.0

    def case(self, bend: Bluntness) -> AirBending:
        """The brake of `umform bend` without options but with twice the penetration, with this sheet."""
        return AirBending(
            thickness=bend.thickness,
            opening=OPENING,
            element=self.variant.element,
            layers=self.layers,
            thickness_points=self.points,
            elements_per_thickness=self.along,
            penetration=bend.thickness / 100.0,
            increment=INCREMENT if bend.ratio <= 2.0 else 0.02,
        )


def _order(order: int) -> Sheet:
    options = {"thickness_order": order, "tie_E33": True} if order > 1 else {}
    return Sheet(f"order {order}, 2 layers of 6 points", Variant("MI9K3DEAS", options), 2, 6)


STACK = Sheet("stack of 4 EAS3DEAS, order 2", Variant("EAS3DEAS", {"thickness_order": 2, "tie_E33": True}), 4, 4, 6.0)
DEFAULT = Sheet("BEND18 (order 4), 2 layers of 6 points: the default", Variant("BEND18"), 2, 6)
FIVE = Sheet("BEND18, 2 layers of 5 points", Variant("BEND18"), 2, 5)
EIGHT = Sheet("BEND18, 2 layers of 8 points", Variant("BEND18"), 2, 8)
SINGLE = Sheet("BEND18, 1 layer of 12 points", Variant("BEND18"), 1, 12)
ORDERS = tuple(_order(order) for order in (1, 2, 3))

Runs = dict[Sheet, Loading]


def _sheets(page: Page, bend: Bluntness) -> tuple[Sheet, ...]:
    if page.short:
        return (STACK, DEFAULT)
    if bend.ratio > 2.0:  # orders 2 to 4 are the same
        return (STACK, ORDERS[0], DEFAULT, EIGHT, SINGLE)
    return (STACK, *ORDERS, DEFAULT, FIVE, EIGHT, SINGLE)


def strain(found: Loading) -> float:
    """Mean strain of the outer face from the middle over an element of the sheet of 18-node elements."""
    case = found.case
    return outer_strain(found.section, max(case.thickness, case.opening / 16.0) / 3.0)


def _radius(found: Loading) -> float:
    """R/h under load."""
    return found.section.radius / found.case.thickness


def _table(page: Page, bend: Bluntness, found: Runs) -> None:
    top, stretched = float(found[STACK].force.max()), strain(found[STACK])
    rows: list[tuple[str | float, ...]] = []
    for sheet, run in found.items():
        force, e = float(run.force.max()), strain(run)
        rows.append((sheet.label, force, force / top, e, e / stretched, run.section.angle, _radius(run)))
    columns = ("sheet", "largest force N/mm", "over stack", "outer strain", "over stack", "angle under load", "R/h")
    page.table(f"{bend.label}: h = {bend.thickness:g} mm, at a stroke of {bend.stroke:g} mm", columns, rows)


def _judge(page: Page, bend: Bluntness, found: Runs) -> None:
    top, stretched = float(found[STACK].force.max()), strain(found[STACK])
    # The stack of 4 has 0.3 % (force) and 1.5 % (strain) of its own at R/h = 1, seen from one of 8.
    page.check(f"{bend.label}, default: largest force", float(found[DEFAULT].force.max()), top, 0.03)
    page.check(f"{bend.label}, default: outer strain", strain(found[DEFAULT]), stretched, 0.04)
    if page.short:
        return
    # the heights of points relative to the border of flow change with their number: the limit is that of the default
    page.check(f"{bend.label}, 8 points for 6: outer strain", strain(found[EIGHT]), strain(found[DEFAULT]), 0.04)
    what = f"{bend.label}, one layer: outer strain"
    page.check(what, strain(found[SINGLE]), stretched, 0.04, known=0.27, cause=ONE_LAYER, theory=ONE_LAYER_THEORY)


def _figure(page: Page, found: Mapping[Bluntness, Runs]) -> None:
    shown = {"order 1, 2 layers": ORDERS[0], "BEND18, 2 layers": DEFAULT, "BEND18, 1 layer": SINGLE}
    radii = [_radius(run[STACK]) for run in found.values()]
    for name, what, of in (
        ("force", "largest force over that of the stack", lambda run: float(run.force.max())),
        ("strain", "outer strain over that of the stack", strain),
    ):
        curves = [
            Curve(label, radii, [of(run[sheet]) / of(run[STACK]) for run in found.values()], "o-")
            for label, sheet in shown.items()
        ]
        page.figure(name, plot(curves, "R/h", what, log="x", level=1.0), f"{what.capitalize()}, by R/h")


def run(page: Page) -> None:
    """Fill the page."""
    found: dict[Bluntness, Runs] = {}
    pairs = [(bend, sheet) for bend in page.pick(BENDS, BENDS[:1]) for sheet in _sheets(page, bend)]
    for bend, sheet in page.each(pairs, lambda pair: f"{pair[0].label}, {pair[1].label}"):
        loading = load(page, f"{bend.label}, {sheet.label}", sheet.case(bend), bend.stroke)
        found.setdefault(bend, {})[sheet] = loading
    for bend, runs in found.items():
        _table(page, bend, runs)
        _judge(page, bend, runs)
    if page.short:
        return
    _figure(page, found)
    _advice(page, found)
    sharpest = found[BENDS[0]][DEFAULT].result
    page.shape("shape", sharpest, "Half of the sheet, R/h = 1", values="plastic_strain_max", view=(-90, 0))


def _advice(page: Page, found: Mapping[Bluntness, Runs]) -> None:
    def off(runs: Runs, sheet: Sheet) -> str:
        return f"{100 * (strain(runs[sheet]) / strain(runs[STACK]) - 1):+.0f} %"

    sheets = {"order 1": ORDERS[0], "order 2": ORDERS[1], "the default": DEFAULT, "one layer of BEND18": SINGLE}
    said = [
        f"{bend.label}: " + ", ".join(f"{name} {off(runs, sheet)}" for name, sheet in sheets.items() if sheet in runs)
        for bend, runs in found.items()
    ]
    page.text(
        f"**Outer strain against the stack.** {'; '.join(said)}. In two layers, order 1 locks in sharp bends and "
        "orders 2 to 4 hardly differ, since each layer bends half as sharply for its thickness. One layer is too "
        "sharp, also with order 4 ([cause](air-bend-mesh.md))."
    )


CASE = Case(
    name="air-bend-sharpness",
    title="Air bending: blunt and sharp bends",
    problem=f"""
The default brake of `umform bend` (opening {OPENING:g} mm, tools of 85 degrees, shoulders of 2 mm, tip of 1.5 mm, metal
like DC04, plane strain) with sheets of 2.56 to 0.35 mm, bent until the inside radius R under load is 1 to 20
thicknesses h. Two layers of the 18-node element with thickness order 1 (as in the literature), 2, 3 (E_33 tied) and 4
(BEND18), and several numbers of thickness points; one layer. Three elements per thickness (or per 1/16 of the opening,
if that is more); automatic contact points, allowed penetration h/100. Outer strain: mean logarithmic strain over the
element next to the middle.
""",
    reference="""
Stack of four layers of EAS3DEAS of order 2, E_33 tied, twice as many elements along: another element with other
assumptions. Uncertainty at R/h = 1, from eight layers on twice as many elements: 0.3 % of the largest force, 1.5 % of
the outer strain.
""",
    own="four layers of EAS3DEAS of order 2, umform itself",
    run=run,
    picture="strain",
    cost=50.0,
)
