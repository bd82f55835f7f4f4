"""Hardening along paths: tension and shear, cycles of Yoshida and Uemori, in the limit of small steps."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform.materials import Chaboche, Linear, Metal, Perfect, Voce, point_path, tension
from umform_book.case import Case
from umform_book.metals import HARDENING, SPCC, SPCC_YIELD
from umform_book.page import Page
from umform_book.plastic.curves import lines_figure
from umform_book.references import table

Floats = NDArray[np.float64]

SLOPE = 1930.0 * 195e3 / (195e3 - 1930.0)


def run(page: Page) -> None:
    """Fill the page."""
    _tension_and_shear(page)
    _cycles(page)


def corners_of(metal: Metal, stresses: Sequence[tuple[float, float]], steps: int) -> Floats:
    """Strains 11 and 12 (of the tensor) and plastic strain after each corner of a path in stresses 11 and 12."""
    corners = np.array([[0.0, 0.0], *stresses])
    rows = np.concatenate([np.linspace(a, b, steps + 1)[1:] for a, b in itertools.pairwise(corners)])
    stress = np.zeros((len(rows), 6))
    stress[:, 0], stress[:, 3] = rows.T
    found = point_path(metal, np.full_like(stress, np.nan), stress)
    ends = slice(steps - 1, None, steps)
    return np.stack([found.strain[ends, 0], 0.5 * found.strain[ends, 3], found.state[ends, 6]], axis=1)


def limit_of(metal: Metal, stresses: Sequence[tuple[float, float]], steps: int) -> Floats:
    """The same in the limit of small steps: backward Euler is of first order."""
    coarse, fine = (corners_of(metal, stresses, n) for n in (steps, 2 * steps))
    return np.asarray(2.0 * fine - coarse)


def _tension_and_shear(page: Page) -> None:
    page.heading("Tension and shear")
    names = ("strain 11", "strain 12", "plastic strain")
    path = [(151.2, 93.1), (257.2, 33.1)]
    metal = Metal(E=195e3, nu=0.3, hardening=Linear(181.0, SLOPE))
    first, second = limit_of(metal, path, 200)
    known = ((0.014829713606886, 0.013601401082429, 0.020547265463595), (0.035265, 0.020471, 0.042329286420819))
    for name, found, reference in zip(names, first, known[0], strict=True):
        page.check(f"isotropic, proportional: {name}", found, reference, 1e-9)
    for name, found, reference in zip(names, second, known[1], strict=True):
        page.check(f"isotropic, second part: {name}", found, reference, 2.5e-5)
    prager = Metal(E=195e3, nu=0.3, hardening=Perfect(181.0), back_stress=Chaboche(((SLOPE, 0.0),)))
    rows = corners_of(prager, [*path, (259.3, 0.0)], 30)
    printed = ((1, (0.0406612, 0.01978), 5e-5), (2, (0.044151, 0.0190853), 1e-3))
    for part, values, within in printed:
        for name, found, value in zip(names, rows[part], values, strict=False):
            page.check(f"Prager, part {part + 1}, 30 steps: {name}", found, value, within)
    two = Metal(
        E=145200.0,
        nu=0.3,
        hardening=Voce(87.0, 151.0, 2.3),
        back_stress=Chaboche(((187 * 341.0, 341.0), (29 * 17184.0, 17184.0)), first=0.43, rate=6.09),
    )
    end = limit_of(two, [(143.5, 143.5)], 1000)[0]
    for name, found, value in zip(names, end, (0.09698266, 0.14527633, 0.19198873), strict=True):
        page.check(f"Chaboche, two back stresses with moduli that grow: {name}", found, value, 1e-5)


def cycle(metal: Metal, corners: Floats, size: float) -> tuple[Floats, Floats, list[int]]:
    """Strains and stresses in steps of a size through given strains, and the rows of these."""
    path: list[float] = []
    ends: list[int] = []
    for a, b in itertools.pairwise(np.concatenate([[0.0], corners])):
        path += list(np.linspace(a, b, max(1, math.ceil(abs(b - a) / size)) + 1)[1:])
        ends.append(len(path) - 1)
    strain, stress, _ = tension(metal, np.array(path))
    return strain, stress, ends


def _cycles(page: Page) -> None:
    page.heading("Cycles of SPCC")
    known = table("yoshida_uemori_spcc.csv")
    strains, stresses = known["strain"][1:], known["stress_MPa"][1:]
    keep = np.flatnonzero(np.diff(strains, prepend=0.0) != 0.0)[: page.pick((len(strains),), (60,))[0]]
    strains, stresses = strains[keep], stresses[keep]
    corners, rows = _with_turns(strains)
    metal = Metal(E=206e3, nu=0.3, hardening=SPCC_YIELD, back_stress=SPCC)
    found, slopes = [], []
    for size in (1e-4, 5e-5, 2.5e-5):
        strain, stress, ends = cycle(metal, corners, size)
        found.append(stress[ends][rows])
        before, behind = np.maximum(np.array(ends) - 1, 0), ends
        slopes.append(((stress[behind] - stress[before]) / (strain[behind] - strain[before]))[rows])
    once = [2.0 * fine - coarse for coarse, fine in itertools.pairwise(found)]
    limit = (4.0 * once[1] - once[0]) / 3.0
    allowed = 2e-6 * np.abs(slopes[-1])
    beyond = np.maximum(np.abs(limit - stresses) - allowed, 0.0)
    page.at_most(
        "Yoshida-Uemori, SPCC: largest error of the stress in the limit of steps, MPa", float(beyond.max()), 0.05
    )
    page.at_most("the same in steps of 1e-4, MPa", float(np.abs(found[0] - stresses).max()), 4.0)
    lines = {name: cycle(law, np.array([0.05, -0.05, 0.05]), 1e-3)[:2] for name, law in HARDENING.items()}
    figure = lines_figure(
        "logarithmic strain", {"stress, MPa": lines}, references={"stress, MPa": {"reference": (strains, stresses)}}
    )
    page.figure("cycles", figure, "One cycle and a half of the laws of the page of bending, and the reference of SPCC")


def _with_turns(strains: Floats) -> tuple[Floats, Floats]:
    """Strains with the reversals inserted, and the rows of the given ones."""
    turns, at = [0.05, -0.05, 0.05, -0.05, 0.05], 0
    path: list[float] = []
    rows: list[int] = []
    way = 1.0
    for k, strain in enumerate(strains):
        if k > 0 and (strain - strains[k - 1]) * way < 0.0:
            if abs(path[-1] - turns[at]) > 1e-7:
                path.append(turns[at])
            at, way = at + 1, -way
        path.append(float(strain))
        rows.append(len(path) - 1)
    return np.array(path), np.array(rows)


CASE = Case(
    name="material-paths",
    title="Hardening along paths",
    problem="""
A point in tension and shear, proportional and not: isotropic hardening, Prager, Chaboche with two back stresses whose
moduli grow with the plastic strain. A bar of SPCC cycled between strains of 5 and -5 % with Yoshida-Uemori. Backward
Euler is of first order: values are extrapolated from two step sizes.
""",
    reference="""
Tests SSNP15 (closed form; other programs to 1 % in its second part), SSNP14 (other programs) and SSNV101 of
Code_Aster, the last integrated exactly along its proportional path: p = 0.19198873. SPCC: Yoshida and Uemori (2002),
table 1, integrated by an independent program with explicit steps of 2e-6, which overshoot the reversals by up to 2e-6:
the check also allows this overshoot times the slope.
""",
    run=run,
    cost=15.0,
)
