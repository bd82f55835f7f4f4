"""Initial guess for a sheet between tools that hold it only in another position: it moves as a rigid body."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.model.equations.checks import left_free, middle, motion_along
from umform.model.terms.forces import rigid_body_modes
from umform.model.terms.state import State

Floats = NDArray[np.float64]

#: Largest motion in a pass, and a motion that ends the passes, relative to the thickness.
_FARTHEST, _NONE = 2.0, 1e-4
#: Passes at most: normals and gaps follow the motion.
_PASSES = 4
#: Cost of a motion relative to that of the same penetration: of equal penetrations the nearest position counts.
_COST_OF_MOTION = 1e-3


def rigid_start(model: Model, goal: State) -> Floats | None:
    """Rigid motion of the sheet to the position with the least penetration into its tools. eq. (4.260)

    Parameters
    ----------
    model : Model
        In one process.
    goal : State
        The goal of the increment, with the poses of the tools.

    Returns
    -------
    ndarray, shape (3 n + k,), or None
        The displacement, zero at scalar unknowns. None if supports hold the sheet, or if the tools leave it room:
        then no position is determined.
    """
    from scipy.optimize import linprog  # a fifth of a second, and rarely needed

    size, start, depth = model.u.size, np.zeros_like(goal.x), 0.0
    values = model.controls.values_at(goal)
    for _ in range(_PASSES):
        u = model.u + start[:size]
        points = model.mesh.displaced(u)
        centre, extent = middle(model.system, points)
        modes = rigid_body_modes(points, centre, extent)
        free = left_free(model.system, modes)
        found = [pair.locate(u, pair.tool.pose(values, goal.time)) for pair in model.contacts if not pair.tool.open]
        gap = np.concatenate([at.gap for at in found])
        rows = np.concatenate([motion_along(at.x, at.normal, centre, extent) for at in found]) @ free.T
        known = np.isfinite(gap) & np.isfinite(rows).all(axis=1)
        if len(free) == 0 or not known.any():
            return None
        rows, gap = rows[known], gap[known]
        count, far = len(free), _FARTHEST * model.system.thickness
        answer = linprog(
            [_COST_OF_MOTION] * (2 * count) + [1.0],
            A_ub=np.column_stack([-rows, rows, -np.ones(len(rows))]),
            b_ub=gap,
            bounds=[(0.0, far)] * (2 * count) + [(0.0, None)],
            method="highs-ds",
        )
        if answer.x is None:
            return None
        motion, depth = answer.x[:count] - answer.x[count:-1], float(answer.x[-1])
        start[:size] += motion @ free @ modes
        if np.abs(motion).max() < _NONE * model.system.thickness:
            break
    return start if depth > 0.0 else None
