"""Runs that must be the same on any number of ranks; ``mpiexec -n 2 python cases.py solve petsc FOLDER`` runs all.

Each case brings in something that the ranks must agree on: contact, two tools, ties across the thickness, a follower
pressure, multipliers, automatic penalties and points, tools of the user, cuts, release and lift-off. On three ranks or
more the first one alone describes the case; on one and two all do.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import umform as uf
from umform.analysis.newton.options import NewtonOptions
from umform.history_variables import named
from umform.mesh import strip
from umform.model import Body, NodalTerm
from umform.problem import load
from umform.problem.templates import template_file

STEEL = {"kappa": 175e3, "mu": 80.77e3}
#: Of the command line: the trouble that the functions of the cases make, and the solver that decks are built for.
TROUBLE, SOLVER = "", "superlu"


def free_bending():
    """Contact with a cylinder, J2, release to lift-off: the deck of the template."""
    changes = {"mesh.cells": [12, 2], "steps.0.increments": 8, "steps.0.to.punch": -8.0}
    problem = load(template_file("free-bending"), changes).build(SOLVER)
    return problem.model, problem.steps, problem.options


def air_bending():
    """A driven punch against a die, cells of high thickness order, increments that grow."""
    changes = {"mesh.cells": [16, 2], "steps.0.increments": 12, "steps.0.to.stroke": 1.5}
    problem = load(template_file("air-bending"), changes).build(SOLVER)
    return problem.model, problem.steps, problem.options


def hinged_strip():
    """18-node cells in two layers, a hinge and a prescribed mid-line, all dead loads."""
    mesh = strip(20.0, 4.0, 1.0, (6, 2), cell="hex18", layers=2)
    model = uf.Model(mesh, "MI9K3DEAS", material=uf.J2(**STEEL, hardening=uf.Voce(160.0, 260.0, 20.0)))
    model.hinge("x0", "xyz")
    middle = model.prescribe_midline("x1", "z", "middle")
    model.fix(lambda x, y, z: (x > 20 - 1e-9) & (y < 1e-9), "y")
    loads = [
        model.force(lambda x, y, z: (abs(x - 10) < 1e-9) & (z > 0.49), (0.0, 0.0, -2.0), "nodes"),
        model.traction("x1", (1.0, 0.0, 0.0), "pull"),
        model.line_load("y1", "upper", (0.0, 0.0, -0.5), "line"),
        model.loads.body_force((0.0, 0.0, -0.01), "weight"),
    ]
    steps = [uf.Move(loads, [1.0, 5.0, 1.0, 1.0], steps=3), uf.Move(middle, 0.5, steps=3)]
    return model, steps, None


def blown_strip():
    """A follower pressure, whose tangent is not symmetric, with line search."""
    mesh = strip(20.0, 6.0, 0.5, (10, 3))
    model = uf.Model(mesh, "ANS3DEAS", material=uf.NeoHooke(E=1000.0, nu=0.3))
    model.fix("x0")
    model.fix("x1")
    pressure = model.pressure("lower", "pressure")
    return model, [uf.Move(pressure, 1.0, steps=4)], NewtonOptions(line_search=True)


def roller(x):
    """A cylinder of radius 10 as a function of the user: distance, normal, Hessian."""
    arm = (x - (15.0, 0.0, -10.5)) * (1.0, 0.0, 1.0)
    length = np.linalg.norm(arm, axis=1)
    n = arm / length[:, None]
    H = (np.diag((1.0, 0.0, 1.0)) - np.einsum("na,nb->nab", n, n)) / length[:, None, None]
    return length - 10.0, n, H


def rising(time):
    """Way of the bed."""
    return np.array([0.0, 0.0, 0.01 * time])


def held_by_multipliers():
    """Multipliers, automatic penalty and points, a tool of the user that moves in time, and one that is driven."""
    model = uf.Model(strip(20.0, 5.0, 1.0, (14, 2)), material=uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0)))
    model.symmetry("x0", normal="x")
    model.symmetry("y0", normal="y")
    bed = model.contact("lower", uf.UserSurface(roller), penetration=0.02, points=3, name="bed")
    model.set_motion(bed, rising)
    tool = uf.Cylinder(centre=(0.0, 0.0, 5.49), axis="y", radius=5.0)
    ram = model.contact("upper", tool, points="auto", augmented=True, name="ram")
    drive = model.drive(ram, "-z", "ram_way")
    return model, [uf.Move(drive, inwards, steps=4), uf.Release(drive)], None


def cut():
    """Increments that fail and are cut, along a function of time."""
    model = uf.Model(strip(60.0, 10.0, 1.0, (12, 2)), material=uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0)))
    model.symmetry("x0", normal="x")
    model.fix(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), "y")
    punch = model.prescribe("x0_lower", "z", "punch")
    tool = uf.Cylinder(centre=(25.0, 0.0, -20.5), axis="y", radius=20.0)
    model.contact("lower", tool, penalty=100.0, points="nodes", name="tool")
    steps = [uf.Move(punch, downwards, steps=3, grow=2.0), uf.Release(punch)]
    return model, steps, NewtonOptions(max_iterations=7)


def pressed():
    """A punch that a force presses, against a pad on a spring: two ways that are unknowns."""
    model = uf.Model(strip(20.0, 4.0, 1.0, (14, 2)), material=uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0)))
    model.fix("x0")
    model.fix("x1")
    above, below = (9.0, 0.0, 5.46), (11.5, 0.0, -5.46)
    punch = model.contact("upper", uf.Cylinder(above, "y", 5.0), penetration=0.02, points=3, name="punch")
    pad = model.contact("lower", uf.Cylinder(below, "y", 5.0), penetration=0.02, points=3, name="pad")
    model.spring(pad, "z", stiffness=500.0, preload=20.0, name="gas")
    force = model.press(punch, "z", "press")
    return model, [uf.Move(force, -100.0, steps=1), uf.Move(force, weighing, steps=4), uf.Move(force, -50.0)], None


def rubbed():
    """A sheet under a holder that a force presses, drawn over a die with friction, back and forth."""
    model = uf.Model(strip(30.0, 4.0, 1.0, (12, 3)), material=uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0)))
    model.symmetry("y0", "y")
    pull = model.prescribe("x1", "x", "pull")
    decaying = uf.Friction(0.25, kinetic=0.2, decay=0.1)
    for number, x in enumerate((10.0, 28.0)):
        die = uf.Cylinder(centre=(x, 0.0, -5.49), axis="y", radius=5.0)
        rule = {"cells": 3} if number else {"points": 3}
        model.contact("lower", die, penalty=1e3, friction=decaying, name=f"die{number}", **rule)
    lid = model.contact("upper", uf.Plane((0, 0, 0.5), (0, 0, -1)), penalty=50.0, friction=0.1, name="lid")
    force = model.press(lid, "z", "force")
    return model, [uf.Move(force, -16.0, steps=2), uf.Move(pull, 0.3, steps=4), uf.Move(pull, 0.1, steps=3)], None


def beaded():
    """A sheet on a bed under a lid that a force presses, drawn through a bead across and a closed one, and back."""
    model = uf.Model(strip(30.0, 8.0, 1.0, (12, 4)), material=uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0)))
    model.symmetry("y0", "y")
    pull = model.prescribe("x1", "x", "pull")
    bed = model.contact("lower", uf.Plane((0, 0, -0.5)), penalty=1e3, name="bed")
    lid = model.contact("upper", uf.Plane((0, 0, 0.5), (0, 0, -1)), penalty=1e3, name="lid")
    model.bead("lower", bed, [(9, -9, -0.5), (10, 9, -0.5)], restraint=30.0, uplift=2.0, width=6.0, name="across")
    square = [(18, -3, 0.5), (24, -3, 0.5), (24, 3, 0.5), (18, 3, 0.5)]
    model.bead("upper", lid, square, restraint=8.0, width=3.0, closed=True, slip=0.05, name="ring")
    force = model.press(lid, "z", "force")
    return model, [uf.Move(force, -60.0, steps=2), uf.Move(pull, 1.0, steps=4), uf.Move(pull, 0.8, steps=3)], None


def closed():
    """A holder over a loose sheet closes with friction, follows a table of forces onto its blocks and eases off."""
    model = uf.Model(strip(20.0, 4.0, 0.8, (14, 2)), material=uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0)))
    model.symmetry("x0", normal="x")
    model.symmetry("y0", normal="y")
    rule = {"penalty": 2e3, "friction": 0.1}
    die = model.contact("lower", uf.Plane((0.0, 0.0, -0.5)), name="die", **rule)
    holder = model.contact("upper", uf.Plane((0.0, 0.0, 1.4), (0.0, 0.0, -1.0)), name="holder", **rule)
    hold = model.press(holder, "z", "hold")
    model.attach(die, model.turn(holder, "z", (5.0, 2.0, 0.0), "twist"))
    model.keep_gap(hold, die, 0.79785)
    pull = model.prescribe("x1_lower", "x", "pull")
    table = [(0.0, -160.0), (0.02, -200.0)]
    pulled = uf.Move(pull, sliding, steps=4, follow={hold: table})
    steps = [uf.Close(hold, force=-160.0), pulled, uf.Move(hold, -20.0, steps=4)]
    return model, steps, None


def sprung_back():
    """A strip that is bent over a hinge and a table, and let go of a support, then of all tools, on a gauge."""
    model = uf.Model(strip(20.0, 4.0, 1.0, (12, 2)), material=uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0)))
    gauge = model.hold_rigid(lambda x, y, z: (x > 3.0) & (y > 1.0), name="gauge")
    edge = model.fix("y0_lower", "y", name="edge")
    clamp = model.hinge("x0", "xz", name="clamp")
    prop = model.fix(lambda x, y, z: (abs(x - 1.7) < 0.2) & (z > 0.0), "z", name="prop")
    table = model.contact("lower", uf.Cylinder((12.0, 0.0, -5.49), "y", 5.0), penalty=2e3, name="table")
    punch = model.contact("upper", uf.Cylinder((19.0, 0.0, 3.49), "y", 3.0), penalty=2e3, points=3, name="punch")
    stroke = model.drive(punch, "z", "stroke")
    steps = [uf.Move(stroke, -1.0, steps=2), uf.Free(prop, steps=2), uf.Move(stroke, -1.1, steps=1)]
    return (
        model,
        [*steps, uf.Free([clamp, edge, table, punch], steps=3, on=gauge), uf.Move(stroke, upwards, steps=3)],
        None,
    )


class Foam(NodalTerm):
    """A bed of springs along z that are crushed for good beyond a force, which grows with the crush."""

    def __init__(self, nodes, stiffness, limit, slope):
        super().__init__("foam", nodes, history={"crush": 1})
        self.stiffness, self.limit, self.slope = stiffness, limit, slope

    each_node = ("stiffness",)

    def respond(self, u, history, at):
        k, h, crush = self.stiffness, self.slope, named(history, self.history_variables)["crush"][:, 0]
        beyond = np.maximum(-k * (u[:, 2] - crush) - self.limit + h * crush, 0.0)
        crush = crush - beyond / (k + h)
        forces, tangents = np.zeros((len(u), 3)), np.zeros((len(u), 3, 3))
        forces[:, 2] = k * (u[:, 2] - crush)
        flows = beyond > 1e-9 * self.limit  # a node on its limit is no matter of round-off
        tangents[:, 2, 2] = np.where(flows, k * h / (k + h), k)
        return forces, tangents, crush[:, None]

    def energy(self, u, history):
        crush = named(history, self.history_variables)["crush"][:, 0]
        return 0.5 * self.stiffness * (u[:, 2] - crush) ** 2, -self.limit * crush + 0.5 * self.slope * crush**2

    def column_names(self):
        return ["foam_force", "foam_crush"]

    def columns(self, found, ranks):
        force, crush = ranks.sum(float(found.forces[:, 2].sum())), ranks.max(float(-found.history.min(initial=0.0)))
        return {"foam_force": force, "foam_crush": crush}


def foundation():
    """A term that is written in Python, with a history; it alone holds the sheet against falling and tilting."""
    mesh = strip(20.0, 4.0, 0.5, (12, 2))
    model = uf.Model(mesh, material=uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0)))
    model.fix("x0_lower", "x")
    model.fix("y0_lower", "y")
    nodes = mesh.nodes("lower")
    model.add(Foam(nodes, 5.0 + 0.5 * mesh.points[nodes, 0], limit=0.4, slope=1.0))
    weight = model.line_load("x1", "upper", (0.0, 0.0, 0.004), "weight")
    return model, [uf.Move(weight, weighing, steps=5), uf.Move(weight, 0.0, steps=2)], None


def two_bodies():
    """A sheet of two laws and two numbers of points, welded in its middle; some ranks have cells of one alone."""
    soft = uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0))
    bodies = [
        Body("ANS3DEAS", material=soft, cells=lambda x, y, z: x < 11.0, name="soft"),
        Body("ANS3DEAS", material=uf.SVK(E=70e3, nu=0.3), cells=lambda x, y, z: x > 11.0, name="elastic"),
    ]
    model = uf.Model(strip(20.0, 4.0, 1.0, (16, 2)), bodies=bodies)
    model.fix("x0")
    model.contact("lower", uf.Cylinder((10.0, 0.0, -10.49), "y", 10.0), penetration=0.02, points=3, name="tool")
    tip = model.prescribe("x1_lower", "z", "tip")
    return model, [uf.Move(tip, downwards, steps=4), uf.Move(tip, -3.0, steps=2)], NewtonOptions(max_iterations=12)


def metals():
    """Metals from parts with rolling directions: back stresses, a modulus that falls, a rate; and two surfaces."""
    hill, surfaces = uf.Hill48(1.8, 1.5, 2.2), uf.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)
    dull = uf.Metal(
        206e3,
        0.3,
        hardening=uf.Voce(180.0, 330.0, 14.0),
        yield_function=hill,
        back_stress=uf.Chaboche([(4000.0, 80.0), (600.0, 6.0)]),
        modulus=uf.FallingModulus(saturated=160e3, rate=30.0),
        rate=uf.CowperSymonds(reference=40.0, exponent=5.0),
    )
    bounded = uf.Metal(206e3, 0.3, hardening=uf.Perfect(124.0), yield_function=hill, back_stress=surfaces)
    bodies = [
        Body(material=dull, cells=lambda x, y, z: x < 7.0, name="dull", rolling=(1.0, 0.5, 0.0)),
        Body(material=bounded, cells=lambda x, y, z: x > 7.0, name="bounded", rolling=(0.0, 1.0, 0.0)),
    ]
    model = uf.Model(strip(12.0, 4.0, 1.0, (12, 2)), bodies=bodies)
    model.fix("x0")
    tip = model.prescribe("x1", "z", "tip")
    return model, [uf.Move(tip, downwards, steps=5, time=0.01), uf.Move(tip, -1.0, steps=3)], None


class Stop(Exception):
    """The end of a run in its middle."""


def inwards(fraction):
    """Way of the ram."""
    trouble_at(fraction)
    return 0.8 * fraction


def upwards(fraction):
    """Way of the punch once it is open."""
    trouble_at(fraction)
    return -1.1 + fraction


def downwards(fraction):
    """Way of the punch."""
    trouble_at(fraction)
    return -4.0 * fraction**1.5


def sliding(fraction):
    """Way of an end that is pulled."""
    trouble_at(fraction)
    return 0.04 * fraction


def weighing(fraction):
    """A load, or the force of a punch."""
    trouble_at(fraction)
    return -100.0 - 300.0 * fraction


def trouble_at(fraction):
    """What ends a run in its middle, if that is asked for."""
    if fraction > 0.6 and TROUBLE == "stop":
        raise Stop
    if fraction > 0.6 and TROUBLE == "fail" and rank() == 1:
        raise ZeroDivisionError("a function of the user on one rank")


CASES = [free_bending, air_bending, hinged_strip, blown_strip, held_by_multipliers, cut]
CASES += [pressed, closed, sprung_back, rubbed, beaded, foundation, two_bodies, metals]


def rank():
    from petsc4py import PETSc

    return PETSc.COMM_WORLD.rank


def described(case):
    """Model, steps and options of a case; on three ranks or more the first one alone has model and steps."""
    if SOLVER != "petsc":
        return case()
    from petsc4py import PETSc

    comm = PETSc.COMM_WORLD.tompi4py()
    if comm.size < 3:
        return case()
    model, steps, options = case() if comm.rank == 0 else (None, [], None)
    return model, steps, comm.bcast(options)


def save(result, path):
    """History, iterations of each increment, and the last fields."""
    last = result.frames[-1]
    columns = {f"history {name}": result[name] for name in result.columns()}
    fields = {f"point {name}": values for name, values in last.points.items()}
    fields |= {f"cell {name}": values for name, values in last.cells.items()}
    fields |= {f"{name} {key}": values for name, at in last.contacts.items() for key, values in at.known().items()}
    imbalance = result.balance().force_imbalance
    counts = [len(records) for records in result.iterations]
    np.savez(path, iterations=counts, imbalance=imbalance, events=result.events, **columns, **fields)


def main(task, solver, folder, *names):
    """Solve, resume, or begin and ("stop", "fail") end in the middle."""
    global TROUBLE, SOLVER
    TROUBLE, SOLVER = task, solver
    for case in CASES:
        if names and case.__name__ not in names:
            continue
        model, steps, options = described(case)
        how = {"solver": solver, "options": options, "frames": 2}
        checkpoint = Path(folder) / f"{case.__name__}.chk.h5"
        try:
            if task == "resume":
                result = uf.resume(checkpoint, model, steps, **how)
            else:
                result = uf.solve(model, steps, checkpoint=None if task == "solve" else checkpoint, every=0.0, **how)
        except Stop as stop:
            result = stop.result
        if solver != "petsc" or rank() == 0:
            save(result, Path(folder) / f"{case.__name__}.npz")


if __name__ == "__main__":
    main(*sys.argv[1:])
