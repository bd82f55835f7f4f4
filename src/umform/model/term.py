"""What adds to residual and tangent: a term. Bodies, contacts, pressures, loads and tools are terms, or one of yours.

`Model.evaluate` is a loop over terms. A term couples degrees of freedom, adds its forces and its tangent, gives back
what it came across, and owns its history. docs/architecture.md
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.model.control import Control, Twins
from umform.model.cut import Cut
from umform.ranks import Ranks

Floats = NDArray[np.float64]
Ids = NDArray[np.int32]

#: State of a term: numbers, texts and arrays by name, which may nest. The schema of snapshots, checkpoints and ranks.
Tree = dict[str, Any]


@dataclass(eq=False)
class Global:
    """A scalar unknown without a node: the way of a tool that a force presses, a load parameter.

    Attributes
    ----------
    name : str
        Column of the history.
    rates : dict of Control to float
        Controls that move with it, and how fast: their values are what they were plus the rate times the unknown.
    value : float
        Converged value.
    """

    name: str
    rates: dict[Control, float]
    value: float = 0.0

    def move(self, values: dict[Control, float], value: float) -> None:
        """Write what the controls that move with it are at a value of it into those of all controls."""
        for control, rate in self.rates.items():
            values[control] += rate * (value - self.value)


@dataclass(frozen=True)
class At:
    """Where terms are evaluated.

    Attributes
    ----------
    u : ndarray, shape (3 n,)
        Displacement.
    time : float
        Time.
    values : mapping of Control to float
        Values of all controls, those that scalar unknowns move included.
    step : float
        Time since the converged state.
    du : ndarray, shape (3 n,), optional
        Increment of the prescribed degrees of freedom, if the predictor is asked for.
    rates : mapping of Control to float
        Rates of the controls, for the predictor.
    until : float, optional
        Time at which tools that move by a function of time arrive, for the predictor. eq. (4.37)
    scalars : mapping of Global to float
        Values of the scalar unknowns.
    """

    u: Floats
    time: float
    values: Mapping[Control, float]
    step: float = 0.0
    du: Floats | None = None
    rates: Mapping[Control, float] = field(default_factory=dict)
    until: float | None = None
    scalars: Mapping[Global, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Border:
    """What scalar unknowns add to the tangent: [[K, columns], [rows, corner]], and the residuals of their equations.

    Attributes
    ----------
    unknowns : tuple of Global
        The scalar unknowns, in their order.
    residual : ndarray, shape (k,)
        Residuals of their equations.
    columns : ndarray, shape (k, 3 n)
        Rates of the residual with each of them.
    rows : ndarray, shape (k, 3 n)
        Derivatives of their equations with the displacement.
    corner : ndarray, shape (k, k)
        Derivatives of their equations with them.
    predictor : ndarray, shape (k,)
        What increments of supports and rates of controls change in their equations.
    """

    unknowns: tuple[Global, ...]
    residual: Floats
    columns: Floats
    rows: Floats
    corner: Floats
    predictor: Floats

    @classmethod
    def of(cls, unknowns: tuple[Global, ...], dofs: int) -> Border:
        """Nothing yet."""
        k = len(unknowns)
        return cls(unknowns, np.zeros(k), np.zeros((k, dofs)), np.zeros((k, dofs)), np.zeros((k, k)), np.zeros(k))

    def number(self, unknown: Global) -> int:
        """Place of a scalar unknown."""
        return self.unknowns.index(unknown)


@dataclass(frozen=True)
class Into:
    """What terms add to; arrays over all degrees of freedom, 3 * node + direction.

    Attributes
    ----------
    residual : ndarray, shape (3 n,)
        Internal forces minus external ones.
    values : ndarray or None
        Entries of the tangent; None where forces alone are asked for.
    predictor : ndarray, shape (3 n,)
        Tangent times the increment of the prescribed degrees of freedom, or rate of the residual.
    scatters : mapping of Term to sequence of Scatter
        Where the matrices of each connectivity of a term go.
    positions : ndarray, shape (3 n,)
        Nodes of the undeformed mesh.
    ranks : Ranks
        Who shares the model.
    border : Border
        Equations of the scalar unknowns.
    found : dict of Term to Found
        What the terms before have found.
    moved : dict of (Term, Global) to ndarray, shape (3 n,)
        Rate of the forces of a term with a scalar unknown that moves it; with None, with the rates of the controls.
    """

    residual: Floats
    values: Floats | None
    predictor: Floats
    scatters: Mapping[Term, Sequence[_core.Scatter]]
    positions: Floats
    ranks: Ranks
    border: Border
    found: dict[Term, Any] = field(default_factory=dict)
    moved: dict[tuple[Term, Global | None], Floats] = field(default_factory=dict)

    def add(self, term: Term, connectivity: Ids, forces: Floats, tangents: Floats | None, at: At) -> None:
        """Add the forces and tangents of the parts of a term that is written in Python.

        Parameters
        ----------
        term : Term
            The term, which couples these nodes.
        connectivity : ndarray of int, shape (parts, nodes)
            Nodes of each part.
        forces : ndarray, shape (parts, nodes, 3)
            Internal forces.
        tangents : ndarray, shape (parts, nodes, 3, nodes, 3), optional
            Their derivatives; symmetric if the term is.
        at : At
            Where the term is evaluated; with ``at.du`` the predictor gets its share.
        """
        np.add.at(self.residual.reshape(-1, 3), connectivity, forces)
        if tangents is None:
            return
        if at.du is not None:
            change = np.einsum("eakbl,ebl->eak", tangents, at.du.reshape(-1, 3)[connectivity])
            np.add.at(self.predictor.reshape(-1, 3), connectivity, change)
        if self.values is not None:
            parts, nodes = connectivity.shape
            by_direction = tangents.transpose(0, 2, 1, 4, 3).reshape(parts, 3 * nodes, 3 * nodes)
            self.scatters[term][0].add(np.ascontiguousarray(by_direction), self.values)


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
    def active(self) -> NDArray[np.bool_]:
        """Which points are in contact; empty for most terms."""
        return np.zeros(0, dtype=bool)

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
        Held by penalty and multipliers of all contacts.
    """

    elastic: float = 0.0
    plastic: float = 0.0
    contact: float = 0.0

    @property
    def total(self) -> float:
        """Their sum."""
        return self.elastic + self.plastic + self.contact


class Term:
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
    rows : ndarray of int
        On a rank: which rows of its state over the whole model are here.
    """

    name: str = ""
    symmetric: bool = True
    timed_as: str = "elements"
    within_bodies: bool = False
    unknowns: tuple[Global, ...] = ()
    elsewhere: bool = False
    rows: NDArray[np.int64]

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

    def recover(self, du: Floats, s: float, mixed: bool) -> None:
        """Update parameters that were condensed, after ``u += s du``."""

    def undo_recover(self) -> None:
        """Take the last :meth:`recover` back."""

    def commit(self, found: Found) -> None:
        """Make the trial history that belongs to ``found`` the converged one."""

    def revert(self) -> None:
        """Go back to the converged history."""

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
        """Forces from outside on the nodes, shape (3 n,), for the balance; None where it applies none."""
        return None

    # Ranks ---------------------------------------------------------------------------------------------------

    def strip(self, bare: Self, twins: Twins) -> None:
        """Take out of a copy what grows with the mesh, and replace what it refers to by its twins."""

    def piece(self, cut: Cut) -> Any:
        """What a rank gets of what :meth:`strip` has taken out, in numbers of its own."""
        return None

    def fill(self, piece: Any, mesh: Any) -> None:
        """Give a stripped copy its piece, on the rank and its part of the mesh."""
