"""Bars under tension: an eighth of a straight bar, and strips that are a little narrower in the middle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from umform import mesh
from umform.elements import Element, element
from umform.materials import J2
from umform.model import Model
from umform.model.terms.control import Prescribed
from umform_book.plastic.plane_strain import State, stretched, yield_curve

Floats = NDArray[np.float64]

LENGTH, WIDTH, THICKNESS = 10.0, 4.0, 1.0


def bar(
    kind: str | Element, material: J2, cells: tuple[int, int] = (6, 2), *, held: bool = False
) -> tuple[Model, Prescribed]:
    """An eighth of a bar under tension, and the control of its end; held: the width does not change (plane strain)."""
    chosen = element(kind)
    model = Model(mesh.strip(LENGTH, WIDTH, THICKNESS, cells, cell=chosen.cell), chosen, material=material)
    for plane, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(plane, normal)
    if held:
        model.symmetry("y1", "y")
    return model, model.prescribe("x1", "x", "end")


def maximum_force(material: J2) -> tuple[float, float]:
    """Largest force per reference area of a bar of free width, and the logarithmic strain there.

    The force is tau exp(-eps) with tau = y(e), eps = y / E + e; it is largest where d tau / d eps = tau (Considere).
    """

    def excess(e: float) -> float:
        y, slope = (float(value[0]) for value in yield_curve(material.hardening, np.array([e])))
        return slope - y * (1.0 + slope / material.E)

    e = float(brentq(excess, 0.0, 2.0, xtol=1e-14))
    tau = float(yield_curve(material.hardening, np.array([e]))[0][0])
    strain = tau / material.E + e
    return tau * float(np.exp(-strain)), strain


def maximum_force_plane_strain(material: J2, *, steps: int = 4000, largest: float = 1.0) -> tuple[float, float]:
    """The same with the width held: the law integrated in small steps."""
    strains = np.linspace(0.0, largest, steps + 1)
    forces = np.zeros(steps + 1)
    state = State.virgin(1)
    for k in range(1, steps + 1):
        force, _, state = stretched(material, np.exp(strains[k : k + 1]), state)
        forces[k] = force[0]
    return peak(strains, forces)


def peak(x: Floats, y: Floats) -> tuple[float, float]:
    """Largest ordinate of a smooth curve given by points, and its abscissa: a parabola through the three top points."""
    top = min(max(int(np.argmax(y)), 1), len(y) - 2)
    at = slice(top - 1, top + 2)
    a, b, c = np.polyfit(x[at] - x[top], y[at], 2)
    return float(c - b * b / (4.0 * a)), float(x[top] - b / (2.0 * a))


def narrowed_strip(
    kind: str | Element,
    material: J2,
    cells: tuple[int, int],
    *,
    length: float = 30.0,
    width: float = 10.0,
    thickness: float = 0.5,
    imperfection: float = 0.01,
    held: bool = False,
) -> tuple[Model, Prescribed]:
    """A quarter of a strip that is narrower by the imperfection in its middle x = 0.

    The thickness is half of that of the sheet (its mid-plane is ``lower``), or with ``held`` does not change.
    """
    chosen = element(kind)

    def narrowed(X: Floats) -> Floats:
        factor = 1.0 - imperfection * 0.5 * (1.0 + np.cos(np.pi * X[:, 0] / length))
        return np.column_stack([X[:, 0], factor * X[:, 1], X[:, 2]])

    straight = mesh.strip(length, width, thickness, cells, cell=chosen.cell)
    points = 2 if held else 3
    model = Model(straight.transformed(narrowed), chosen, material=material, thickness_points=points)
    for plane, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(plane, normal)
    if held:
        model.symmetry("upper", "z")
    return model, model.prescribe("x1", "x", "end")
