"""Small models of every kind of step, tool, control and load."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform_book.derivatives.differences import Example

Floats = NDArray[np.float64]
Built = tuple[uf.Model, list[Any]]


def metal(yield_stress: float = 160.0) -> uf.J2:
    """Steel of the free bending example with linear hardening."""
    return uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Linear(yield_stress, 500.0))


def rubber(E: float) -> uf.NeoHooke:
    """An elastic law."""
    return uf.NeoHooke(E=E, nu=0.3)


def strip(material: Any, t: float, length: float = 30.0, cells: int = 12) -> uf.Model:
    """A strip of width 2, held at its middle plane y = 0."""
    model = uf.Model(uf.mesh.strip(length, 2.0, t, (cells, 1)), material=material)
    model.symmetry("y0", "y")
    return model


def bent(E: float, Y: float, n: float, t: float, R: float, mu: float, stroke: float, points: float = 0.0) -> Built:
    """A strip that its middle draws over a cylinder with friction: the free bending example, coarser."""
    material = uf.J2(E=E, nu=0.3, hardening=uf.Swift(Y / 0.004**n, 0.004, n))
    model = uf.Model(uf.mesh.strip(60.0, 10.0, t, (12, 1)), material=material)
    model.symmetry("x0", normal="x")
    model.symmetry(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), normal="y")
    punch = model.prescribe("x0_lower", "z", "punch")
    tool = uf.Cylinder((25.0, 0.0, -R - t / 2), "y", R)
    cells: dict[str, Any] = {} if points > 0.0 else {"cells": 2}
    model.contact("lower", tool, penalty=500.0, friction=mu, name="tool", **cells)
    return model, [uf.Move(punch, stroke, steps=12)]


def bent_and_released(**values: float) -> Built:
    """The same, and let go until it lifts off."""
    model, steps = bent(**values, mu=BEND["mu"])
    return model, [*steps, uf.Release(steps[0].control, tolerance=1e-10)]


def paced(Y: float, t: float, R: float, mu: float) -> Built:
    """The same at a pace."""
    model, (step,) = bent(206e3, Y, 0.2, t, R, mu, -4.0)
    return model, [uf.Move(step.control, step.to, uf.Pace(first=0.05, largest=0.2))]


def pulled(Y: float, pull: float) -> Built:
    """A bar pulled, released to zero force, and pulled on."""
    model = uf.Model(uf.mesh.strip(1.0, 0.5, 0.4, (1, 1)), "EAS3DEAS", material=metal(Y))
    for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(face, normal=normal)
    end = model.prescribe("x1", "x", "pull")
    release = uf.Release(end, increment=5e-3, tolerance=1e-10)
    return model, [uf.Move(end, pull, 5), release, uf.Move(end, 1.5 * pull, 3)]


def driven(Y: float, t: float, R: float, stroke: float) -> Built:
    """A clamped strip bent by a cylinder that goes back until it lifts off."""
    model = uf.Model(uf.mesh.strip(30.0, 2.0, t, (12, 1)), material=metal(Y))
    model.fix("x1")
    model.symmetry("x0", "x")
    die = uf.Cylinder((0.0, 0.0, R + t / 2), "y", R)
    ram = model.drive(model.contact("upper", die, penalty=500.0, cells=2, friction=0.1, name="die"), "z", "ram")
    return model, [uf.Move(ram, stroke, 6), uf.Release(ram, tolerance=1e-9)]


def closed(E: float, force: float, gap: float, t: float) -> Built:
    """A plate that closes a gap and presses a block."""
    model = uf.Model(uf.mesh.strip(2.0, 1.0, t, (2, 1)), material=rubber(E))
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    model.contact("lower", uf.Plane((0, 0, -t / 2)), penalty=1e4, name="bed")
    plate = model.contact("upper", uf.Plane((0, 0, t / 2 + gap), (0, 0, -1)), penalty=1e4, name="plate")
    return model, [uf.Close(model.press(plate, "z", "press"), force=force)]


def pressed_and_let_go(Y: float, t: float, gap: float, force: float) -> Built:
    """A tool that closes on a strip, presses it, and is released."""
    model = strip(metal(Y), t, 20.0, 6)
    model.symmetry("x0", "x")
    model.contact("lower", uf.Plane((0, 0, -t / 2)), penalty=1e3, name="bed")
    plate = uf.Plane((0, 0, t / 2 + gap), (0, 0, -1))
    press = model.press(model.contact("upper", plate, penalty=1e3, friction=0.1, name="plate"), "z", "press")
    pull = model.prescribe("x1", "x", "pull")
    return model, [
        uf.Close(press, 0.6 * force),
        uf.Move([press, pull], [force, 0.1], 4),
        uf.Release(press, tolerance=1e-10),
    ]


def clamped(Y: float, t: float, mu: float, force: float, pull: float) -> Built:
    """A strip pressed between a bed and a lid, pulled, and let go to zero force: it slips back, and stays clamped."""
    model = strip(metal(Y), t, 20.0, 6)
    model.symmetry("x0", "x")
    model.contact("lower", uf.Plane((0, 0, -t / 2)), penalty=1e3, cells=2, friction=mu, name="bed")
    lid = uf.Plane((0, 0, t / 2), (0, 0, -1))
    press = model.press(model.contact("upper", lid, penalty=1e3, cells=2, friction=mu, name="lid"), "z", "press")
    end = model.prescribe("x1", "x", "pull")
    return model, [uf.Move(press, force, 2), uf.Move(end, pull, 20), uf.Release(end, tolerance=1e-10)]


def let_go(Y: float, t: float, tip: float) -> Built:
    """A cantilever with a support on the way that is taken away."""
    model = uf.Model(uf.mesh.strip(20.0, 2.0, t, (8, 1)), material=metal(Y))
    model.fix("x0")
    end = model.prescribe("x1_lower", "z", name="tip")
    rest = model.fix(lambda x, y, z: (abs(x - 10.0) < 1e-6) & (z < 0), "z")
    load = model.force("x1_upper", (0, 0, -1.0), "load")
    return model, [uf.Move([end, load], [tip, 1.0], 5), uf.Free(rest, 3), uf.Move(end, 0.5 * tip, 3)]


def opened(Y: float, t: float, R: float, mu: float, stroke: float) -> Built:
    """A strip bent over a die that opens, together with a support."""
    model = strip(metal(Y), t)
    model.symmetry("x0", "x")
    punch = model.prescribe("x0_lower", "z", "punch")
    tool = uf.Cylinder((12.0, 0.0, -R - t / 2), "y", R)
    die = model.contact("lower", tool, penalty=500.0, friction=mu, cells=2, name="die")
    end = model.fix("x1", "x")
    return model, [uf.Move(punch, stroke, 6), uf.Free([die, end], 4)]


def arch(E: float, h: float, t: float) -> Built:
    """Half of a shallow arch that snaps through; the time of the path is that of its length."""
    mesh = uf.mesh.strip(10.0, 1.0, t, (4, 1)).transformed(lambda x: x + [0.0, 0.0, h] * (1 - x[:, :1] / 10.0))
    model = uf.Model(mesh, material=uf.SVK(E=E, nu=0.0))
    model.hinge("x1", "xz")
    model.hinge("x0", "x")
    for side in ("y0", "y1"):
        model.symmetry(side, "y")
    nodes = mesh.nodes("x0")
    load = model.force(nodes, (0.0, 0.0, -1.0 / len(nodes)), "load")
    return model, [uf.Arc(load, 1.0, increment=0.5)]


def in_time(Y: float, reference: float, exponent: float, duration: float) -> Built:
    """A metal with a rate, bent fast and slowly back."""
    rate = uf.CowperSymonds(reference, exponent)
    material = uf.Metal(E=206e3, nu=0.3, hardening=uf.Voce(Y, 300.0, 12.0), rate=rate)
    model = uf.Model(uf.mesh.strip(8.0, 4.0, 1.0, (4, 1)), material=material)
    model.fix("x0")
    tip = model.prescribe("x1", "z", "tip")
    return model, [uf.Move(tip, 0.8, 4, time=duration), uf.Move(tip, 0.2, 3, time=2.0)]


def sprung_back(Y: float, width: float, stroke: float) -> Built:
    """A cantilever that nothing touches when it is let go."""
    model = uf.Model(uf.mesh.strip(20.0, width, 1.0, (8, 1)), material=metal(Y))
    model.fix("x0")
    tip = model.prescribe("x1_lower", "z", "tip")
    return model, [uf.Move(tip, stroke, 6), uf.Release(tip, steps=10)]


def sprung_back_in_time(Y: float, reference: float, loading: float, back: float) -> Built:
    """The same of a metal with a rate, bent fast and let go in another time."""
    material = uf.Metal(E=206e3, nu=0.3, hardening=uf.Voce(Y, 300.0, 12.0), rate=uf.CowperSymonds(reference, 5.0))
    model = uf.Model(uf.mesh.strip(20.0, 2.0, 1.0, (8, 1)), material=material)
    model.fix("x0")
    tip = model.prescribe("x1_lower", "z", "tip")
    return model, [uf.Move(tip, -3.0, 6, time=loading), uf.Release(tip, steps=20, time=back)]


def rubbed(mu: float, force: float, R: float) -> Built:
    """A strip under a lid with augmented multipliers that a force presses, drawn over two dies, back and forth."""
    model, t = strip(metal(), 1.0), 1.0
    pull = model.prescribe("x1", "x", "pull")
    die = uf.Cylinder((10.0, 0.0, -R - t / 2 + 0.01), "y", R)
    model.contact("lower", die, penalty=1e3, cells=2, friction=mu, name="die")
    bed = uf.Cylinder((28.0, 0.0, -R - t / 2 + 0.01), "y", R)
    table = uf.Friction([(0.0, 0.1), (5.0, 0.05), (50.0, 0.03)], kinetic=0.08, decay=0.1)
    model.contact("lower", bed, penalty=1e3, cells=2, friction=table, name="bed")
    lid = model.contact(
        "upper",
        uf.Plane((0, 0, t / 2), (0, 0, -1)),
        penalty=50.0,
        penetration=0.01,
        augmented=True,
        friction=0.1,
        cells=2,
        name="lid",
    )
    press = model.press(lid, "z", "press")
    return model, [uf.Move(press, force, 2), uf.Move(pull, 0.3, 4), uf.Move(pull, 0.1, 3)]


def tabled(kinetic: float, low: float, high: float, cap: float) -> Built:
    """A block under pressure drawn over a plane: a table of coefficients, a kinetic one, and a largest traction."""
    model = uf.Model(uf.mesh.strip(4.0, 2.0, 1.0, (4, 1)), material=rubber(1e3))
    model.symmetry("y0", "y")
    pressure, pull = model.pressure("upper", "pressure"), model.prescribe("x1", "x", "pull")
    law = uf.Friction([(0.0, high), (40.0, low)], kinetic=kinetic, decay=0.2, cap=cap)
    model.contact("lower", uf.Plane((0, 0, -0.5)), penalty=1e3, cells=2, friction=law, name="bed")
    return model, [uf.Move(pressure, 20.0, 2), uf.Move(pull, 0.6, 6), uf.Move(pressure, 60.0, 2), uf.Move(pull, 1.0, 3)]


def beaded(E: float, restraint: float, uplift: float, t: float) -> Built:
    """A strip on a bed under a lid, drawn through a bead and back."""
    model = strip(rubber(E), t)
    pull = model.prescribe("x1", "x", "pull")
    bed = model.contact("lower", uf.Plane((0, 0, -t / 2)), penalty=1e3, name="bed")
    model.contact("upper", uf.Plane((0, 0, t / 2), (0, 0, -1)), penalty=1e3, name="lid")
    curve = [(9, -9, -0.5), (10, 9, -0.5)]
    model.bead("lower", bed, curve, restraint=restraint, uplift=uplift, width=6.0, name="bead")
    return model, [uf.Move(pull, 1.0, 4), uf.Move(pull, 0.5, 4)]


def kept(Y: float, R: float, mu: float, t: float) -> Built:
    """A clamped sheet and a sphere whose penalty grows to keep the allowed penetration."""
    model = uf.Model(uf.mesh.strip(20.0, 20.0, t, (3, 3)), material=metal(Y))
    for side, normal in (("x0", "x"), ("y0", "y")):
        model.symmetry(side, normal)
        model.fix(side.replace("0", "1"))
    ball = model.contact("upper", uf.Sphere((0.0, 0.0, R + t / 2), R), friction=mu, name="ball")
    return model, [uf.Move(model.drive(ball, "z", "punch"), -2.0, 6)]


def inflated(E: float, t: float, turn: float, pressure: float) -> Built:
    """A clamped plate of 18-node cells under a follower pressure, then a tool that moves and turns in time."""
    model = uf.Model(uf.mesh.strip(4.0, 1.0, t, (3, 1), cell="hex18"), "MI9K3DEAS", material=rubber(E))
    model.fix("x0")
    load = model.pressure("lower")
    lid = model.contact("upper", uf.Plane((0, 0, 0.4), (0, 0, -1)), penalty=500.0, name="lid")
    model.set_motion(lid, lambda time: (np.zeros(3), np.array([0.0, turn * time, 0.0])))
    ram = model.drive(lid, "z", "ram")
    return model, [uf.Move(load, pressure, 3), uf.Move([ram, load], [-0.2, 1.2 * pressure], 3)]


def _on_pad(Y: float, t: float) -> tuple[uf.Model, Any, Any]:
    model = strip(metal(Y), t)
    model.symmetry("x0", "x")
    die = uf.Cylinder((20.0, 0.0, -5.0 - t / 2), "y", 5.0)
    model.contact("lower", die, penalty=500.0, cells=2, friction=0.1, name="die")
    pad = model.contact("lower", uf.Plane((0, 0, -t / 2), (0, 0, 1)), penalty=500.0, cells=2, name="plate")
    punch = uf.Cylinder((0.0, 0.0, 5.0 + t / 2), "y", 5.0)
    return model, pad, model.drive(model.contact("upper", punch, penalty=500.0, cells=2, name="punch"), "z", "ram")


def sprung(stiffness: float, preload: float, at: float, end: float) -> Built:
    """A strip bent over a pad on a spring, with a stiff stop."""
    model, plate, ram = _on_pad(160.0, 1.0)
    pad = model.spring(plate, "z", stiffness, preload=preload, name="pad")
    model.stop(pad, -at, end, below=True)
    return model, [uf.Move(ram, -2.0, 8)]


def stopped(Y: float, t: float, force: float, at: float) -> Built:
    """A strip bent over a pad that a force presses between rigid stops."""
    model, plate, ram = _on_pad(Y, t)
    pad = model.press(plate, "z", "pad")
    model.stop(pad, -at, below=True)
    model.stop(pad, 0.0)
    return model, [uf.Move(pad, force, 2), uf.Move(ram, -2.0, 8)]


def waved(E: float, length: float, height: float) -> Built:
    """A strip pressed on a wave that is a Python function."""

    def wave(x: Floats) -> tuple[Floats, Floats, Floats]:
        slope, normal, hessian = height / length, np.zeros_like(x), np.zeros((len(x), 3, 3))
        normal[:, 0], normal[:, 2] = slope * np.sin(x[:, 0] / length), 1.0
        hessian[:, 0, 0] = slope / length * np.cos(x[:, 0] / length)
        return x[:, 2] + 0.5 + height * (1.0 - np.cos(x[:, 0] / length)), normal, hessian

    model = strip(rubber(E), 1.0, 20.0, 10)
    model.symmetry("x0", "x")
    surface = uf.UserSurface(wave, name="wave")
    model.contact("lower", surface, penalty=500.0, cells=2, friction=0.1, name="wave")
    plate = uf.Plane((0, 0, 0.5), (0, 0, -1))
    ram = model.drive(model.contact("upper", plate, penalty=500.0, cells=2, name="plate"), "z", "ram")
    return model, [uf.Move(ram, -0.4, 5)]


BEND = {"E": 206e3, "Y": 180.0, "n": 0.2, "t": 1.0, "R": 20.0, "mu": 0.1, "stroke": -6.0}
DRAWN = {"Y": 160.0, "t": 1.0, "R": 6.0, "mu": 0.1, "stroke": -2.0}

EXAMPLES: dict[str, Example] = {
    "Move; friction": Example(bent, BEND, ("punch_force", "plastic_work", "friction_work")),
    "Move at a pace": Example(paced, {"Y": 180.0, "t": 1.0, "R": 20.0, "mu": 0.1}, ("punch_force",), replays=True),
    "Release until contact is lost": Example(
        bent_and_released,
        {name: value for name, value in BEND.items() if name != "mu"},
        ("punch", "plastic_work"),
        ends=True,
        size=1e-3,
        limit=5e-3,
    ),
    "Release to zero force": Example(pulled, {"Y": 160.0, "pull": 0.2}, ("pull_force", "plastic_work"), ends=True),
    "Release without contact": Example(
        sprung_back, {"Y": 160.0, "width": 2.0, "stroke": -3.0}, ("tip", "plastic_work"), ends=True
    ),
    "Release of a driven tool": Example(
        driven, {name: DRAWN[name] for name in ("Y", "t", "R", "stroke")}, ("ram", "plastic_work"), ends=True
    ),
    "Close": Example(
        closed, {"E": 1e3, "force": -50.0, "gap": 0.3, "t": 0.5}, ("press_way", "elastic_energy"), ends=True
    ),
    "Close, Release of a pressed tool": Example(
        pressed_and_let_go,
        {"Y": 160.0, "t": 1.0, "gap": 0.3, "force": -80.0},
        ("press_way", "plastic_work"),
        ends=True,
        size=2e-2,
        limit=1e-2,
    ),
    "Release of a clamped strip; friction": Example(
        clamped,
        {"Y": 160.0, "t": 1.0, "mu": 0.15, "force": -400.0, "pull": 0.2},
        ("pull", "plastic_work", "friction_work"),
        ends=True,
    ),
    "Free, of a support": Example(let_go, {"Y": 160.0, "t": 1.0, "tip": -3.0}, ("tip_force", "plastic_work")),
    "Free, of a tool and a support": Example(opened, DRAWN, ("punch_force", "plastic_work", "elastic_energy")),
    "Arc": Example(arch, {"E": 1e3, "h": 0.6, "t": 0.8}, ("load", "elastic_energy"), ends=True),
    "metal with a rate; time of a step": Example(
        in_time, {"Y": 130.0, "reference": 40.0, "exponent": 5.0, "duration": 0.01}, ("tip_force",)
    ),
    "metal with a rate; Release": Example(
        sprung_back_in_time,
        {"Y": 130.0, "reference": 40.0, "loading": 0.1, "back": 1.0},
        ("tip", "plastic_work"),
        ends=True,
    ),
    "press; augmented multipliers": Example(
        rubbed, {"mu": 0.2, "force": -8.0, "R": 5.0}, ("pull_force", "press_way", "lid_friction_work")
    ),
    "table of friction, kinetic, cap": Example(
        tabled, {"kinetic": 0.08, "low": 0.05, "high": 0.1, "cap": 2.0}, ("pull_force", "friction_work")
    ),
    "bead": Example(beaded, {"E": 1e4, "restraint": 30.0, "uplift": 5.0, "t": 1.0}, ("pull_force",)),
    "penalty that grows": Example(
        kept, {"Y": 160.0, "R": 12.0, "mu": 0.1, "t": 1.0}, ("punch_force", "plastic_work"), replays=True
    ),
    "pressure; tool in time": Example(
        inflated, {"E": 1e4, "t": 0.2, "turn": 0.02, "pressure": 0.1}, ("ram_force", "elastic_energy")
    ),
    "spring, stop that yields": Example(
        sprung, {"stiffness": 5.0, "preload": 2.0, "at": 1.0, "end": 50.0}, ("pad", "pad_way", "ram_force")
    ),
    "press, rigid stops": Example(
        stopped, {"Y": 160.0, "t": 1.0, "force": 40.0, "at": 1.0}, ("pad_way", "pad_stop", "ram_force")
    ),
    "surface in Python": Example(waved, {"E": 2e3, "length": 6.0, "height": 0.3}, ("ram_force", "friction_work")),
}
