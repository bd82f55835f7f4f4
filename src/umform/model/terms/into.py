"""Input and output of the evaluation of terms: state, residual, tangent, and the border of the scalar unknowns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidValue, NotFinite
from umform.materials.user_law import SYMMETRY
from umform.model.terms.control import Control, Twins
from umform.ranks import Ranks

Floats = NDArray[np.float64]
Ids = NDArray[np.int32]


@dataclass(eq=False)
class Global:
    """A scalar unknown without a node: the travel of a force-driven tool, a load parameter.

    Attributes
    ----------
    name : str
        Column of the history.
    rates : dict of Control to float
        Controls that depend on it: their values change by the rate times the unknown.
    value : float
        Converged value.
    what : str
        Description for messages.
    """

    name: str
    rates: dict[Control, float]
    value: float = 0.0
    what: str = "a scalar unknown"

    def move(self, values: dict[Control, float], before: float, value: float) -> None:
        """Write the values of the dependent controls for a value of the unknown, from those for the value before."""
        for control, rate in self.rates.items():
            values[control] += rate * (value - before)

    def strip(self, bare: Global, twins: Twins) -> None:
        """The same for the twins of its controls."""
        bare.rates = twins.rates(self.rates)


@dataclass(frozen=True)
class At:
    """State at which terms are evaluated.

    Attributes
    ----------
    u : ndarray, shape (3 n,)
        Displacement.
    time : float
        Time.
    values : mapping of Control to float
        Values of all controls, including those that scalar unknowns move.
    step : float
        Time since the converged state.
    du : ndarray, shape (3 n,), optional
        Increment of the prescribed degrees of freedom, if the predictor is requested.
    rates : mapping of Control to float
        Rates of the controls, for the predictor.
    until : float, optional
        End time of tools whose motion is a function of time, for the predictor. eq. (4.37)
    scalars : mapping of Global to float
        Values of the scalar unknowns.
    keep : bool
        Whether tools hold all points that they hold in the converged state, whatever the gap. eq. (4.230)
    """

    u: Floats
    time: float
    values: Mapping[Control, float]
    step: float = 0.0
    du: Floats | None = None
    rates: Mapping[Control, float] = field(default_factory=dict)
    until: float | None = None
    scalars: Mapping[Global, float] = field(default_factory=dict)
    keep: bool = False


@dataclass(frozen=True)
class Border:
    """Border of the tangent due to scalar unknowns: [[K, columns], [rows, corner]], and the residuals of their
    equations.

    Attributes
    ----------
    unknowns : tuple of Global
        The scalar unknowns, in their order.
    residual : ndarray, shape (k,)
        Residuals of their equations.
    columns : ndarray, shape (k, 3 n)
        Derivatives of the residual with respect to each of them.
    rows : ndarray, shape (k, 3 n)
        Derivatives of their equations with respect to the displacement.
    corner : ndarray, shape (k, k)
        Derivatives of their equations with respect to each of them.
    predictor : ndarray, shape (k,)
        Change of their equations due to increments of supports and rates of controls.
    """

    unknowns: tuple[Global, ...]
    residual: Floats
    columns: Floats
    rows: Floats
    corner: Floats
    predictor: Floats

    @classmethod
    def of(cls, unknowns: tuple[Global, ...], dofs: int) -> Border:
        """An empty border."""
        k = len(unknowns)
        return cls(unknowns, np.zeros(k), np.zeros((k, dofs)), np.zeros((k, dofs)), np.zeros((k, k)), np.zeros(k))

    def number(self, unknown: Global) -> int:
        """Index of a scalar unknown."""
        return self.unknowns.index(unknown)


@dataclass(frozen=True)
class Into:
    """Output of terms; arrays over all degrees of freedom, 3 * node + direction.

    Attributes
    ----------
    residual : ndarray, shape (3 n,)
        Internal forces minus external ones.
    values : ndarray or None
        Entries of the tangent; None if only forces are requested.
    predictor : ndarray, shape (3 n,)
        Tangent times the increment of the prescribed degrees of freedom, or rate of the residual.
    scatters : mapping of Term to sequence of Scatter
        Scatter maps of the matrices of each connectivity of a term.
    positions : ndarray, shape (3 n,)
        Nodes of the undeformed mesh.
    ranks : Ranks
        Ranks that share the model.
    border : Border
        Equations of the scalar unknowns.
    found : dict of Term to Found
        Results of the previous terms.
    moved : dict of (Term, Global) to ndarray, shape (3 n,)
        Rate of the forces of a term with a scalar unknown that moves it; with None as key, with the rates of the
        controls.
    pattern : umform._core.Pattern
        Pattern of ``values``, for terms without scatter maps.
    rates_only : bool
        Whether only the predictor is read, not the residual and the results of the term.
    """

    residual: Floats
    values: Floats | None
    predictor: Floats
    scatters: Mapping[Any, Sequence[_core.Scatter]]
    positions: Floats
    ranks: Ranks
    border: Border
    found: dict[Any, Any] = field(default_factory=dict)
    moved: dict[tuple[Any, Global | None], Floats] = field(default_factory=dict)
    pattern: Any = None
    rates_only: bool = False

    def add(self, term: Any, connectivity: Ids, forces: Floats, tangents: Floats | None, at: At, kind: int = 0) -> None:
        """Add the forces and tangents of the parts of a term written in Python.

        Parameters
        ----------
        term : Term
            The term, which couples these nodes.
        connectivity : ndarray of int, shape (parts, nodes)
            Nodes of each part.
        forces : ndarray, shape (parts, nodes, 3)
            Internal forces.
        tangents : ndarray, shape (parts, nodes, 3, nodes, 3), optional
            Their derivatives; symmetric if the term is symmetric.
        at : At
            State of the evaluation; with ``at.du`` the predictor gets its contribution.
        kind : int
            Index of the connectivity of these parts in :meth:`Term.couples`.

        Raises
        ------
        InvalidValue
            If the arrays have other shapes, or tangents of a symmetric term are not symmetric.
        NotFinite
            If one of them holds NaN or infinity, which cuts the increment of a run.
        """
        parts, nodes = connectivity.shape
        forces = checked_answer(term, "forces", forces, (parts, nodes, 3))
        np.add.at(self.residual.reshape(-1, 3), connectivity, forces)
        if tangents is None:
            return
        tangents = checked_answer(term, "tangents", tangents, (parts, nodes, 3, nodes, 3))
        if at.du is not None:
            change = np.einsum("eakbl,ebl->eak", tangents, at.du.reshape(-1, 3)[connectivity])
            np.add.at(self.predictor.reshape(-1, 3), connectivity, change)
        if self.values is not None:
            matrices = np.ascontiguousarray(tangents.reshape(parts, 3 * nodes, 3 * nodes))
            if term.symmetric:
                _refuse_unsymmetric(term, matrices)
            self.scatters[term][kind].add(matrices, self.values)


def shaped_answer(term: Any, name: str, values: ArrayLike, shape: tuple[int, ...]) -> Floats:
    """An array that a term written in Python gave, if it has its shape."""
    array = np.asarray(values, dtype=float)
    if array.shape != shape:
        raise InvalidValue(
            f"{name} of a term must have shape {shape}",
            where=repr(term),
            value=array.shape,
            cause="an answer for one part, or with its axes in another order",
            remedy="parts come first: one row for each",
        )
    return array


def checked_answer(term: Any, name: str, values: ArrayLike, shape: tuple[int, ...]) -> Floats:
    """An array that a term written in Python gave, if it has its shape and is finite."""
    array = shaped_answer(term, name, values, shape)
    if not np.isfinite(array).all():
        raise NotFinite(
            f"{name} of a term must be finite",
            where=f"{term!r}, part {np.argwhere(~np.isfinite(array))[0][0]}",
            cause="a root, logarithm or division outside of its domain",
            remedy="smaller steps, or a function of all displacements; at.step is zero before the first increment",
        )
    return array


def _refuse_unsymmetric(term: Any, matrices: Floats) -> None:
    """Refuse matrices of which only the upper triangle would count."""
    deviation = np.abs(matrices - matrices.transpose(0, 2, 1)).max(axis=(1, 2), initial=0.0)
    largest = np.abs(matrices).max(axis=(1, 2), initial=0.0)
    wrong = np.flatnonzero(deviation > SYMMETRY * largest)
    if wrong.size:
        raise InvalidValue(
            "the tangent of a term is not symmetric",
            where=f"{term!r}, part {wrong[0]}",
            value=f"it less its transpose is {deviation[wrong[0]] / largest[wrong[0]]:.2g} of its largest entry",
            cause="forces without a potential, or a mistake in their derivatives",
            remedy="symmetric = False in the class of the term where it is meant",
        )
