"""The cup of AA6016-T4 of the ESAFORM benchmark 2021: heights, ears and forces, compared with measurements."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.processes.draw import Cup
from umform.results.forming import EarProfile
from umform.sheet_metals import get, uniaxial
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.drawing.aa6016_words import MEASURED, capacity, ears, forces, heights, volume
from umform_book.drawing.chords import thickness_in_gap
from umform_book.drawing.cups import COLUMNS, FLANGE, Made, aa6016, cosine, esaform, isotropic, make
from umform_book.drawing.rim import compressed_flange, narrow_ring
from umform_book.page import Page
from umform_book.references import table

Floats = NDArray[np.float64]

#: Limit and known deviation of the mean height from the measured one, mm.
WITHIN, KNOWN = 0.5, 1.3
_CAUSE = "the reference does not give the force of the holder, and the height depends on it (see the table)"
#: The coarsest mesh, the run that others are compared with, the mesh of the ears, and the run without ironing.
_COARSE, _BASE, _FINE, _FREE = "30 degrees", "20 degrees", "15 degrees", "opening 64 mm, holder 2 kN"
#: Radii of the blank and of the middle of the wall.
_RADII = (53.75, 30.6)
#: Strain around the narrow ring.
_COMPRESSED = 0.2
#: Curves of the figure and their runs.
_DRAWN = {"Yld2004, NTNU": _FINE, "Yld2004, Postech": "Postech", "NTNU, without ironing": _FREE}
#: Runs that differ in the force of the holder in kN and in friction.
_PROCESS = {
    "holder 20 kN": (20, 0.09),
    _BASE: (40, 0.09),
    "holder 60 kN": (60, 0.09),
    "friction 0.07": (40, 0.07),
    "friction 0.1": (40, 0.1),
}
_FRICTIONS = ("friction 0.07", "friction 0.1")
#: Meshes by the largest angle that an element turns over an edge, and the elements around the quarter.
_MESHES = {_COARSE: (30.0, 8), _BASE: (20.0, 8), _FINE: (15.0, 12), "10 degrees": (10.0, 12)}
#: Cards and the profiles of teams with the same card.
_CARDS = {"": "NTNU Yld2004", "Postech": "Postech Yld2004"}


def setups() -> dict[str, Cup]:
    """The runs of the page: heights by the process on the mesh of the base, ears on the finest mesh."""
    base, fine = (mesh_of(label) for label in (_BASE, _FINE))
    found = {label: esaform(turn=t, around=n) for label, (t, n) in _MESHES.items()}
    for label, (force, friction) in _PROCESS.items():
        found[label] = esaform(holder_force=1e3 * force, friction=friction, **base)
    return found | {
        "Postech": esaform(aa6016("Postech"), friction=0.1, **fine),
        "isotropic": esaform(isotropic(), **fine),
        _FREE: esaform(die_radius=32.0, holder_force=2e3, **fine),
    }


def mesh_of(label: str) -> dict[str, Any]:
    """Parameters of a mesh."""
    turn, around = _MESHES[label]
    return {"turn": turn, "around": around}


def run(page: Page) -> None:
    """Fill the page."""
    measured, teams, shells = (table(f"cup_AA6016_{name}.csv") for name in ("measured", "teams", "shells"))
    _ring(page)
    if page.short:
        _short(page)
        return
    cases = setups()
    made = {label: make(page, label, case) for label, case in ((name, cases[name]) for name in page.each(cases, str))}
    found = {label: cup for label, cup in made.items() if cup is not None}
    page.table(
        "Heights in mm and forces, card of NTNU but where another is named",
        COLUMNS,
        [(label, *cup.row()) for label, cup in found.items()],
    )
    page.table(
        "Heights of the measured cup and of others, mm",
        ("", "mean height", "lowest", "highest", "cos 4θ"),
        [("measured", *_profile(measured["angle"], measured["height"]))]
        + [(name, *_profile(teams["angle"], teams[name])) for name in _names(teams)]
        + [(f"{name}: shells", *_profile(shells["angle"], shells[name])) for name in _names(shells)]
        + [
            (f"Yld2004, {card or 'NTNU'}: compressed flange", None, None, None, cosine(_compressed(card)))
            for card in _CARDS
        ],
    )
    _figure(page, found)
    _process(page, found)
    _point(page)
    _check_heights(page, found, [float(np.trapezoid(teams[name], teams["angle"])) / 360.0 for name in _names(teams)])
    _check_ears(page, found)
    _check_forces(page, found)
    page.text(volume(found[_BASE]))
    page.text(capacity())


def _names(columns: dict[str, Floats]) -> list[str]:
    return [name for name in columns if name != "angle"]


def _ring(page: Page) -> None:
    """Law, elements and rolling direction without tools: a ring of each card, and one that is turned."""
    rows = []
    for card, rolling in (("", 0.0), ("", 20.0), ("Postech", 0.0), ("Hill48", 0.0)):
        label = f"{card or 'NTNU'}, rolling direction at {rolling:g} degrees"
        found, expected = (profile.wave(4) for profile in narrow_ring(aa6016(card), _COMPRESSED, rolling))
        rows.append((label, *found, *expected))
        page.check(f"ring, {label}: cos 4θ of the radial strain", found[0], expected[0], 0.03)
        page.check(f"ring, {label}: its angle, degrees", found[1], rolling, 0.1, relative=False)
    columns = ("", "cos 4θ", "its angle", "by the r-values", "its angle")
    page.table(f"Radial strain of a narrow ring under a compression of {_COMPRESSED:g} around it", columns, rows)


def _point(page: Page) -> None:
    """Tension at a point: yield stress and r-value of each card over the angle, beside the measured ones."""
    given = get("AA6016-T4").measured
    assert given is not None
    rows: list[tuple[str | float, ...]] = []
    for angle, r in given.r.items():
        numbers = [number for card in _CARDS for number in uniaxial(aa6016(card).yield_function, angle)]
        rows.append((f"{angle:g} degrees", given.stress[angle], *numbers[::2], r, *numbers[1::2]))
    columns = ("", "yield stress, measured", "NTNU", "Postech", "r-value, measured", "NTNU", "Postech")
    page.table("Tension at a point, stresses over that in the rolling direction", columns, rows)


def _process(page: Page, found: dict[str, Made]) -> None:
    """Heights by holder force and friction."""
    rows: list[tuple[str | float, ...]] = [
        (f"{force} kN, friction {friction:g}", *_row(found[label]))
        for label, (force, friction) in _PROCESS.items()
        if label in found
    ]
    page.table(
        "Heights by the force of the holder and friction, mm; measured " + f"{MEASURED:g}",
        ("holder", "mean height", "of the measured one, %", "cos 4θ", "punch force, kN", "±"),
        rows,
    )
    by_force = {float(_PROCESS[label][0]): found[label].ears.mean for label in _PROCESS if _PROCESS[label][1] == 0.09}
    page.text(heights(by_force, *({name: found[name].ears.mean for name in names} for names in (_FRICTIONS, _MESHES))))


def _row(cup: Made) -> tuple[float, ...]:
    return cup.ears.mean, 100.0 * cup.ears.mean / MEASURED, cosine(cup.ears), cup.force.value, cup.force.ripple


def _check_heights(page: Page, found: dict[str, Made], means: list[float]) -> None:
    base = found[_BASE].ears.mean
    for label in (_BASE, "holder 60 kN", "Postech"):
        height = found[label].ears.mean
        page.check(f"{label}: mean height, mm", height, MEASURED, WITHIN, relative=False, known=KNOWN, cause=_CAUSE)
    finest = list(_MESHES)[-1]
    page.check(f"{_BASE}: mean height, mm, against {finest}", base, found[finest].ears.mean, 0.3, relative=False)
    scatter = f"seven teams {min(means):.1f} to {max(means):.1f}"
    page.compare("mean height of the cup of AA6016-T4, mm", found[_BASE].ears.mean, MEASURED, scatter)
    page.compare("the same with the card of Postech, mm", found["Postech"].ears.mean, MEASURED, scatter)
    middle, half = 0.5 * (min(means) + max(means)), 0.5 * (max(means) - min(means))
    page.check(f"{_BASE}: mean height within the band of the teams", base, middle, half, relative=False)
    case = setups()[_BASE]
    gap = thickness_in_gap(case.clearance, case.throat, case.around, case.contact_points)
    what = f"{_BASE}: thickness of the rim in the gap, mm, eq. (4.192)"
    page.check(what, found[_BASE].wall[1], gap, 0.02, relative=False)


def _check_ears(page: Page, found: dict[str, Made]) -> None:
    measured, teams = table("cup_AA6016_measured.csv"), table("cup_AA6016_teams.csv")
    for label, card in ((_FINE, ""), ("Postech", "Postech")):
        team = _CARDS[card]
        theirs = cosine(EarProfile(teams["angle"][:-1], teams[team][:-1]))
        ours = cosine(found[label].ears)
        page.check(f"{label}: cos 4θ against that of {team}, the same card, mm", ours, theirs, 0.3, relative=False)
    page.at_most("isotropic: cos 4θ, mm", abs(cosine(found["isotropic"].ears)), 0.2)
    if _FREE in found:
        formula, size = cosine(_compressed("")), cosine(found[_FREE].ears)
        page.check(f"{_FREE}: cos 4θ against that of a compressed flange, mm", size, formula, 0.2, relative=False)
    real = cosine(EarProfile(measured["angle"][:-1], measured["height"][:-1]))
    sizes = [cosine(EarProfile(teams["angle"][:-1], teams[name][:-1])) for name in _names(teams)]
    scatter = f"seven teams {min(sizes):.2f} to {max(sizes):.2f}"
    page.compare("its ears: cos 4θ of the height, mm", cosine(found[_FINE].ears), real, scatter)
    page.check(
        f"{_FINE}: cos 4θ of the height, mm",
        cosine(found[_FINE].ears),
        real,
        0.2,
        relative=False,
        known=0.9,
        cause="a flat holder and the gap even out the ears of both cards, in the results of NTNU and Postech too",
    )
    rows = [
        (label, cosine(found[label].flange), cosine(found[label].ears), found[label].ears.words("mm"))
        for label in found
    ]
    columns = ("", f"of the rim on the flange, stroke {FLANGE:g} mm", "of the height", "ears")
    page.table("cos 4θ in mm, positive for ears in and across the rolling direction", columns, rows)
    page.text(ears({name: cosine(found[name].ears) for name in (*_MESHES, "isotropic", _FREE) if name in found}))


def _check_forces(page: Page, found: dict[str, Made]) -> None:
    """Punch force by mesh, and its bands."""
    *others, finest = _MESHES
    fine = found[finest].force.value
    for label in others:
        cup = found[label]
        if label != _COARSE:  # there only the band is checked
            page.check(f"{label}: punch force against {finest}, kN", cup.force.value, fine, 0.05)
        what = f"{label}: distance of its punch force from {finest} over its band"
        page.at_most(what, abs(cup.force.value - fine) / cup.force.ripple, 1.0)
    page.text(forces({label: found[label] for label in _MESHES}))


def _short(page: Page) -> None:
    """A few millimetres of the stroke on a coarse mesh: the ears begin where they are at the end."""
    case = esaform(turn=45.0, around=6, stroke=8.0, penalty=3e3, contact_points=2)
    model, press = case.build()
    page.solve("8 mm", model, press.closing)
    x = model.positions
    rim = x[model.mesh.nodes("rim_lower"), :2]
    radius = EarProfile(np.degrees(np.arctan2(rim[:, 1], rim[:, 0])), np.hypot(*rim.T))
    order = np.argsort(radius.angle)
    page.check(
        "8 mm: angle at which the fourth harmonic of the rim is largest",
        EarProfile(radius.angle[order], radius.height[order]).wave(4)[1],
        0.0,
        5.0,
        relative=False,
    )


def _profile(angle: Floats, height: Floats) -> tuple[float, float, float, float]:
    profile = EarProfile(angle[:-1], height[:-1])
    return profile.mean, float(height.min()), float(height.max()), cosine(profile)


def _compressed(card: str) -> EarProfile:
    return compressed_flange(aa6016(card), *_RADII)


def _figure(page: Page, found: dict[str, Made]) -> None:
    measured, teams = table("cup_AA6016_measured.csv"), table("cup_AA6016_teams.csv")
    angle = np.arange(0.0, 361.0, 1.0)
    curves = [Curve("measured", measured["angle"], measured["height"], "ko")]
    for name in _names(teams):
        label = "teams" if name == "Poly6" else ""
        curves.append(Curve(label, teams["angle"], teams[name], ":"))
    for name, label in (_DRAWN | {"NTNU, 60 kN": "holder 60 kN"}).items():
        if label in found:
            curves.append(Curve(name, angle, found[label].ears.at(angle)))
    caption = "Height of the cup over the angle to the rolling direction; dotted: seven results of the teams"
    page.figure("ears", plot(curves, "angle, degrees", "height, mm"), caption)


CASE = Case(
    name="drawing-aa6016-cup",
    title="ESAFORM 2021: cup of AA6016-T4",
    problem="""
