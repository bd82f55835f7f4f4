"""What adds to residual and tangent: a term. Bodies, contacts, pressures, loads and tools are terms, or one of yours.

`Model.evaluate` is a loop over terms. A term couples degrees of freedom, adds its forces and its tangent, gives back
what it came across, and owns its history. docs/architecture.md
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.model.control import Control, Twins
from umform.model.cut import Cut
from umform.model.frozen import Frozen
from umform.model.into import At, Border, Global, Into
from umform.ranks import Ranks

__all__ = ["At", "Border", "Energies", "Found", "Global", "Into", "Term", "Tree"]

Floats = NDArray[np.float64]
Ids = NDArray[np.int32]

#: State of a term: numbers, texts and arrays by name, which may nest. The schema of snapshots, checkpoints and ranks.
Tree = dict[str, Any]


@dataclass(frozen=True)
class Found:
    """What came out of the evaluation of a term, beside its forces and its tangent.

    Attributes
    ----------
    force_scale_squared : float
        Sum of the squares of its element forces. eq. (5.8)
    round_off_squared : float
        Square of what a relative error of all positions makes of its residual, over that of the error. eq. (5.36)
    failed : int
        First cell without an answer, or -1.
    failure : str
        Why that cell has none.
    """

    force_scale_squared: float = 0.0
    round_off_squared: float = 0.0
    failed: int = -1
    failure: str = ""

    @property
    def status(self) -> NDArray[np.uint8]:
        """For each contact point 0 if it is open, 1 if a tool holds it, 2 if it slips as well; empty for most terms."""
        return np.zeros(0, dtype=np.uint8)

    @property
    def active(self) -> NDArray[np.bool_]:
        """Which points are in contact; empty for most terms."""
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
        Stored in elastic strains, springs and foundations; NaN if a law does not know it.
    plastic : float
        Work of the yield stress on the plastic strains so far: heat, and what hardening keeps. NaN if not known.
    contact : float
        Held by penalty and multipliers of all contacts; of cells the work of their pressure so far.
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
    """Something that adds to the residual; a new kind of it says what differs from nothing.

    Attributes
    ----------
    name : str
        For messages, files and the history.
    symmetric : bool
        Whether its tangent is symmetric.
    timed_as : str
        Part of the timing that its evaluation counts for.
    within_bodies : bool
        Whether it couples only what bodies couple already.
    unknowns : tuple of Global
        Scalar unknowns that it brings.
    elsewhere : bool
        Whether the ranks of a run have its history.
    rows : ndarray of int, optional
        On a rank: which rows of its state over the whole model are here; None if the state has no rows.
    nodal : tuple of str
        Entries of its state with three values for each node, of which each rank has those of the nodes that it owns.
    before : ndarray
        History that the evaluation of the converged state had read; empty where there is none.
    memory : tuple of str
        Names of the attributes that change in a run; all others say what the term is.
    """

    name: str = ""
    symmetric: bool = True
    timed_as: str = "elements"
    within_bodies: bool = False
    unknowns: tuple[Global, ...] = ()
    elsewhere: bool = False
    rows: NDArray[np.int64] | None = None
    nodal: tuple[str, ...] = ()
    before: Floats = np.empty(0)
    memory: tuple[str, ...] = ("elsewhere", "rows")

    @property
    def key(self) -> str:
        """Kind and name: under it the state of the term is kept."""
        return f"{type(self).__name__.lower()} {self.name}"

    def moves_with(self, rates: Mapping[Control, float]) -> bool:
        """Whether its forces change with controls that have these rates while the nodes are held."""
        return False

    def couples(self) -> Sequence[_core.Connectivity]:
        """Nodes that its tangent couples: one connectivity for each kind of its parts."""
        return ()

    def evaluate(self, at: At, into: Into) -> Found:
        """Add residual and tangent; changes no converged history."""
        raise NotImplementedError

    def recover(self, du: Floats, mixed: bool) -> None:
        """Update parameters that were condensed, after ``u += du``."""

    def follow(self) -> None:
        """After forces alone were evaluated: recover from them next, with the tangent of before."""

    def shorten(self, part: float) -> None:
        """Shorten the change of the last :meth:`recover` to a part of it."""

    def commit(self, found: Found) -> None:
        """Make the trial history that belongs to ``found`` the converged one."""

    def settled(self, model: Any, evaluation: Any) -> None:
        """Look at the model, which has just been committed at an evaluation, and change what later increments see."""

    def revert(self) -> None:
        """Go back to the converged history."""

    def go_back(self, before: Floats) -> None:
        """Take the history that the evaluation of the converged state had read, so that it can be repeated."""

    def state(self) -> Tree:
        """Converged history; empty where there is none."""
        return {}

    def restore(self, tree: Tree) -> None:
        """Put a history back that :meth:`state` has given."""

    def columns(self, found: Found, ranks: Ranks) -> dict[str, float]:
        """Its columns of the history."""
        return {}

    def column_names(self) -> Iterable[str]:
        """Names of its columns, so that no two things of a model write the same one."""
        return ()

    def energies(self, found: Found, u: Floats) -> Energies:
        """Its share of the energies of a converged state (of this rank)."""
        return Energies()

    def external_forces(self, at: At) -> Floats | None:
        """Forces from outside on the nodes, shape (3 n,), for the balance; None where it applies none.

        Their work is external work.
        """
        return None

    def support_forces(self, at: At) -> Floats | None:
        """Forces on the nodes of what holds the sheet, an elastic foundation for instance; shape (3 n,).

        They count in the sums of forces and moments; their work is in :meth:`energies`.
        """
        return None

    def holds(self, at: At) -> tuple[Ids, Floats] | None:
        """Nodes (k,) that it does not let move freely, and the direction (k, 3) of each; None where it holds none.

        Rigid-body motions that it resists are not refused then. A node may be there several times.
        """
        return None

    # Ranks ---------------------------------------------------------------------------------------------------

    @property
    def shareable(self) -> bool:
        """Whether it can be given to ranks: it says what each of them gets of it."""
        kind = type(self)
        return kind.strip is not Term.strip and kind.fill is not Term.fill

    def strip(self, bare: Self, twins: Twins) -> None:
        """Take out of a copy what grows with the mesh, and replace what it refers to by its twins."""

    def piece(self, cut: Cut) -> Any:
        """What a rank gets of what :meth:`strip` has taken out, in numbers of its own."""
        return None

    def fill(self, piece: Any, mesh: Any) -> None:
        """Give a stripped copy its piece, on the rank and its part of the mesh."""
