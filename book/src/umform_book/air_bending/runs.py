"""Runs of the press brake: loading with its curve and its section, whole bends, the moment along the sheet."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.model.contact import ContactPoints
from umform.processes.air_bending import AirBend, AirBending, air_bending
from umform.processes.air_bending.loading import OPTIONS, against_flank, force_per_width
from umform.processes.air_bending.problem import build
from umform.processes.air_bending.section import Section
from umform_book.balance import balance_row
from umform_book.page import Page

Floats = NDArray[np.float64]

#: Increment of the studies, over the opening: twice the default, which moves an angle by less than 0.1 degrees.
INCREMENT = 0.0125


@dataclass(frozen=True)
class Loading:
    """A sheet that has been bent and not unloaded.

    Attributes
    ----------
    case : AirBending
        The parameters.
    stroke, force : ndarray, shape (n,)
        Way of the punch in mm and its force in N for each mm of the bend.
    section : Section
        The section at the end.
    contacts : mapping of str to ContactPoints
        Contact points of die and punch at the end.
    against : str
        Tool against whose flank the sheet lies at the end: "die", "punch" or none.
    result : Result
        The run.
    """

    case: AirBending
    stroke: Floats
    force: Floats
    section: Section
    contacts: Mapping[str, ContactPoints]
    against: str
    result: Result


def load(page: Page, label: str, case: AirBending, stroke: float, way: float | None = None, frames: int = 1) -> Loading:
    """Bend to a stroke, which may go beyond air bending, and enter the balance.

    Parameters
    ----------
    page : Page
        The page of the case.
    label : str
        Name of the run.
    case : AirBending
        The parameters; the stroke is not used.
    stroke : float
        Way of the punch.
    way : float, optional
        That in one increment; default: the increment of the case.
    frames : int
        About how many states are kept.
    """
    model, punch = build(case)
    steps = math.ceil(stroke / (way or case.way) - 1e-9)
    result = page.solve(label, model, Move(punch, to=stroke, steps=steps), options=OPTIONS, frames=frames)
    contacts = result.frames[-1].contacts
    force = force_per_width(case, result["stroke_force"])
    section = Section.of(model.mesh, model.u)
    return Loading(case, result["stroke"], force, section, contacts, against_flank(case, contacts), result)


def bend(page: Page, label: str, case: AirBending, frames: int = 1) -> AirBend:
    """Bend and unload as `umform bend` does, and enter the balance."""
    found = air_bending(case, frames=frames, progress=False)
    page.balances.append(balance_row(page.case.name, label, found.result))
    return found


def curvatures(section: Section) -> tuple[Floats, Floats]:
    """Middle of each element along the flat sheet, and its turn for each mm of the flat sheet.

    The turn is that of the lines from the lower to the upper face.
    """
    across = section.current[:: section.order, -1] - section.current[:: section.order, 0]
    turn = np.arctan2(-across[:, 0], across[:, 1])
    X = section.reference[:: section.order, 0, 0]
    return 0.5 * (X[1:] + X[:-1]), np.diff(turn) / np.diff(X)


def moments(loading: Loading) -> Floats:
    """Moment per mm of width in the middle of each element: that of the contact forces beyond it.

    Shape (elements,). Contact forces on the element itself are shared: the mean over its ends and its middle by
    Simpson's rule.
    """
    width = loading.case.thickness if loading.case.width is None else 0.5 * loading.case.width
    x = np.concatenate([points.x[:, [0, 2]] for points in loading.contacts.values()])
    f = np.concatenate([_forces(points) for points in loading.contacts.values()])
    line = loading.section.fibre(0.5)
    if loading.section.order == 1:
        line = np.stack([line[:-1], 0.5 * (line[:-1] + line[1:])], axis=1).reshape(-1, 2)
        line = np.vstack([line, loading.section.fibre(0.5)[-1:]])
    arm = x[None] - line[:, None]
    beyond = arm[:, :, 0] > 0.0
    at = np.where(beyond, arm[:, :, 0] * f[:, 1] - arm[:, :, 1] * f[:, 0], 0.0).sum(axis=1) / width
    mean: Floats = (at[:-1:2] + 4.0 * at[1::2] + at[2::2]) / 6.0
    return mean


def _forces(points: ContactPoints) -> Floats:
    """Forces (n, 2) of a tool on the sheet at its contact points."""
    return np.asarray((points.pressure * points.area)[:, None] * points.normal[:, [0, 2]])


def outer_strain(section: Section, gauge: float) -> float:
    """Mean logarithmic strain of the outer face over a gauge length from the middle, measured on the flat sheet."""
    X = section.reference[:: section.order, 0, 0]
    grown = np.concatenate([[0.0], np.cumsum(section.element_lengths(0.0))])
    return float(np.log(np.interp(gauge, X, grown) / gauge))
