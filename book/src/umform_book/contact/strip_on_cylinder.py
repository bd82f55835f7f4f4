"""A thin elastic strip over a rigid cylinder: model, and the closed form of the elastica that hangs over it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq

from umform import mesh
from umform.materials import SVK
from umform.model import Model
from umform.model.contact import Contact
from umform.model.terms.dead_load import Load
from umform.surfaces import Cylinder
from umform_book.variants import Variant

Floats = NDArray[np.float64]

E, THICKNESS, WIDTH, RADIUS = 1e5, 0.1, 1.0, 10.0
EI = E * THICKNESS**3 * WIDTH / 12
#: Radius of the mid-surface on the tool.
MIDDLE = RADIUS + 0.5 * THICKNESS


@dataclass(frozen=True)
class Hanging:
    """Half of a strip that lies over a cylinder, a dead force at its end.

    Attributes
    ----------
    angle : float
        Where the strip leaves the cylinder, from the top.
    tip : tuple of float
        Horizontal and vertical position of the end, from the mid-surface at the top.
    pressing : float
        Sum of all normal forces.
    centre : float
        Mean angle of the normal forces.
    pressure : float
        Pressure on the arc, on the reference area.
    """

    angle: float
    tip: tuple[float, float]
    pressing: float
    centre: float
    pressure: float


def hanging(force: float, length: float) -> Hanging:
    """Closed form for an inextensible strip without shear strain.

    On the arc the curvature is 1/R, so the moment is EI/R and constant: no shear force, a constant tension and the
    pressure of that tension. Beyond, EI psi'^2 / 2 = F (sin psi_end - sin psi). Where the strip leaves the cylinder the
    curvature is continuous, so EI/(2 R^2) = F (sin psi_end - sin angle), and the shear force F cos(angle) of the
    free part is balanced by a line force of the tool. The tension there is F sin(angle).
    """
    ratio = force / EI

    def free_part(angle: float) -> tuple[float, float, float]:
        """Length, run and fall of the part beyond an angle."""
        end = np.arcsin(np.sin(angle) + 1 / (2 * ratio * MIDDLE**2))
        root = np.sqrt(end - angle)

        def along(q: float) -> float:  # psi = end - q^2 takes the singularity at the end away
            difference = 2 * np.cos(end - 0.5 * q * q) * np.sin(0.5 * q * q)
            return (
                float(2 * q / np.sqrt(2 * ratio * difference)) if q > 0 else float(2 / np.sqrt(2 * ratio * np.cos(end)))
            )

        parts = [lambda q: 1.0, lambda q: float(np.cos(end - q * q)), lambda q: float(np.sin(end - q * q))]
        length_, run, fall = (quad(lambda q, part=part: along(q) * part(q), 0.0, root)[0] for part in parts)
        return length_, run, fall

    steepest = float(np.arcsin(1 - 1 / (2 * ratio * MIDDLE**2))) * (1 - 1e-9)
    angle = float(brentq(lambda a: free_part(a)[0] + MIDDLE * a - length, 0.0, steepest, xtol=1e-12))
    _, run, fall = free_part(angle)
    line, tension = force * np.cos(angle), force * np.sin(angle)
    pressing = line + tension * angle
    return Hanging(
        angle=angle,
        tip=(float(MIDDLE * np.sin(angle) + run), float(-MIDDLE * (1 - np.cos(angle)) - fall)),
        pressing=float(pressing),
        centre=float((line * angle + 0.5 * tension * angle**2) / pressing),
        pressure=float(tension / (MIDDLE * WIDTH)),
    )


def flat_strip(
    variant: Variant,
    divisions: int,
    ends: tuple[float, float],
    penalty: float,
    points: int | str,
    *,
    overlap: float = 0.0,
    radius: float = RADIUS,
) -> tuple[Model, Contact, Load]:
    """Flat strip in a plane (u_y = 0, nu = 0) on top of a cylinder, a dead force downwards at its end x1.

    Parameters
    ----------
    variant : Variant
        Element.
    divisions : int
        Intervals between nodes along the strip.
    ends : tuple of float
        x of the ends; the axis of the cylinder is at x = 0.
    penalty : float
        Penalty.
    points : int or "nodes"
        Contact rule.
    overlap : float
        How far the tool stands in the strip at first, so that a contact point touches it.
    radius : float
        Radius of the cylinder.
    """
    length = ends[1] - ends[0]
    strip = mesh.strip(length, WIDTH, THICKNESS, (variant.cells(divisions), 1), cell=variant.cell)
    strip = strip.moved((ends[0], 0.0, 0.0))
    model = Model(strip, variant.element, material=SVK(E=E, nu=0.0))
    model.fix(np.arange(len(strip.points)), "y")
    tool = Cylinder((0.0, 0.0, overlap - radius - 0.5 * THICKNESS), "y", radius)
    contact = model.contact("lower", tool, penalty=penalty, points=points, name="tool")
    load = model.traction("x1", (0.0, 0.0, -1 / (WIDTH * THICKNESS)), "force")
    return model, contact, load
