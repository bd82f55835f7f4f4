"""Draw K over R / T of three metals from runs, for docs/k-factor.md: python tools/k_factor_picture.py [FILE].

The bends are in the store of the user after the first time (some 75 s of CPU).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from umform.plotting import COLOURS, house_style, save
from umform.processes.air_bending import AirBending
from umform.studies.bend_table import BendTable, bend_table, setups

METALS = ("DC04", "1.4301", "EN AW-5754")
THICKNESSES, OPENINGS = (1.0, 1.5, 2.0), (12.0, 16.0)
ANGLES = tuple(90.0 + 7.5 * number for number in range(11))
#: K of the tables of Machinery's Handbook, as Creo ships them.
SHIPPED = (0.35, 0.41, 0.45)
PICTURE = Path(__file__).parent.parent / "docs" / "images" / "k_factor.png"


def picture(table: BendTable) -> Figure:
    """K and the place of the neutral fibre over R / T, with the formula of DIN 6935 and three constants."""
    figure = Figure(figsize=(8.4, 3.7), layout="constrained")
    left, right = figure.subplots(1, 2, sharey=True)
    _draw(left, table, "k_factor")
    _draw(right, table, "neutral_fibre")
    left.set_ylabel("K (ANSI) for the flat pattern")
    right.set_ylabel("neutral fibre in the flat sheet, from the inner face, over T")
    left.set_ylim(0.3, 0.52)
    left.legend(fontsize="small")
    return figure


def _draw(axes: Axes, table: BendTable, quantity: str) -> None:
    for part in table.parts:
        number, ratio = METALS.index(part.setup.metal), [one.radius / one.case.thickness for one in part.bends]
        first = part.setup.case.thickness == THICKNESSES[0] and part.setup.case.opening == OPENINGS[0]
        label = part.setup.metal if first else None
        values = [getattr(one.measures, quantity) for one in part.bends]
        axes.plot(ratio, values, "o-", ms=3.0, lw=0.6, color=COLOURS[number], label=label)
    ratio = np.geomspace(0.7, 20.0, 100)
    axes.plot(ratio, 0.5 * np.minimum(0.65 + 0.5 * np.log10(ratio), 1.0), "k-", lw=1.0, label="DIN 6935, k / 2")
    for K in SHIPPED:
        axes.axhline(K, color="0.6", lw=0.8, ls="--", label="0.35, 0.41, 0.45" if SHIPPED[0] == K else None)
    axes.set(xscale="log", xlabel="inside radius R / thickness T", xlim=(0.7, 20.0))
    axes.set_xticks([1, 2, 5, 10, 20], ["1", "2", "5", "10", "20"])


def main(path: Path) -> None:
    """Compute what is missing, draw, and print the numbers of the page."""
    wanted = setups(METALS, AirBending(), thicknesses=THICKNESSES, openings=OPENINGS)
    table = bend_table(wanted, ANGLES)
    with house_style():
        save(picture(table), path)
    bends = [one for part in table.parts for one in part.bends]
    for quantity in ("k_factor", "neutral_fibre"):
        near = [one for one in bends if 2.7 < one.radius / one.case.thickness < 3.3]
        values = [getattr(one.measures, quantity) for one in near]
        print(f"{quantity} at R/T of 2.7 to 3.3: {min(values):.3f} to {max(values):.3f}")
    print(f"errors of BD with K = {SHIPPED} and R, and with K = {SHIPPED[1]} and the radius of the punch")
    for part in table.parts:
        one, case = part.bends[0], part.setup.case
        if one.wanted == 90.0 and part.setup.metal == METALS[0]:
            T, guesses = case.thickness, [*((one.radius, K) for K in SHIPPED), (case.punch_radius, SHIPPED[1])]
            errors = [f"{2.0 * (R + T) - 0.5 * np.pi * (R + K * T) - one.deduction:+.2f}" for R, K in guesses]
            numbers = [f"{one.radius:.2f}", f"{one.k_factor:.3f}", f"{one.deduction:.3f}", *errors]
            print(f"| {T:g} mm, V {case.opening:g} | {' | '.join(numbers)} |")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURE)
