"""A measured loop of tension and compression, and what the laws of hardening leave of it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from umform.materials import FallingModulus, Metal, Voce, tension
from umform.plotting import COLOURS
from umform.sheet_metals.cyclic_fit import fit_chaboche, fit_cycles, fit_yoshida_uemori
from umform.sheet_metals.least_squares import Fit
from umform_book.case import Case
from umform_book.page import Page
from umform_book.references import table

Floats = NDArray[np.float64]

POISSON = 0.33
#: Stresses of the first loading, and from a turning point on, between which the modulus is read, MPa.
FIRST, AFTER = (20.0, 80.0), (20.0, 120.0)
#: Rate of the falling modulus: nearly saturated at the plastic strain of the first turning point.
RATE = 100.0
#: Largest strain of a step, that of the fits.
STEP = 1e-3
#: Part of the largest stress that a good fit leaves, rms.
GOOD = 0.02


def run(page: Page) -> None:
    """Fill the page."""
    strain, stress, turns = loop()
    slopes = _slopes(strain, stress, turns)
    page.heading("Modulus")
    page.table("slopes, GPa", ("branch", "modulus"), [(name, slope / 1000.0) for name, slope in slopes.items()])
    young, falling = _moduli(slopes)
    page.text(
        f"The fits take E = {young / 1000.0:.4g} GPa. The falling modulus is {falling.saturated / 1000.0:.4g} GPa in "
        f"the limit, with the rate {RATE:g}, which one unloading does not determine."
    )
    page.heading("Fits")
    fits = loop_fits()
    left = {name: _path(one.law, strain) - stress for name, one in fits.items()}
    branches = np.split(np.arange(len(strain)), [turns[0] + 1, turns[1] + 1])
    page.table(
        "what the fits leave, MPa; rms of all points, of tension, of compression, of tension again",
        ("law", "constants", "rms", "largest", "at a strain of", "tension", "compression", "tension again"),
        [
            (
                name,
                len(fits[name].constants),
                _rms(rest),
                float(np.abs(rest).max()),
                float(strain[np.abs(rest).argmax()]),
                *(_rms(rest[rows]) for rows in branches),
            )
            for name, rest in left.items()
        ],
    )
    for name, one in fits.items():
        rows = [(constant, value, one.deviations[constant]) for constant, value in one.constants.items()]
        page.table(f"{name}: MPa or 1", ("constant", "value", "standard deviation"), rows)
    good = GOOD * float(np.abs(stress).max())
    best = "Yoshida-Uemori"
    for what, at in (("largest", int(stress.argmax())), ("least", int(stress.argmin()))):
        scatter = f"one test; rms of the whole loop {_rms(left[best]):.2g}"
        page.compare(f"{what} stress of the loop by {best}, MPa", stress[at] + left[best][at], stress[at], scatter)
    for name in ("two back stresses", best):
        page.at_most(f"{name}: rms, MPa", _rms(left[name]), good)
    order = ["isotropic", "one back stress", "two back stresses", "Yoshida-Uemori"]
    ratios = [_rms(left[b]) / _rms(left[a]) for a, b in itertools.pairwise(order)]
    page.at_most("rms of each law over that of the law before: the largest", max(ratios), 1.0)
    page.at_most("rms of one back stress over that of isotropic hardening", ratios[0], 0.5)
    if page.images is not None:
        page.figure("loop", _figure(strain, stress, fits, left), "Measured points, the fits, and what they leave")


def loop() -> tuple[Floats, Floats, list[int]]:
    """Strains, stresses in MPa, and the points where the strain turns back."""
    data = table("nist_aa6xxx_t4.csv")
    strain, stress = data["true_strain"], data["true_stress_MPa"]
    return strain, stress, [int(n) for n in np.flatnonzero(np.diff(np.sign(np.diff(strain)))) + 1]


def law_of_sheet() -> Metal:
    """The law that other pages take for this sheet."""
    return loop_fits()["Yoshida-Uemori, falling modulus"].law


def _moduli(slopes: dict[str, float]) -> tuple[float, FallingModulus]:
    """Modulus of the first loading, and the one that falls."""
    return round(slopes["first loading"], -2), FallingModulus(min(slopes.values()), RATE)


def _slopes(strain: Floats, stress: Floats, turns: list[int]) -> dict[str, float]:
    """Slopes of the first loading, and behind each turning point."""
    loading = slice(0, turns[0])
    found = {"first loading": _slope(strain[loading], stress[loading], FIRST)}
    for name, turn, end in zip(("unloading", "reloading"), turns, [*turns[1:], len(strain)], strict=True):
        found[name] = _slope(strain[turn:end], np.abs(stress[turn:end] - stress[turn]), AFTER)
    return found


def _slope(strain: Floats, stress: Floats, window: tuple[float, float]) -> float:
    """Slope of a line through the points whose stresses are in a window, up to the first beyond it."""
    beyond = np.flatnonzero(stress > window[1])[0]
    inside = stress[:beyond] > window[0]
    return float(abs(np.polyfit(strain[:beyond][inside], stress[:beyond][inside], 1)[0]))


@cache
def loop_fits() -> dict[str, Fit[Metal]]:
    """The laws, fitted to the loop."""
    strain, stress, turns = loop()
    young, falling = _moduli(_slopes(strain, stress, turns))
    tests = [(strain, stress)]

    def isotropic(c: Mapping[str, float]) -> Metal:
        return Metal(young, POISSON, hardening=Voce(c["Y"], c["Y"] + c["Q"], c["d"]))

    fits = {
        "isotropic": fit_cycles(strain, stress, isotropic, {"Y": 120.0, "Q": 150.0, "d": 15.0}, STEP),
        "one back stress": fit_chaboche(tests, 1, young, POISSON, largest_step=STEP),
        "two back stresses": fit_chaboche(tests, 2, young, POISSON, largest_step=STEP),
        "Yoshida-Uemori": fit_yoshida_uemori(tests, young, POISSON, largest_step=STEP),
    }
    fits["two back stresses, falling modulus"] = fit_chaboche(
        tests, 2, young, POISSON, largest_step=STEP, modulus=falling
    )
    fits["Yoshida-Uemori, falling modulus"] = fit_yoshida_uemori(
        tests, young, POISSON, largest_step=STEP, modulus=falling
    )
    return fits


def _path(metal: Metal, strain: Floats) -> Floats:
    """Stresses at measured strains, in the steps of the fits."""
    path: list[float] = []
    ends, before = [], 0.0
    for e in strain:
        path += np.linspace(before, e, max(math.ceil(abs(e - before) / STEP), 1) + 1)[1:].tolist()
        ends.append(len(path) - 1)
        before = float(e)
    found: Floats = tension(metal, path)[1][ends]
    return found


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _figure(strain: Floats, stress: Floats, fits: dict[str, Fit[Metal]], left: dict[str, Floats]) -> Figure:
    figure = Figure(figsize=(8.0, 6.0), layout="constrained")
    loop, rest = figure.subplots(2, 1, height_ratios=(2, 1))
    loop.plot(strain, stress, "k.", markersize=3, label="measured")
    for n, name in enumerate(name for name in fits if "falling" not in name):
        colour = COLOURS[n % len(COLOURS)]
        loop.plot(strain, stress + left[name], color=colour, linewidth=1.0, label=name)
        rest.plot(np.arange(len(strain)), left[name], color=colour, linewidth=1.0)
    loop.set(xlabel="true strain", ylabel="true stress, MPa")
    loop.legend(fontsize="small")
    rest.set(xlabel="point, in the order of time", ylabel="fit - measured, MPa")
    return figure


CASE = Case(
    name="material-measured-loop",
    title="A measured loop of an aluminium sheet: what each law leaves",
    problem=f"""
AA6xxx-T4 of NUMISHEET 2020, 1.5 mm, along the rolling direction: tension to a strain of 0.0505, compression to
-0.0044, tension to the largest force. Laws are fitted to all points with equal weights, with Poisson's ratio
{POISSON:g}, von Mises and E of the first loading between {FIRST[0]:g} and {FIRST[1]:g} MPa: Voce's isotropic hardening,
Voce with one and with two back stresses of Chaboche, the two surfaces of Yoshida and Uemori, and the last two with a
modulus that falls to the smallest measured slope: those between {AFTER[0]:g} and {AFTER[1]:g} MPa after each reversal
(MPa, logarithmic strain).
""",
    reference="""
Rust, Luecke and Iadicola, data for NUMISHEET 2020, uniaxial tensile and tension/compression tests, NIST Public Data
Repository, doi 10.18434/M32202 (`nist_aa6xxx_t4.csv`, reduced from 2087 points). Whether they were corrected for the
friction of the guide against buckling is not known. Expected: each law leaves less than the one before it, one back
stress less than half of isotropic hardening; two back stresses and Yoshida-Uemori 2 % of the largest stress, rms.
""",
    run=run,
    picture="loop",
    cost=10.0,
)
