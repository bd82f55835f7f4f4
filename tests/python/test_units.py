"""The same run in other units takes the same iterations and gives the same numbers."""

from __future__ import annotations

import numpy as np
import pytest

from umform.steps import Move, Release, solve

UNITS = {
    "m-N-Pa": (1e-3, 1.0),
    "inch-lbf-psi": (1 / 25.4, 1 / 4.4482216152605),
    "km-MN": (1e-6, 1e-6),
}


def run(build, length_unit, force_unit, element, points):
    case = build.free_bending((10, 1), element, points, length_unit, force_unit)
    steps = [Move(case.punch, -4.0 * length_unit, steps=12), Release(case.punch)]
    return case, solve(case.model, steps, frames=1)


@pytest.mark.parametrize("units", UNITS)
@pytest.mark.parametrize(("element", "points"), [("ANS3DEAS", 2), ("MI9K3DEAS", 3)])
def test_other_units_take_the_same_iterations_to_the_same_numbers(build, units, element, points):
    L, force = UNITS[units]
    base, expected = run(build, 1.0, 1.0, element, points)
    case, result = run(build, L, force, element, points)
    np.testing.assert_array_equal(result["iterations"][:13], expected["iterations"][:13])
    assert len(result) == len(expected)
    peak = np.abs(expected["punch_force"]).max()
    np.testing.assert_allclose(result["punch"] / L, expected["punch"], atol=1e-8)
    np.testing.assert_allclose(result["punch_force"] / force, expected["punch_force"], atol=1e-8 * peak)
    np.testing.assert_allclose(result["tool_my"] / (force * L), expected["tool_my"], rtol=1e-8, atol=1e-6 * peak)
    np.testing.assert_array_equal(result["tool_active"], expected["tool_active"])
    np.testing.assert_allclose(case.model.u / L, base.model.u, atol=1e-7)
    stress = force / L**2
    one, other = result.frames[-1], expected.frames[-1]
    largest = np.abs(other.cells["stress_cauchy"]).max()
    np.testing.assert_allclose(one.cells["stress_cauchy"] / stress, other.cells["stress_cauchy"], atol=1e-6 * largest)
    np.testing.assert_allclose(one.cells["plastic_strain_max"], other.cells["plastic_strain_max"], atol=1e-9)
    np.testing.assert_allclose(one.points["thickness_change"], other.points["thickness_change"], atol=1e-8)
