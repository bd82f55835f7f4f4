"""Terms: contributions to residual and tangent. Bodies, contacts, pressures, loads, tools, or your own.

`Model.evaluate` is a loop over terms. A term couples degrees of freedom, adds its forces and its tangent, returns its
results, and owns its history. docs/architecture.md
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.model.terms.control import Control, Twins
from umform.model.terms.cut import Cut
from umform.model.terms.frozen import Frozen
from umform.model.terms.into import At, Border, Global, Into
from umform.ranks import Ranks

__all__ = ["At", "Border", "Energies", "Found", "Global", "Into", "Term", "Tree"]

Floats = NDArray[np.float64]
Ids = NDArray[np.int32]

#: State of a term: numbers, texts and arrays by name, which may nest. The schema of snapshots, checkpoints and ranks.
Tree = dict[str, Any]


@dataclass(frozen=True)
class Found:
    """Results of the evaluation of a term, besides its forces and its tangent.

    Attributes
    ----------
    force_scale_squared : float
        Sum of the squares of its element forces. eq. (5.8)
    round_off_squared : float
        Square of the change of its residual per relative error of all positions. eq. (5.36)
    failed : int
        First cell whose evaluation failed, or -1.
    failure : str
        Cause of that failure.
    kept : bool
        Whether tools hold open points, so that this is no state of equilibrium. eq. (4.230)
    """

    force_scale_squared: float = 0.0
    round_off_squared: float = 0.0
    failed: int = -1
    failure: str = ""
    kept: bool = False

    @property
    def status(self) -> NDArray[np.uint8]:
        """For each contact point 0 if it is open, 1 if a tool holds it, 2 if it also slips; empty for most terms."""
        return np.zeros(0, dtype=np.uint8)

    @property
    def active(self) -> NDArray[np.bool_]:
        """Mask of the points in contact; empty for most terms."""
        return self.status > 0

    @property
    def flowing(self) -> NDArray[np.uint8]:
        """1 for each point whose history the evaluation has changed, else 0; empty for most terms."""
        return np.zeros(0, dtype=np.uint8)


@dataclass(frozen=True)
class Energies:
    """Energies of a model or of a term.

    Attributes
    ----------
    elastic : float
        Energy of elastic strains, springs and foundations; NaN if a law does not know it.
    plastic : float
        Plastic work so far: heat, and energy stored by hardening. NaN if unknown.
    contact : float
        Energy of penalty and multipliers of all contacts; for cells the work of their pressure so far.
    friction : float
        Work of friction so far.
    """

    elastic: float = 0.0
    plastic: float = 0.0
    contact: float = 0.0
    friction: float = 0.0

    @property
    def total(self) -> float:
        """Their sum."""
        return self.elastic + self.plastic + self.contact + self.friction


class Term(Frozen):
    """Something that adds to the residual; a derived class overrides what differs from zero.

    Attributes
    ----------
    name : str
        For messages, files and the history.
    symmetric : bool
        Whether its tangent is symmetric.
    timed_as : str
        Part of the timing to which its evaluation counts.
    within_bodies : bool
        Whether it couples only degrees of freedom that bodies already couple.
    by_pattern : bool
        Whether it adds its tangent by the pattern itself, because its couplings change; else by scatter maps.
    smooth : bool
        Whether its forces are a smooth function of the displacement.
    unknowns : tuple of Global
        Scalar unknowns that it adds.
    elsewhere : bool
        Whether the ranks of a run hold its history.
    rows : ndarray of int, optional
        On a rank: the local rows of its state over the whole model; None if the state has no rows.
    nodal : tuple of str
        Entries of its state with three values for each node, of which each rank has those of the nodes that it owns.
    before : ndarray
        History that the evaluation of the converged state used as input; empty if there is none.
    memory : tuple of str
        Names of the attributes that change in a run; all others are constant.
    """

    name: str = ""
    symmetric: bool = True
    timed_as: str = "elements"
    within_bodies: bool = False
    by_pattern: bool = False
    smooth: bool = True
    unknowns: tuple[Global, ...] = ()
    elsewhere: bool = False
    rows: NDArray[np.int64] | None = None
    nodal: tuple[str, ...] = ()
    before: Floats = np.empty(0)
    memory: tuple[str, ...] = ("elsewhere", "rows")

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r})"

    @property
    def key(self) -> str:
        """Kind and name: the key of its state."""
        return f"{type(self).__name__.lower()} {self.name}"

    def moves_with(self, rates: Mapping[Control, float]) -> bool:
        """Whether its forces change with controls of these rates at fixed nodes."""
        return False

    def couples(self) -> Sequence[_core.Connectivity]:
        """Nodes that its tangent couples: one connectivity for each kind of its parts."""
        return ()

    def covers(self, u: Floats) -> bool:
        """Whether :meth:`couples` has all that the tangent at a displacement couples; else it is asked again."""
        return True

    def evaluate(self, at: At, into: Into) -> Found:
        """Add residual and tangent; changes no converged history."""
        raise NotImplementedError

    def recover(self, du: Floats, mixed: bool) -> None:
        """Update condensed parameters after ``u += du``."""

    def follow(self) -> None:
        """After an evaluation of forces only: recover from them next, with the previous tangent."""

    def shorten(self, part: float) -> None:
        """Scale the change of the last :meth:`recover`."""

    def commit(self, found: Found) -> None:
        """Accept the trial history of ``found`` as converged."""

    def settled(self, model: Any, evaluation: Any) -> None:
        """Called after a commit of the model; may change what later increments use."""

    def revert(self) -> None:
        """Return to the converged history."""

    def go_back(self, before: Floats) -> None:
        """Restore the history that the evaluation of the converged state used as input, so that it can be repeated."""

    def state(self) -> Tree:
        """Converged history; empty where there is none."""
        return {}

    def restore(self, tree: Tree) -> None:
        """Restore a history from :meth:`state`."""

    def columns(self, found: Found, ranks: Ranks) -> dict[str, float]:
        """Its columns of the history."""
        return {}

    def column_names(self) -> Iterable[str]:
        """Names of its columns, which must be unique in a model."""
        return ()

    def energies(self, found: Found, u: Floats) -> Energies:
        """Its part of the energies of a converged state (on this rank)."""
        return Energies()

    def external_forces(self, at: At) -> Floats | None:
        """External forces on the nodes, shape (3 n,), for the balance; None if there are none.

        Their work is external work.
        """
        return None

    def support_forces(self, found: Found, at: At) -> Floats | None:
        """Forces of foundations on the nodes, an elastic foundation for instance; shape (3 n,).

        They count in the resultants; their work is part of :meth:`energies`.
        """
        return None

    def holds(self, at: At) -> tuple[Ids, Floats] | None:
        """Nodes (k,) that it constrains, and the direction (k, 3) of each; None if there are none.

        The check of supports uses them. A node may occur several times.
        """
        return None

    # Ranks ---------------------------------------------------------------------------------------------------

    @property
    def shareable(self) -> bool:
        """Whether it can be distributed: it defines the piece of each rank."""
        kind = type(self)
        return kind.strip is not Term.strip and kind.fill is not Term.fill

    def strip(self, bare: Self, twins: Twins) -> None:
        """Remove from a copy what grows with the mesh, and replace references by twins."""

    def piece(self, cut: Cut) -> Any:
        """The piece of a rank, removed by :meth:`strip`, in the numbering of the rank."""
        return None

    def fill(self, piece: Any, mesh: Any) -> None:
        """Give a stripped copy its piece, on the rank and its part of the mesh."""
