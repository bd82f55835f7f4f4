"""A dead load: a factor times a fixed vector of nodal forces."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.model.terms.control import Control, Twins
from umform.model.terms.cut import Cut
from umform.model.terms.term import At, Found, Into, Term

Floats = NDArray[np.float64]


@dataclass(eq=False, repr=False)
class Load(Control, Term):
    """A dead load: the factor ``value`` times a fixed vector of nodal forces."""

    vector: Floats = field(default_factory=lambda: np.empty(0))

    timed_as = "contact"

    def moves_with(self, rates: Mapping[Control, float]) -> bool:
        """Whether the load has a rate."""
        return rates.get(self, 0.0) != 0.0

    def evaluate(self, at: At, into: Into) -> Found:
        """Subtract the load from the internal forces, and its rate from the predictor."""
        rate, value = at.rates.get(self, 0.0), at.values[self]
        if self in at.rates:
            np.subtract(into.predictor, rate * self.vector, out=into.predictor)
        if value == 0.0:
            return Found()
        np.subtract(into.residual, value * self.vector, out=into.residual)
        return Found(value**2 * float(self.vector @ self.vector))

    def external_forces(self, at: At) -> Floats:
        """The load."""
        return at.values[self] * self.vector

    def strip(self, bare: Any, twins: Twins) -> None:
        """Without its vector."""
        bare.vector = np.empty(0)

    def piece(self, cut: Cut) -> Floats:
        """Forces at the nodes of the rank; those on a shared node count on its owner."""
        vector = np.zeros((len(cut.nodes), 3))
        vector[cut.owned] = self.vector.reshape(-1, 3)[cut.nodes[cut.owned]]
        return vector.ravel()

    def fill(self, piece: Any, mesh: Any) -> None:
        """Set the forces."""
        self.vector = piece
