"""How the book reads thickness strains and the volume of a drawn disc, on shapes that are known."""

from __future__ import annotations

import numpy as np
import pytest

from umform.materials import J2, Perfect
from umform_book.drawing.spherical import BLANK, THICKNESS, Setup, along_x, blank, volume

STEEL = J2(206e3, 0.3, hardening=Perfect(200.0))


@pytest.mark.parametrize("setup", [Setup(STEEL, 5.0, 4), Setup(STEEL, 5.0, 4, "ANS3DEAS", layers=2)])
def test_a_stretched_sheet_has_the_thickness_strain_and_the_volume(setup: Setup) -> None:
    mesh = blank(setup)
    stretch = np.array([1.2, 1.1, 0.7])
    u = (mesh.points * (stretch - 1.0)).ravel()
    place, strain = along_x(mesh, u)
    assert place[0] == 0.0 and place[-1] == pytest.approx(BLANK)
    np.testing.assert_allclose(strain, np.log(0.7), rtol=1e-12)
    now = volume(mesh.points * stretch, mesh)
    assert now / volume(mesh.points, mesh) == pytest.approx(stretch.prod(), rel=1e-12)


def test_the_volume_is_that_of_a_quarter_of_a_disc() -> None:
    quadratic = blank(Setup(STEEL, 5.0, 8))  # its rim of arcs of parabolas
    assert volume(quadratic.points, quadratic) == pytest.approx(0.25 * np.pi * BLANK**2 * THICKNESS, rel=1e-5)


def test_a_bent_sheet_keeps_its_thickness() -> None:
    mesh, radius = blank(Setup(STEEL, 2.0, 4)), 60.0
    x, y, z = mesh.points.T
    bent = np.stack([(radius + z) * np.sin(x / radius), y, (radius + z) * np.cos(x / radius) - radius], axis=1)
    _, strain = along_x(mesh, (bent - mesh.points).ravel())
    assert np.abs(strain).max() < 1e-3  # of the tangents by differences
