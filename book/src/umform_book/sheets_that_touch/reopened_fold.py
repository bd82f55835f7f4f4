"""A fold that closes on itself and is opened again, with the order of its faces exchanged."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.analysis.steps import Move
from umform_book.case import Case
from umform_book.page import Page
from umform_book.sheets_that_touch.closed_fold import fold

Floats = NDArray[np.float64]

ELEMENTS, WAY, INCREMENTS = 40, -2.4, 24


def reopened(page: Page, order: str, **rule: Any) -> tuple[Floats, Floats, float]:
    """Displacements closed and opened again, and the largest force between the flanges."""
    mesh = fold(ELEMENTS, 1)
    steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(560.0, 0.005, 0.22))
    model = uf.Model(mesh, "ANS3DEAS", material=steel, plane_strain=True)
    model.fix("x0")
    model.fix(np.arange(len(mesh.points)), "y")
    end = model.prescribe("x1", "z", "end")
    faces = mesh.face_set("upper")
    halves = faces[: ELEMENTS // 2], faces[ELEMENTS // 2 :]
    if order == "itself":
        model.self_contact("upper", name="inside", **rule)
    else:
        model.sheet_contact(*(halves if order == "lower first" else halves[::-1]), name="inside", **rule)
    steps = [Move(end, WAY, steps=INCREMENTS), Move(end, 0.0, steps=INCREMENTS)]
    result = page.solve(f"{order}, {rule}", model, steps, frames=2 * INCREMENTS)
    closed = next(frame for frame in result.frames if frame.number == INCREMENTS)
    held = result["inside_active"]
    if not held[INCREMENTS] > 0 == held[-1]:
        raise AssertionError("the fold has not closed, or not opened again")
    return closed.points["displacement"].ravel(), model.u.copy(), float(result["inside_penetration"].max())


def run(page: Page) -> None:
    """The two faces in both orders, and one face against itself."""
    rows: list[tuple[str | float, ...]] = []
    rules: list[dict[str, Any]] = [{"points": 2}, {"cells": 3}, {"points": 2, "friction": 0.1}]
    for rule in page.pick(rules, rules[:1]):
        label = ", ".join(f"{value} {name}" for name, value in rule.items())
        one, other, alone = (reopened(page, order, **rule) for order in ("lower first", "upper first", "itself"))
        differences = []
        for state, name in enumerate(("closed", "opened again")):
            for second, what in ((other, "order exchanged"), (alone, "one face against itself")):
                change = float(np.abs(second[state] - one[state]).max() / np.abs(one[state]).max())
                page.at_most(f"{label}, {name}, {what}: change of the displacements", change, 1e-10)
                differences.append(change)
        rows.append((label, *differences, one[2]))
    columns = ("rule", "closed: exchanged", "itself", "opened: exchanged", "itself", "penetration")
    page.table("Change of the displacements, over the largest one", columns, rows)


CASE = Case(
    name="touch-reopened-fold",
    title="A fold that closes and is opened again",
    problem="The fold of touch-closed-fold, in plane strain: the end of its shorter flange goes down by 2.4 until the "
    "flanges lie on each other, and back. Steel, hardening of Swift. The two halves of the inner face touch each "
    "other, in both orders; and the face touches itself.",
    reference="The answer is the same whichever face comes first, and the same as of the face against itself: to "
    "1e-10 of the displacements, after two strokes of plastic flow.",
    run=run,
    cost=20.0,
)
