"""Limit and bifurcation points: their loads, and what a change of pivots means."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from umform import materials as mt
from umform.analysis.run import Result, solve
from umform.analysis.steps import Arc
from umform.analysis.steps.arc_length.critical import CriticalPoints, PathState, extremum
from umform.mesh import Mesh, strip
from umform.model import Model


def roof(thickness, cells=4):
    """A quarter of the hinged cylindrical roof of [SzeLiuLo2004] under a central force; mm, N."""
    made = strip(0.1, 254.0, thickness, (cells, cells), cell="hex18")
    angle, y, z = (made.points - made.points.min(axis=0)).T
    radius = 2540.0 + z - 0.5 * thickness
    points = np.stack([radius * np.sin(angle), y, radius * np.cos(angle) - 2540.0], axis=1)
    mesh = Mesh(points, made.cells, made.sets, made.faces)
    model = Model(mesh, "MI9K3DEAS", material=mt.SVK(E=3102.75, nu=0.3))
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    model.hinge("x1", "xz")
    model.hinge(np.setdiff1d(mesh.nodes("x1"), mesh.nodes("y0")), "y")
    centre = np.intersect1d(mesh.nodes("x0"), mesh.nodes("y0"))
    return model, model.force(centre, (0.0, 0.0, -0.125), "force"), centre


@pytest.mark.parametrize("symmetric", [True, False])
def test_euler_load_of_a_straight_strip_is_bracketed(symmetric):
    """Compressed on its hinges the strip stays straight; at pi^2 E I / L^2 a pivot turns and the load does not.

    A pressure that nobody raises makes the matrix an unsymmetric one: then the determinant tells.
    """
    model = Model(strip(10.0, 1.0, 0.2, (8, 1), cell="hex18"), "MI9K3DEAS", material=mt.SVK(E=1e4, nu=0.0))
    model.hinge("x0", "xz")
    model.hinge("x1", "z")
    for side in ("y0", "y1"):
        model.symmetry(side, "y")
    area = 0.2
    load = model.traction("x1", (-1.0 / area, 0.0, 0.0), "load")
    euler = math.pi**2 * 1e4 * 0.2**3 / 12 / 100
    if not symmetric:
        model.pressure("upper")
    result = solve(model, Arc(load, 1.5 * euler, increment=0.05, grow=1.0), solver="superlu", frames=0)
    bifurcation = [re.search(r"bifurcation point between load = (\S+) and load = (\S+);", e) for e in result.events]
    bifurcation = [match for match in bifurcation if match]
    assert len(bifurcation) == 1
    assert len(result.events) == (1 if symmetric else 2)
    low, high = float(bifurcation[0][1]), float(bifurcation[0][2])
    assert low < euler < high
    assert high - low < 0.1 * euler
    assert ("0 -> 1" if symmetric else "the determinant changes its sign") in result.events[-1]
    assert any("unstable primary" in warning for warning in result.warnings)
    assert np.abs(model.u.reshape(-1, 3)[:, 2]).max() < 1e-6


def test_the_roof_snaps_through_and_back(build):
    """Limit loads of the literature: 0.742 of 3000 N at 12.7 mm (table of [SzeLiuLo2004], read to its digits)."""
    model, force, centre = roof(12.7)
    result = solve(model, Arc(force, 3000.0), frames=200)
    thick = build.limit_loads(result)
    assert len(thick) == 2
    assert thick[0] == pytest.approx(0.7421 * 3000, rel=0.01)
    assert thick[1] == pytest.approx(0.1729 * 3000, rel=0.03)
    w = np.array([-frame.points["displacement"][centre, 2].mean() for frame in result.frames])
    assert (np.diff(w) > 0).all()
    assert np.interp(4.477, w, result["force"]) == pytest.approx(0.4686 * 3000, rel=0.01)

    model, force, centre = roof(6.35)
    result = solve(model, Arc(force, 3000.0), frames=200)
    assert len(build.limit_loads(result)) == 2
    assert build.limit_loads(result)[1] < 0.0  # the load changes its sign on the way
    w = np.array([-frame.points["displacement"][centre, 2].mean() for frame in result.frames])
    assert np.diff(w).min() < -0.1  # snap-back
    assert np.sum(np.diff(np.sign(np.diff(w))) != 0) == 2


def state(fraction, arc, slope, pivots, odd=None):
    return PathState(fraction, arc, np.zeros(1), slope, pivots, odd)


def test_the_load_of_a_limit_point_is_exact_on_a_cubic():
    def at(s):
        return state(s**3 - 3 * s, s, 3 * s**2 - 3, 0)

    assert extremum(at(0.5), at(1.7)) == pytest.approx(-2.0, abs=1e-12)
    assert extremum(at(-1.3), at(0.0)) == pytest.approx(2.0, abs=1e-12)


@pytest.mark.parametrize(
    ("slopes", "pivots", "limits", "bifurcations"),
    [
        ((1, 1), (0, 0), 0, 0),
        ((1, -1), (0, 1), 1, 0),
        ((1, -1, 1), (0, 1, 0), 2, 0),
        ((1, 1), (0, 1), 0, 1),
        ((1, 1, -1), (0, 1, 2), 1, 1),
        ((1, -1), (0, 2), 1, 1),
        ((1, -1), (0, 0), 1, 1),
        ((1, -1, 1), (0, None, 0), 2, 0),
        ((1, -1, -1), (0, None, 1), 1, 0),
        ((1, 1, 1), (0, None, 1), 0, 1),
        ((1, -1), (None, None), 1, 0),
    ],
)
def test_what_a_change_of_pivots_means(slopes, pivots, limits, bifurcations, build):
    result = Result(build.bar()[0])
    points = CriticalPoints(result, lambda fraction: f"load = {fraction:g}", "step 1")
    for k, (slope, count) in enumerate(zip(slopes, pivots, strict=True)):
        points.advance(state(0.1 * k, 0.1 * k, float(slope), count))
    assert sum("limit point" in event for event in result.events) == limits
    assert sum("bifurcation point between" in event for event in result.events) == bifurcations
    assert sum("does not tell" in event for event in result.events) == (None in pivots)


@pytest.mark.parametrize(
    ("slopes", "signs", "limits", "bifurcations"),
    [
        ((1, 1), (False, False), 0, 0),
        ((1, -1), (False, True), 1, 0),
        ((1, -1, 1), (False, True, False), 2, 0),
        ((1, 1), (False, True), 0, 1),
        ((1, -1), (False, False), 1, 1),
        ((1, -1, 1), (False, None, False), 2, 0),
        ((1, 1, 1), (False, None, True), 0, 1),
        ((1, 1), (3, False), 0, 1),
        ((1, 1), (False, 2), 0, 0),
    ],
)
def test_what_the_sign_of_the_determinant_means(slopes, signs, limits, bifurcations, build):
    """Where the number of negative pivots is not known, or in one of both states only (3 and 2 are such numbers)."""
    result = Result(build.bar()[0])
    points = CriticalPoints(result, lambda fraction: f"load = {fraction:g}", "step 1")
    for k, (slope, sign) in enumerate(zip(slopes, signs, strict=True)):
        told = (None, sign) if isinstance(sign, bool) or sign is None else (sign, None)
        points.advance(state(0.1 * k, 0.1 * k, float(slope), *told))
    assert sum("limit point" in event for event in result.events) == limits
    assert sum("bifurcation point between" in event for event in result.events) == bifurcations


def test_an_unsymmetric_tangent_says_what_may_pass_unseen(build):
    model, _ = build.cantilever(cells=(4, 1))
    arc = Arc(model.pressure("lower"), 0.2, increment=0.2)
    result = solve(model, arc, solver="superlu", frames=0)
    assert sum("two bifurcation points in one increment may pass unseen" in event for event in result.events) == 1
