"""A wide sheet in pure bending as a model: a few elements between two sections, the end section turned and turned back.

The horizontal displacements of the lower and of the upper edge of the end section are those of an arc whose mid-line
keeps its length, as it does in a wide sheet without hardening (Hill 1950); vertical displacements and the thickness are
free. The force along the sheet that this leaves is measured, and is small of second order.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.materials import J2, Material
from umform.model import Model
from umform.model.terms.control import Prescribed
from umform_book.page import Page
from umform_book.plastic.plane_strain import BendingPath, zero_moment
from umform_book.variants import Variant

Floats = NDArray[np.float64]

THICKNESS = 1.0
LENGTH = 2.0
WIDTH = 1.0


@dataclass(frozen=True)
class Bent:
    """Results of a sheet: arrays over the increments up and back.

    Attributes
    ----------
    curvature, moment, force : ndarray
        On the way up: curvature, moment per width, force along the sheet per width.
    residual_curvature : float
        Curvature without moment after the way back.
    result : Result
        The run.
    """

    curvature: Floats
    moment: Floats
    force: Floats
    residual_curvature: float
    result: Result


def end_section(curvature: float, chords: int, length: float = LENGTH) -> tuple[float, float]:
    """Horizontal displacements of the lower and of the upper edge; the mid-line is made of chords (0: an arc)."""
    turn = 2.0 * np.arcsin(0.5 * curvature * length / chords) if chords else 0.0
    angle = chords * turn if chords else curvature * length
    # np.sinc(x / pi) is sin(x) / x
    middle = np.cos((np.arange(chords) + 0.5) * turn).mean() * length if chords else np.sinc(angle / np.pi) * length
    half = 0.5 * THICKNESS * np.sin(angle)
    return float(middle - half - length), float(middle + half - length)


def model_of(
    variant: Variant, cells: int, material: Material, points: int, rule: str
) -> tuple[Model, tuple[Prescribed, Prescribed]]:
    """The sheet in plane strain, and the controls of the lower and of the upper edge of its end section."""
    sheet = mesh.strip(LENGTH, WIDTH, THICKNESS, (cells, 1), cell=variant.cell)
    model = Model(sheet, variant.element, material=material, thickness_points=points, thickness_rule=rule)
    model.fix(np.arange(len(sheet.points)), "y")
    model.symmetry("x0", "x")
    model.fix("x0_lower", "z")
    return model, (model.prescribe("x1_lower", "x", "lower"), model.prescribe("x1_upper", "x", "upper"))


def bend(
    page: Page,
    label: str,
    variant: Variant,
    cells: int,
    material: J2,
    path: BendingPath,
    *,
    points: int = 9,
    rule: str = "gauss",
    steps: int = 40,
    frames: int = 0,
) -> Bent:
    """Bend a sheet along the path of a reference and back to zero moment."""
    model, edges = model_of(variant, cells, material, points, rule)
    chords = cells if variant.cell == "hex8" else 0

    def way(curvatures: Floats, side: int) -> Callable[[float], float]:
        fractions = np.linspace(0.0, 1.0, len(curvatures))
        return lambda fraction: end_section(float(np.interp(fraction, fractions, curvatures)), chords)[side]

    up = Move(edges, [way(path.curvature, side) for side in (0, 1)], steps=steps)
    back = Move(edges, [way(path.curvature_back, side) for side in (0, 1)], steps=3)
    result = page.solve(label, model, [up, back], frames=frames)
    curvature = _curvatures(result, path)
    moment, force = _section_forces(result, curvature, chords)
    turned = result["step"] < 2
    last = np.flatnonzero(turned)[-1]
    residual = zero_moment(curvature[last:], moment[last:])
    return Bent(curvature[turned], moment[turned], force[turned], residual, result)


def _curvatures(result: Result, path: BendingPath) -> Floats:
    """Curvature of each row of the history: step 1 is loading, step 2 unloading."""
    time = result["time"]
    up = np.interp(time, np.linspace(0.0, 1.0, len(path.curvature)), path.curvature)
    back = np.interp(time - 1.0, np.linspace(0.0, 1.0, len(path.curvature_back)), path.curvature_back)
    return np.where(time > 1.0, back, up)


def _section_forces(result: Result, curvature: Floats, chords: int) -> tuple[Floats, Floats]:
    """Moment (work conjugate of the curvature) and force along the sheet, per width."""
    d = 1e-6
    by_curvature = [
        np.subtract(end_section(k + d, chords), end_section(k - d, chords)) / (2.0 * d * LENGTH) for k in curvature
    ]
    edges = np.stack([result["lower_force"], result["upper_force"]], axis=1) / WIDTH
    moment: Floats = np.einsum("ij,ij->i", edges, by_curvature)
    return moment, edges.sum(axis=1)
