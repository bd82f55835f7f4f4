"""Hertzian contact: a tool pressed into a block; measures of peak pressure and size of the contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.model import Model
from umform.model.contact import Contact, ContactPoints
from umform.surfaces import Cylinder, Sphere
from umform_book.contact.figures import rule_name
from umform_book.contact.half_space import E_STAR, NU, E, block
from umform_book.page import Page
from umform_book.variants import Variant

Floats = NDArray[np.float64]

#: The residual cannot fall below the round-off of positions on a tool of this radius times a stiff penalty.
_OPTIONS = NewtonOptions(residual=1e-7)


@dataclass(frozen=True)
class Problem:
    """A tool pressed into a block.

    Attributes
    ----------
    kind : {"line", "point"}
        Cylinder in plane strain, half of it; or sphere, a quarter of it.
    radius : float
        Radius of the tool.
    depth : float
        How far it is driven, so that the contact gets a size of about 1.
    end : float
        Half-width and depth of the block.
    growth : float
        Growth of the elements away from the contact.
    steps : int
        Increments; the size of the contact grows linearly with their number.
    """

    kind: str
    radius: float
    depth: float
    end: float
    growth: float
    steps: int


@dataclass(frozen=True)
class Measures:
    """Results over those of Hertz for the same force.

    Attributes
    ----------
    force : float
        On the whole tool (line: per width).
    size : float
        Half-width or radius of the contact after Hertz.
    peak : float
        Peak pressure after Hertz.
    peak_points, peak_nodes : float
        Largest pressure at a contact point, and largest average at a node, over the peak.
    spread : float
        Size from the second moment of the pressure, over the size.
    edge : float
        Outermost point in contact, over the size.
    """

    force: float
    size: float
    peak: float
    peak_points: float
    peak_nodes: float
    spread: float
    edge: float


def hertz_line(force: float, radius: float) -> tuple[float, float]:
    """Half-width a = sqrt(4 P R / (pi E*)) and peak pressure 2 P / (pi a) of a line contact."""
    a = np.sqrt(4 * force * radius / (np.pi * E_STAR))
    return float(a), float(2 * force / (np.pi * a))


def hertz_point(force: float, radius: float) -> tuple[float, float]:
    """Radius a = (3 F R / (4 E*))^(1/3) and peak pressure 3 F / (2 pi a^2) of a point contact."""
    a = np.cbrt(3 * force * radius / (4 * E_STAR))
    return float(a), float(1.5 * force / (np.pi * a * a))


def press(
    page: Page,
    problem: Problem,
    variant: Variant,
    divisions: int,
    points: int | str,
    stiffness: float,
    frames: int = 0,
    *,
    over_cells: bool = False,
) -> tuple[Model, Contact, Result]:
    """Drive the tool into the block.

    Parameters
    ----------
    page : Page
        Gets the balance.
    problem : Problem
        What is pressed.
    variant : Variant
        Element.
    divisions : int
        Intervals between nodes over the half-width, about.
    points : int or "nodes"
        Contact rule.
    stiffness : float
        Penalty times half-width over E*.
    frames : int
        States kept.
    over_cells : bool
        Whether there are so many cells in place of points.
    """
    element, line = variant.element, problem.kind == "line"
    body = block(1.0 / variant.cells(divisions), problem.end, problem.growth, element.cell, plane=line)
    model = Model(body, element, material=SVK(E=E, nu=NU))
    model.symmetry("x0", "x")
    model.symmetry(np.arange(len(body.points)) if line else "y0", "y")
    model.fix("lower", "z")
    centre, radius = (0.0, 0.0, problem.radius), problem.radius
    tool = Cylinder(centre, "y", radius) if line else Sphere(centre, radius)
    where: dict[str, Any] = {"cells" if over_cells else "points": points}
    contact = model.contact("upper", tool, penalty=stiffness * E_STAR, name="tool", **where)
    drive = model.drive(contact, "-z")
    rule = f"{points} x {points} cells" if over_cells else rule_name(points)
    label = f"{variant.label}, {divisions} intervals, {rule}, penalty {stiffness:g} E*/a"
    step = Move(drive, lambda fraction: problem.depth * fraction**2, steps=problem.steps)
    return model, contact, page.solve(label, model, step, options=_OPTIONS, frames=frames)


def measure(problem: Problem, at: ContactPoints, nodal: Floats) -> Measures:
    """Compare with Hertz.

    Parameters
    ----------
    problem : Problem
        What was pressed.
    at : ContactPoints
        The contact points.
    nodal : ndarray, shape (n,)
        Pressures at the nodes.
    """
    share = at.pressure * at.area
    if problem.kind == "line":
        distance, whole, moment = np.abs(at.x[:, 0]), 2.0, 0.25
        force = whole * float(-share @ at.normal[:, 2])
        size, peak = hertz_line(force, problem.radius)
    else:
        distance, whole, moment = np.linalg.norm(at.x[:, :2], axis=1), 4.0, 0.4
        force = whole * float(-share @ at.normal[:, 2])
        size, peak = hertz_point(force, problem.radius)
    second = whole * float(share @ distance**2) / force  # a^2 / 4 in a line contact, 2 a^2 / 5 in a point contact
    return Measures(
        force=force,
        size=size,
        peak=peak,
        peak_points=float(at.pressure.max()) / peak,
        peak_nodes=float(nodal.max()) / peak,
        spread=float(np.sqrt(second / moment)) / size,
        edge=float(distance[at.pressure > 0.0].max()) / size,
    )


def pressed_to(
    page: Page,
    problem: Problem,
    variant: Variant,
    divisions: int,
    points: int | str,
    stiffness: float = 100.0,
    *,
    over_cells: bool = False,
) -> Measures:
    """Drive the tool into the block and compare with Hertz at the end."""
    model, contact, _ = press(page, problem, variant, divisions, points, stiffness, over_cells=over_cells)
    return measure(problem, contact.at_points(), contact.at_nodes(model.u, model.mesh)[0])
