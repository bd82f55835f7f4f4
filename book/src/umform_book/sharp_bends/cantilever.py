"""A wide cantilever that is bent slightly beyond its yield moment, and released: its section, and its model."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.analysis.steps import Move
from umform.elements import element as catalogue_element
from umform.elements.technology import Element
from umform.model import Model
from umform_book.page import Page
from umform_book.plastic.plane_strain import Section, plane_strain_modulus
from umform_book.sharp_bends.candidates import YIELD_STRESS, steel

Floats = NDArray[np.float64]

HARDENING = 2000.0
LENGTH, THICKNESS = 40.0, 1.0
#: Elements in the third of the length at the root, and in the rest.
FINE, COARSE = 60, 12
_PLACES = 4001

_NU = (3 * 175e3 - 2 * 80.77e3) / (2 * (3 * 175e3 + 80.77e3))
#: Curvature and moment per width at which the outer fibre of a wide sheet begins to flow.
YIELD_CURVATURE = (
    YIELD_STRESS / np.sqrt(1.0 - _NU + _NU**2) / (0.5 * THICKNESS * plane_strain_modulus(steel(HARDENING)))
)
YIELD_MOMENT = plane_strain_modulus(steel(HARDENING)) * YIELD_CURVATURE * THICKNESS**3 / 12.0


def curvatures(largest: float, number: int = 160) -> Floats:
    """Curvatures over that of first yield: few below it, most in the knee."""
    return np.concatenate([[0.5, 0.9], 0.9 + (largest - 0.9) * np.linspace(0.0, 1.0, number + 1)[1:] ** 2])


def fibres(largest: float = 3.0, number: int = 160, count: int = 1000) -> tuple[Floats, Floats]:
    """Curvature and moment over those of first yield, by fibres of one size that each have sigma_33 = 0."""
    half = np.linspace(-1.0, 1.0, 2 * count + 1)[1::2]
    section = Section(steel(HARDENING), THICKNESS, (half, np.full(count, 2.0 / count)))
    ks = curvatures(largest, number)
    return ks, np.array([section.bend(k * YIELD_CURVATURE) for k in ks]) / YIELD_MOMENT


def permanent_sets(curve: tuple[Floats, Floats], levels: Sequence[float]) -> Floats:
    """Permanent deflections of the tip, over LENGTH, after forces P with P LENGTH over the yield moment. eq. (2.45)

    The loaded shape is that of the elastica: its rotation shortens the arm of the force. Unloading is elastic.
    """
    curvature, moment = (np.concatenate([[0.0], part]) for part in curve)
    stiffness = moment[1] / curvature[1]
    step = LENGTH / _PLACES
    sets = []
    for level in levels:
        arm = LENGTH - (np.arange(_PLACES) + 0.5) * step
        for _ in range(8):
            bent = np.interp(level * arm / LENGTH, moment, curvature) * YIELD_CURVATURE
            x = _integral(np.cos(_integral(bent, step)), step)
            arm = x[-1] + 0.5 * step * np.cos(bent.sum() * step) - x
        left = bent - level * arm / LENGTH / stiffness * YIELD_CURVATURE
        sets.append(float(np.sin(_integral(left, step)).mean()))
    return np.array(sets)


def _integral(values: Floats, step: float) -> Floats:
    """Integral from the first end to the middle of each interval."""
    return np.asarray((np.cumsum(values) - 0.5 * values) * step)


def cantilever_sets(
    page: Page, label: str, element: str | Element, levels: Sequence[float], **through: object
) -> Floats:
    """Permanent deflections of a model, loaded to one level after the other and released after each."""
    cell = catalogue_element(element).cell
    half = 1 if cell == "hex8" else 2
    root, rest = np.linspace(0.0, 1.0 / 3.0, FINE // half + 1), np.linspace(1.0 / 3.0, 1.0, COARSE // half + 1)
    x, z = LENGTH * np.concatenate([root, rest[1:]]), np.array([-0.5, 0.5]) * THICKNESS
    sheet = mesh.grid(x, np.array([0.0, 1.0]), z, cell)
    model = Model(sheet, element, material=steel(HARDENING), **through)  # type: ignore[arg-type]
    model.symmetry("x0", "x")
    model.fix("x0_lower", "z")
    model.fix(np.arange(len(sheet.points)), "y")
    shear = YIELD_MOMENT / (LENGTH * THICKNESS)
    # The root gets its shear as a traction too: a reaction at one edge would make it flow there.
    loads = [model.traction(face, (0.0, 0.0, sign * shear)) for face, sign in (("x1", 1.0), ("x0", -1.0))]
    ways = [(level, count) for top in levels for level, count in ((top, 24), (0.0, 1))]
    steps = [Move(loads, to=[level, level], steps=count) for level, count in ways]
    tip = sheet.nodes("x1")
    result = page.solve(label, model, steps, frames=1)
    released = [frame for frame in result.frames if frame.time > 0.0 and round(frame.time, 9) % 2.0 == 0.0]
    return np.array([frame.points["displacement"][tip, 2].mean() for frame in released]) / LENGTH
