"""The cup of AA6016-T4 of the ESAFORM benchmark 2021: heights and ears beside the measured ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.processes.draw import Cup
from umform.results.forming import EarProfile
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.drawing.aa6016_words import MEASURED, capacity, ears, reading, volume
from umform_book.drawing.chords import thickness_in_gap
from umform_book.drawing.cups import COLUMNS, FLANGE, Made, aa6016, esaform, fourth, make
from umform_book.drawing.rim import compressed_flange
from umform_book.page import Page
from umform_book.references import table

Floats = NDArray[np.float64]

#: How far from the measured mean height is good, and how far is known, mm.
WITHIN, KNOWN = 0.5, 1.3
_CAUSE = "the force of the holder is not among the data of the reference, and the height follows it, see the budget"
#: Mesh of the cards, the finest mesh, and the run without ironing.
_BASE, _FINEST, _FREE = "10 degrees", "7.5 degrees", "opening 64 mm, holder 2 kN"
#: Radii of the blank and of the middle of the wall.
_RADII = (53.75, 30.6)
#: Curves of the figure and their runs.
_DRAWN = {"Yld2004, NTNU": _BASE, "Yld2004, Postech": "Postech", "NTNU, without ironing": _FREE}
#: Runs of the budget of errors: what each one changes, and the run beside it.
_BUDGET = {
    "around: 18 elements": ("elements around the quarter, 18 for 12", "15 degrees"),
    "3 x 3 contact points": ("contact points, 3 x 3 for 2 x 2", "15 degrees"),
    "two layers of 3 points": ("layers", "3 x 3 contact points"),
    "300 increments": ("increments, twice as many", "3 x 3 contact points"),
    "penalty 3e5": ("penetration, a third of it", "3 x 3 contact points"),
    "friction 0.1": ("friction, 0.01 more", "3 x 3 contact points"),
    "holder 50 kN": ("force of the holder, 10 kN more", "3 x 3 contact points"),
    "holder 60 kN": ("force of the holder, 20 kN more", _BASE),
    "Swift": ("hardening: Swift of TUAT for Voce", _BASE),
    "opening 64 mm": ("no ironing: opening of 64 mm", "15 degrees"),
    "opening 64 mm, holder 2 kN": ("no ironing, and a holder of 2 kN", "15 degrees"),
}
_INCREMENTS = {"300 increments": 300}
#: Meshes by the largest angle that an element turns over an edge, and the elements around the quarter.
_MESHES = {"20 degrees": (20.0, 8), "15 degrees": (15.0, 12), "10 degrees": (10.0, 12), "7.5 degrees": (7.5, 12)}
#: Mesh of the cards: largest angle of an element over an edge, degrees.
_TURN = 10.0


def setups() -> dict[str, Cup]:
    """The runs of the page; those of the budget on the mesh of 15 degrees, most with 3 x 3 contact points."""
    meshes = {label: esaform(turn=turn, around=around) for label, (turn, around) in _MESHES.items()}
    return meshes | {
        "Postech": esaform(aa6016("Postech"), friction=0.1, turn=_TURN),
        "Swift": esaform(aa6016(hardening="Hill48"), turn=_TURN),
        "holder 60 kN": esaform(holder_force=60e3, turn=_TURN),
        "Hill48": esaform(aa6016("Hill48"), contact_points=3),
        "around: 18 elements": esaform(around=18),
        "3 x 3 contact points": esaform(contact_points=3),
        "two layers of 3 points": esaform(contact_points=3, layers=2, thickness_points=3),
        "300 increments": esaform(contact_points=3),
        "penalty 3e5": esaform(contact_points=3, penalty=3e5),
        "friction 0.1": esaform(contact_points=3, friction=0.1),
        "holder 50 kN": esaform(contact_points=3, holder_force=50e3),
        "opening 64 mm": esaform(die_radius=32.0),
        "opening 64 mm, holder 2 kN": esaform(die_radius=32.0, holder_force=2e3),
    }


def run(page: Page) -> None:
    """Fill the page."""
    measured, teams, shells = (table(f"cup_AA6016_{name}.csv") for name in ("measured", "teams", "shells"))
    if page.short:
        _short(page)
        return
    cases = setups()
    made = {label: make(page, label, cases[label], _INCREMENTS.get(label)) for label in page.each(list(cases), str)}
    found = {label: cup for label, cup in made.items() if cup is not None}
    page.table(
        "Heights in mm, card of NTNU but where another is named",
        COLUMNS,
        [(label, *cup.row()) for label, cup in found.items()],
    )
    page.table(
        "Heights of the measured cup and of others, mm",
        ("", "mean height", "lowest", "highest", "fourth harmonic", "its angle"),
        [("measured", *_profile(measured["angle"], measured["height"]))]
        + [(name, *_profile(teams["angle"], teams[name])) for name in _names(teams)]
        + [(f"{name}: shells", *_profile(shells["angle"], shells[name])) for name in _names(shells)]
        + [
            (f"Yld2004, {card or 'NTNU'}: compressed flange", None, None, None, *_compressed(card))
            for card in ("", "Postech")
        ],
    )
    _figure(page, found)
    _meshes(page, found)
    same = {name: _profile(teams["angle"], teams[name])[0] for name in ("NTNU Yld2004", "Postech Yld2004")}
    page.text(reading(found, same))
    _budget(page, found)
    page.text(volume(found[_FINEST]))
    page.text(capacity())
    _check_heights(page, found, [float(np.trapezoid(teams[name], teams["angle"])) / 360.0 for name in _names(teams)])
    _check_ears(page, found)


def _names(columns: dict[str, Floats]) -> list[str]:
    return [name for name in columns if name != "angle"]


def _check_heights(page: Page, found: dict[str, Made], means: list[float]) -> None:
    base = found[_BASE].ears.mean
    for label in (_FINEST, _BASE, "Postech"):
        height = found[label].ears.mean
        page.check(f"{label}: mean height, mm", height, MEASURED, WITHIN, relative=False, known=KNOWN, cause=_CAUSE)
    page.check(f"{_BASE}: mean height, mm, beside the finest mesh", base, found[_FINEST].ears.mean, 0.2, relative=False)
    page.check(
        f"{_BASE}: mean height within the band of the teams",
        base,
        0.5 * (min(means) + max(means)),
        0.5 * (max(means) - min(means)),
        relative=False,
    )
    for label in ("15 degrees", "3 x 3 contact points"):
        if label in found:
            rim, gap = found[label].wall[1], _gap(setups()[label])
            what = f"{label}: thickness of the rim in the gap, mm, eq. (4.192)"
            page.check(what, rim, gap, 0.02, relative=False)


def _check_ears(page: Page, found: dict[str, Made]) -> None:
    measured, teams = table("cup_AA6016_measured.csv"), table("cup_AA6016_teams.csv")
    wanted = fourth(EarProfile(measured["angle"][:-1], measured["height"][:-1]))
    sizes = [fourth(EarProfile(teams["angle"][:-1], teams[name][:-1]))[0] for name in _names(teams)]
    if _FREE in found:
        size, angle = fourth(found[_FREE].ears)
        formula, there = fourth(compressed_flange(aa6016(), *_RADII))
        page.check(f"{_FREE}: angle of the ears, degrees", angle, there, 5.0, relative=False)
        what = f"{_FREE}: fourth harmonic beside that of a compressed flange, mm"
        page.check(what, size, formula, 0.2, relative=False)
    page.check(
        f"{_BASE}: fourth harmonic of the height within that of the teams, mm",
        fourth(found[_BASE].ears)[0],
        0.5 * (min(sizes) + max(sizes)),
        0.5 * (max(sizes) - min(sizes)),
        relative=False,
    )
    page.check(
        f"{_BASE}: fourth harmonic of the height, mm",
        fourth(found[_BASE].ears)[0],
        wanted[0],
        0.2,
        relative=False,
        known=0.7,
        cause="a flat holder and stiff tools even the ears out, as in the results of NTNU and Postech in the table",
    )
    rows = [
        (label, *_angled(found[label].flange), *_angled(found[label].ears))
        for label in (*_MESHES, "Postech", "opening 64 mm", _FREE)
        if label in found
    ]
    columns = ("", f"of the rim on the flange, stroke {FLANGE:g} mm", "angle", "of the height", "angle")
    page.table("Fourth harmonic, mm, and its angle, degrees", columns, rows)
    page.text(ears())


def _angled(profile: EarProfile) -> tuple[float, int]:
    """Fourth harmonic and its angle: a quarter has it at 0 or 45 degrees."""
    size, angle = fourth(profile)
    return size, abs(round(angle))


def _short(page: Page) -> None:
    """A few millimetres of the stroke on a coarse mesh: the ears begin where they are at the end."""
    case = esaform(turn=45.0, around=6, stroke=8.0, penalty=3e3, contact_points=2)
    model, press = case.build()
    page.solve("8 mm", model, press.closing())
    x = model.mesh.points + model.u.reshape(-1, 3)
    rim = x[model.mesh.nodes("rim_lower"), :2]
    radius = EarProfile(np.degrees(np.arctan2(rim[:, 1], rim[:, 0])), np.hypot(*rim.T))
    order = np.argsort(radius.angle)
    page.check(
        "8 mm: angle at which the fourth harmonic of the rim is largest",
        fourth(EarProfile(radius.angle[order], radius.height[order]))[1],
        0.0,
        5.0,
        relative=False,
    )


def _profile(angle: Floats, height: Floats) -> tuple[float, float, float, float, int]:
    ears = EarProfile(angle[:-1], height[:-1])
    size, highest = fourth(ears)
    return ears.mean, float(height.min()), float(height.max()), size, round(highest)


def _compressed(card: str) -> tuple[float, int]:
    return _angled(compressed_flange(aa6016(card), *_RADII))


def _figure(page: Page, found: dict[str, Made]) -> None:
    measured, teams = table("cup_AA6016_measured.csv"), table("cup_AA6016_teams.csv")
    angle = np.arange(0.0, 361.0, 1.0)
    curves = [Curve("measured", measured["angle"], measured["height"], "ko")]
    for name in _names(teams):
        label = "teams" if name == "Poly6" else ""
        curves.append(Curve(label, teams["angle"], teams[name], ":"))
    for name, label in _DRAWN.items():
        if label in found:
            curves.append(Curve(name, angle, found[label].ears.at(angle)))
    caption = "Height of the cup over the angle to the rolling direction; dotted: seven results of the teams"
    page.figure("ears", plot(curves, "angle, degrees", "height, mm"), caption)


def _meshes(page: Page, found: dict[str, Made]) -> None:
    """Mean heights over the meshes."""
    labels = [label for label in _MESHES if label in found]
    means = [found[label].ears.mean for label in labels]
    changes = [None, *np.diff(means).tolist()]
    rows = [
        (label, found[label].elements, mean, change) for label, mean, change in zip(labels, means, changes, strict=True)
    ]
    page.table("Meshes: mean height, mm", ("largest turn of an element", "elements", "mean height", "change"), rows)


def _budget(page: Page, found: dict[str, Made]) -> None:
    """What each change does to the mean height: numbers of the method first, then data that the reference lacks."""
    rows = [
        (
            what,
            label,
            beside,
            found[label].ears.mean - found[beside].ears.mean,
            _gap(setups()[label]),
            found[label].wall[1],
        )
        for label, (what, beside) in _BUDGET.items()
        if label in found and beside in found
    ]
    columns = ("", "run", "beside", "change", "gap, eq. (4.192)", "rim")
    page.table("Budget of errors: change of the mean height, gap and thickness of the rim, mm", columns, rows)


def _gap(case: Cup) -> float:
    return thickness_in_gap(case.clearance, case.die_radius, case.around, case.contact_points)


CASE = Case(
    name="drawing-aa6016-cup",
    title="ESAFORM 2021: cup of AA6016-T4",
    problem="""
