"""The cup of AA6016-T4 of the ESAFORM benchmark 2021: heights and ears beside the measured ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.processes.draw import Cup
from umform.results.forming import EarProfile
from umform.sheet_metals import balanced, uniaxial
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.drawing.cups import COLUMNS, FLANGE, WALL, Made, aa6016, esaform, fourth, make
from umform_book.page import Page
from umform_book.references import table

Floats = NDArray[np.float64]

#: Mean height of the measured cup, how far from it is good, and how far is known.
MEASURED, WITHIN, KNOWN = 34.15, 0.5, 1.3
_CAUSE = "the force of the holder is not among the data of the reference, and it governs the height, see the budget"
_CARDS = ("Yld2004, NTNU", "Yld2004, Postech", "Hill48")
#: Runs of the budget of errors, and what each one changes.
_BUDGET = {
    "finer: 11 degrees": "mesh",
    "coarser: 20 degrees": "mesh",
    "two layers of 3 points": "layers",
    "4 x 4 contact points": "contact points",
    "300 increments": "increments, twice as many",
    "penalty 3e5": "penetration, a third of it",
    "penalty 3e4, 2 x 2 contact points": "penetration, thrice as much, and fewer points",
    "friction 0.1": "friction, 0.01 more",
    "holder 50 kN": "force of the holder, 10 kN more",
}
_INCREMENTS = {"300 increments": 300}


def setups() -> dict[str, Cup]:
    """The runs of the page."""
    base = esaform()
    return {
        "Yld2004, NTNU": base,
        "Yld2004, Postech": esaform(aa6016("Postech")),
        "Hill48": esaform(aa6016("Hill48")),
        "finer: 11 degrees": esaform(turn=11.0, around=14),
        "coarser: 20 degrees": esaform(turn=20.0, around=8),
        "coarser: 30 degrees": esaform(turn=30.0, around=8),
        "two layers of 3 points": esaform(layers=2, thickness_points=3),
        "4 x 4 contact points": esaform(contact_points=4),
        "300 increments": base,
        "penalty 3e5": esaform(penalty=3e5),
        "penalty 3e4, 2 x 2 contact points": esaform(penalty=3e4, contact_points=2),
        "friction 0.1": esaform(friction=0.1),
        "holder 50 kN": esaform(holder_force=50e3),
        "holder at a fixed distance": esaform(holder_force=None),
    }


def run(page: Page) -> None:
    """Fill the page."""
    measured, teams = table("cup_AA6016_measured.csv"), table("cup_AA6016_teams.csv")
    names = [name for name in teams if name != "angle"]
    if page.short:
        _short(page)
        return
    cases = setups()
    made = {label: make(page, label, cases[label], _INCREMENTS.get(label)) for label in page.each(list(cases), str)}
    found = {label: cup for label, cup in made.items() if cup is not None}
    page.table("Heights in mm", COLUMNS, [(label, *cup.row()) for label, cup in found.items()])
    page.table(
        "Heights of the measured cup and of the teams, mm",
        ("", "mean height", "lowest", "highest", "fourth harmonic"),
        [("measured", *_profile(measured["angle"], measured["height"]))]
        + [(name, *_profile(teams["angle"], teams[name])) for name in names],
    )
    _figure(page, found)
    _budget(page, found)
    page.text(_volume(found["Yld2004, NTNU"]))
    page.text(_capacity())
    base = found["Yld2004, NTNU"]
    for label in ("Yld2004, NTNU", "Yld2004, Postech", "finer: 11 degrees"):
        height = found[label].ears.mean
        page.check(f"{label}: mean height, mm", height, MEASURED, WITHIN, relative=False, known=KNOWN, cause=_CAUSE)
    means = [float(np.trapezoid(teams[name], teams["angle"])) / 360.0 for name in names]
    page.check(
        "Yld2004, NTNU: mean height within the band of the teams",
        base.ears.mean,
        0.5 * (min(means) + max(means)),
        0.5 * (max(means) - min(means)),
        relative=False,
    )
    wanted = fourth(EarProfile(measured["angle"][:-1], measured["height"][:-1]))
    for label in filter(found.__contains__, _CARDS):
        angle = fourth(found[label].flange)[1]
        what = f"{label}: angle of the ears on the flange, at a stroke of {FLANGE:g} mm, degrees"
        page.check(what, angle, wanted[1], 5.0, relative=False)
    sizes = [fourth(EarProfile(teams["angle"][:-1], teams[name][:-1]))[0] for name in names]
    page.check(
        "Yld2004, NTNU: fourth harmonic of the height within that of the teams, mm",
        fourth(base.ears)[0],
        0.5 * (min(sizes) + max(sizes)),
        0.5 * (max(sizes) - min(sizes)),
        relative=False,
    )
    page.check(
        "Yld2004, NTNU: fourth harmonic of the height, mm",
        fourth(base.ears)[0],
        wanted[0],
        0.2,
        relative=False,
        known=0.7,
        cause="stiff tools iron the ears off in the gap of 1.2 mm, as in the results of NTNU and Postech in the table",
    )
    text = "On the flange the fourth harmonic of the radius of the rim, at a stroke of {:g} mm, is: {}."
    there = "; ".join(f"{label} {fourth(cup.flange)[0]:.2f} mm" for label, cup in found.items())
    page.text(text.format(FLANGE, there))


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


def _profile(angle: Floats, height: Floats) -> tuple[float, float, float, float]:
    ears = EarProfile(angle[:-1], height[:-1])
    return ears.mean, float(height.min()), float(height.max()), fourth(ears)[0]


def _figure(page: Page, found: dict[str, Made]) -> None:
    measured, teams = table("cup_AA6016_measured.csv"), table("cup_AA6016_teams.csv")
    angle = np.arange(0.0, 361.0, 1.0)
    curves = [Curve("measured", measured["angle"], measured["height"], "ko")]
    for name in teams:
        if name != "angle":
            label = "teams" if name == "Poly6" else ""
            curves.append(Curve(label, teams["angle"], teams[name], ":"))
    for label in filter(found.__contains__, _CARDS):
        curves.append(Curve(label, angle, found[label].ears.at(angle)))
    caption = "Height of the cup over the angle to the rolling direction; dotted: seven results of the teams"
    page.figure("ears", plot(curves, "angle, degrees", "height, mm"), caption)


def _budget(page: Page, found: dict[str, Made]) -> None:
    """What each change does to the mean height: numbers of the method first, then data that the reference lacks."""
    base = found["Yld2004, NTNU"].ears.mean
    rows = [(what, label, found[label].ears.mean - base) for label, what in _BUDGET.items() if label in found]
    page.table("Budget of errors: change of the mean height, mm, card of NTNU", ("", "run", "change"), rows)


def _volume(base: Made) -> str:
    """What the heights say of the thickness of the wall: the metal above its beginning stays the same."""
    thickness, rim = base.wall
    implied = thickness * (base.ears.mean - WALL) / (MEASURED - WALL)
    return (
        f"Volume: the wall from {WALL:g} mm above the bottom up has a mean thickness of {thickness:.3f} mm with the "
        f"card of NTNU; with the same metal the measured height implies {implied:.3f} mm. The rim is {rim:.3f} mm "
        "thick in a gap of 1.2 mm between punch and die. Tools that penetrate more, with a penalty of 3e4 MPa/mm at "
        "2 x 2 points, leave a rim that is thicker than the gap, and a cup that is too low: see the budget."
    )


def _capacity() -> str:
    """What the bottom of the cup carries over what the rim resists, by the yield stresses of each card."""
    ratios = []
    for name, card in (("Yld2004, NTNU", ""), ("Yld2004, Postech", "Postech"), ("Hill48", "Hill48")):
        function = aa6016(card).yield_function
        rim = float(np.mean([uniaxial(function, angle)[0] for angle in np.arange(0.0, 180.0, 7.5)]))
        ratios.append(f"{name} {balanced(function)[0] / rim:.2f}")
    return (
        "The bottom carries its biaxial yield stress, the rim resists with its yield stress in compression around the "
        f"cup. The first over the mean of the second, without hardening and friction: {'; '.join(ratios)}. Where it is "
        "low, the bottom flows in place of the flange until it tears. With Hill48 from r-values far below 1 it does; "
        "none of the teams in the table used Hill48."
    )


CASE = Case(
    name="drawing-aa6016-cup",
    title="ESAFORM 2021: cup of AA6016-T4",
    problem="""
