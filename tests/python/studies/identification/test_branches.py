"""A run at measured abscissae."""

import numpy as np
import pytest

from umform.studies.identification.branches import at_abscissae, branches


def test_a_column_is_divided_where_it_turns_and_not_where_it_trembles():
    assert branches(np.array([0.0, 1.0, 0.999, 2.0, 3.0])) == [(0, 4)]
    assert branches(np.array([0.0, 1.0, 2.0, 2.0, 1.0, -1.0, 0.0])) == [(0, 3), (3, 5), (5, 6)]
    assert branches(np.array([0.0, -1.0, -2.0, -1.0])) == [(0, 2), (2, 3)]


def run(p):
    """Abscissae and ordinates of rows that move with a parameter: up, and down on another curve."""
    t = np.linspace(0.0, 2.0, 41)
    X = p * np.minimum(t, 2.0 - t)
    return X, np.where(t <= 1.0, p**2 * np.sin(X), p**2 * np.sin(p) - 3.0 * (p - X))


def test_ordinates_and_their_derivatives_at_abscissae_that_the_rows_do_not_have():
    p, e = 1.3, 1e-6
    x = np.array([0.11, 0.52, 0.97, 1.29, 1.1, 0.4])
    (X, Y), (X2, Y2) = run(p), run(p + e)
    slopes = ((X2 - X)[:, None] / e, (Y2 - Y)[:, None] / e)
    found = list(at_abscissae(x, (X, Y), slopes))
    again = list(at_abscissae(x, (X2, Y2), slopes))
    assert [one[0] for one in found[:4]] == pytest.approx(p**2 * np.sin(x[:4]), rel=1e-3)
    assert [one[0] for one in found[4:]] == pytest.approx(p**2 * np.sin(p) - 3.0 * (p - x[4:]), rel=1e-3)
    differences = [(b[0] - a[0]) / e for a, b in zip(found, again, strict=True)]
    assert [float(one[1][0]) for one in found] == pytest.approx(differences, rel=1e-4)
    assert max(one[2] for one in found) == 0.0


def test_how_far_an_abscissa_is_beyond_the_run():
    X, Y = np.array([0.0, 1.0, 2.0]), np.array([0.0, 2.0, 3.0])
    zero = np.zeros((3, 1))
    found = list(at_abscissae(np.array([-0.5, 1.5, 2.5]), (X, Y), (zero, zero)))
    assert [one[0] for one in found] == [-1.0, 2.5, 3.5]
    assert [one[2] for one in found] == [0.5, 0.0, 0.5]
    down = list(at_abscissae(np.array([1.0, 2.0, 0.5]), (np.array([0.0, 2.0, 1.2]), Y), (zero, zero)))
    assert [one[2:] for one in down] == [(0.0, (0.0, 2.0)), (0.0, (0.0, 2.0)), (0.7, (2.0, 1.2))]
