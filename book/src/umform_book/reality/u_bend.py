"""The U-bend of NUMISHEET 93 with a measured sheet: which part of its law makes which part of the springback."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from umform.materials import Metal, Table, tension
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.friction.u_bend import Measured, Setup, u_bend
from umform_book.page import Page
from umform_book.reality.measured_loop import POISSON, law_of_sheet, loop_fits

INTERVALS, FINER = 100, 140
#: Where the wall is measured, mm: it curls so much that it ends below the 55 mm of the benchmark.
HEIGHTS = (12.0, 27.0, 42.0)
#: Strains of the tension curve that the isotropic law takes over.
_CURVE = np.concatenate([np.arange(1, 101) * 1e-4, 0.01 + np.arange(1, 100) * 5e-3])
#: The law of the sheet, and the same without its parts.
WHOLE, CONSTANT, ISOTROPIC, NEITHER = (
    "Yoshida-Uemori, falling modulus",
    "Yoshida-Uemori",
    "isotropic, falling modulus",
    "isotropic",
)


def isotropic(whole: Metal, after: float = 0.0) -> Metal:
    """The law without its Bauschinger effect: the same curve in tension, from a plastic strain on."""
    _, stress, plastic = tension(whole, _CURVE)
    flows = plastic[:, 0] > after
    first = float(np.interp(after, plastic[:, 0], stress)) if after else float(stress[~flows][-1])
    curve = Table((0.0, *(plastic[flows, 0] - after)), (first, *np.maximum.accumulate(stress[flows])))
    return Metal(whole.E, whole.nu, hardening=curve, modulus=whole.modulus)


def laws() -> dict[str, Metal]:
    """The law of the sheet with each of two parts switched off, and other fits of the same loop."""
    whole = law_of_sheet()
    same = isotropic(whole)
    fits = {f"{name}, fitted to the loop": fit.law for name, fit in loop_fits().items() if "falling" not in name}
    return {
        WHOLE: whole,
        CONSTANT: replace(whole, modulus=None),
        ISOTROPIC: same,
        NEITHER: replace(same, modulus=None),
        **fits,
    }


def effects(value: dict[str, float]) -> tuple[float, float, float]:
    """Effects of the Bauschinger effect and of the falling modulus, each with and without the other, and of both."""
    bauschinger = 0.5 * (value[CONSTANT] - value[NEITHER] + value[WHOLE] - value[ISOTROPIC])
    modulus = 0.5 * (value[ISOTROPIC] - value[NEITHER] + value[WHOLE] - value[CONSTANT])
    return bauschinger, modulus, value[WHOLE] - value[NEITHER]


def run(page: Page) -> None:
    """Fill the page."""
    metals = laws()
    if page.short:
        _tension(page, metals)
        return
    found: dict[str, Measured] = {}
    curves = []
    finer = {f"{name}, {FINER} elements": (metals[name], FINER) for name in (WHOLE, NEITHER)}
    runs = {name: (metal, INTERVALS) for name, metal in metals.items()} | finer
    for name in page.each(list(runs)):
        metal, intervals = runs[name]
        found[name], line, _ = u_bend(page, Setup(intervals=intervals, material=metal, heights=HEIGHTS), name)
        if name in (WHOLE, CONSTANT, ISOTROPIC, NEITHER):
            curves.append(Curve(name, line[:, 0], line[:, 1]))
    columns = (
        "law",
        "punch force, N/mm",
        "draw-in, mm",
        "theta1, degrees",
        "theta2, degrees",
        "radius of the wall, mm",
    )
    rows = [(name, one.force, one.draw_in, one.theta1, one.theta2, one.radius) for name, one in found.items()]
    page.table("Quantities of the benchmark", columns, rows)
    page.figure("part", plot(curves, "x, mm", "z, mm"), "Mid-surface of the part after the release")
    page.compare("theta1, degrees", found[WHOLE].theta1, None, "no test of this sheet in these tools is known")
    _tension(page, metals)
    _effects(page, found)


def _tension(page: Page, metals: dict[str, Metal]) -> None:
    """The switched laws have one curve in tension."""
    curve = {name: tension(metals[name], _CURVE)[1] for name in (WHOLE, ISOTROPIC)}
    off = float(np.abs(curve[ISOTROPIC] / curve[WHOLE] - 1.0)[_CURVE > 5e-3].max())
    page.at_most("tension curve without the Bauschinger effect over the one with it, minus one", off, 2e-3)


def _effects(page: Page, found: dict[str, Measured]) -> None:
    sizes = {
        "theta1 - 90, degrees": {name: one.theta1 - 90.0 for name, one in found.items()},
        "90 - theta2, degrees": {name: 90.0 - one.theta2 for name, one in found.items()},
        "curvature of the wall, 1/m": {name: 1e3 / one.radius for name, one in found.items()},
    }
    rows = []
    for what, value in sizes.items():
        bauschinger, modulus, both = effects(value)
        mesh = {name: value[f"{name}, {FINER} elements"] - value[name] for name in (WHOLE, NEITHER)}
        rows.append((what, value[WHOLE], bauschinger, modulus, both, mesh[WHOLE], mesh[WHOLE] - mesh[NEITHER]))
        page.check(f"{what}: sign of the change by a falling modulus", float(np.sign(modulus)), 1.0, 0.0)
    columns = (
        "",
        "law of the sheet",
        "Bauschinger effect",
        "falling modulus",
        "both",
        "by the finer mesh",
        "of both, by it",
    )
    page.table("What each part of the law adds to the springback", columns, rows)
    sheet = law_of_sheet()
    assert sheet.modulus is not None
    fall = 100.0 * (1.0 - sheet.modulus.saturated / sheet.E)
    share = {what: 100.0 * effects(value)[0] / value[WHOLE] for what, value in sizes.items()}
    page.text(
        "Share of the Bauschinger effect in the springback: "
        + "; ".join(f"{what.split(',')[0]} {value:+.0f} %" for what, value in share.items())
        + f". The modulus of this sheet falls by {fall:.1f} % only, by its one measured unloading; that of the "
        "steel on the page of [each kind of hardening](material-u-bend.md) falls by 26 %."
    )


CASE = Case(
    name="reality-u-bend",
    title="U-bend of a measured sheet: what the Bauschinger effect adds",
    problem=f"""
The tools and the blank of the [U-bend](friction-u-bend.md) of NUMISHEET 93, with the sheet AA6xxx-T4 whose
[loop](material-measured-loop.md) of tension and compression NIST measured: Yoshida-Uemori with a falling
modulus as fitted there, von Mises, nu = {POISSON:g}. Then one part of the law is switched off at a time: the
modulus stays at its first value; isotropic hardening with the same curve in tension has no Bauschinger effect. The wall
is measured at {HEIGHTS[0]:g}, {HEIGHTS[1]:g} and {HEIGHTS[2]:g} mm above the bottom: the curled wall ends below
52 mm. {INTERVALS} elements of BEND8 along half of the blank, two runs with {FINER}. The other fits of the
same loop show what the choice of a law does.
""",
    reference="""
No measured U-bend of this sheet is known, so no angle is checked: the page shows how much of the springback is due to
which part of the law. In the table of the parts the change by the Bauschinger effect is the mean with and without the
falling modulus, and that by the modulus likewise; the last two columns are the changes of the first and the fourth by
the finer mesh. Checks: both laws have one tension curve; a falling modulus adds springback.
""",
    own="all of it but the measured loop: laws are compared with each other",
    run=run,
    cost=330.0,
)
