"""Ears of a flange in uniaxial compression around the cup."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from umform.materials import Hill48, Metal, Voce
from umform.sheet_metals import uniaxial
from umform_book.drawing.cups import aa6016
from umform_book.drawing.rim import compressed_flange, narrow_ring

BLANK, WALL = 53.75, 30.6


def test_isotropic_flange_has_no_ears() -> None:
    """r = 1: each radius stretches by half of the compression."""
    metal = Metal(70e3, 0.33, hardening=Voce(126.0, 315.0, 12.0), yield_function=Hill48(1.0, 1.0, 1.0))
    height = compressed_flange(metal, BLANK, WALL).height
    assert np.ptp(height) < 1e-9
    assert height[0] == pytest.approx(quad(lambda radius: np.sqrt(radius / WALL), WALL, BLANK)[0], rel=1e-9)


def test_ears_stand_where_the_rim_across_has_a_large_r() -> None:
    """The height at an angle follows the r-value at right angles to it."""
    metal = aa6016()
    profile = compressed_flange(metal, BLANK, WALL)
    r = [uniaxial(metal.yield_function, angle + 90.0)[1] for angle in profile.angle]
    assert np.argmax(profile.height) == np.argmax(r)
    size, angle = profile.wave(4)
    assert size > 0.3
    assert abs(angle) < 5.0


@pytest.mark.parametrize(("card", "rolling"), [("", 0.0), ("", 20.0), ("Postech", 0.0), ("Hill48", 0.0)])
def test_a_narrow_ring_has_the_ears_of_its_r_values(card: str, rolling: float) -> None:
    """Elements, law and rolling direction: every radius of a ring that is compressed around itself."""
    found, expected = narrow_ring(aa6016(card), 0.2, rolling)
    np.testing.assert_allclose(found.height, expected.height, atol=1e-3)
    size, angle = found.wave(4)
    assert size == pytest.approx(expected.wave(4)[0], rel=0.03) and size > 0.01
    assert angle == pytest.approx(rolling, abs=0.01)
