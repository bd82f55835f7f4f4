"""Draw K over R / T of three metals from runs, for docs/k-factor.md: python tools/k_factor_picture.py [FILE].

The bends are in the store of the user after the first time (some 75 s of CPU).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
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
    """K over R / T, with the formula of DIN 6935 and three constants."""
    figure = Figure(figsize=(7.2, 4.2), layout="constrained")
    axes = figure.subplots()
    for number, metal in enumerate(METALS):
        bends = [one for part in table.parts if part.setup.metal == metal for one in part.bends]
        ratio = [one.radius / one.case.thickness for one in bends]
        axes.plot(ratio, [one.k_factor for one in bends], "o", ms=3.5, color=COLOURS[number], label=metal)
    ratio = np.geomspace(0.7, 20.0, 100)
    axes.plot(ratio, 0.5 * np.minimum(0.65 + 0.5 * np.log10(ratio), 1.0), "k-", lw=1.0, label="DIN 6935, k / 2")
    for K in SHIPPED:
        axes.axhline(K, color="0.6", lw=0.8, ls="--", label="0.35, 0.41, 0.45" if K == SHIPPED[0] else None)
    axes.set(xscale="log", xlabel="inside radius / thickness", ylabel="K (ANSI)", xlim=(0.7, 20.0), ylim=(0.3, 0.52))
    axes.set_xticks([1, 2, 5, 10, 20], ["1", "2", "5", "10", "20"])
    axes.legend()
    return figure


def main(path: Path) -> None:
    """Compute what is missing, draw, and print the numbers of the page."""
    wanted = setups(METALS, AirBending(), thicknesses=THICKNESSES, openings=OPENINGS)
    table = bend_table(wanted, ANGLES)
    with house_style():
        save(picture(table), path)
    for metal in METALS:
        bends = [one for part in table.parts if part.setup.metal == metal for one in part.bends]
        near = {
            at: [one.k_factor for one in bends if abs(one.radius / one.case.thickness / at - 1.0) < 0.1]
            for at in (1, 2, 5)
        }
        print(metal, {at: f"{min(ks):.3f} to {max(ks):.3f}" for at, ks in near.items() if ks})
        right = {
            part.setup.name: one
            for part in table.parts
            for one in part.bends
            if one.wanted == 90.0 and part.setup.metal == metal
        }
        for name, one in right.items():
            print(f"  {name}: 90 degrees, R {one.radius:.2f}, K {one.k_factor:.3f}, BD {one.deduction:.3f}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else PICTURE)
