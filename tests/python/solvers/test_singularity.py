"""Mechanisms are refused however large the mesh is, and thin sheets that are held are not."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from matrices import factored, grid, stored
from scipy import sparse

import umform as uf
from umform.errors import NoConvergence, SingularMatrix
from umform.model import System
from umform.solvers import multifrontal
from umform.solvers.singularity import Iteration, weak_pivot


def sheet(size, cells, turned=0.0, clamped=True):
    """The tangent of a sheet of this length, width and thickness, turned about the edge by which it is held.

    It is held by both lines of nodes of that edge, or by the lower one alone, a hinge.
    """
    mesh = uf.mesh.strip(*size, cells)
    model = uf.Model(mesh, "ANS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    points = mesh.points
    c, s = np.cos(turned), np.sin(turned)
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    pattern, values = model.system.pattern, model.evaluate((points @ turn.T - points).reshape(model.u.shape)).values
    upper = sparse.csr_matrix((values, pattern.indices, pattern.indptr), shape=(pattern.n, pattern.n))
    whole = (upper + sparse.triu(upper, 1).T).tocsr()
    held = (points[:, 0] == points[:, 0].min()) & (clamped | (points[:, 2] == points[:, 2].min()))
    free = np.flatnonzero(~np.repeat(held, 3))
    return whole[free][:, free]


SHEETS = [
    ((4.0, 1.0, 0.5), (4, 1)),
    ((60.0, 10.0, 1.0), (24, 1)),
    ((60.0, 0.005, 1.0), (12, 1)),
    ((600.0, 8.0, 0.2), (150, 2)),
    ((40.0, 30.0, 0.5), (40, 30)),
    ((40.0, 30.0, 0.02), (40, 30)),
]


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("turned", [0.0, 0.3])
@pytest.mark.parametrize(("size", "cells"), SHEETS)
def test_a_hinge_is_refused_and_a_clamp_is_not(size, cells, turned, symmetric):
    solver, told = factored(sheet(size, cells, turned), symmetric)
    assert told.odd is False
    assert np.isfinite(solver.solve(np.ones(solver._pattern.n))).all()
    with pytest.raises(SingularMatrix):
        factored(sheet(size, cells, turned, clamped=False), symmetric)


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("hold", [0.0, 1e-9, 1e-6])
def test_what_holds_a_loose_part_may_be_soft(hold, symmetric):
    """A stiffness of 1e-9 of the others holds; in any unit."""
    free = grid((9, 9), 2) - (1.0 - hold) * sparse.eye(162)
    unit = sparse.diags(10.0 ** np.random.default_rng(0).uniform(-8.0, 8.0, 162))
    for matrix in (free, unit @ free @ unit):
        if hold == 0.0:
            with pytest.raises(SingularMatrix):
                factored(matrix, symmetric)
        else:
            _, told = factored(matrix, symmetric)
            assert told.odd is False


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize(("size", "cells"), SHEETS)
def test_a_mechanism_without_a_weak_pivot_is_seen_in_a_solution(size, cells, symmetric, monkeypatch):
    """The larger the mesh, the less weak the pivots of a mechanism: in the end a solution alone can tell."""
    monkeypatch.setattr(multifrontal, "weak_pivot", lambda *_: None)
    factored(sheet(size, cells, 0.3), symmetric)
    with pytest.raises(SingularMatrix) as caught:
        factored(sheet(size, cells, 0.3, clamped=False), symmetric)
    motion = caught.value.motion.reshape(-1, 3)  # it turns about the hinge: the free end goes farthest
    assert np.argmax(np.linalg.norm(motion, axis=1)) >= len(motion) - 2 * (cells[1] + 1) * 2


def test_the_first_matrix_of_a_pattern_alone_is_asked_for_a_solution(monkeypatch):
    asked = []
    monkeypatch.setattr(multifrontal, "large_solution", lambda *_: asked.append(1))
    pattern, values = stored(grid((9, 9), 2))
    solver = multifrontal.Multifrontal()
    for expected in (1, 2):
        solver.analyse(pattern)
        solver.factor(values)
        solver.factor(2.0 * values)
        assert len(asked) == expected


def test_an_eigenvalue_that_vanishes_among_negative_ones_is_seen():
    matrix = grid((8, 8), 2).toarray()
    values, vectors = np.linalg.eigh(matrix)
    for gap, refused in ((0.0, True), (1e-9, False)):
        moved = values - values[20] + gap * values[-1]
        indefinite = (vectors * moved) @ vectors.T
        indefinite = 0.5 * (indefinite + indefinite.T)
        if refused:
            with pytest.raises(SingularMatrix):
                factored(indefinite)
        else:
            assert factored(indefinite)[1].negative_pivots == 20


def test_resistance_is_the_part_of_the_entries_that_would_have_to_change():
    """[[1, -1], [-1, 1 + d]] is singular without d, which is a quarter of what w = (1, 1) meets; in any unit."""

    def of(matrix, scale):
        iteration = Iteration(scale, scale, partial(np.linalg.solve, matrix), partial(np.matmul, np.abs(matrix)))
        part, w = iteration.resistance(np.array([0.0, 1.0]))
        np.testing.assert_allclose(np.abs(w), np.sqrt(0.5), rtol=1e-2)
        return part

    unit = np.array([1e-6, 1e3])
    for d in (1e-3, 1e-9):
        matrix = np.array([[1.0, -1.0], [-1.0, 1.0 + d]])
        assert of(matrix, np.ones(2)) == pytest.approx(d / 4.0, rel=1e-3)
        assert of(matrix * np.outer(unit, unit), 1.0 / unit) == pytest.approx(d / 4.0, rel=1e-3)


def test_only_weak_pivots_are_asked_about():
    asked = []

    def held(start):
        asked.append(int(np.argmax(start)))
        return 1e-12, start

    size = np.array([1.0, 10.0, 0.0])
    assert weak_pivot(np.array([1e-7, -5.0]), size[:2], held) is None
    assert not asked
    assert weak_pivot(np.array([-1e-9, 5.0]), size[:2], held) is None
    assert asked == [0]
    assert weak_pivot(np.array([1.0, 1e-9]), size[:2], lambda start: (1e-17, start)).equation == 1
    nothing = weak_pivot(np.array([1.0, 1e-16]), size[:2], held)  # refused whatever is found, which says what moves
    assert nothing.equation == 1
    np.testing.assert_array_equal(nothing.motion, [0.0, 1.0])
    assert asked == [0, 1]
    assert weak_pivot(np.array([1.0, 1.0, 0.0]), size, held).equation == 2
    assert asked == [0, 1]


def test_a_pivot_that_is_nothing_but_rounding_names_what_moves():
    """A chain of springs that nothing holds, but for a part of 4e-16 of one of them."""
    count = 5
    chain = sparse.diags([2.0 * np.ones(count), -np.ones(count - 1), -np.ones(count - 1)], [0, 1, -1]).tolil()
    chain[0, 0] = 1.0 + 4e-16
    chain[count - 1, count - 1] = 1.0
    with pytest.raises(SingularMatrix) as caught:
        factored(chain.tocsr())
    motion = caught.value.motion
    np.testing.assert_allclose(motion / motion[0], np.ones(count), rtol=1e-6)


@pytest.mark.parametrize(("thickness", "count"), [(0.5, 21), (1.2e-3, 18)])  # the upper nodes of the edge move by t
def test_the_error_of_a_run_names_what_moves(thickness, count):
    """Two plates that share the lower nodes of an edge: one turns about it."""
    flat = uf.mesh.strip(12.0, 4.0, thickness, (6, 2))
    points, cells = flat.points, flat.connectivity.copy()
    edge = np.flatnonzero((np.abs(points[:, 0] - 6.0) < 1e-9) & (points[:, 2] > 0.0))
    own = np.arange(len(points))
    own[edge] = len(points) + np.arange(len(edge))
    right = points[cells].mean(axis=1)[:, 0] > 6.0
    cells[right] = own[cells[right]]
    model = uf.Model(
        uf.Mesh(np.vstack([points, points[edge]]), {"hex8": cells}, flat.sets), material=uf.SVK(E=1e5, nu=0.3)
    )
    model.fix("x0")
    push = model.force("x1", (0.0, 0.0, -1e-3 * (thickness / 0.5) ** 3), "push")
    with pytest.raises(
        NoConvergence, match=rf"{count} of 45 nodes can move, most of all node \d+ at \(12, .* along \("
    ) as caught:
        uf.solve(model, uf.Move(push, 1.0, steps=1, cuts=1), progress=False)
    assert "join its nodes" in str(caught.value)


def least_resistance(size, cells, turned, clamped, monkeypatch):
    seen = []
    monkeypatch.setattr(multifrontal, "weak_pivot", lambda pivots, size, resistance: seen.append((pivots, resistance)))
    monkeypatch.setattr(multifrontal, "large_solution", lambda *_: None)
    factored(sheet(size, cells, turned, clamped))
    pivots, resistance = seen[0]
    return resistance(np.cos(np.arange(1.0, len(pivots) + 1.0)), 3)[0]


@pytest.mark.parametrize("cells", [(20, 1), (60, 1)])
@pytest.mark.parametrize("slenderness", [1e-3, 4e-4, 2e-4])
def test_a_strip_resists_bending_by_the_fourth_power_of_its_slenderness(slenderness, cells, monkeypatch):
    """eq. (5.80)"""
    least = least_resistance((100.0, 1.0, 100.0 * slenderness), cells, 0.0, True, monkeypatch)
    assert least == pytest.approx(0.26 * slenderness**4, rel=0.15)


def test_where_bending_resists_less_than_rounding_a_mechanism_may_resist_more(monkeypatch):
    """Sheets of t/L = 1e-4: no bound on the resistance separates those that are clamped from those that are hinged."""
    clamped, hinged = (
        [
            least_resistance((100.0, width, 0.01), cells, turned, kind, monkeypatch)
            for width, cells in ((1.0, (20, 1)), (20.0, (20, 4)))
            for turned in (0.0, 0.1, 0.3, 1.0)
        ]
        for kind in (True, False)
    )
    assert max(*clamped, *hinged) < 2.0**-52
    assert np.median(clamped) < max(hinged)
    assert min(clamped) < np.median(hinged)


def cantilever(slenderness, turned=0.0, unit=1.0, deflection=1e-3):
    """Tip of a cantilever under a small force at its end beside P L^3 / (3 E I), and the evaluations."""
    length, width, thickness = 100.0 * unit, unit, 100.0 * slenderness * unit
    mesh = uf.mesh.strip(length, width, thickness, (40, 1))
    flat, (c, s) = mesh.points, (np.cos(turned), np.sin(turned))
    turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    model = uf.Model(uf.Mesh(flat @ turn.T, {"hex8": mesh.connectivity}, mesh.sets), material=uf.SVK(E=210e3, nu=0.0))
    model.fix("x0")
    end = flat[:, 0] > length * (1.0 - 1e-9)
    force = deflection * length * 3.0 * 210e3 * (width * thickness**3 / 12.0) / length**3
    push = model.force("x1", tuple(turn @ (0.0, 0.0, -force / end.sum())), "push")
    result = uf.solve(model, uf.Move(push, 1.0, steps=1, cuts=1), progress=False)
    tip = -(model.u.reshape(-1, 3) @ turn)[end, 2].mean()
    return tip / (deflection * length), result.timing.attempts.evaluations


@pytest.mark.parametrize(("turned", "unit"), [(0.0, 1.0), (0.3, 1.0), (0.3, 1e-6), (1.0, 1e6)])
def test_a_cantilever_that_resists_less_than_rounding_bends_as_it_should(turned, unit, monkeypatch):
    """t/L = 1e-4, where eq. (5.53) refuses the tangent of a clamped sheet: forces are exact, Newton converges."""
    found = []
    mechanism = System.mechanism
    monkeypatch.setattr(System, "mechanism", lambda *own: found.append(mechanism(*own)) or found[-1])
    tip, evaluations = cantilever(1e-4, turned, unit)
    assert found and all(motion is None for motion in found)
    assert tip == pytest.approx(1.0, rel=1e-3)
    assert evaluations <= 20
    found.clear()
    thicker, evaluations = cantilever(1e-3, turned, unit)
    assert thicker == pytest.approx(tip, rel=5e-4)
    assert evaluations <= 6
    assert not found


@pytest.mark.parametrize("element", ["ANS3DEAS", "BEND8"])
@pytest.mark.parametrize(("slenderness", "accuracy"), [(1e-3, 1e-3), (1e-4, 0.05)])
def test_the_reaction_of_a_thin_cantilever_is_known_less_well(slenderness, accuracy, element):
    """A reaction is a residual, which eq. (5.10) knows to the round-off of the largest entry."""
    mesh = uf.mesh.strip(100.0, 1.0, 100.0 * slenderness, (40, 1))
    model = uf.Model(mesh, element, material=uf.SVK(E=210e3, nu=0.0))
    model.fix("x0")
    end = model.prescribe("x1_lower", "z", name="end")
    result = uf.solve(model, uf.Move(end, -0.1, steps=2, cuts=2), progress=False)
    force = 0.1 * 3.0 * 210e3 * ((100.0 * slenderness) ** 3 / 12.0) / 100.0**3
    assert -result["end_force"][-1] == pytest.approx(force, rel=accuracy)


@pytest.mark.parametrize("unit", [1.0, 1e-6, 1e6])
def test_a_tool_bends_a_thin_strip(unit):
    """t/L = 1e-4: the force of the tool is 3 E I / a^3 times the deflection below it, apart from the penetration."""
    length, width, thickness, down = 100.0 * unit, 2.0 * unit, 0.01 * unit, 0.2 * unit
    mesh = uf.mesh.strip(length, width, thickness, (80, 1))
    model = uf.Model(mesh, material=uf.SVK(E=210e3, nu=0.0))
    model.fix("x0")
    stiffness = 3.0 * 210e3 * (width * thickness**3 / 12.0) / (0.8 * length) ** 3
    tool = uf.Cylinder(centre=(0.8 * length, 0.0, mesh.points[:, 2].max() + 20.0 * unit), axis="y", radius=20.0 * unit)
    contact = model.contact("upper", tool, penalty=1e4 * stiffness / unit**2, points=2, name="tool")
    way = model.drive(contact, "z", name="way")
    result = uf.solve(model, uf.Move(way, to=-down, steps=2, cuts=2), progress=False)
    assert result["tool_fz"][-1] / (stiffness * down) == pytest.approx(1.0, rel=0.01)


def test_the_error_of_a_thin_sheet_says_that_it_needs_more_supports():
    """t/L = 2e-5: round-off of the tangent hides its resistance to bending."""
    with pytest.raises(NoConvergence, match="50000 times as long as thick") as caught:
        cantilever(2e-5)
    assert "more places" in str(caught.value)
