"""Change of a body between converged states: rotation of its fibres, plastic strain."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.history_variables import named
from umform.model.bodies.body import Body

Floats = NDArray[np.float64]


def turned(body: Body, before: Floats, after: Floats) -> float:
    """Largest angle in degrees by which a fibre through the thickness rotates between two displacements, (3 n,)."""
    X, cells = body.mesh.points, body.connectivity
    half = cells.shape[1] // 2
    lower, upper = cells[:, :half].ravel(), cells[:, half:].ravel()  # finding duplicates takes longer
    fibres = [_fibres(X + u.reshape(-1, 3), lower, upper) for u in (before, after)]
    chord = np.linalg.norm(fibres[1] - fibres[0], axis=1).max()
    return float(np.degrees(2.0 * np.arcsin(min(0.5 * chord, 1.0))))


def _fibres(x: Floats, lower: NDArray[np.int32], upper: NDArray[np.int32]) -> Floats:
    """Unit vectors from the lower to the upper nodes."""
    d = x[upper] - x[lower]
    return np.asarray(d / np.linalg.norm(d, axis=1)[:, None])


def strained(body: Body) -> float:
    """Largest increase of the accumulated plastic strain in the last increment; zero for laws without ``eqps``."""
    history_variables, state = body.block.history_variables, body.block.state
    if "eqps" not in history_variables or not body.before.size:
        return 0.0
    before, after = (named(history, history_variables)["eqps"] for history in (body.before.reshape(state.shape), state))
    return float((after - before).max())
