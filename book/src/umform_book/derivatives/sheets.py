"""Small models of sheets that touch each other, and of one that touches itself."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform_book.derivatives.differences import Example

Floats = NDArray[np.float64]
Built = tuple[uf.Model, list[Any]]


def _metal(E: float, Y: float) -> uf.J2:
    return uf.J2(E=E, nu=0.3, hardening=uf.Linear(Y, 500.0))


def stacked(E: float, Y: float, t: float, stroke: float, mu: float = 0.0, **rule: Any) -> Built:
    """Two strips of other meshes, pressed on each other and clamped at one end, bent together by the other end."""
    lower = uf.mesh.strip(20.0, 2.0, 1.0, (10, 1))
    upper = uf.mesh.strip(20.0, 2.0, t, (13, 1)).moved((0.0, 0.0, 0.5 + 0.5 * t))
    model = uf.Model(uf.mesh.together(a=lower, b=upper), material=_metal(E, Y))
    model.sheet_contact("upper of a", "lower of b", name="stack", friction=mu, **rule)
    for sheet in "ab":
        model.fix(f"x0 of {sheet}")
        model.symmetry(f"y0 of {sheet}", "y")
    pressures = [model.pressure("lower of a", "below"), model.pressure("upper of b", "above")]
    end = model.prescribe("x1 of b", "z", "end")
    return model, [uf.Move(pressures, [2.0, 2.0], steps=1), uf.Move(end, stroke, steps=8)]


def folded(E: float, Y: float, R: float, stroke: float, mu: float = 0.0, **rule: Any) -> Built:
    """A strip with half a turn of inside radius R, whose shorter flank is pushed onto the other one, and along it."""
    flank, cells = 5.0, 20

    def turned(X: Floats) -> Floats:
        s, y, z = X.T[0] * (2.0 * flank - 2.0 + np.pi * (R + 0.5)), X.T[1], X.T[2]
        angle = np.clip((s - flank) / (R + 0.5), 0.0, np.pi)
        beyond = np.maximum(s - flank - np.pi * (R + 0.5), 0.0)
        x = np.minimum(s, flank) - beyond + (R + 0.5 - z) * np.sin(angle)
        return np.column_stack([x, y, (R + 0.5) - (R + 0.5 - z) * np.cos(angle)])

    model = uf.Model(uf.mesh.strip(1.0, 2.0, 1.0, (cells, 1)).transformed(turned), material=_metal(E, Y))
    model.self_contact("upper", name="inside", friction=mu, **rule)
    model.fix("x0")
    model.symmetry("y0", "y")
    end, along = model.prescribe("x1", "z", "end"), model.prescribe("x1", "x", "along")
    return model, [uf.Move(end, stroke, steps=8), uf.Move(along, 0.1, steps=4)]


BENT = {"E": 200e3, "Y": 200.0, "t": 0.8, "stroke": -1.5, "mu": 0.15}
CLOSED = {"E": 200e3, "Y": 200.0, "R": 0.4, "stroke": -1.2, "mu": 0.1}
_OF_TWO = ("end_force", "stack_fz", "plastic_work")
_OF_ONE = ("end_force", "along_force", "plastic_work")

SHEETS: dict[str, Example] = {
    "two sheets, cells; friction": Example(
        # A point begins to slide within a larger change.
        partial(stacked, cells=3),
        BENT,
        (*_OF_TWO, "stack_friction_work"),
        replays=True,
        size=1e-5,
    ),
    "two sheets, points; friction": Example(
        partial(stacked, points=2), BENT, (*_OF_TWO, "stack_friction_work"), replays=True
    ),
    "two sheets, a penalty that grows in most increments; friction": Example(
        partial(stacked, penetration=5e-4),
        BENT,
        (*_OF_TWO, "stack_friction_work"),
        replays=True,
        size=1e-5,
    ),
    "two sheets; multipliers, friction": Example(
        partial(stacked, cells=3, penalty=1e3, penetration=1e-3, augmented=True),
        BENT,
        (*_OF_TWO, "stack_friction_work"),
    ),
    "a sheet on itself, cells; friction": Example(
        partial(folded, cells=3, penalty=1e3, penetration=0.02),
        CLOSED,
        (*_OF_ONE, "inside_friction_work"),
        limit=6e-4,  # R and stroke change by a thousandth of the penetration
    ),
    "a sheet on itself, points, penalty that grows": Example(
        partial(folded, R=CLOSED["R"], stroke=CLOSED["stroke"], points=2),
        {name: CLOSED[name] for name in ("E", "Y")},
        _OF_ONE,
        replays=True,
    ),
}
