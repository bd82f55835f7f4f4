"""Strains of the sheet on its skins and in its middle."""

import numpy as np
import pytest

import umform as uf
from umform.results.forming import forming_fields, sheet_strains

CELLS = ["hex8", "hex18"]


@pytest.mark.parametrize("cell", CELLS)
def test_homogeneous_stretch(cell):
    strip = uf.mesh.strip(4.0, 3.0, 0.5, (4, 3), cell=cell)
    F = np.array([[1.2, 0.1, 0.0], [0.0, 0.9, 0.0], [0.0, 0.0, 0.93]])
    found = sheet_strains(strip, strip.points @ (F - np.eye(3)).T)
    minor, major = np.log(np.linalg.svd(F[:2, :2], compute_uv=False))[::-1]
    for name in ("lower", "middle", "upper"):
        np.testing.assert_allclose(found.major[name], major, rtol=1e-12)
        np.testing.assert_allclose(found.minor[name], minor, rtol=1e-12)
    np.testing.assert_allclose(found.thickness, np.log(0.93), rtol=1e-12)


@pytest.mark.parametrize("cell", CELLS)
def test_a_rotation_strains_nothing(cell):
    disc = uf.mesh.disc(10.0, 1.0, (3, 4), part="half", cell=cell)
    turn = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
    found = forming_fields(disc, disc.points @ (turn - np.eye(3)).T)
    assert max(abs(values).max() for values in found.values()) < 1e-12


@pytest.mark.parametrize("cell", CELLS)
def test_bending_strains_the_skins_and_not_the_thickness(cell):
    R, t, count = 5.0, 1.0, 40
    strip = uf.mesh.strip(5.0, 0.3, t, (count, 1), cell=cell)
    X = strip.points
    angle, radius = X[:, 0] / R, R - X[:, 2]
    bent = np.column_stack([radius * np.sin(angle), X[:, 1], R - radius * np.cos(angle)])
    found = sheet_strains(strip, bent - X)
    np.testing.assert_allclose(found.major["lower"], np.log(1.0 + 0.5 * t / R), atol=2e-4)
    np.testing.assert_allclose(found.minor["upper"], np.log(1.0 - 0.5 * t / R), atol=2e-4)
    assert abs(found.thickness[1:-1]).max() < 2e-5
    assert abs(found.major["middle"]).max() < 2e-4
