"""Cantilever strip of Sze et al. (2004): bent by an end shear force, and rolled up by an end moment.

Length 10, width 1, thickness 0.1, E = 1.2e6, nu = 0.
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest

import umform as uf

from .cases import table

LENGTH, WIDTH, THICKNESS, E = 10.0, 1.0, 0.1, 1.2e6
SHEAR_FORCE = 4.0


def cantilever(cells: int, element: str = "ANS3DEAS", thickness: float = THICKNESS, **options) -> uf.Model:
    cell = uf.elements.element(element).cell
    mesh = uf.mesh.strip(LENGTH, WIDTH, thickness, (cells, 1), cell=cell)
    model = uf.Model(mesh, element, material=uf.SVK(E=E, nu=0.0), **options)
    model.fix("x0")
    return model


def displacement_of_tip(model: uf.Model) -> np.ndarray:
    return model.u.reshape(-1, 3)[model.mesh.nodes("x1")].mean(axis=0)


# End shear ------------------------------------------------------------------------------------------------------------


def end_shear_curve(cells: int, element: str = "ANS3DEAS", steps: int = 20, **options) -> np.ndarray:
    """Displacement of the tip after each of equal steps up to the full load; shape (steps, 3)."""
    model = cantilever(cells, element, **options)
    load = model.traction("x1", (0, 0, 1 / (WIDTH * THICKNESS)), "shear")
    tip = []
    for fraction in np.arange(1, steps + 1) / steps:
        uf.solve(model, uf.Move(load, SHEAR_FORCE * fraction, steps=1), frames=0)
        tip.append(displacement_of_tip(model))
    return np.array(tip)


@pytest.mark.parametrize(
    ("cells", "element", "tolerance"), [(16, "ANS3DEAS", 0.01), (32, "ANS3DEAS", 0.002), (8, "MI9K3DEAS", 0.002)]
)
def test_end_shear(cells, element, tolerance, book):
    """The whole curve, errors relative to its last value, 6.698 for the deflection."""
    reference = table("sze_end_shear.csv")
    tip = end_shear_curve(cells, element)
    assert reference["w_tip"][-1] == 6.698
    book("cantilever, end shear", f"{element}, {cells} elements", "deflection of the tip", 6.698, tip[-1, 2])
    assert tip[:, 2] == pytest.approx(reference["w_tip"][1:], abs=tolerance * reference["w_tip"][-1])
    assert -tip[:, 0] == pytest.approx(reference["minus_u_tip"][1:], abs=tolerance * reference["minus_u_tip"][-1])


def test_error_falls_with_the_square_of_the_element_length():
    deflection = [end_shear_curve(cells, steps=4, tie_E33=True)[-1, 2] for cells in (8, 16, 32)]
    ratio = (deflection[1] - deflection[0]) / (deflection[2] - deflection[1])
    assert ratio == pytest.approx(4.0, rel=0.1)


def test_newton_converges_quadratically():
    """The last iteration gains twice the digits of the one before it.

    Looked at in the second half of the load: before, the last iterations are not yet in the quadratic range.
    """
    model = cantilever(16)
    load = model.traction("x1", (0, 0, 1 / (WIDTH * THICKNESS)), "shear")
    result = uf.solve(model, uf.Move(load, SHEAR_FORCE, steps=20), frames=0)
    assert max(result["iterations"]) <= 7
    for iterations in result.iterations[10:]:
        digits = -np.diff([np.log10(record.energy) for record in iterations if record.energy > 0])
        assert digits[-1] / digits[-2] == pytest.approx(2.0, abs=0.3)


# Roll-up --------------------------------------------------------------------------------------------------------------


def rolled_up(cells: int, element: str, turn: float = 2 * pi, thickness: float = THICKNESS, steps: int = 20, **options):
    """Rotation and position of the end under the moment E I turn / length, over its closed form.

    The moment is a couple of line loads on the upper and lower edge of the end. They are dead loads, but
    their direction is set in each step to be normal to the director of the closed form. A director that is
    off by delta gets the moment times cos(delta): an error of second order in the error of the solution.
    """
    model = cantilever(cells, element, thickness, **options)
    moment = E * thickness**3 / 12 * turn / LENGTH
    edges = [(side, axis) for side in ("upper", "lower") for axis in range(2)]
    loads = [model.line_load("x1", side, np.eye(3)[2 * axis], f"{side}{axis}") for side, axis in edges]

    def path(side: str, axis: int):
        sign = -1.0 if side == "upper" else 1.0
        return lambda t: sign * moment * t / thickness * (cos, sin)[axis](turn * t)

    uf.solve(model, uf.Move(loads, [path(*edge) for edge in edges], steps=steps), frames=0)
    x = model.mesh.points + model.u.reshape(-1, 3)
    upper, lower = (x[model.mesh.nodes(f"x1_{side}")].mean(axis=0) for side in ("upper", "lower"))
    director, end = upper - lower, 0.5 * (upper + lower)
    off = np.arctan2(-director[0], director[2]) - turn
    rotation = turn + (off + pi) % (2 * pi) - pi
    closed_form = LENGTH / turn * np.array([sin(turn), 0.0, 1 - cos(turn)])
    return rotation / turn, np.abs(end - [0, WIDTH / 2, 0] - closed_form).max() / LENGTH


@pytest.mark.parametrize(
    ("cells", "element", "options"),
    [(64, "ANS3DEAS", {}), (16, "MI9K3DEAS", {}), (64, "ANS3DEAS", {"tie_E33": True})],
    ids=["ANS3DEAS", "MI9K3DEAS", "ANS3DEAS, E_33 tied"],
)
def test_roll_up_to_a_full_circle(cells, element, options, book):
    """The closed form is that of a thin beam; (k h)² = 0.4 % is what it neglects."""
    rotation, distance = rolled_up(cells, element, **options)
    tied = ", E_33 tied" if options else ""
    book(
        "cantilever, rolled to a circle",
        f"{element}{tied}, {cells} elements",
        "rotation of the end / 2 pi",
        1.0,
        rotation,
    )
    assert rotation == pytest.approx(1.0, abs=0.004)
    assert distance < 0.004


def test_rolled_up_thinner_it_meets_the_closed_form():
    """What is left over falls with the square of the thickness."""
    errors = [rolled_up(16, "MI9K3DEAS", thickness=h)[0] - 1 for h in (0.2, 0.1)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)
    assert rolled_up(16, "MI9K3DEAS", thickness=0.05)[0] == pytest.approx(1.0, abs=0.0005)


def test_tying_of_E33_lets_a_coarse_ring_close():
    """16 elements turn by 22.5 degrees each: without tying they do not carry the moment of the full circle."""
    rotation, _ = rolled_up(16, "ANS3DEAS", tie_E33=True)
    assert rotation == pytest.approx(1.0, abs=0.025)
    with pytest.raises(uf.errors.NoConvergence):
        rolled_up(16, "ANS3DEAS")
