"""Rigid motions of parts tell mechanisms from very thin sheets that are held, docs/theory, 5.8."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.newton import Newton
from umform.errors import SingularMatrix
from umform.model.equations import mechanisms

LENGTH, WIDTH = 100.0, 20.0
SIZES = [(1e-4, 0.0, 1.0), (1e-4, 0.3, 1e-6), (3e-5, 1.0, 1e6), (1e-5, 0.3, 1.0)]


def strip(thickness, turned, unit, joint="whole"):
    """A model in any unit, turned about y, and the undeformed points before; its halves may be hinged or apart."""
    flat = uf.mesh.strip(LENGTH * unit, WIDTH * unit, thickness * LENGTH * unit, (10, 2))
    points, cells = flat.points, flat.connectivity.copy()
    edge = np.zeros(0, dtype=int)
    if joint != "whole":
        edge = np.flatnonzero((np.abs(points[:, 0] / unit - 50.0) < 1e-6) & ((points[:, 2] > 0.0) | (joint == "apart")))
        own = np.arange(len(points))
        own[edge] = len(points) + np.arange(len(edge))
        right = points[cells].mean(axis=1)[:, 0] > 50.0 * unit
        cells[right] = own[cells[right]]
    points = np.vstack([points, points[edge]])
    c, s = np.cos(turned), np.sin(turned)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    mesh = uf.Mesh(points @ turn.T, {"hex8": cells}, flat.sets, flat.faces)
    return uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3)), points / unit


def clamp(model, points):
    model.fix(np.flatnonzero(points[:, 0] < 1e-6))


def hinge(model, points):
    model.fix(np.flatnonzero((points[:, 0] < 1e-6) & (points[:, 2] < 0.0)))


def three_points(model, points):
    corner = (points[:, 2] < 0.0) & ((points[:, 0] < 1e-6) | (points[:, 0] > LENGTH - 1e-6))
    model.fix(np.flatnonzero(corner & ((points[:, 1] < 1e-6) | (points[:, 0] < 1e-6))))


def one_node(model, points):
    model.fix(np.flatnonzero((points[:, 0] < 1e-6) & (points[:, 1] < 1e-6) & (points[:, 2] < 0.0)))


def both_ends(model, points):
    model.fix(np.flatnonzero((points[:, 0] < 1e-6) | (points[:, 0] > LENGTH - 1e-6)))


def nothing(model, points):
    pass


def springs(share):
    """Springs at all nodes, each with this share of the stiffness through the thickness of a cell."""

    def hold(model, points):
        unit = np.ptp(model.mesh.points[:, 1]) / WIDTH
        cell = 210e3 * (10.0 * 10.0) * unit / np.ptp(points[:, 2])
        model.rest(stiffness=share * cell * len(points))

    return hold


def is_rigid(model, motion):
    """Whether the nodes of each cell keep their distances from its first one, to first order."""
    x, u = model.mesh.points, model.system.extend(motion).reshape(-1, 3)
    x, u = x / np.ptp(x, axis=0).max(), u / np.abs(u).max()
    cells = model.mesh.connectivity
    return all(
        np.abs(np.einsum("ca,ca->c", x[cells[:, i]] - x[cells[:, 0]], u[cells[:, i]] - u[cells[:, 0]])).max() < 1e-12
        for i in range(1, 8)
    )


def is_held(model, tangent):
    return model.system.mechanism(tangent.values, np.ones(model.system.pattern.n)) is None


@pytest.mark.parametrize(("thickness", "turned", "unit"), SIZES)
@pytest.mark.parametrize(
    ("joint", "hold", "held"),
    [
        ("whole", clamp, True),
        ("whole", three_points, True),
        ("whole", springs(1e-9), True),
        ("hinged", both_ends, True),
        ("apart", both_ends, True),
        ("whole", nothing, False),
        ("whole", springs(1e-18), False),
        ("whole", hinge, False),
        ("whole", one_node, False),
        ("hinged", clamp, False),
        ("apart", clamp, False),
    ],
    ids=lambda value: getattr(value, "__name__", None),
)
def test_a_thin_sheet_is_held_unless_a_part_can_move_rigidly(joint, hold, held, thickness, turned, unit, monkeypatch):
    """eqs. (5.99), (5.100)"""
    model, points = strip(thickness, turned, unit, joint)
    hold(model, points)
    tangent = model.evaluate(model.system.x)
    for threshold in (1e-15, 1e-14, 1e-12):  # far from all of these
        monkeypatch.setattr(mechanisms, "_ROUND_OFF", threshold)
        assert is_held(model, tangent) is held
    solver = Newton(model.system).ready_solver()
    if held:
        solver.factor(tangent)
        assert np.isfinite(solver.solve(np.ones(model.system.pattern.n))).all()
    else:
        with pytest.raises(SingularMatrix) as caught:
            solver.factor(tangent)
        assert caught.value.motion is None or is_rigid(model, caught.value.motion)


@pytest.mark.parametrize(("touching", "held"), [(True, True), (False, False)])
def test_contact_holds_a_hinged_sheet_as_long_as_it_touches(touching, held):
    model, points = strip(1e-4, 0.0, 1.0)
    hinge(model, points)
    model.contact(
        "lower", uf.Plane((0.0, 0.0, points[:, 2].min() - 1e-3 + 2e-3 * touching), (0.0, 0.0, 1.0)), penalty=1
    )
    assert is_held(model, model.evaluate(model.system.x)) is held


def test_a_midline_hinge_lets_a_thin_sheet_turn():
    """Constraints between nodes, not only held nodes."""
    for clamped in (True, False):
        model, _ = strip(1e-4, 0.0, 1.0)
        model.hinge("x0") if not clamped else model.fix("x0")
        assert is_held(model, model.evaluate(model.system.x)) is clamped


def test_a_thicker_sheet_is_left_to_the_solver():
    for thickness, asked in ((1e-3, False), (4e-4, True)):
        model, points = strip(thickness, 0.0, 1.0)
        clamp(model, points)
        assert is_held(model, model.evaluate(model.system.x)) is asked
