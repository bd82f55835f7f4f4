"""The present state of a model, shared by its parts."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(eq=False)
class Now:
    """The present state.

    Attributes
    ----------
    u : ndarray, shape (3 n,)
        Displacement.
    time : float
        Time.
    converged, began : float
        Time at the end and at the beginning of the last increment.
    revision : int
        How often the structure of the tangent has changed: supports, terms, contacts.
    """

    u: Floats = field(default_factory=lambda: np.empty(0))
    time: float = 0.0
    converged: float = 0.0
    began: float = 0.0
    revision: int = 0

    def restructured(self) -> None:
        """Rebuild pattern and maps at the next evaluation."""
        self.revision += 1

    def strip(self, bare: Any, twins: Any) -> None:
        """Without the displacement."""
        bare.u = np.empty(0)
