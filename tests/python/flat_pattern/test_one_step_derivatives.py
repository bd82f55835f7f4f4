"""Energies, material forces and their matrices against differences, at large strains, with everything active."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import umform as uf
from umform.flat_pattern.one_step.equations import Equations
from umform.flat_pattern.one_step.forces import Friction, Restraint
from umform.flat_pattern.one_step.law import PathLaw
from umform.flat_pattern.one_step.part import sheet_of
from umform.flat_pattern.one_step.places import FlatProblem, first_fold
from umform.flat_pattern.one_step.strain import Formed, areas, flat_sides, log_strains, work
from umform_book.drawing.revolved import cup

METAL = uf.Metal(70e3, 0.33, hardening=uf.Swift(500.0, 0.01, 0.2), yield_function=uf.Hill48(1.8, 1.2, 2.1))
STEP = 1e-6


def some(count: int = 40) -> tuple[np.ndarray, np.ndarray, Formed]:
    """Sides in the flat, corners and formed triangles with strains up to one."""
    random = np.random.default_rng(3)
    points = random.normal(size=(3 * count, 3))
    formed = Formed.of(points, np.arange(3 * count).reshape(count, 3))
    D = np.swapaxes(np.linalg.cholesky(np.linalg.inv(formed.inverse)), 1, 2)
    D = D + np.linspace(0.0, 0.4, count)[:, None, None] * random.normal(size=D.shape)
    wrong = areas(D) < 0.0
    D[wrong] = D[wrong][:, :, ::-1]
    return D, points, formed


@pytest.mark.parametrize("thickest", [math.inf, -0.1])
def test_derivatives_of_the_energy(thickest):
    D, _, formed = some()
    law = replace(PathLaw.of(METAL), thickest=thickest)
    found = work(D, formed.inverse, law)
    for k in range(4):
        way = np.zeros(4)
        way[k] = STEP
        ahead, behind = (work(D + sign * way.reshape(2, 2), formed.inverse, law) for sign in (1.0, -1.0))
        slope = (ahead.value - behind.value) / (2.0 * STEP)
        assert np.allclose(slope, found.gradient[:, k], rtol=1e-5, atol=1e-5 * abs(found.gradient).max())
        bend = (ahead.gradient - behind.gradient) / (2.0 * STEP)
        size = abs(found.hessian).max(axis=(1, 2))[:, None]
        assert (abs(bend - found.hessian[:, :, k]) < 1e-5 * size).all()


def test_strains_are_half_of_the_logarithm_of_cauchy_green():
    D, _, formed = some()
    X = np.zeros((3 * len(D), 2))
    X[1::3], X[2::3] = D[:, :, 0], D[:, :, 1]
    triangles = np.arange(3 * len(D)).reshape(-1, 3)
    e = log_strains(X, triangles, formed)
    for k in range(len(D)):
        inverse = np.linalg.inv(D[k])
        values, vectors = np.linalg.eigh(inverse.T @ np.linalg.inv(formed.inverse[k]) @ inverse)
        exact = vectors @ np.diag(0.5 * np.log(values)) @ vectors.T
        assert e[k] == pytest.approx([exact[0, 0], exact[1, 1], exact[0, 1]], abs=1e-10)


def test_tension_has_the_stress_and_r_value_of_hill():
    """The energy of uniaxial strains with the r-value is least over the width strain, at the stress of the curve."""
    law = PathLaw.of(METAL)
    for angle, r in ((0.0, 1.8), (90.0, 2.1)):
        along = 0.2
        width = np.linspace(-0.2, 0.0, 2001)
        e = np.stack([np.full(2001, along), width, np.zeros(2001)], axis=1)
        if angle:
            e = e[:, [1, 0, 2]]
        size = law.equivalent(e)
        least = width[size.argmin()]
        assert least == pytest.approx(-along * r / (1.0 + r), abs=2e-4)
    assert law.equivalent(np.array([[0.2, -0.2 * 1.8 / 2.8, 0.0]]))[0] == pytest.approx(0.2)


def problem() -> tuple[FlatProblem, np.ndarray]:
    """A cup with all forces, at places near those of equal area."""
    points, triangles = cup(5, 20.0)
    sheet = sheet_of(points, triangles, 1.0)
    formed = Formed.of(sheet.points, sheet.triangles)
    law = replace(PathLaw.of(METAL).smooth(0.2), thickest=0.05)
    made = FlatProblem(sheet, formed, law, np.zeros(len(points), dtype=bool))
    under = sheet.points[sheet.triangles].mean(axis=1)[:, 2] < 1.0
    made.forces = [Friction.on(sheet, formed, under, 400.0), Restraint.on(sheet, formed, 30.0)]
    every = np.arange(len(triangles))
    made.forces += [Restraint(every, np.tile(np.arange(3), (len(every), 1)), 20.0 * formed.sides[:, 2])]
    random = np.random.default_rng(5)
    flat = np.hypot(points[:, 0], points[:, 1])
    r = flat + 0.8 * points[:, 2]
    X = points[:, :2] * (r / np.maximum(flat, 1e-9))[:, None] + 0.1 * random.normal(size=(len(points), 2))
    assert areas(flat_sides(X, triangles)).min() > 0.0
    return made, X


def test_matrices_of_the_material_forces():
    made, X = problem()
    equations = Equations(len(X), made.sheet.triangles, np.zeros(2 * len(X), dtype=bool), symmetric=False)
    pattern = equations.pattern
    _, K6 = made.residual(X)
    K = np.zeros((2 * len(X), 2 * len(X)))
    K[pattern.rows, pattern.indices] = equations.matrix(K6)
    for dof in np.random.default_rng(1).choice(2 * len(X), 30, replace=False):
        way = np.zeros(2 * len(X))
        way[dof] = STEP
        ahead, behind = (equations.vector(made.residual(X + sign * way.reshape(-1, 2))[0]) for sign in (1.0, -1.0))
        assert np.allclose((ahead - behind) / (2.0 * STEP), K[:, dof], atol=1e-5 * abs(K).max())
    assert abs(K - K.T).max() > 1e-3 * abs(K).max()  # forces and edges are not symmetric


def test_columns_and_rows_of_held_unknowns():
    made, X = problem()
    held = np.zeros(2 * len(X), dtype=bool)
    held[[3, 8]] = True
    whole = Equations(len(X), made.sheet.triangles, np.zeros_like(held), symmetric=False)
    some_held = Equations(len(X), made.sheet.triangles, held, symmetric=False)
    _, K6 = made.residual(X)
    K = np.zeros((2 * len(X), 2 * len(X)))
    K[whole.pattern.rows, whole.pattern.indices] = whole.matrix(K6)
    assert np.allclose(some_held.columns(K6, np.array([3, 8])), K[:, [3, 8]])
    assert np.allclose(some_held.rows(K6, np.array([3, 8])), K[[3, 8]])


def test_material_forces_are_those_of_virtual_work():
    """Inside, minus F^T times the forces of the formed sheet: both vanish together in a homogeneous state."""
    made, _ = problem()
    made.forces = []
    plane = made.sheet.points[:, :2] * 1.0
    flat_part = sheet_of(np.c_[np.random.default_rng(2).uniform(size=(60, 2)) * 50.0, np.zeros(60)], _delaunay(), 1.0)
    formed = Formed.of(flat_part.points, flat_part.triangles)
    stretch = np.diag([1.0 / 1.2, 1.0 / 0.95])
    X = flat_part.points[:, :2] @ stretch
    homogeneous = FlatProblem(flat_part, formed, PathLaw.of(METAL), np.zeros(60, dtype=bool))
    equations = Equations(60, flat_part.triangles, np.zeros(120, dtype=bool), symmetric=False)
    r = equations.vector(homogeneous.residual(X)[0]).reshape(-1, 2)
    inner = np.setdiff1d(np.arange(60), flat_part.loops[0])
    assert abs(r[inner]).max() < 1e-9 * abs(r).max()
    assert len(plane)


def _delaunay() -> np.ndarray:
    from scipy.spatial import Delaunay

    return Delaunay(np.random.default_rng(2).uniform(size=(60, 2)) * 50.0).simplices


def test_a_step_ends_before_the_first_fold():
    triangles = np.array([[0, 1, 2]])
    X = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    down = np.array([[0.0, 0.0], [0.0, 0.0], [0.0, -2.0]])
    assert first_fold(X, down, triangles) == pytest.approx(0.5)
    assert first_fold(X, -down, triangles) == math.inf
    crushed = np.array([[0.0, 0.0], [-1.0, 0.0], [0.0, -2.0]])
    assert first_fold(X, crushed, triangles) == pytest.approx(0.5)
