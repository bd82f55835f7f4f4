"""Straight elements in the gap between round tools: thickness by the geometry of the chords."""

from __future__ import annotations

import numpy as np
import pytest

from umform_book.drawing.chords import thickness_in_gap

INNER, GAP = 30.0, 1.2


@pytest.mark.parametrize("points", [2, 3, 4])
@pytest.mark.parametrize("around", [8, 12, 24])
def test_elements_touch_both_tools_at_contact_points(points: int, around: int) -> None:
    """Chords of this thickness touch the inner and the outer tool with a contact point each, eq. (4.192)."""
    thickness = thickness_in_gap(GAP, INNER + GAP, around, points)
    angle = 0.5 * np.pi / around
    xi = np.polynomial.legendre.leggauss(points)[0]
    across = xi * INNER * np.tan(0.5 * angle)  # of a face whose middle is at INNER
    middle = np.sqrt(INNER**2 - np.abs(across).min() ** 2)  # distance of the inner face, its nearest point on the tool
    outer = middle + thickness
    reached = np.hypot(outer, across * outer / middle).max()
    assert reached == pytest.approx(INNER + GAP, abs=0.03 * GAP / around)


def test_two_points_lose_nothing() -> None:
    assert thickness_in_gap(GAP, 31.2, 12, 2) == pytest.approx(GAP, abs=1e-12)
