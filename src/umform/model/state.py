"""The state of a model: all that a converged increment is."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from umform.model.term import Tree

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Snapshot:
    """A converged state that a model can be put back to.

    Poses of tools follow from the controls, the scalar unknowns and the time.

    Attributes
    ----------
    u : ndarray, shape (3 n,)
        Displacement.
    time, began : float
        Time, and that at which its increment began.
    controls : dict of str to float
        Value of each control, by its name.
    unknowns : dict of str to float
        Value of each scalar unknown, by its name.
    terms : dict of str to Tree
        History of each term that has one, by its key.
    supports : dict of str to Tree
        Of each support that has been removed, or is to be: whether it acts, where, and the forces in its place.
    """

    u: Floats
    time: float = 0.0
    controls: dict[str, float] = field(default_factory=dict)
    unknowns: dict[str, float] = field(default_factory=dict)
    terms: dict[str, Tree] = field(default_factory=dict)
    supports: dict[str, Tree] = field(default_factory=dict)
    began: float = 0.0
