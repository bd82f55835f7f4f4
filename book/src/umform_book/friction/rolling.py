"""Rolling: friction draws a strip through two rolls; force, torque, forward slip and the friction hill."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform import mesh
from umform.analysis.steps import Move
from umform.materials import J2, Linear
from umform.model import Model
from umform.surfaces import Cylinder
from umform_book.case import Case
from umform_book.contact.figures import Curve, plot
from umform_book.page import Page

Floats = NDArray[np.float64]

#: Half of the thickness before and after, radius of the rolls, half of the length of the strip, way of the roll.
BEFORE, AFTER, RADIUS, LENGTH, WAY = 1.0, 0.8, 50.0, 24.0, 10.0
E, NU, YIELD, MODULUS, MU = 70e3, 0.3, 100.0, 50.0, 0.1
PENALTY, SLIP = 1e5, 2e-4
#: Expected relative errors of force and torque of the slab method at a contact of 2.5 thicknesses: it neglects shear
#: within the strip.
FORCE, TORQUE = 0.1, 0.05


@dataclass(frozen=True)
class Slab:
    """Karman's strip: plane sections stay plane, friction slips towards the neutral point.

    Attributes
    ----------
    force, torque : float
        Of one roll, per width.
    forward : float
        Speed at the exit over that of the roll, less one.
    x, pressure : ndarray
        Distance from the exit, and pressure, without the elastic arcs.
    """

    force: float
    torque: float
    forward: float
    x: Floats
    pressure: Floats


def slab(points: int = 4000) -> Slab:
    """Equilibrium of the slab d(h s)/dx = -2 p (tan(theta) + mu), from both ends; elastic arcs after Bland and Ford."""
    draft = 2.0 * (BEFORE - AFTER)
    x = np.linspace(0.0, np.sqrt(RADIUS * draft - 0.25 * draft**2), points + 1)
    h = 2.0 * (AFTER + RADIUS - np.sqrt(RADIUS**2 - x**2))
    slope = x / np.sqrt(RADIUS**2 - x**2)
    plane = 2.0 / np.sqrt(3.0)
    k = plane * (YIELD + MODULUS * plane * np.log(2.0 * BEFORE / h))
    # the strip springs back behind the rolls by its own elasticity and by that of the penalty; friction there slips
    # against its way, and pushes it back into the gap
    recoil = k[0] * ((1.0 - NU**2) * AFTER / E + 1.0 / PENALTY)
    arc = 2.0 / 3.0 * np.sqrt(2.0 * RADIUS * recoil) * k[0]
    at_exit, at_entry = _from_end(x, h, slope, k, 1, -2.0 * MU * arc), _from_end(x, h, slope, k, -1, 0.0)
    ahead = at_exit < at_entry
    p = np.minimum(at_exit, at_entry)
    neutral = int(np.argmin(ahead))
    force = float(np.trapezoid(p, x)) + arc
    torque = RADIUS * MU * (float(np.trapezoid(np.where(ahead, -p, p), x)) - arc)
    forward = float(h[neutral] / (2.0 * AFTER * np.hypot(1.0, slope[neutral]))) - 1.0
    return Slab(force, torque, forward, x, p)


def _from_end(x: Floats, h: Floats, slope: Floats, k: Floats, side: int, force: float) -> Floats:
    """Pressure where the strip slips ahead of the roll (1, from the exit) or behind it (-1, from the entry)."""
    p = np.zeros_like(x)
    order = range(len(x))[::side]
    step = side * (x[1] - x[0])
    for i in order:
        p[i] = k[i] - force / h[i]
        force -= step * 2.0 * p[i] * (slope[i] + side * MU)
    return p


@dataclass(frozen=True)
class Rolled:
    """A strip in steady rolling.

    Attributes
    ----------
    force, torque : float
        Means over the last fifth of the way.
    pull : float
        Largest force along the strip there, over the force.
    forward : float
        Way of the front end over that of the roll there, less one.
    way, forces, torques : ndarray
        Over the way of the roll.
    x, pressure : ndarray
        Of the contact points at the end: distance along the strip from the axis of the roll.
    """

    force: float
    torque: float
    pull: float
    forward: float
    way: Floats
    forces: Floats
    torques: Floats
    x: Floats
    pressure: Floats


def roll(page: Page, cells: int, way: float) -> Rolled:
    """Bite the strip, and roll."""
    at = np.linspace(-6.0, LENGTH - 6.0, cells + 1)
    body = mesh.grid(at, [0.0, 1.0], np.linspace(0.0, BEFORE, 3))
    steel = J2(E=E, nu=NU, hardening=Linear(YIELD, MODULUS))
    model = Model(body, "ANS3DEAS", material=steel, thickness_order=1, thickness_points=3)
    model.fix(np.arange(len(body.points)), "y")
    model.fix("lower", "z")
    tail = model.fix("x1", "x")
    axis = (0.0, 0.0, BEFORE + RADIUS)
    tool = model.tool("roll", Cylinder(axis, "y", RADIUS))
    contact = model.contact("upper", tool, penalty=PENALTY, points=2, friction=MU, slip=SLIP, name="bite")
    down, spin = model.drive(tool, "-z", "down"), model.turn(tool, "y", about=axis, name="spin")
    label = f"{cells} elements"
    page.solve(f"{label}: bite", model, Move(down, BEFORE - AFTER, steps=20))
    page.solve(f"{label}: tail let go", model, Move(model.remove(tail), 0.0, steps=3))
    increments = round(1.9 * cells * way / WAY)
    front = model.mesh.nodes("x0")
    last = 0.8 * way
    page.solve(f"{label}: begin", model, Move(spin, last / RADIUS, steps=round(0.8 * increments)))
    start = float(model.u.reshape(-1, 3)[front, 0].mean())
    begun = page.solve(f"{label}: steady", model, Move(spin, way / RADIUS, steps=increments - round(0.8 * increments)))
    moved = start - float(model.u.reshape(-1, 3)[front, 0].mean())
    forces, torques = begun["roll_fz"], -begun["roll_my"]
    held = contact.found.held
    return Rolled(
        float(forces.mean()),
        float(torques.mean()),
        float(np.abs(begun["roll_fx"]).max() / forces.mean()),
        moved / (way - last) - 1.0,
        begun["spin"] * RADIUS,
        forces,
        torques,
        np.asarray(held.x)[:, 0],
        np.asarray(held.pressure),
    )


def run(page: Page) -> None:
    """Fill the page."""
    exact, rows = slab(), []
    curves = []
    for cells in page.each(page.pick((108, 144, 180), (108,)), lambda n: f"{n} elements"):
        found = roll(page, cells, page.pick((WAY,), (4.0,))[0])
        rows.append((f"{cells} elements", found.force, found.torque, 100.0 * found.forward, found.pull))
        curves.append(Curve(f"{cells} elements", found.x, found.pressure, "."))
    rows.append(("slab", exact.force, exact.torque, 100.0 * exact.forward, 0.0))
    columns = ("", "force, N/mm", "torque, N mm/mm", "forward slip, %", "pull over force")
    page.table("One roll, per width, steady", columns, rows)
    curves.append(Curve("slab", exact.x, exact.pressure, "k-"))
    axes = ("distance from the plane of the axes, mm", "pressure, MPa")
    page.figure("hill", plot(curves, *axes), "Friction hill: pressure under the roll; the strip goes to the left")
    label = rows[-2][0]
    page.check(f"{label}: force", found.force, exact.force, FORCE)
    page.check(f"{label}: torque", found.torque, exact.torque, TORQUE)
    page.at_most(f"{label}: force along the strip over the force of the roll", found.pull, 1e-6)


CASE = Case(
    name="friction-rolling",
    title="Rolling of a strip between two rolls",
    problem=f"""
A strip of {2 * BEFORE:g} mm is rolled to {2 * AFTER:g} mm between rolls of R = {RADIUS:g} mm in plane strain; upper
half, E = {E:g}, nu = {NU:g}, yield stress {YIELD:g}, hardening modulus {MODULUS:g} MPa, mu = {MU:g}. The roll is
pressed into the strip, whose tail is held and then released, and rolls over a path of {WAY:g} mm: only friction moves
the strip. ANS3DEAS in two layers, 108, 144 and 180 elements over {LENGTH:g} mm, 2 x 2 contact points, penalty
{PENALTY:g}. The contact is 4.5 mm long; measured over the last fifth.
""",
    reference="""
Von Kármán's slab (1925): equilibrium of plane sections with the yield stress of plane strain and friction towards the
neutral point, integrated numerically from both ends; behind the rolls the elastic arc of Bland and Ford (1948), with
the penetration of the penalty. It neglects shear within the strip, which raises the force by 5 to 10 % at a contact of
2.5 thicknesses, the torque by less. The forward slip depends on the neutral point, where two branches cross at a small
angle: for comparison only. Without tension the force along the strip is zero.
""",
    run=run,
    cost=60.0,
)
