"""Cantilever strip of Sze et al. (2004): length 10, width 1, thickness 0.1, E = 1.2e6, nu = 0."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.materials import SVK
from umform.model import Model
from umform_book.nonlinear.tracing import Probe, Setup
from umform_book.variants import Variant

Floats = NDArray[np.float64]

LENGTH, WIDTH, THICKNESS, E = 10.0, 1.0, 0.1, 1.2e6
SHEAR_FORCE = 4.0
TURN = 2 * pi


def clamped_strip(variant: Variant, divisions: int, thickness: float = THICKNESS) -> Model:
    """Strip clamped at x0, one element wide."""
    strip = mesh.strip(LENGTH, WIDTH, thickness, (variant.cells(divisions), 1), cell=variant.cell)
    model = Model(strip, variant.element, material=SVK(E=E, nu=0.0))
    model.fix("x0")
    return model


def end_shear(variant: Variant, divisions: int) -> Setup:
    """The strip under a dead shear force at its end."""
    model = clamped_strip(variant, divisions)
    load = model.traction("x1", (0, 0, 1 / (WIDTH * THICKNESS)), "shear")
    end = model.mesh.nodes("x1")
    probes = {"w_tip": Probe(end, (0, 0, 1)), "minus_u_tip": Probe(end, (-1, 0, 0))}
    return Setup(model, {load: SHEAR_FORCE}, probes)


def end_moment(variant: Variant, divisions: int, thickness: float = THICKNESS) -> Setup:
    """The strip under the moment E I 2 pi / length at its end, which bends it to a circle.

    The moment is a couple of line loads on the upper and lower edge of the end. They are dead loads, but their
    direction is set in each increment to be normal to the director of the closed form. A director that is off by delta
    gets the moment times cos(delta): an error of second order in the error of the solution.
    """
    model = clamped_strip(variant, divisions, thickness)
    force = E * thickness**2 / 12 * TURN / LENGTH
    loads = {
        model.line_load("x1", side, np.eye(3)[2 * axis], f"{side}{axis}"): _couple(sign * force, part)
        for side, sign in (("upper", -1.0), ("lower", 1.0))
        for axis, part in enumerate((cos, sin))
    }
    end = model.mesh.nodes("x1")
    probes = {"w_tip": Probe(end, (0, 0, 1)), "minus_u_tip": Probe(end, (-1, 0, 0))}
    return Setup(model, loads, probes)


def _couple(force: float, part: Callable[[float], float]) -> Callable[[float], float]:
    return lambda fraction: force * fraction * part(TURN * fraction)


def circle(fractions: Floats) -> dict[str, Floats]:
    """Closed form of the thin strip under a part of the moment that bends it to a circle: displacements of its end."""
    angle = TURN * np.asarray(fractions)
    return {
        "load_fraction": np.asarray(fractions),
        "w_tip": LENGTH * (1 - np.cos(angle)) / angle,
        "minus_u_tip": LENGTH * (1 - np.sin(angle) / angle),
    }


def rotation_of_end(model: Model) -> float:
    """Angle by which the end of the strip has turned, taken to be the one next to a full turn."""
    x = model.positions
    upper, lower = (x[model.mesh.nodes(f"x1_{side}")].mean(axis=0) for side in ("upper", "lower"))
    director = upper - lower
    off = np.arctan2(-director[0], director[2]) - TURN
    return float(TURN + (off + pi) % (2 * pi) - pi)
