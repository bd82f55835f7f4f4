"""Runs of the paper's example: meshes, one run through the page, length of the contact, and what is smooth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.processes import Bending, FreeBending, free_bending
from umform.processes.bending.spec import ContactRule
from umform_book.balance import balance_row
from umform_book.contact.figures import rule_name
from umform_book.page import Page

Floats = NDArray[np.float64]

#: Lever arm between the tool and the section that yields: x = 25 mm less what the contact has wandered.
LEVER = 20.0


@dataclass(frozen=True)
class Discretisation:
    """A mesh of the paper with its element.

    Attributes
    ----------
    element : str
        Name in the catalogue.
    mesh : tuple of int
        Elements along and across the strip.
    least : int
        Contact points per direction that a face needs at least.
    """

    element: str
    mesh: tuple[int, int]
    least: int

    @property
    def label(self) -> str:
        """Name in tables."""
        return f"{self.element} {self.mesh[0]}x{self.mesh[1]}"

    @property
    def size(self) -> float:
        """Length of an element."""
        return FreeBending().length / self.mesh[0]

    def spacing(self, points: ContactRule) -> float:
        """Mean distance of neighbouring contact points along the strip."""
        if points == "nodes":
            return self.size / (1 if self.least == 2 else 2)
        return self.size / int(points)

    def across(self, points: ContactRule) -> int:
        """Contact points in a line across the strip."""
        if points == "nodes":
            return self.mesh[1] * (1 if self.least == 2 else 2) + 1
        return self.mesh[1] * int(points)


MESHES = (
    Discretisation("ANS3DEAS", (24, 1), 2),
    Discretisation("MI9K3DEAS", (12, 1), 3),
    Discretisation("ANS3DEAS", (48, 2), 2),
    Discretisation("MI9K3DEAS", (24, 2), 3),
)
#: What sharp bends need.
RECOMMENDED = {"thickness_order": 3, "tie_E33": True, "thickness_points": 8}


def bend(page: Page, case: FreeBending) -> Bending:
    """Run a case and enter its balance."""
    bending = free_bending(case, progress=False)
    assert bending.result is not None
    label = f"{case.name}, penalty {case.penalty:g}, {case.steps} increments"
    page.balances.append(balance_row(page.case.name, label, bending.result))
    return bending


@dataclass(frozen=True)
class Smoothness:
    """How smooth a curve is.

    Attributes
    ----------
    mesh, points, penalty : Discretisation, int or "nodes", float
        What was run.
    jump, roughness : float
        J, and the root mean square deviation from a smooth fit.
    lines : float
        Lines of contact points that carry force, on the average beyond u = 2.
    u, F : ndarray
        The curve of loading.
    """

    mesh: Discretisation
    points: ContactRule
    penalty: float
    jump: float
    roughness: float
    lines: float
    u: Floats
    F: Floats

    @property
    def spacing(self) -> float:
        """Distance of the contact points."""
        return self.mesh.spacing(self.points)

    @property
    def rule(self) -> str:
        """Name of the contact rule."""
        return rule_name(self.points)


def smoothness(page: Page, mesh: Discretisation, points: ContactRule, penalty: float, steps: int = 150) -> Smoothness:
    """Bend, without release, and measure jumps, roughness and contact."""
    case = FreeBending(mesh=mesh.mesh, element=mesh.element, contact=points, penalty=penalty, steps=steps, unload=False)
    bending = bend(page, case)
    assert bending.result is not None and bending.jump is not None and bending.roughness is not None
    beyond = bending.u > case.marks[0]
    active = float(bending.result["cylinder_active"][beyond].mean())
    return Smoothness(
        mesh, points, penalty, bending.jump, bending.roughness, active / mesh.across(points), *bending.loading
    )


def contact_length(penalty: float, line_force: float) -> float:
    """Length of the contact under a line force, the strip straight beside the tool. eq. (4.15)"""
    return float(2 * (1.5 * FreeBending().radius * line_force / penalty) ** (1 / 3))
