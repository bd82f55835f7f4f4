"""A bar pulled homogeneously far into plastic flow: what the number of enhanced membrane modes costs in iterations.

In a converged plastic state every point lies on the yield surface up to round-off. If that decided what is plastic in
the first tangent of an increment, the tangent would be a patchwork; an increment predicted with it is not homogeneous,
and the more membrane modes an element has, the further it follows the patchwork. The law therefore has a margin of
1e-10 of the yield stress, and all elements take the same iterations.
"""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform_book.plastic.bars import THICKNESS, WIDTH, bar

HARDENING = uf.Linear(160.0, 500.0)
STEEL = uf.J2(kappa=175000, mu=80770, hardening=HARDENING)

ELEMENTS = {
    "ANS3DEAS": uf.elements.element("ANS3DEAS"),
    **{f"{modes} modes": uf.elements.element("EAS3DEAS", membrane_modes=modes) for modes in (4, 5, 7)},
}


def pull(name: str, elongation: float = 1.0, steps: int = 20, **options) -> uf.Result:
    model, end = bar(ELEMENTS[name], STEEL)
    return uf.solve(model, uf.Move(end, elongation, steps), options=uf.NewtonOptions(**options), frames=0)


@pytest.mark.parametrize("name", ELEMENTS)
def test_homogeneous_state(name):
    """Force and shape of uniaxial tension: sigma = y(eqps) on the area that elastic and plastic strains leave."""
    result = pull(name)
    model = result.model
    X, u = model.mesh.points, model.u.reshape(-1, 3)
    stretch = (u[X[:, 1] == WIDTH, 1].mean() / WIDTH, u[X[:, 2] > 0, 2].mean() / THICKNESS)
    assert stretch[0] == pytest.approx(stretch[1], rel=1e-9)
    assert u == pytest.approx(X * [0.1, stretch[0], stretch[1]] + [0, 0, THICKNESS / 2 * stretch[1]], abs=1e-9)
    # Kirchhoff stress tau = y(eqps), eps = tau / E + eqps, and the force is tau times V / l.
    axial = np.log(1.1)
    eqps = (axial * STEEL.E - HARDENING.yield_stress) / (STEEL.E + HARDENING.modulus)
    tau = HARDENING.yield_stress + HARDENING.modulus * eqps
    assert result["end_force"][-1] == pytest.approx(tau * WIDTH * THICKNESS / 1.1, rel=1e-9)


def test_extrapolated_steps_take_the_same_iterations():
    """4 in the first two steps, 3 in each of the others, whatever the modes."""
    iterations = {name: pull(name)["iterations"][1:].astype(int) for name in ELEMENTS}
    assert list(iterations["ANS3DEAS"]) == [4, 4] + 18 * [3]
    for name in ELEMENTS:
        assert list(iterations[name]) == list(iterations["ANS3DEAS"])


def test_steps_from_the_tangent_take_the_same_iterations():
    """Without the margin of the yield check: 97 for ANS3DEAS, 151, 161 and 364 for 4, 5 and 7 modes."""
    iterations = {name: pull(name, extrapolate=False)["iterations"].sum() for name in ELEMENTS}
    assert max(iterations.values()) <= 1.1 * iterations["ANS3DEAS"]
