"""Two strips that are bent together: without friction, with friction that holds them, and with less."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import umform as uf
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.contact.hertz_line import EIGHT
from umform_book.page import Page

E, LENGTH, WIDTH, THICKNESS = 210e3, 40.0, 2.0, 1.0
#: Pressure on both outer faces, deflection of the end, elastic slip that is allowed.
PRESSURE, DEFLECTION, SLIP = 0.05, 0.002, 2e-4
FIRST = 20


def beam(thickness: float) -> float:
    """Stiffness of a cantilever with shear, per strip."""
    bending = LENGTH**3 / (3.0 * E * WIDTH * thickness**3 / 12.0)
    shear = LENGTH / (5.0 / 6.0 * 0.5 * E * WIDTH * thickness)
    return 1.0 / (bending + shear)


#: Force at the deflection if the strips are one, and if they slide freely.
WHOLE, APART = beam(2.0 * THICKNESS) * DEFLECTION, 2.0 * beam(THICKNESS) * DEFLECTION


@dataclass(frozen=True)
class Bent:
    """Result of a run, and the force at the end."""

    result: Result
    force: float


def bend(page: Page, second: int, friction: float, **rule: float) -> Bent:
    """Press the strips together, then bend them by the end of the upper one."""
    lower = uf.mesh.strip(LENGTH, WIDTH, THICKNESS, (FIRST, 1))
    upper = uf.mesh.strip(LENGTH, WIDTH, THICKNESS, (second, 1))
    mesh = uf.mesh.together(a=lower, b=upper.moved((0.0, 0.0, THICKNESS)))
    model = uf.Model(mesh, EIGHT.element, material=uf.SVK(E=E, nu=0.0))
    options = {"friction": friction, "slip": SLIP} if friction else {}
    model.sheet_contact("upper of a", "lower of b", name="strips", **rule, **options)
    model.fix("x0 of a")
    model.fix("x0 of b")
    pressures = [model.pressure("lower of a", "below"), model.pressure("upper of b", "above")]
    end = model.prescribe("x1 of b", "z", "end")
    name = f"{FIRST} on {second} elements, friction {friction:g}, {rule}"
    steps = [Move(pressures, [PRESSURE] * 2, steps=1), Move(end, -DEFLECTION, steps=8)]
    result = page.solve(name, model, steps)
    return Bent(result, -float(result["end_force"][-1]))


def run(page: Page) -> None:
    """Free, held and sliding strips."""
    rows: list[tuple[str, str, float, float, float | None]] = []
    for second in (FIRST, 33):
        for rule in ({"points": 2}, {"cells": 3}):
            what, count = next(iter(rule.items()))
            free, held = bend(page, second, 0.0, **rule).force, bend(page, second, 1.0, **rule).force
            rows.append((f"{FIRST} on {second}", f"{count} {what}", free / WHOLE, free / APART, held / WHOLE))
            page.check(f"{FIRST} on {second} elements, {count} {what}, free: force", free, APART, 0.01)
            page.check(f"{FIRST} on {second} elements, {count} {what}, held: force", held, WHOLE, 0.01)
    stiff = bend(page, 33, 0.0, points=2, penalty=E / THICKNESS).force
    rows.append((f"{FIRST} on 33", "2 points, 100 times the penalty", stiff / WHOLE, stiff / APART, None))
    page.table("Force at the end", ("elements", "rule", "free over whole", "free over apart", "held over whole"), rows)
    free = bend(page, 33, 0.0, points=2).force
    coefficients, forces = (0.01, 0.02, 0.05, 0.1), []
    for mu in coefficients:
        bent = bend(page, 33, mu, points=2)
        forces.append(bent.force)
        page.check(f"friction {mu:g}: force above that of free strips", bent.force - free, sliding(mu), 0.01)
        page.at_most(f"friction {mu:g}: work and energies, relative", abs(float(bent.result.balance().drift[-1])), 1e-5)
    theory = [APART + sliding(mu) for mu in coefficients]
    curves = [
        Curve("computed", np.array(coefficients), [f / WHOLE for f in forces], "o"),
        Curve("closed form", np.array(coefficients), [f / WHOLE for f in theory], "-"),
    ]
    page.figure("friction", plot(curves, "coefficient of friction", "force over that of one strip"), "Sliding strips")


def sliding(mu: float) -> float:
    """Force at the end that friction adds while the strips slide everywhere: a couple mu p w t per length."""
    return mu * PRESSURE * WIDTH * THICKNESS


CASE = Case(
    name="touch-strips",
    title="Two strips bent together",
    problem="Two strips of 40 x 2 x 1, clamped at one end, are pressed together by 0.05 on both outer faces. The "
    "other end of the upper one is moved by 0.002. E = 210000, no lateral contraction.",
    reference="Timoshenko's beam. Two strips without friction have a quarter of the stiffness of one of the double "
    "thickness; enough friction makes them one. Where all of the interface slides, the shear stress mu p "
    "is a couple mu p w t per length, which adds mu p w t to the force at the end. The pressure on the "
    "bent faces adds 0.5 % to the stiffness of free strips; the closed forms leave that out.",
    run=run,
)
