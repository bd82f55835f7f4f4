"""A run at measured abscissae: the column of the history there, and its derivatives."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: Turns smaller than this part of the range of a column are noise.
NOISE = 0.01


def branches(values: Floats) -> list[tuple[int, int]]:
    """First and last row of each part of a column that rises or falls."""
    noise = NOISE * float(np.ptp(values))
    ends, direction, extreme = [0], 0.0, 0
    for row in range(1, len(values)):
        ahead = direction * (values[row] - values[extreme])
        if direction == 0.0:
            if abs(values[row] - values[0]) > noise:
                direction, extreme = float(np.sign(values[row] - values[0])), row
        elif ahead >= 0.0:
            extreme = row
        elif ahead < -noise:
            ends.append(extreme)
            direction, extreme = -direction, row
    return list(zip(ends, [*ends[1:], len(values) - 1], strict=True))


def at_abscissae(
    x: Floats, columns: tuple[Floats, Floats], derivatives: tuple[Floats, Floats]
) -> Iterator[tuple[float, Floats, float, tuple[float, float]]]:
    """Ordinate of a run at each abscissa, its derivatives, how far the abscissa is beyond its branch, and its ends.

    A point of the k-th branch of the abscissae is looked for on the k-th branch of the run. Between two rows both
    columns are linear; the rows move with the parameters, eq. (5.171).

    Parameters
    ----------
    x : ndarray, shape (m,)
        Measured abscissae in the order of time.
    columns : tuple of ndarray, shape (r,)
        Abscissae and ordinates of the run.
    derivatives : tuple of ndarray, shape (r, n)
        Their derivatives.
    """
    X, Y = columns
    dX, dY = derivatives
    of_run = branches(X)
    for number, (first, last) in enumerate(branches(x)):
        begin, end = of_run[number]
        sign = 1.0 if X[end] >= X[begin] else -1.0
        way = np.maximum.accumulate(sign * X[begin : end + 1])
        for value in x[first + (number > 0) : last + 1]:
            row = begin + int(np.clip(np.searchsorted(way, sign * value), 1, len(way) - 1))
            while row > begin + 1 and X[row] == X[row - 1]:
                row -= 1
            step = X[row] - X[row - 1]
            t = (value - X[row - 1]) / step if step else 1.0
            slope = (Y[row] - Y[row - 1]) / step if step else 0.0
            beyond = max(way[0] - sign * value, sign * value - way[-1], 0.0)
            inner = (1.0 - t) * (dY[row - 1] - slope * dX[row - 1]) + t * (dY[row] - slope * dX[row])
            yield float(Y[row - 1] + t * (Y[row] - Y[row - 1])), inner, float(beyond), (float(X[begin]), float(X[end]))
