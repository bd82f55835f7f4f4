"""Measurements and fit: stress and r over the angle, yield locus, tension, cycles."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from umform.materials import J2, FallingModulus, Metal, YieldFunction, tension
from umform.plotting import COLOURS, Plot
from umform.sheet_metals import Directions, uniaxial
from umform.studies.calibration.calibrate import Calibration
from umform.studies.calibration.measurements import Test, Unloading

Floats = NDArray[np.float64]
#: Shares of the largest shear at which the locus is drawn.
_SHEARS = (0.0, 0.5, 0.8)
#: Largest strain of a step through a test.
_STEP = 1e-3


def pictures(found: Calibration) -> Iterator[tuple[str, Figure]]:
    """Name and picture of each kind of measurement."""
    given = found.measurements
    if given.directions is not None:
        yield "directions", over_the_angle(found.yield_function, given.directions)
        yield "locus", locus(found.yield_function, given.directions)
    if given.unloading is not None:
        yield "modulus", over_plastic_strain(found.fits["modulus"].law, given.unloading, found.young)
    for name, test in (("tension", given.tension), ("cycles", given.cycles)):
        if test is not None and found.law is not None:
            yield name, along_a_test(found.law, test, name)


def over_the_angle(function: YieldFunction, measured: Directions | None) -> Figure:
    """Yield stress and r-value over the angle to the rolling direction."""
    figure = Plot(figsize=(9, 3.8), layout="constrained")
    angles = np.linspace(0.0, 90.0, 91)
    values = np.array([uniaxial(function, angle) for angle in angles])
    for axes, column, name in zip(figure.subplots(1, 2), (0, 1), ("stress", "r"), strict=True):
        axes.plot(angles, values[:, column], color=COLOURS[0], label="fit")
        points = getattr(measured, name, {})
        if points:
            axes.plot(list(points), list(points.values()), "o", color=COLOURS[1], label="measured")
        axes.set(xlabel="angle to the rolling direction, degrees", xlim=(-2, 92), xticks=range(0, 91, 15))
        axes.set(title="yield stress over that of the curve" if name == "stress" else "r-value")
        axes.legend()
    return figure


def locus(function: YieldFunction, measured: Directions | None) -> Figure:
    """Yield locus in plane stress, for three shears, with what was measured of it."""
    figure = Plot(figsize=(4.6, 4.6), layout="constrained")
    axes = figure.subplots()
    kernel = function.function()
    shear = 1.0 / kernel(np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0]))[0]
    for share in _SHEARS:
        x, y = _contour(function, share * shear)
        label = "shear 0" if not share else f"{share:g} of the largest shear"
        axes.plot(x, y, color=COLOURS[0], alpha=1.0 - 0.6 * share, label=label)
    if measured is not None:
        points = [(measured.stress.get(0.0), 0.0), (0.0, measured.stress.get(90.0)), (measured.biaxial,) * 2]
        for x0, y0 in points:
            if x0 is not None and y0 is not None:
                axes.plot(x0, y0, "o", color=COLOURS[1])
    axes.set(xlabel="stress along the rolling direction", ylabel="stress across it", aspect="equal")
    axes.set(title="yield locus, over the stress of the curve")
    axes.legend(fontsize="small")
    return figure


def _contour(function: YieldFunction, shear: float) -> tuple[Floats, Floats]:
    """Where plane stresses with a shear flow: along each ray the size by bisection, the function being convex."""
    kernel = function.function()
    rays = np.linspace(0.0, 2.0 * np.pi, 241)
    sizes = []
    for ray in rays:
        low, high = 0.0, 4.0
        for _ in range(50):
            middle = 0.5 * (low + high)
            stress = np.array([middle * np.cos(ray), middle * np.sin(ray), 0.0, shear, 0.0, 0.0])
            low, high = (middle, high) if kernel(stress)[0] < 1.0 else (low, middle)
        sizes.append(low)
    size = np.array(sizes)
    return size * np.cos(rays), size * np.sin(rays)


def over_plastic_strain(law: FallingModulus, measured: Unloading, young: float) -> Figure:
    """Slopes of unloading over the plastic strain."""
    figure = Plot(figsize=(6.2, 4.0), layout="constrained")
    axes: Axes = figure.subplots()
    p = np.linspace(0.0, 1.05 * float(measured.eqps.max()), 101)
    axes.plot(measured.eqps, measured.modulus, "o", color=COLOURS[1], markersize=3, label="measured")
    axes.plot(p, young * law.share(young, p), color=COLOURS[0], linewidth=1.2, label="fit")
    axes.set(title="unloading", xlabel="plastic strain", ylabel="modulus, MPa")
    axes.legend()
    return figure


def along_a_test(law: J2 | Metal, test: Test, name: str) -> Figure:
    """Stress over strain of a test: measured, and the law along the same strains."""
    figure = Plot(figsize=(6.2, 4.0), layout="constrained")
    axes: Axes = figure.subplots()
    strain, stress = curve_of(law, test)
    axes.plot(test.strain, test.stress, "o", color=COLOURS[1], markersize=3, label="measured")
    axes.plot(strain, stress, color=COLOURS[0], linewidth=1.2, label="fit")
    axes.set(title=name, xlabel="logarithmic strain", ylabel="true stress, MPa")
    axes.legend()
    return figure


def curve_of(law: J2 | Metal, test: Test) -> tuple[Floats, Floats]:
    """Strain and stress of a law along the strains of a test, in small steps."""
    metal = law if isinstance(law, Metal) else Metal(law.E, law.nu, hardening=law.hardening)
    corners = np.concatenate([[0.0], test.strain])
    parts = [np.linspace(a, b, max(int(np.ceil(abs(b - a) / _STEP)), 1) + 1)[1:] for a, b in pairwise(corners)]
    strain, stress, _ = tension(metal, np.concatenate(parts))
    return np.concatenate([[0.0], strain]), np.concatenate([[0.0], stress])
