"""Tangents on ranks against the whole ones in one process: entries, inertia, solutions; singular and not finite ones.

``mpiexec -n 2 python algebra.py`` prints one line of JSON on the first rank.
"""

from __future__ import annotations

import json

import numpy as np

import umform as uf
from umform.analysis.ranks.outline import Outline
from umform.analysis.ranks.run import hand_out
from umform.errors import NotFinite, SingularMatrix
from umform.mesh import strip
from umform.model import Term
from umform.model.terms.term import Found, Global
from umform.parallel.mpi_ranks import world
from umform.parallel.solver import Petsc
from umform.solvers import make_solver

ELASTIC = uf.SVK(E=210e3, nu=0.3)


def strut(clamped=True, material=ELASTIC):
    """A sheet that is pressed along its length, with hinges at its far end."""
    model = uf.Model(strip(20.0, 4.0, 0.2, (12, 3)), material=material)
    if clamped:
        model.fix("x0")
        model.hinge("x1", "yz")
    return model


def pressed(points, strain):
    """Shortened along x."""
    u = np.zeros_like(points)
    u[:, 0] = -strain * points[:, 0]
    return u.ravel()


def shared(model):
    return hand_out(Outline.of(model), model, world())


def flattened(model):
    """Two cells without a thickness, one at each end."""
    u = np.zeros_like(model.mesh.points)
    for cell in (5, len(model.mesh.connectivity) - 1):
        u[model.mesh.connectivity[cell, 4:], 2] = -0.2
    return u.ravel()


def dofs(share):
    return (3 * share.system.nodes[:, None] + np.arange(3)).ravel()


def refused_tool(press=False):
    """A tool of the user that is not finite at the points of one rank only; with a force that presses it or without."""

    def gap(x):
        far = x[:, 0] > 15.0
        return np.where(far, np.nan, x[:, 2] + 1.0), np.tile((0.0, 0.0, 1.0), (len(x), 1)), np.zeros((len(x), 3, 3))

    model = strut()
    tool = model.contact("lower", uf.UserSurface(gap), penalty=1.0)
    if press:
        model.press(tool, "z")
    part = shared(model)
    try:
        part.evaluate(part.x)
    except NotFinite as error:
        return error.what
    return "taken"


def refused_runs():
    """A second run, whose history has stayed with the ranks; models that differ, or cannot be sent; wrong steps."""
    model = uf.Model(strip(20.0, 4.0, 1.0, (12, 3)), material=ELASTIC)
    model.fix("x0")
    pull = model.prescribe("x1", "x", "pull")
    result = uf.solve(model, uf.Move(pull, 0.1, steps=1), solver="petsc")
    assert (world().rank == 0) == bool(np.isfinite(result.model.u).all())
    yield lambda: uf.solve(model, uf.Move(pull, 0.2, steps=1), solver="petsc")
    yield lambda: uf.fields.point_fields(model)
    other = uf.Model(strip(20.0, 4.0 + world().rank, 1.0, (12, 3)), material=ELASTIC)
    other.fix("x0")
    push = other.prescribe("x1", "x", "push")
    yield lambda: uf.solve(other, uf.Move(push, 0.2, steps=1), solver="petsc")
    elsewhere = strut()
    lift = elsewhere.prescribe("x1_upper", "x", "lift")
    for first, way in ((0, lambda fraction: 1e-4 * fraction), (world().size - 1, 1e-4)):
        given = (elsewhere, uf.Move(lift, way, steps=1)) if world().rank == first else (None, [])
        yield lambda given=given: uf.solve(*given, solver="petsc")
    wrong = uf.Move(push, 0.2) if world().rank == 0 else []  # of another model
    yield lambda: uf.solve(strut() if world().rank == 0 else None, wrong, solver="petsc")
    for term in (Nothing(), Alone()):
        odd = strut()
        odd.add(term)
        yield lambda odd=odd: uf.solve(odd, [], solver="petsc")


class Nothing(Term):
    """A term that adds nothing, and does not say what a rank gets of it."""

    def evaluate(self, at, into):
        return Found()


class Alone(Nothing):
    """One that does, but keeps its scalar unknown."""

    def __init__(self):
        self.unknowns = (Global("way", {}),)

    def strip(self, bare, twins):
        """Nothing grows with the mesh."""

    def fill(self, piece, mesh):
        """Nothing has been taken out."""


def message(run):
    try:
        run()
    except uf.UmformError as error:
        return error.what
    return "done"


def refused(solver, values):
    try:
        solver.factor(values)
    except (SingularMatrix, NotFinite) as error:
        return type(error).__name__
    return "taken"


def main():
    answer = {"negative": [], "serial": [], "error": [], "largest": []}
    whole = strut()
    share, serial, petsc = shared(whole), make_solver(whole.system.pattern, "superlu"), Petsc()
    petsc.analyse(share.system.pattern)
    for strain in (0.0, 0.001, 0.01):
        u = pressed(whole.mesh.points, strain)
        one, own = whole.evaluate(u), share.evaluate(pressed(share.mesh.points, strain))
        answer["negative"].append(petsc.factor(own.values).negative_pivots)
        answer["serial"].append(serial.factor(one.values).negative_pivots)
        load = np.random.default_rng(1).normal(size=u.size)
        expected = whole.system.extend(serial.solve(whole.system.restrict(load)))
        mine = np.zeros(share.u.size)
        mine.reshape(-1, 3)[share.system.whole.owned] = load.reshape(-1, 3)[
            share.system.nodes[share.system.whole.owned]
        ]
        found = share.system.extend(petsc.solve(share.system.restrict(mine)))
        difference = np.abs(found - expected.reshape(-1, 3)[share.system.nodes].ravel()).max() / np.abs(expected).max()
        answer["error"].append(world().max(float(difference)))
        answer["largest"].append(share.system.largest_entry(own.values) / whole.system.largest_entry(one.values) - 1.0)
    values = own.values.copy()
    if world().rank == world().size - 1:
        values[0] = np.nan
    answer["nan"] = refused(petsc, values)
    steel = strut(material=uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Linear(160.0, 500.0)))
    part, flat = shared(steel), flattened(steel)
    answer["failed"] = [steel.evaluate(flat).failed, part.evaluate(flat[dofs(part)]).failed]
    answer["tool"] = [refused_tool(press) for press in (False, True)]
    answer["runs"] = [message(run) for run in refused_runs()]
    loose, rigid = Petsc(), shared(strut(clamped=False))
    loose.analyse(rigid.pattern)
    answer["loose"] = refused(loose, rigid.evaluate(rigid.u).values)
    return answer


if __name__ == "__main__":
    outcome = main()
    if world().rank == 0:
        print(json.dumps(outcome))