A disc of 107.5 mm and 1 mm is drawn through a die of 62.4 mm (edge 10 mm) by a punch of 60 mm (edge 5 mm): a quarter,
one layer of ANS3DEAS, no element turns more than 15 degrees over an edge. The holder is pressed with 40 kN and lies on
distance blocks at 1.04 mm; friction 0.09; penalty 1e5 MPa/mm
at 3 x 3 points a facet. The rim is ironed in the gap of 1.2 mm between punch and
die. Then the die and the holder open, then the punch, and the height of the rim above the bottom is measured. E = 70
GPa, nu = 0.33, hardening of Voce; the two cards of Yld2004-18p of the benchmark, and Hill48 from the measured
r-values. The fourth harmonic is the size of cos 4 theta in the height.
""",
    reference="""
Habraken et al. 2022, Int. J. Mater. Form. 15, 61: measured profile (25 digitised points) and profiles of teams,
digitised by S. C. Soare (PolyN). The profiles of the teams have means of 30.6 to 34.5 mm. Tools and distance of the
holder are those of the input files in PolyN, friction and hardening those of NTNU. Those files are for shells without
a thickness in contact, whose flange cannot press against a holder that keeps its distance. A flange of solid elements
thickens against it, and the cup tears where the holder keeps its distance. So the holder is pressed; its force is not
in the files, 40 kN is an assumption, and the budget shows what 10 kN more do.
""",
    run=run,
    cost=800.0,
)
