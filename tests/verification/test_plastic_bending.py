"""Pure plastic bending in plane strain of one element: locking in sharp bends (docs/theory, section 2.8).

All nodes are prescribed: they lie on circles, the directors keep the length h, and the stretch of the mid-line is
chosen such that the axial force vanishes. The moment stands over the exact one of a perfectly plastic plate in plane
strain, (2 / sqrt 3) y0 b h^2 / 4 (Hill 1950), and over the factor 1.0115 by which 8 Gauss points overrate it where the
neutral line is at the mid-surface: so does the reference table. The second factor is misleading, since with held
directors the neutral line moves, t_n = -x_s, and the points that it passes change the factor. The 0.964 of order 3 at a
surface strain of 0.20 is one of quadrature: 15 Gauss points give 0.996 (8 nodes) and 0.998 (18 nodes) there. What the
elements are worth in a sheet, whose thickness is free, is measured by the case bend-moment of the verification book.
"""

from __future__ import annotations

import numpy as np
import pytest

from umform_book.sharp_bends.arc_bending import ArcBending
from umform_book.sharp_bends.candidates import KAPPA, YIELD_STRESS, Candidate
from umform_book.variants import Variant

LENGTH, THICKNESS = 0.5, 2.0
EIGHT_POINTS = 1.0115
SURFACE_STRAINS = (0.01, 0.05, 0.10, 0.15, 0.20)

#: Moment ratios at the surface strains k h / 2, measured with another program.
MOMENTS = {
    1: (1.000, 1.087, 1.705, 3.317, 6.26),
    2: (1.000, 0.998, 0.997, 1.018, 1.110),
    3: (1.000, 0.997, 0.989, 0.977, 0.964),
}
#: The same for MI9K3DEAS, measured with this one.
MOMENTS_18 = {
    1: (1.001, 1.088, 1.707, 3.328, 6.300),
    2: (1.000, 0.9985, 0.998, 1.020, 1.114),
    3: (1.000, 0.998, 0.990, 0.979, 0.966),
}


def moment_ratios(element: str, increments: int = 100, **options) -> np.ndarray:
    """Moment ratios at SURFACE_STRAINS, bent in equal increments up to the last of them."""
    candidate = Candidate(element, Variant(element, options), points=8, rule="gauss")
    bending = ArcBending(candidate, length=LENGTH, thickness=THICKNESS, held=True)
    return bending.moments(SURFACE_STRAINS, increments) / EIGHT_POINTS


@pytest.mark.parametrize("order", MOMENTS)
def test_8_nodes(order, book):
    found = moment_ratios("ANS3DEAS", thickness_order=order)
    name = f"ANS3DEAS, order {order}, 8 points"
    book("pure plastic bending, plane strain", name, "moment / Hill's at surface strain 0.20", 1.0, found[-1])
    assert found == pytest.approx(MOMENTS[order], abs=1e-3 if order > 1 else 3e-3)


@pytest.mark.parametrize("tie_E33", [False, True])
@pytest.mark.parametrize("order", MOMENTS_18)
def test_18_nodes(order, tie_E33):
    """18 nodes are no cure, and on an arc with directors of constant length tying E_33 changes nothing."""
    found = moment_ratios("MI9K3DEAS", increments=40, thickness_order=order, tie_E33=tie_E33)
    assert found == pytest.approx(MOMENTS_18[order], abs=2e-3)


@pytest.mark.parametrize("element", ["ANS3DEAS", "MI9K3DEAS"])
def test_order_3_with_tying_is_near_to_the_exact_moment(element, book):
    """The setting that is recommended for bending: within 4 % of Hill up to a surface strain of 0.2."""
    found = moment_ratios(element, increments=40, thickness_order=3, tie_E33=True)
    for strain, ratio in zip(SURFACE_STRAINS, found, strict=True):
        name = f"{element}, order 3, E_33 tied, 8 points"
        book("pure plastic bending, plane strain", name, f"moment / Hill's at surface strain {strain:.2f}", 1.0, ratio)
    assert found == pytest.approx(1.0, abs=0.04)


def test_formula_of_the_locking_moment():
    """Eq. (2.29): M_lock / M_pl = sqrt 3 m beta² / (2 m + 1) kappa / y0 x^(2 m - 1), m = 2, beta = 1 at order 1.

    The formula is the leading term, so it is compared where the surface strain is small and the excess is large enough.
    """
    strain = 0.05
    excess = moment_ratios("ANS3DEAS", thickness_order=1)[1] - moment_ratios("ANS3DEAS", thickness_order=3)[1]
    formula = np.sqrt(3) * 2 / 5 * KAPPA / YIELD_STRESS * strain**3
    assert excess * EIGHT_POINTS == pytest.approx(formula, rel=0.1)


def test_the_increments_are_fine_enough():
    coarse, fine = (moment_ratios("ANS3DEAS", increments=n, thickness_order=3) for n in (40, 200))
    assert coarse == pytest.approx(fine, abs=2e-4)
