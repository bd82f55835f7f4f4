"""Constants of a metal from measurements of a part: noise and standard errors, and a card that one bend corrects."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import umform as uf
from umform.materials import J2, Chaboche, Linear, LinearVoce, Metal, Swift
from umform.plotting import COLOURS
from umform.processes.air_bending import AirBending
from umform.processes.problems import outcome_of, problem_of
from umform.results.outcome import Outcome
from umform_book.case import Case
from umform_book.page import Page

Floats = NDArray[np.float64]

#: Constants of the bar, its elongations with the increments to each, and the noise of its force.
TRUTH = {"yield_stress": 200.0, "modulus": 500.0, "C": 20e3, "gamma": 100.0}
CYCLE, NOISE = ((0.02, 8), (-0.02, 12)), 2.0
SAMPLES, FEW = 100, 4
#: Standard deviations of the measured bend: degrees, and relative to the force.
ANGLE, FORCE = 0.1, 0.01
#: The bend that is measured, and those that are predicted.
CARD = AirBending(stroke=6.1)
OTHERS: dict[str, dict[str, Any]] = {
    "stroke 4": {"stroke": 4.0},
    "stroke 5": {"stroke": 5.0},
    "stroke 6.8": {"stroke": 6.8},
    "punch radius 3": {"punch_radius": 3.0},
    "opening 12, stroke 4": {"opening": 12.0, "stroke": 4.0},
    "opening 24, stroke 8": {"opening": 24.0, "stroke": 8.0},
}
#: Metals of the coil.
COILS: dict[str, uf.materials.Hardening] = {
    "strength +12 %, exponent -5 %": Swift(1.12 * 520.0, 0.004, 0.95 * 0.22),
    "offset 0.008 besides": Swift(1.12 * 520.0, 0.008, 0.95 * 0.22),
    "another law, of Voce and a line": LinearVoce(190.0, 420.0, 370.0, 18.0),
}


def bar(yield_stress: float, modulus: float, C: float, gamma: float) -> tuple[uf.Model, list[uf.Move]]:
    """One element in tension and compression."""
    metal = Metal(E=200e3, nu=0.3, hardening=Linear(yield_stress, modulus), back_stress=Chaboche(((C, gamma),)))
    model = uf.Model(uf.mesh.strip(1.0, 1.0, 1.0, (1, 1)), "BEND8", material=metal)
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    model.hinge("x0", "z")
    pull = model.prescribe("x1", "x", name="pull")
    return model, [uf.Move(pull, to=to, steps=count) for to, count in CYCLE]


def run(page: Page) -> None:
    """Fill the page."""
    _noise(page)
    _bends(page)


def _noise(page: Page) -> None:
    """Standard errors against the scatter of many samples."""
    page.heading("Noise: a bar in tension and compression")
    exact = uf.derivatives(bar, TRUTH, [], progress=False).runs.reference
    x, y = exact["pull"][1:], exact["pull_force"][1:]
    sought = {name: uf.Sought(0.5 * value, 2.0 * value, start=1.25 * value) for name, value in TRUTH.items()}
    samples = page.pick(range(SAMPLES), range(FEW))
    distances, runs, deviations = [], [], []
    for seed in page.each(samples, lambda seed: f"sample {seed + 1}"):
        noise = np.random.default_rng(seed).normal(0.0, NOISE, len(y))
        found = uf.identify(
            bar, sought, [uf.MeasuredCurve("pull", "pull_force", (x, y + noise), NOISE)], progress=False
        )
        distances.append([(found.values[name] - value) / found.deviations[name] for name, value in TRUTH.items()])
        deviations.append([found.deviations[name] for name in TRUTH])
        runs.append(found.runs)
    off, mean = np.array(distances), np.mean(deviations, axis=0)
    page.table(
        f"constants of {len(off)} samples, distances from the truth over the standard error",
        ("constant", "truth", "standard error", "mean distance", "spread", "within two"),
        [
            (name, value, float(mean[n]), float(off[:, n].mean()), float(off[:, n].std()), _share(off[:, n]))
            for n, (name, value) in enumerate(TRUTH.items())
        ],
    )
    page.text(f"A fit of four constants takes at most {max(runs)} runs, each with its derivatives.")
    count = off.size
    page.check("share of all constants within two standard errors", _share(off), 0.9545, within=0.8 / math.sqrt(count))
    page.check("spread of the distances", float(off.std()), 1.0, within=3.0 / math.sqrt(count))
    page.at_most("mean distance", abs(float(off.mean())), 4.0 / math.sqrt(count))


def _share(distances: Floats) -> float:
    return float(np.mean(np.abs(distances) < 2.0))


def measured(case: AirBending) -> Outcome:
    """What a bend reports."""
    made = problem_of(case).build()
    how: dict[str, Any] = {"solver": made.solver, "options": made.options, "frames": 1, "progress": False}
    return outcome_of(case, uf.solve(made.model, made.steps, **how))


def _numbers(case: Any, others: Sequence[str]) -> Floats:
    """Angle and force of other bends of a metal."""
    bends = [measured(replace(case, **OTHERS[name])) for name in others]
    return np.array([[bend[name].value for name in ("angle", "force")] for bend in bends], dtype=float)


def _bends(page: Page) -> None:
    """A card that one bend corrects."""
    card = page.pick((CARD,), (replace(CARD, elements_per_thickness=1.0, layers=1, increment=0.025),))[0]
    others = page.pick(list(OTHERS), ["punch radius 3"])
    before = _numbers(card, others)
    errors: dict[str, tuple[Floats, Floats]] = {}
    for name in page.each(page.pick(list(COILS), list(COILS)[:1])):
        coil = replace(card, material=replace(_law(card), hardening=COILS[name]))
        truth, at_stroke = _numbers(coil, others), measured(coil)
        signs = page.pick(((0, 0), (1, 1), (1, -1)), ((1, 1),)) if name == next(iter(COILS)) else ((0, 0),)
        for sign in signs:
            off = f"{sign[0] * ANGLE:+g} degrees and {100 * sign[1] * FORCE:+g} % off" if any(sign) else "exactly"
            key = f"{name}, measured {off}"
            page.heading(key)
            found = _corrected(card, at_stroke, sign)
            header, *rows = found.table
            page.table("constants", header, rows)
            page.text(f"{found.runs} runs, each with {len(rows)} shadows.")
            after = _numbers(found.subject, others)
            errors[key] = (after - truth, before - truth)
            _table(page, others, truth, *errors[key])
            page.at_most(f"{key}: angle, degrees", float(np.abs(after - truth)[:, 0].max()), 0.3)
            page.at_most(f"{key}: force, relative", float(np.abs(after / truth - 1.0)[:, 1].max()), 0.02)
    if page.images is not None:
        page.figure("angles", _figure(errors, others), "Errors of the angle with the card, and with the corrected one")


def _law(case: AirBending) -> J2:
    assert isinstance(case.material, J2)
    return case.material


def _corrected(card: AirBending, bend: Outcome, sign: tuple[int, int]) -> uf.Identified:
    """Strength and exponent of the card from angle and force of one bend."""
    angle, force = (float(bend[name].value or 0.0) for name in ("angle", "force"))
    data = [
        uf.MeasuredNumber("angle", angle + sign[0] * ANGLE, ANGLE),
        uf.MeasuredNumber("force", force * (1.0 + sign[1] * FORCE), FORCE * force),
    ]
    sought = {"strength": (300.0, 1000.0), "hardening.exponent": (0.05, 0.5)}
    return uf.identify(card, sought, data, progress=False)


def _table(page: Page, others: Sequence[str], truth: Floats, after: Floats, before: Floats) -> None:
    page.table(
        "other bends: angle in degrees, force in N/mm, and errors with the card and with the corrected one",
        ("bend", "angle", "card", "corrected", "force", "card, %", "corrected, %"),
        [
            (
                name,
                *map(float, (truth[n, 0], before[n, 0], after[n, 0], truth[n, 1])),
                *map(float, (100 * before[n, 1] / truth[n, 1], 100 * after[n, 1] / truth[n, 1])),
            )
            for n, name in enumerate(others)
        ],
    )


def _figure(errors: dict[str, tuple[Floats, Floats]], others: Sequence[str]) -> Figure:
    figure = Figure(figsize=(8.0, 3.6), layout="constrained")
    axes = figure.subplots()
    places = np.arange(len(others))
    for n, (key, (after, before)) in enumerate(errors.items()):
        axes.plot(places, after[:, 0], "o", color=COLOURS[n % len(COLOURS)], label=key)
        axes.plot(places, before[:, 0], "x", color=COLOURS[n % len(COLOURS)])
    axes.axhline(0.0, color="black", linewidth=0.8)
    axes.set_xticks(places, others, rotation=20)
    axes.set(ylabel="error of the angle, degrees; crosses: the card")
    axes.legend(fontsize="x-small")
    return figure


CASE = Case(
    name="material-identification",
    title="Constants from a measured bar, and from one measured bend",
    problem=f"""
A bar of one element, cycled between elongations of 0.02 and -0.02, with yield stress 200, hardening modulus 500 and a
back stress of C = 20000, gamma = 100 (N, mm). Its force gets noise of {NOISE:g} N, and `uf.identify` finds the four
constants from it, in {SAMPLES} samples, from 25 % too much. Then a coil bends otherwise than the card of its metal,
like DC04 (Swift's 520 (0.004 + e)^0.22): angle and force of one air bend (2 mm, opening 16 mm, stroke 6.1 mm) give
another strength and exponent, which predict other bends.
""",
    reference="""
The truth of each sample. Of a normal distribution 95.45 % lie within two standard deviations. Of the bends: those of
the metal of the coil, whose angles must be right within 0.3 degrees, and forces within 2 %.
""",
    run=run,
    own="all of it: measurements are runs with other constants",
    picture="angles",
    cost=150.0,
)
