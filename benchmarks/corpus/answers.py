"""What is known of the answers of a job without another code: symmetry, tools that carry each other, other units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

import umform as uf
from umform.analysis.steps import Step
from umform.problem.findings import accept
from umform.problem.plausible import of_model

Floats = NDArray[np.float64]

#: Images in the plane x = 0, in the plane y = 0, and in the plane x = y.
LEFT_RIGHT, FRONT_BACK = np.diag([-1.0, 1.0, 1.0]), np.diag([1.0, -1.0, 1.0])
DIAGONAL = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


@dataclass
class Answer:
    """What a job gave.

    Attributes
    ----------
    results : list of Result
        Runs whose balances are watched.
    symmetry, tools : list of float
        Deviations of symmetric, mirrored or scaled answers; and sums of the forces of tools that carry each other.
    trim : float, optional
        Elastic energy that a cut has added, over that before.
    """

    results: list[uf.Result]
    symmetry: list[float] = field(default_factory=list)
    tools: list[float] = field(default_factory=list)
    trim: float | None = None


def solve(model: uf.Model, steps: Sequence[Step] | Step, **options: Any) -> uf.Result:
    """Refuse what `umform check` refuses, and run."""
    accept(of_model(model, [steps] if isinstance(steps, Step) else steps))
    return uf.solve(model, steps, frames=0, progress=False, **options)


def unlike(one: uf.Model, other: uf.Model, image: Floats, scale: float = 1.0) -> float:
    """Largest difference of the displacements of a model from the image of those of another, over the largest one.

    Parameters
    ----------
    one, other : Model
        Both may be the same; the nodes of the first lie where the images of the nodes of the second do.
    image : ndarray, shape (3, 3)
        Reflection.
    scale : float
        Unit of length of the second over that of the first.
    """
    X, Y = one.mesh.points, scale * other.mesh.points @ image
    u, v = one.u.reshape(-1, 3), scale * other.u.reshape(-1, 3) @ image
    distances, nodes = cKDTree(X).query(Y)
    if not distances.max() < 1e-9 * np.ptp(X, axis=0).max():
        raise ValueError(f"a node has no image: the nearest one is {distances.max():.3g} away")
    return float(np.abs(u[nodes] - v).max() / np.abs(u).max())


def carried(result: uf.Result, tools: Sequence[str], axis: str = "z") -> float:
    """Largest sum of the forces of tools that carry each other, over the largest of them."""
    forces = np.array([result[f"{tool}_f{axis}"] for tool in tools])
    return float(np.abs(forces.sum(axis=0))[1:].max() / np.abs(forces).max())