A disc of 107.5 mm and 1 mm is drawn through a die of 62.4 mm (edge 10 mm) by a punch of 60 mm (edge 5 mm): a quarter,
one layer of ANS3DEAS, 12 elements around it; runs have the name of the largest angle that an element turns over an
edge, or of what they change. The holder is pressed with 40 kN and lies on distance blocks at 1.04 mm; friction 0.09,
with the card of Postech its 0.1; penalty 1e5 MPa/mm at 2 x 2 points a facet. The rim is ironed in the gap of 1.2 mm
between punch and die. Then the die and the holder open, then the punch, and the height of the rim above the bottom is
measured. E = 70 GPa, nu = 0.33, hardening of Voce; the two cards of Yld2004-18p of the benchmark, and Hill48 from the
measured r-values. The fourth harmonic is the size of cos 4 theta in the height; ears in and across the rolling
direction have the angle 0, ears between them 45 degrees.
""",
    reference="""
Habraken et al. 2022, Int. J. Mater. Form. 15, 61: measured profile (25 digitised points) and profiles of teams,
digitised by S. C. Soare (PolyN). The profiles of the teams have means of 30.6 to 34.5 mm. Tools and distance of the
holder are those of the input files in PolyN, friction and hardening those of NTNU. Those files are for shells without
a thickness in contact, whose flange cannot press against a holder that keeps its distance, and whose wall is not
ironed; the table has the profiles of these shells with the two cards. A flange of solid elements thickens against the
holder, and the cup tears where the holder keeps its distance. So the holder is pressed; its force is not in the files,
40 kN is an assumption, and the budget shows what more force does.
""",
    run=run,
    cost=1500.0,
)
