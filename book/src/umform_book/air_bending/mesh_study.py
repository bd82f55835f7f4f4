"""Air bending on meshes: elements, layers, length of the elements; and why one layer bends too sharply."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from umform.materials import Material
from umform.model import Model
from umform.processes.air_bending import AirBending, Measures, find_stroke
from umform_book.air_bending.causes import LAYERS, ONE_LAYER, ONE_LAYER_THEORY, known
from umform_book.air_bending.pure_bending import Arc
from umform_book.air_bending.runs import INCREMENT, Floats, Loading, bend, curvatures, load, moments
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page
from umform_book.sharp_bends.candidates import Candidate
from umform_book.variants import Variant

STROKE = 5.5
#: Limits of angle (degrees), largest force and springback against the reference, and known deviations.
WITHIN = {"angle": (0.4, 1.0), "force": (0.01, 0.04), "springback": (0.02, 0.06)}
#: Known deviation of the angle of one layer, degrees.
ONE_KNOWN = 3.0


@dataclass(frozen=True)
class Sheet:
    """An element, its layers, and elements per thickness on three meshes."""

    element: str
    layers: int
    points: int
    along: tuple[float, ...]

    @property
    def label(self) -> str:
        """Name in tables."""
        return f"{self.element}, {self.layers} layer{'s' if self.layers > 1 else ''}"

    def case(self, along: float) -> AirBending:
        """The default brake with this sheet."""
        element = self.element
        return AirBending(
            stroke=STROKE,
            element=Variant(element, {"thickness_order": 2, "tie_E33": True}).element if "EAS" in element else element,
            layers=self.layers,
            thickness_points=self.points,
            elements_per_thickness=along,
            increment=INCREMENT,
        )


REFERENCE = Sheet("EAS3DEAS", 8, 4, (12.0,))
DEFAULT = Sheet("BEND18", 2, 6, (1.5, 3.0, 6.0))
SINGLE = Sheet("BEND18", 1, 12, (1.5, 3.0, 6.0))
THREE, FOUR = Sheet("BEND18", 3, 6, (3.0,)), Sheet("BEND18", 4, 5, (3.0,))
BEND8 = Sheet("BEND8", 1, 12, (6.0,))
STACK = Sheet("EAS3DEAS", 4, 4, (3.0, 6.0, 12.0))
SHEETS = (SINGLE, DEFAULT, THREE, FOUR, BEND8, Sheet("BEND8", 2, 6, (3.0, 6.0, 12.0)), STACK)

Found = dict[tuple[Sheet, float], Measures]


def _study(page: Page) -> Found:
    short = ((SINGLE, 1.5), (DEFAULT, 1.5))
    pairs = page.pick([(sheet, along) for sheet in (REFERENCE, *SHEETS) for along in sheet.along], short)
    found: Found = {}
    for sheet, along in page.each(pairs, lambda pair: f"{pair[0].label}, {pair[1]:g} per thickness"):
        found[sheet, along] = bend(page, f"{sheet.label}, {along:g} elements per thickness", sheet.case(along)).measures
    rows = [
        (sheet.label, along, m.angle, m.springback, m.largest_force, m.radius, m.k_factor, m.outer_strain)
        for (sheet, along), m in found.items()
    ]
    columns = (
        "sheet",
        "elements per thickness",
        "angle",
        "springback",
        "largest force N/mm",
        "R mm",
        "K",
        "outer strain",
    )
    page.table(f"After a stroke of {STROKE:g} mm", columns, rows)
    return found


def _judge(page: Page, found: Found) -> None:
    if page.short:
        one, two = (found[sheet, 1.5].angle for sheet in (SINGLE, DEFAULT))
        page.check("one layer against two: angle, degrees", one, two, 0.4, relative=False, known=4.0, cause=ONE_LAYER)
        return
    reference = found[REFERENCE, REFERENCE.along[0]]
    for sheet, along in ((DEFAULT, 3.0), (DEFAULT, 6.0), (THREE, 3.0), (FOUR, 3.0), (STACK, 12.0)):
        m, what = found[sheet, along], f"{sheet.label}, {along:g} elements per thickness"
        causes = {name: known(limit, LAYERS, sheet is not STACK) for name, (_, limit) in WITHIN.items()}
        within = {name: limit for name, (limit, _) in WITHIN.items()}
        angles = m.angle, reference.angle, within["angle"]
        page.check(f"{what}: angle, degrees", *angles, relative=False, **causes["angle"])
        forces = m.largest_force, reference.largest_force, within["force"]
        page.check(f"{what}: largest force", *forces, **causes["force"])
        page.check(
            f"{what}: springback", m.springback, reference.springback, within["springback"], **causes["springback"]
        )
    for sheet, along in ((SINGLE, 3.0), (BEND8, 6.0)):
        angles = found[sheet, along].angle, reference.angle, WITHIN["angle"][0]
        what = f"{sheet.label}, {along:g} elements per thickness: angle, degrees"
        page.check(what, *angles, relative=False, known=ONE_KNOWN, cause=ONE_LAYER, theory=ONE_LAYER_THEORY)


def _plot(page: Page, found: Found) -> None:
    curves = []
    for sheet in (s for s in SHEETS if len(s.along) > 1):
        lengths = [1.0 / along for along in sheet.along]
        style = "o--" if sheet.element == "BEND18" else "o-"
        curves.append(Curve(sheet.label, lengths, [found[sheet, along].angle for along in sheet.along], style))
    level = found[REFERENCE, REFERENCE.along[0]].angle
    figure = plot(curves, "length of an element over the thickness", "angle, degrees", log="x", level=level)
    page.figure("angle", figure, "Angle after unloading over the length of the elements; line: stack of 8")


# Why one layer bends too sharply ----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Metal(Candidate):
    """A candidate of the metal of the brake; it ignores the hardening that is passed."""

    def strip(
        self,
        x: Floats,
        y: Floats,
        thickness: float,
        hardening: float,
        shape: Callable[[Floats], Floats] | None = None,
    ) -> Model:
        """Flat strip between the stations x and y, its mid-surface at z = 0; its nodes moved by a shape if wanted."""
        flat = super().strip(x, y, thickness, hardening, shape).mesh
        element, rule = self.variant.element, self.rule
        return Model(flat, element, material=_metal(), thickness_points=self.points, thickness_rule=rule)


def _metal() -> Material:
    return AirBending().material


def _pure_bending(turns: Floats) -> Floats:
    """Moment for h = 1 at turns k h, from a stack of eight layers in pure bending."""
    arc = Arc(Metal("", Variant("ANS3DEAS", {"thickness_order": 2, "tie_E33": True}), 4, "gauss", 8), 1.0)
    found = []
    for turn in turns:
        for curvature in np.linspace(arc.curvature, turn, 7)[1:]:
            arc.bend_to(float(curvature))
        found.append(arc.moment)
    return np.array(found)


def _over_pure(loading: Loading, turns: Floats, pure: Floats) -> tuple[Floats, Floats]:
    """Distance of the elements that flow from the middle over h, and their moment over that of pure bending."""
    h = loading.case.thickness
    X, k = curvatures(loading.section)
    bent = (k * h > turns[0]) & (k * h < turns[-1])
    return X[bent] / h, moments(loading)[bent] / (h**2 * np.interp(k[bent] * h, turns, pure))


def _cause(page: Page) -> None:
    page.heading("Why one layer bends too sharply")
    turns = np.linspace(0.05, 1.0, 20)
    pure = _pure_bending(turns)
    curves = []
    rows = []
    for layers, points in ((1, 12), (2, 6), (4, 5)):
        case = AirBending(layers=layers, thickness_points=points, increment=INCREMENT, contact_points=10)
        loading = load(page, f"cause: {layers} layers", case, STROKE)
        x, ratio = _over_pure(loading, turns, pure)
        near, far = ratio[x < 0.5], ratio[(x > 1.0) & (x < 1.5)]
        label = f"{layers} layer{'s' if layers > 1 else ''}"
        curves.append(Curve(label, x, ratio, "o-"))
        sharpest = float(curvatures(loading.section)[1][0] * case.thickness)
        rows.append((label, sharpest, float(near.mean()), float(far.mean())))
        if layers == 1:
            page.shape("shape", loading.result, "One layer under load", values="plastic_strain_max", view=(-90, 0))
        page.check(f"{label}: moment over pure bending, 1 to 1.5 h from the middle", float(far.mean()), 1.0, 0.04)
    columns = ("sheet", "k h in the middle", "moment over pure bending, 0 to 0.5 h", "1 to 1.5 h")
    page.table(f"Under load at {STROKE:g} mm, moment of the contact forces over that of pure bending", columns, rows)
    page.check("1 layer: moment over pure bending, 0 to 0.5 h from the middle", rows[0][2], 1.0, 0.02)
    what = "4 layers: moment over pure bending above 1, 0 to 0.5 h from the middle"
    page.check(what, rows[2][2] - 1.0, 0.05, 0.03, relative=False)
    page.figure(
        "cause", plot(curves, "distance from the middle over h", "moment over pure bending", level=1.0), _CAPTION
    )
    page.text(
        "One layer is a beam: its moment is everywhere that of pure bending at its curvature. In several layers the "
        f"moment is {100 * (rows[2][2] - 1):.0f} % larger under the punch, and equal from a distance of one thickness "
        "on. Under the punch the pressure and the change of sign of the shear bend the section and cause a stress "
        "through the thickness. The moment of this metal grows with about the fifth root of the curvature, so "
        f"{100 * (rows[2][2] - 1):.0f} % of moment are {100 * (rows[2][2] ** 5 - 1):.0f} % of curvature: the hinge of "
        "one layer is too sharp, less so in a wider die. Layers help; order and number of points do not. Two layers "
        "are 1 to 5 % too stiff in pure bending at R/h = 5 to 2 ([air-bend-wide-sheet](air-bend-wide-sheet.md)), so "
        "their moment is above that of four."
    )


_CAPTION = "Moment of the contact forces over the moment that the same curvature takes in pure bending"


def _search(page: Page) -> None:
    """Stroke that leaves a right angle."""
    found = find_stroke(AirBending(stroke=None), 90.0, progress=False)
    page.text(
        f"With all defaults the search for the stroke that leaves 90 degrees ends at {found.case.stroke:.2f} mm after "
        f"{len(found.trials)} trials."
    )


def run(page: Page) -> None:
    """Fill the page."""
    found = _study(page)
    _judge(page, found)
    if page.short:
        return
    _plot(page, found)
    _advice(page, found)
    _cause(page)
    _search(page)


def _advice(page: Page, found: Found) -> None:
    fine = [found[key].angle for key in ((DEFAULT, 6.0), (THREE, 3.0), (FOUR, 3.0), (STACK, 12.0), (REFERENCE, 12.0))]
    stacked = [found[SHEETS[5], along].angle - found[REFERENCE, 12.0].angle for along in SHEETS[5].along]
    page.text(
        f"Two, three and four layers of BEND18 and stacks of EAS3DEAS lie within {max(fine) - min(fine):.1f} degrees, "
        "whatever the mesh along the sheet. Two layers of BEND8 are "
        f"{', '.join(f'{off:+.1f}' for off in stacked)} degrees off with 3, 6, 12 elements per thickness: they lock in "
        "their own plane, as layers of ANS3DEAS do. Take BEND18 for more than one layer."
    )


CASE = Case(
    name="air-bend-mesh",
    title="Air bending: meshes, layers, and why one layer bends too sharply",
    problem=f"""
The default of `umform bend`: 2 mm sheet like DC04, 16 mm opening, tools of 85 degrees, plane strain, stroke {STROKE:g}
mm, unloaded; increments of 0.2 mm. Varied: elements, layers, elements per thickness. For the cause: the moment of the
contact forces at each element under load, over the moment of pure bending at its curvature.
""",
    reference="""
Stack of eight layers of EAS3DEAS of order 2, E_33 tied, twelve elements per thickness; four layers are checked against
it. Pure bending: a stack of eight layers of the same metal between two sections of an arc, as in
[bend-moment](bend-moment.md).
""",
    own="eight layers of EAS3DEAS of order 2, umform itself",
    run=run,
    cost=60.0,
)
