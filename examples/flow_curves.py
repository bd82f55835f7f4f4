"""Flow curves of all sheet metals of the library, with the forces of their tensile tests."""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import umform as uf
from umform.plotting import COLOURS, INK, house_style, save


def draw() -> Figure:
    """Yield stress over plastic strain, dashed where it is extrapolated; nominal stress over elongation."""
    figure = Figure(figsize=(10, 4), layout="constrained")
    flow, nominal = figure.subplots(1, 2)
    for name, colour in zip(uf.sheet_metals.names(), COLOURS, strict=True):
        metal = uf.sheet_metals.get(name)
        curve = metal.law.hardening.curve()
        p = np.concatenate([[0.0], np.geomspace(1e-4, 0.6, 300)])
        y = np.array([curve(e)[0] for e in p])
        inside = p <= metal.valid_strain
        flow.plot(p[inside], y[inside], color=colour, label=name)
        flow.plot(p[~inside], y[~inside], "--", color=colour, linewidth=0.8)
        strain = p[inside] + y[inside] / metal.young
        nominal.plot(np.r_[0, 100 * np.expm1(strain)], np.r_[0, y[inside] * np.exp(-strain)], color=colour)
        total = 100 * (metal.uniform_elongation + metal.tensile_strength / metal.young)
        proof = 100 * (0.002 + metal.yield_stress / metal.young)
        nominal.plot([proof, total], [metal.yield_stress, metal.tensile_strength], "o", color=colour, markersize=4)
    flow.set(title="flow curves", xlabel="plastic strain", ylabel="yield stress, MPa", xlim=(0, 0.6), ylim=(0, None))
    flow.legend(ncols=2)
    nominal.set(title="tensile tests up to the largest force", xlabel="elongation, %", ylabel="force / first area, MPa")
    nominal.set(xlim=(0, None), ylim=(0, None))
    nominal.annotate("points: R and Rm of the source", (0.97, 0.04), xycoords="axes fraction", ha="right", color=INK)
    return figure


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    with house_style():
        save(draw(), folder / "flow_curves.png", dpi=110)
