"""Controls: quantities that a step can prescribe, each with a value and a conjugate force."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from umform.model.terms.cut import Cut
from umform.ranks import Ranks

Floats = NDArray[np.float64]
Ids = NDArray[np.int32]
_T = TypeVar("_T")


class Seen(Protocol):
    """Results of an evaluation that a control needs for its force."""

    @property
    def residual(self) -> Floats:
        """Residual at all degrees of freedom; reactions where they are held, prescribed or tied."""

    @property
    def found(self) -> Mapping[Any, Any]:
        """Results of each term."""

    @property
    def controls(self) -> Mapping[Control, float]:
        """Values of the controls."""

    @property
    def time(self) -> float:
        """Time."""


@dataclass(eq=False)
class Control:
    """A quantity with one value that a step can prescribe: a displacement, a load factor, a tool.

    Attributes
    ----------
    name : str
        Column of the history; the conjugate force is ``<name>_force``.
    value : float
        Present value: displacement or factor.
    """

    name: str
    value: float = 0.0

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r}, value={self.value:g})"

    def force(self, evaluation: Seen, ranks: Ranks) -> float:
        """Its conjugate force: a sum of reactions, the force on a tool along its direction, or the load itself."""
        return self.value

    def displace(self, u: Floats, value: float) -> None:
        """Write the displacement that it prescribes into u, shape (3 n,); most controls prescribe none."""

    # Ranks ---------------------------------------------------------------------------------------------------

    def strip(self, bare: Any, twins: Twins) -> None:
        """Remove from a copy what grows with the mesh, and replace references by twins."""

    def piece(self, cut: Cut) -> Any:
        """The piece of a rank, removed by :meth:`strip`, in the numbering of the rank."""
        return None

    def fill(self, piece: Any, mesh: Any) -> None:
        """Give a stripped copy its piece, on the rank and its part of the mesh."""


@dataclass(eq=False, repr=False)
class OnDofs(Control):
    """A control of the displacement at some degrees of freedom; its force is the sum of the reactions there.

    Attributes
    ----------
    dofs : ndarray of int
        The degrees of freedom.
    along : ndarray, shape (3 n,), optional
        Displacement for the value 1, where supports in local axes couple more degrees of freedom to these.
    """

    dofs: Ids = field(default_factory=lambda: np.empty(0, dtype=np.int32))
    along: Floats | None = None

    def force(self, evaluation: Seen, ranks: Ranks) -> float:
        """Sum of the reactions on the sheet."""
        if self.along is not None:
            return ranks.sum(float(evaluation.residual[: self.along.size] @ self.along))
        return ranks.sum(float(evaluation.residual[self.dofs].sum()))

    def displace(self, u: Floats, value: float) -> None:
        """Write the value at the degrees of freedom."""
        u[self.dofs] = value

    def strip(self, bare: Any, twins: Twins) -> None:
        """Without degrees of freedom."""
        bare.dofs = np.empty(0, dtype=np.int32)

    def piece(self, cut: Cut) -> Ids:
        """The degrees of freedom on the rank."""
        dofs = cut.dofs(self.dofs)
        return dofs[dofs >= 0]

    def fill(self, piece: Any, mesh: Any) -> None:
        """Set the degrees of freedom."""
        self.dofs = piece


@dataclass(eq=False, repr=False)
class Prescribed(OnDofs):
    """Displacement of nodes in one direction; its force is the sum of the reactions on the sheet."""


class Twins:
    """Copies of controls and terms without data that grow with the mesh, with the references of the originals."""

    def __init__(self) -> None:
        self._twin: dict[int, Any] = {}
        self._kept: list[Any] = []  # an id is unique only while the object lives

    def of(self, thing: _T) -> _T:
        """The twin of a control or a term; always the same object."""
        if id(thing) not in self._twin:
            bare = copy.copy(thing)
            self._twin[id(thing)] = bare
            self._kept.append(thing)
            thing.strip(bare, self)  # type: ignore[attr-defined]
        return self._twin[id(thing)]  # type: ignore[no-any-return]

    def rates(self, rates: Mapping[Control, float]) -> dict[Control, float]:
        """A mapping of controls with the twins as its keys."""
        return {self.of(control): rate for control, rate in rates.items()}