A disc of 107.5 mm in diameter, 1 mm thick, is drawn by a punch of 60 mm (edge radius 5 mm) through a die of 62.4 mm
(edge radius 10 mm). The model is a quarter with one layer of ANS3DEAS. Runs for the height have 8 elements around the
quarter, and an element turns by at most 20 degrees over an edge. Runs for the ears (also Postech, isotropic, without
ironing) have 12 elements and 15 degrees. The holder presses with 40 kN; distance blocks stop it at 1.04 mm. Friction is
0.09, with the card of Postech 0.1. The penalty is 1e5 MPa/mm at 2 x 2 points per facet. The gap of 1.2 mm between punch
and die irons the rim. Then die and holder open, then the punch, and the height of the rim above the bottom is measured.
E = 70 GPa, nu = 0.33, hardening of Voce; the two cards of Yld2004-18p of the benchmark. cos 4θ: amplitude of this
harmonic in the height, positive for ears at 0 and 90 degrees to the rolling direction, negative for ears between them.
The punch force is the largest mean over the passage of one element; its ripple is the band, eq. (5.72).
""",
    reference="""
Habraken et al. 2022, Int. J. Mater. Form. 15, 61: measured profile (25 digitised points) and profiles of teams,
digitised by S. C. Soare (PolyN). The mean heights of the teams are 30.6 to 34.5 mm. Tools and distance of the holder
are those of the input files in PolyN, friction and hardening those of NTNU. The files use shells without thickness in
contact: their flange cannot press against a holder at a fixed distance, and their wall is not ironed. The table has the
profiles of these shells with the two cards. A flange of solid elements thickens against the holder; at a fixed distance
the cup tears. So here a force presses the holder. The files do not give it: 40 kN is an assumption, and a table shows
the height by this force and by friction.
""",
    run=run,
    cost=280.0,
)
