"""Weak springs on which a loose sheet rests until contact holds it. docs/theory, 4.18"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.history_variables import named
from umform.model.equations.checks import held_by_tools
from umform.model.terms.nodal_term import NodalFound, NodalTerm
from umform.model.terms.term import At, Found
from umform.ranks import Ranks

Floats = NDArray[np.float64]

#: Ratio of the forces of the springs to those of contact below which the springs are removed.
_NEGLIGIBLE = 1e-3


class Rest(NodalTerm):
    """Springs between all nodes and their initial positions; removed permanently once tools hold the sheet.

    Parameters
    ----------
    name : str
        Columns of the history: ``<name>_energy`` of the springs, after their removal that at removal, and
        ``<name>_acts``, 1 while they act.
    u : ndarray, shape (3 n,)
        Displacement at which they have no force.
    stiffness : float
        Force per length of all springs together.
    motions : str
        Rigid-body motions for which a run added the springs; empty if the user did.
    """

    each_node = ("origin",)

    def __init__(self, name: str, u: Floats, stiffness: float, motions: str = "") -> None:
        self.motions = motions
        self.origin = u.reshape(-1, 3).copy()
        nodes = np.arange(len(self.origin), dtype=np.int32)
        super().__init__(name, nodes, history={"removed": 1, "energy at removal": 1})
        self.each = stiffness / len(self.origin)

    def respond(self, u: Floats, history: Floats, at: At) -> tuple[Floats, Floats, Floats]:
        """Linear springs, or zero."""
        stiffness = self.each * (1.0 - named(history, self.history_variables)["removed"])
        return stiffness * (u - self.origin), stiffness[:, :, None] * np.eye(3), history

    def energy(self, u: Floats, history: Floats) -> tuple[Floats, Floats]:
        """Energy of the springs while they act."""
        acts = 1.0 - named(history, self.history_variables)["removed"].ravel()
        stored = 0.5 * self.each * acts * ((u - self.origin) ** 2).sum(axis=1)
        return stored, np.zeros(len(u))

    def acts(self, ranks: Ranks) -> bool:
        """Whether the springs still act."""
        return ranks.any(bool((named(self.history, self.history_variables)["removed"] == 0.0).any()))

    def settled(self, model: Any, evaluation: Any) -> None:
        """Remove the springs once tools hold the sheet and the forces of the springs are negligible."""
        ranks, own = model.ranks, evaluation.found[self]
        if not self.acts(ranks):
            return
        bearing = ranks.sum(float(sum(evaluation.found[pair].held_force for pair in model.contacts)))
        springs = ranks.sum(float(np.abs(own.forces).sum()))
        if springs <= _NEGLIGIBLE * bearing and held_by_tools(model, evaluation):
            stored = self.energy(self._at_nodes(evaluation.u), self.history)[0]
            self.history = np.empty_like(self.history)
            parts = named(self.history, self.history_variables)
            parts["removed"][:], parts["energy at removal"][:] = 1.0, stored[:, None]

    def columns(self, found: Found, ranks: Ranks) -> dict[str, float]:
        """Energy, and whether the springs act, at the evaluated state."""
        assert isinstance(found, NodalFound)
        acts = self.acts(ranks)
        squares = (found.forces**2).sum() / (2.0 * self.each)
        at_removal = named(self.history, self.history_variables)["energy at removal"]
        energy = ranks.sum(float(squares if acts else at_removal.sum()))
        return {f"{self.name}_energy": energy, f"{self.name}_acts": float(acts)}

    def column_names(self) -> Iterable[str]:
        """Energy, and whether the springs act."""
        return [f"{self.name}_energy", f"{self.name}_acts"]
