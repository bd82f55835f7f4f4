"""Strips bent sharply: on supports without contact, over the cylinder of the paper, over a small cylinder.

All are halves, symmetric about x = 0, 1 thick, of the steel of this chapter; forces are for a width of 10.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.errors import UmformError
from umform.model import Model
from umform.surfaces import Cylinder
from umform_book.page import Page
from umform_book.sharp_bends.candidates import Candidate

Floats = NDArray[np.float64]

THICKNESS, WIDTH = 1.0, 10.0
#: Elastic slip that is allowed, where there is friction.
SLIP = 0.005


@dataclass(frozen=True)
class Strip:
    """A problem.

    Attributes
    ----------
    kind : {"supports", "cylinder", "fold"}
        Three-point bending: the punch pushes the lower edge at x = 0 down, the lower edge of the other end rests. The
        paper's strip: it lies on a cylinder at x = 25. A strip that lies on a cylinder at x = 0, its end pushed down.
    length : float
        Half length.
    stroke : float
        Displacement of the punch or of the end.
    hardening : float
        Hardening modulus.
    radius : float
        Of the cylinder.
    steps : int
        Increments.
    friction : float
        Coefficient on the cylinder.
    """

    kind: str
    length: float
    stroke: float
    hardening: float
    radius: float = 20.0
    steps: int = 50
    friction: float = 0.0

    @property
    def driven(self) -> str:
        """The line that is pushed down."""
        return "x1_lower" if self.kind == "fold" else "x0_lower"


@dataclass(frozen=True)
class Distortion:
    """A mesh of a strip in plane strain that is not regular.

    Attributes
    ----------
    name : str
        What is added to the name of the run.
    move : callable
        Nodes (n, 3) of the regular mesh to those of the distorted one.
    over_width : int
        Elements over the width of 1.
    """

    name: str
    move: Callable[[Floats], Floats]
    over_width: int = 1


@dataclass(frozen=True)
class Bend:
    """Results of a strip.

    Attributes
    ----------
    u, force : ndarray
        Displacement and force; as far as it was reached.
    radius : float
        Least radius of the mid-surface over the thickness, of one element, at the end.
    iterations : int
        Of Newton's method, all increments.
    result : Result
        The run.
    """

    u: Floats
    force: Floats
    radius: float
    iterations: int
    result: Result

    def at(self, u: float) -> float:
        """Force at a displacement; NaN if it was not reached."""
        return float(np.interp(u, self.u, self.force)) if u <= self.u[-1] * (1 + 1e-9) else float("nan")


def bend(
    page: Page,
    strip: Strip,
    candidate: Candidate,
    cells: int,
    across: int = 0,
    frames: int = 0,
    distortion: Distortion | None = None,
) -> Bend:
    """Bend a strip of elements.

    Parameters
    ----------
    page : Page
        Keeps the balance.
    strip, candidate : Strip, Candidate
        Problem and element.
    cells, across : int
        Elements along the strip, and over its width of 10; with none it is 1 wide, in plane strain.
    frames : int
        Frames to keep.
    distortion : Distortion, optional
        Of the mesh in plane strain.
    """
    model = _model(strip, candidate, cells, across, distortion)
    control = model.prescribe(strip.driven, "z", "punch")
    label = f"{candidate.label}, {cells} elements, H = {strip.hardening:g}"
    label += f", {across} across" if across else ""
    label += f", R = {strip.radius:g}" if strip.kind == "fold" else ""
    label += f", {distortion.name}" if distortion else ""
    label += f", mu = {strip.friction:g}" if strip.friction else ""
    try:
        result = page.solve(label, model, [Move(control, to=-strip.stroke, steps=strip.steps)], frames=frames)
    except UmformError as error:  # the page shows how far it came
        result = error.result  # type: ignore[attr-defined]
    force = -result["punch_force"] * (1.0 if across else WIDTH)
    return Bend(-result["punch"], force, least_radius(model), int(result["iterations"].sum()), result)


def _model(strip: Strip, candidate: Candidate, cells: int, across: int, distortion: Distortion | None) -> Model:
    x = np.linspace(0.0, strip.length, cells + 1)
    y = np.linspace(0.0, WIDTH if across else 1.0, (across or (distortion.over_width if distortion else 1)) + 1)
    model = candidate.strip(x, y, THICKNESS, strip.hardening, distortion.move if distortion else None)
    model.symmetry("x0", "x")
    everywhere = np.arange(len(model.mesh.points))
    edge = np.intersect1d(model.mesh.nodes("x0_lower"), model.mesh.nodes("y0"))
    model.fix(edge if across else everywhere, "y")
    if strip.kind == "supports":
        model.fix("x1_lower", "z")
        return model
    fold = strip.kind == "fold"
    tool = Cylinder((0.0 if fold else 25.0, 0.0, -0.5 * THICKNESS - strip.radius), "y", strip.radius)
    points = 5 if fold else (2 if model.mesh.cell == "hex8" else 3)
    penalty, mu = 5000.0 if fold else 100.0, strip.friction or None
    model.contact("lower", tool, penalty=penalty, points=points, name="tool", friction=mu, slip=SLIP if mu else None)
    return model


def least_radius(model: Model) -> float:
    """Least radius over the thickness, from the turn between the directors of neighbouring stations."""
    X, x = model.mesh.points, model.positions
    lower, upper = (np.intersect1d(model.mesh.nodes(face), model.mesh.nodes("y0")) for face in ("lower", "upper"))
    lower, upper = (nodes[np.argsort(X[nodes, 0])] for nodes in (lower, upper))
    angles = []
    for points in (X, x):
        director = points[upper] - points[lower]
        angles.append(np.arctan2(director[:, 0], director[:, 2]))
    along = 0.5 * (X[lower, 0] + X[upper, 0])
    curvature = np.abs(np.diff(angles[1] - angles[0])) / np.diff(along)
    return float(1.0 / (curvature.max() * THICKNESS))
