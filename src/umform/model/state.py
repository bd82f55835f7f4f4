"""The converged state of a model."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from umform.model.term import Tree

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Snapshot:
    """A converged state to which a model can be restored.

    Poses of tools follow from the controls, the scalar unknowns and the time.

    Attributes
    ----------
    u : ndarray, shape (3 n,)
        Displacement.
    time, began : float
        Time at the end and at the beginning of its increment.
    controls : dict of str to float
        Value of each control, by its name.
    unknowns : dict of str to float
        Value of each scalar unknown, by its name.
    terms : dict of str to Tree
        History of each term that has one, by its key.
    supports : dict of str to Tree
        For each removed or removable support: whether it is active, its base displacement, and the replacing forces.
    """

    u: Floats
    time: float = 0.0
    controls: dict[str, float] = field(default_factory=dict)
    unknowns: dict[str, float] = field(default_factory=dict)
    terms: dict[str, Tree] = field(default_factory=dict)
    supports: dict[str, Tree] = field(default_factory=dict)
    began: float = 0.0
