"""Correlations of parameters, and their covariance."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.studies.scatter.source import Source

Floats = NDArray[np.float64]
#: Round-off of an eigenvalue.
_ROUND_OFF = 1e-12


def covariance(
    sources: Sequence[Source], correlations: Mapping[tuple[str, str], float], path_of: Callable[[str], str]
) -> Floats:
    """Covariance of parameters.

    Parameters
    ----------
    sources : sequence of Source
        The parameters with their standard deviations.
    correlations : mapping of tuple of str to float
        Coefficients of correlation by pairs of names; other pairs are independent.
    path_of : callable
        Path of a name.

    Raises
    ------
    InvalidValue
        A parameter that does not scatter, a coefficient beyond ±1, or correlations that exclude each other.
    """
    paths = [one.path for one in sources]
    matrix = np.eye(len(paths))
    for (one, other), number in correlations.items():
        row, column = (_index(paths, path_of(name), f"{one},{other}") for name in (one, other))
        if row == column or not abs(number) <= 1.0:
            raise InvalidValue(
                "a correlation is a number from -1 to 1 between two parameters",
                where="correlations",
                value=f"{one},{other}={number:g}",
                cause="twice the same parameter" if row == column else "",
                remedy="two names and a number, such as thickness,strength=0.5",
            )
        matrix[row, column] = matrix[column, row] = number
    least = float(np.linalg.eigvalsh(matrix)[0])
    if least < -_ROUND_OFF:
        raise InvalidValue(
            "these correlations exclude each other",
            where="correlations",
            value=", ".join(f"{one},{other}={number:g}" for (one, other), number in correlations.items()),
            cause=f"their matrix is not positive definite: its smallest eigenvalue is {least:.3g}",
            remedy="smaller coefficients, or one for each pair of the parameters that depend on each other",
        )
    deviations = np.array([one.deviation for one in sources])
    found: Floats = matrix * np.outer(deviations, deviations)
    return found


def _index(paths: Sequence[str], path: str, pair: str) -> int:
    if path not in paths:
        raise InvalidValue(
            "a parameter of a correlation does not scatter",
            where="correlations",
            value=pair,
            cause=f"{path} has no scatter",
            remedy=f"a scatter for it too, or one of {', '.join(paths)}",
        )
    return paths.index(path)
