"""The same run in other units takes the same iterations and gives the same numbers.

The promise: the same number of iterations in all increments, on the way down and on the way back, and each column of
the history and each field of the frames the same to 1e-8 of its largest value. What is measured is below 2e-10 for
forces, moments and penetrations (Newton leaves a residual of up to 1e-9 of the forces inside) and below 2e-11 for all
else; the secant of the release starts from those forces, and its path moves by 1e-11.
"""

from __future__ import annotations

import numpy as np
import pytest

from umform.analysis.run import solve
from umform.analysis.steps import Move, Release

UNITS = {
    "m-N-Pa": (1e-3, 1.0),
    "inch-lbf-psi": (1 / 25.4, 1 / 4.4482216152605),
    "km-MN": (1e-6, 1e-6),
}

#: Counts are the same, not nearly the same.
COUNTS = ("step", "iterations", "tool_active")

#: Powers of force and length in the unit of a column or field, by the end of its name; numbers have none.
DIMENSIONS = {
    ("punch", "penetration", "displacement", "gap"): (0, 1),
    ("_force", "_fx", "_fy", "_fz", "reaction"): (1, 0),
    ("_mx", "_my", "_mz", "_work", "_energy"): (1, 1),
    (
        "stress_cauchy",
        "stress_cauchy_local",
        "stress_pk2",
        "stress_pk2_local",
        "stress_von_mises",
        "contact_pressure",
    ): (1, -2),
    ("_penalty",): (1, -3),
}


def run(build, length_unit, force_unit, element, points):
    case = build.free_bending((10, 1), element, points, length_unit, force_unit)
    steps = [Move(case.punch, -4.0 * length_unit, steps=12), Release(case.punch)]
    return case, solve(case.model, steps, frames=1)


def unit(name, force, length):
    """Unit of a column or field."""
    f, el = next((powers for ends, powers in DIMENSIONS.items() if name.endswith(ends)), (0, 0))
    return force**f * length**el


def assert_same(name, found, expected):
    """To 1e-8 of the largest value; what is zero, or NaN where it has no meaning, is so in all units."""
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-8 * np.nanmax(np.abs(expected)), err_msg=name)


@pytest.mark.parametrize("units", UNITS)
@pytest.mark.parametrize(("element", "points"), [("ANS3DEAS", 2), ("MI9K3DEAS", 3)])
def test_other_units_take_the_same_iterations_to_the_same_numbers(build, units, element, points):
    length, force = UNITS[units]
    base, expected = run(build, 1.0, 1.0, element, points)
    case, result = run(build, length, force, element, points)
    assert len(result) == len(expected)
    assert result.columns() == expected.columns()
    for name in COUNTS:
        np.testing.assert_array_equal(result[name], expected[name], err_msg=name)
    for name in expected.columns():
        assert_same(name, result[name] / unit(name, force, length), expected[name])
    assert_same("u", case.model.u / length, base.model.u)
    assert len(result.frames) == len(expected.frames) >= 3
    for kind in ("points", "cells"):
        for name in getattr(expected.frames[0], kind):
            found, wanted = (
                np.array([getattr(frame, kind)[name] for frame in each.frames]) for each in (result, expected)
            )
            assert_same(name, found / unit(name, force, length), wanted)
