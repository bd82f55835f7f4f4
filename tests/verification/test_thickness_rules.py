"""Rules through the thickness: the fully plastic moment that they find, over the exact one. Eqs. (2.21), (2.22)."""

from __future__ import annotations

import numpy as np
import pytest

from umform_book.plastic.thickness_points import plastic_moment

GAUSS = {2: 1.155, 3: 0.861, 4: 1.043, 5: 0.945, 6: 1.020, 7: 0.971, 8: 1.012, 9: 0.982}


@pytest.mark.parametrize("points", GAUSS)
def test_gauss(points):
    assert round(plastic_moment(points, "gauss"), 3) == GAUSS[points]


def test_gauss_in_closed_form():
    """Two points at 1/sqrt 3; three at 0 and sqrt 0.6, the outer ones with the weight 5/9."""
    assert plastic_moment(2, "gauss") == pytest.approx(2 / np.sqrt(3), rel=1e-14)
    assert plastic_moment(3, "gauss") == pytest.approx(10 / 9 * np.sqrt(0.6), rel=1e-14)


@pytest.mark.parametrize("points", [2, 4, 6, 8, 10, 12, 14])
def test_split_is_exact(points):
    assert plastic_moment(points, "split") == pytest.approx(1.0, rel=1e-14)


@pytest.mark.parametrize("points", range(3, 16))
def test_lobatto_is_worse_than_gauss_at_the_kink(points):
    errors = {rule: abs(plastic_moment(points, rule) - 1) for rule in ("gauss", "lobatto")}
    assert errors["lobatto"] > errors["gauss"] > 0.003
