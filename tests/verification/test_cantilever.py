"""Cantilever strip of Sze et al. (2004): bent by an end shear force, and rolled up by an end moment.

The strip and its loads are those of the verification book, umform_book.nonlinear.cantilever.
"""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform_book.nonlinear import cantilever
from umform_book.nonlinear.tracing import trace
from umform_book.variants import Variant, with_tying

from .cases import table

TIED = with_tying("ANS3DEAS")


def equal_steps(count: int) -> np.ndarray:
    return np.arange(1, count + 1) / count


# End shear ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("intervals", "element", "tolerance"), [(16, "ANS3DEAS", 0.01), (32, "ANS3DEAS", 0.002), (16, "MI9K3DEAS", 0.002)]
)
def test_end_shear(intervals, element, tolerance, book):
    """The whole curve, errors relative to its last value, 6.698 for the deflection."""
    reference = table("sze_end_shear.csv")
    tip = trace(cantilever.end_shear(Variant(element), intervals), equal_steps(20), uf.solve)
    assert reference["w_tip"][-1] == 6.698
    name = f"{element}, {Variant(element).cells(intervals)} elements"
    book("cantilever, end shear", name, "deflection of the tip", 6.698, tip["w_tip"][-1])
    for probe in ("w_tip", "minus_u_tip"):
        assert tip[probe] == pytest.approx(reference[probe], abs=tolerance * reference[probe][-1])


def test_error_falls_with_the_square_of_the_element_length():
    curves = [trace(cantilever.end_shear(TIED, intervals), equal_steps(4), uf.solve) for intervals in (8, 16, 32)]
    deflection = [curve["w_tip"][-1] for curve in curves]
    ratio = (deflection[1] - deflection[0]) / (deflection[2] - deflection[1])
    assert ratio == pytest.approx(4.0, rel=0.1)


def digits_gained(mixed: bool, increments: int) -> tuple[int, list[float]]:
    """Most iterations of an increment; digits of the last iteration over those of the one before it.

    Looked at in the second half of the load: before, the last iterations are not yet in the quadratic range.
    """
    setup = cantilever.end_shear(Variant("ANS3DEAS"), 16)
    steps = uf.Move(*zip(*setup.loads.items(), strict=True), steps=increments)
    result = uf.solve(setup.model, steps, options=uf.NewtonOptions(mixed=mixed), frames=0)
    gains = []
    for iterations in result.iterations[increments // 2 :]:
        digits = -np.diff([np.log10(record.energy) for record in iterations if record.energy > 0])
        gains.append(digits[-1] / digits[-2])
    return int(max(result["iterations"])), gains


def test_newton_converges_quadratically():
    """With the consistent tangent the last iteration gains twice the digits of the one before it."""
    most, gains = digits_gained(mixed=False, increments=20)
    assert most <= 7
    assert gains == pytest.approx(len(gains) * [2.0], abs=0.3)


def test_the_mixed_tangent_takes_fewer_iterations_and_gains_no_fewer_digits():
    most, gains = digits_gained(mixed=True, increments=10)
    assert most <= 4
    assert min(gains) > 1.7


# Roll-up --------------------------------------------------------------------------------------------------------------


def rolled_up(variant: Variant, intervals: int, thickness: float = cantilever.THICKNESS) -> tuple[float, float]:
    """Rotation of the end under the moment of a full turn, and how far the end is from the closed form.

    Over a full turn and over the length.
    """
    setup = cantilever.end_moment(variant, intervals, thickness)
    curve = trace(setup, equal_steps(20), uf.solve)
    closed_form = cantilever.circle(np.ones(1))
    sideways = setup.model.u.reshape(-1, 3)[setup.model.mesh.nodes("x1"), 1].mean()
    off = max(abs(sideways), *(abs(curve[probe][-1] - closed_form[probe][0]) for probe in setup.probes))
    return cantilever.rotation_of_end(setup.model) / cantilever.TURN, off / cantilever.LENGTH


@pytest.mark.parametrize(
    ("intervals", "variant"),
    [(64, Variant("ANS3DEAS")), (32, Variant("MI9K3DEAS")), (64, TIED)],
    ids=lambda value: getattr(value, "label", None),
)
def test_roll_up_to_a_full_circle(intervals, variant, book):
    """The closed form is that of a thin beam; (k h)² = 0.4 % is what it neglects."""
    rotation, distance = rolled_up(variant, intervals)
    name = f"{variant.label}, {variant.cells(intervals)} elements"
    book("cantilever, rolled to a circle", name, "rotation of the end / 2 pi", 1.0, rotation)
    assert rotation == pytest.approx(1.0, abs=0.004)
    assert distance < 0.004


def test_rolled_up_thinner_it_meets_the_closed_form():
    """What is left over falls with the square of the thickness."""
    quadratic = Variant("MI9K3DEAS")
    errors = [rolled_up(quadratic, 32, thickness=h)[0] - 1 for h in (0.2, 0.1)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)
    assert rolled_up(quadratic, 32, thickness=0.05)[0] == pytest.approx(1.0, abs=0.0005)


def test_tying_of_E33_lets_a_coarse_ring_close():
    """16 elements turn by 22.5 degrees each: without tying they do not carry the moment of the full circle."""
    rotation, _ = rolled_up(TIED, 16)
    assert rotation == pytest.approx(1.0, abs=0.025)
    with pytest.raises(uf.errors.NoConvergence):
        rolled_up(Variant("ANS3DEAS"), 16)
