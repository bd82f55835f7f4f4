"""Forces are the derivative of the energy of an element, for every elastic law."""

from __future__ import annotations

import numpy as np
import pytest

from umform.elements import CATALOGUE
from umform.materials import UserLaw


def quadratic(E, state):
    C = np.diag([500.0, 300.0, 200.0, 90.0, 60.0, 70.0])
    return E @ C, np.tile(C, (len(E), 1, 1)), state


def stored(E, state):
    return 0.5 * (E * quadratic(E, state)[0]).sum(axis=1), np.zeros(len(E))


@pytest.mark.parametrize("rolling", [None, (1.0, 2.0, 0.0)])
@pytest.mark.parametrize("law", ["svk", "neo-hooke", "neo-hooke-power", "orthotropic"])
@pytest.mark.parametrize("name", CATALOGUE)
def test_force_is_the_derivative_of_the_energy(build, materials, name, law, rolling):
    material = UserLaw(quadratic, energy=stored) if law == "orthotropic" else materials[law]
    one = build.one_element(name, material, rolling=rolling)
    u = one.displacement()

    def energy(v):
        one.settle(v)
        one.block.commit()
        elastic, plastic = one.block.energy(v)
        assert plastic == 0.0
        return elastic

    _, f = one(u)
    for _ in range(3):
        du = one.displacement()
        slope = build.central_difference(energy, u, du, h=1e-4)
        assert f @ du == pytest.approx(slope, rel=1e-6, abs=1e-7 * np.abs(f).max() * np.abs(du).max())
