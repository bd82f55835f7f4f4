"""The share of a rank in a model: its cells, supports, loads and contacts in local numbering.

It is made from an outline, which all ranks have, and a parcel, which the first rank has made for this one.

A share is a model like any other. It uses PETSc or the ranks only for sums over all ranks.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.ranks.outline import Outline
from umform.errors import UmformError
from umform.mesh import Mesh
from umform.model import Model
from umform.model.bodies.bodies import Bodies
from umform.model.contact.contacts import Contacts
from umform.model.contact.tools import Tools
from umform.model.equations.assembled import Parts
from umform.model.equations.checks import check_held, middle
from umform.model.equations.evaluation import Evaluation
from umform.model.equations.frame import Frame
from umform.model.equations.whole import Whole
from umform.model.supports.support import Support
from umform.model.supports.supports import Supports
from umform.model.supports.ties import Tie
from umform.model.system import System
from umform.model.terms.control import Control
from umform.model.terms.controls import Controls
from umform.model.terms.forces import rigid_body_modes
from umform.model.terms.state import State
from umform.parallel.cutting import Parcel
from umform.parallel.exchange import Exchange
from umform.parallel.gathering import Gathering
from umform.parallel.mpi_ranks import MpiRanks
from umform.parallel.numbering import SharedPattern
from umform.solvers import Pattern

Floats = NDArray[np.float64]


class SharedSupports(Supports):
    """Supports of a share; the ranks number their unknowns again when supports change."""

    renumber: Callable[[], None]

    def hold_again(self) -> None:
        """Apply the supports again, and renumber the unknowns of all ranks."""
        super().hold_again()
        self.renumber()


class SharedWhole(Whole):
    """The whole model of a share.

    Parameters
    ----------
    described : Model, optional
        The model, if available.
    system : SharedSystem
        Equations of the share.
    parcel : Parcel
        Part of this rank.
    """

    def __init__(self, described: Model | None, system: SharedSystem, parcel: Parcel) -> None:
        super().__init__(described)
        self._system, self._nodes, self.owned = system, parcel.nodes, parcel.owned

    def node_number(self, node: int) -> int:
        """Number of a node in the whole mesh."""
        return int(self._nodes[node])

    def sum_at_nodes(self, shares: Floats) -> Floats:
        """Sums over the ranks at the nodes, shape (n, k)."""
        at_nodes = self._system.at_nodes
        return np.stack([at_nodes.spread(at_nodes.sum(column)) for column in shares.T], axis=1)

    def frame(self, frame: Frame) -> Frame | None:
        """The frame over the whole model, on the first rank."""
        return self._system.gathering.frame(frame)

    def state(self, tree: dict[str, Any]) -> dict[str, Any]:
        """The state of a run over the whole model, on the first rank."""
        return self._system.gathering.state(tree)

    def own_state(self, read: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """The local part of the state of a run, which the first rank reads."""
        return self._system.gathering.own_state(read)


class SharedSystem(System):
    """Equations of a share: its sums run over all ranks.

    Parameters
    ----------
    parts : Parts
        Parts of the share.
    parcel : Parcel
        Part of this rank.
    ranks : MpiRanks
        Those that share the model.

    Attributes
    ----------
    cells, nodes : ndarray of int
        Numbers in the whole mesh of the cells and nodes that are here. A node may be on several ranks.
    at_nodes : Exchange
        Sums at the nodes over the ranks.
    """

    ranks: MpiRanks

    def __init__(self, parts: Parts, parcel: Parcel, ranks: MpiRanks) -> None:
        super().__init__(parts)
        self.ranks, self.cells, self.nodes, self.owned = ranks, parcel.cells, parcel.nodes, parcel.owned
        self.at_nodes = Exchange(parcel.node_numbers, len(parcel.owned), ranks)
        self._number(parcel.numbers, parcel.own, parcel.before, parcel.count)

    def _number(self, numbers: NDArray[np.int64], own: int, before: int, count: int) -> None:
        """Set global numbers of the local unknowns, and prepare the sums of partial values."""
        self._numbers, self._own, self._count = numbers, own, count
        self._unknowns = Exchange(numbers, own, self.ranks)
        number = numbers - before
        self._owned_places = np.flatnonzero((number >= 0) & (number < own))
        self._owned_numbers = number[self._owned_places]
        self._shared: SharedPattern | None = None

    def renumber(self) -> None:
        """Number the unknowns of all ranks after a change of supports."""
        constrained, pairs = self.supports.constrained(), self.supports.pairs
        constrained[pairs] = True
        owned = np.zeros((len(self.nodes), 3), dtype=bool)
        owned[self.owned] = True
        free = np.flatnonzero(~constrained)
        places = np.concatenate([free, pairs[:, 0]])  # the unknown of a pair has the position of its lower node
        mine = places[owned.ravel()[places]]
        counts = self.ranks.sum(np.eye(self.ranks.size)[self.ranks.rank] * len(mine)).astype(np.int64)
        before = int(counts[: self.ranks.rank].sum())
        number = np.full((len(self.nodes), 3), -1.0)
        number.ravel()[mine] = before + np.arange(len(mine))
        known = np.stack([self.at_nodes.spread(column) for column in number[self.owned].T], axis=1)
        self._number(known.ravel()[places].astype(np.int64), len(mine), before, int(counts.sum()))

    @cached_property
    def gathering(self) -> Gathering:
        """Gathers its arrays on the first rank and distributes them."""
        return Gathering(self)

    def check(self, gauge: Support | None = None) -> None:
        """Reject a model that cannot be solved; all ranks check their nodes and contact points."""
        check_held(self, gauge)

    # Newton's method -----------------------------------------------------------------------------------------

    @property
    def pattern(self) -> Pattern:
        """Pattern of the share in the tangent, with the global numbers of its unknowns."""
        if self._shared is None:
            mine = self._assembly().pattern
            entries = mine.indptr, mine.indices, mine.symmetric
            self._shared = SharedPattern(self._count, *entries, self._numbers, self._own, self._modes, self.ranks)
        return self._shared

    def _modes(self) -> Floats:
        modes = rigid_body_modes(self.mesh.points, *middle(self))
        return np.stack([self.coefficients(mode) for mode in modes])

    def _restrict_nodes(self, r: Floats) -> Floats:
        """Forces at the unknowns that this rank owns, summed over the ranks. eq. (5.18)"""
        return self._unknowns.sum(super()._restrict_nodes(r))

    def _coefficients_nodes(self, u: Floats) -> Floats:
        """Unknowns that this rank owns in a displacement."""
        found = np.empty(self._own)
        found[self._owned_numbers] = super()._coefficients_nodes(u)[self._owned_places]
        return found

    def _extend_nodes(self, x: Floats) -> Floats:
        """Displacement of the local nodes, from the unknowns that each rank owns. eq. (5.17)"""
        return super()._extend_nodes(self._unknowns.spread(x))

    def largest_entry(self, values: Floats) -> float:
        """Size of the largest entry; the diagonal ones, among which it is, are summed over the ranks."""
        pattern = self.pattern
        diagonal = self._unknowns.sum(values[pattern.indices == pattern.rows])
        return self.ranks.max(max(super(SharedSystem, self).largest_entry(part) for part in (diagonal, values)))

    def evaluate(
        self,
        state: State | Floats,
        du: Floats | None = None,
        rates: Mapping[Control, float] | None = None,
        until: float | None = None,
        *,
        tangent: bool = True,
        keep: bool = False,
    ) -> Evaluation:
        """Local parts of residual and tangent; scale, round-off, failed cell and errors are global."""
        problem, found = None, None
        try:
            found = super().evaluate(state, du, rates, until, tangent=tangent, keep=keep)
        except UmformError as error:
            problem = error
        self.ranks.agree(problem)
        assert found is not None
        first = -self.ranks.max(-float(self.cells[found.failed]) if found.failed >= 0 else -np.inf)
        scale, round_off = np.sqrt(self.ranks.sum(np.array([found.force_scale, found.round_off]) ** 2))
        failed, failure = -1, ""
        if np.isfinite(first):
            failed = int(first)
            mine = found.failed >= 0 and self.cells[found.failed] == failed
            failure = self.ranks.text(found.failure if mine else "")
        scale, round_off = float(scale), float(round_off)
        return replace(found, force_scale=scale, round_off=round_off, failed=failed, failure=failure)


class Share(Model):
    """What one rank has of a model.

    Parameters
    ----------
    outline : Outline
        Common part of the model; the share uses its controls and contacts.
    parcel : Parcel
        Part of this rank.
    ranks : MpiRanks
        Those that share the model.
    whole : Model, optional
        The model, if available.

    Attributes
    ----------
    whole : Model or None
        The model.
    """

    system: SharedSystem

    def __init__(self, outline: Outline, parcel: Parcel, ranks: MpiRanks, whole: Model | None = None) -> None:
        mesh = Mesh(parcel.points, {parcel.cell: parcel.connectivity})
        now = outline.now
        now.u = parcel.u  # before contacts with a history make their points, which begin where the part lies
        now.began = now.converged = now.time
        for thing, piece in zip(outline.pieces_for(), parcel.pieces, strict=True):
            thing.fill(piece, mesh)
        controls, bodies = Controls(now), Bodies(outline.bodies)
        tools, supports = Tools(controls, now), SharedSupports(mesh, controls, now)
        contacts = Contacts(mesh, bodies, tools)
        controls[:], tools[:], contacts[:] = outline.controls, outline.tools, outline.contacts
        ties = [Tie(dofs, control) for dofs, control in zip(parcel.ties, outline.tied, strict=True)]
        supports.take(outline.holders, parcel.fixed, ties)
        parts = Parts(mesh, bodies, controls, supports, tools, contacts, now, Whole())
        system = SharedSystem(parts, parcel, ranks)
        system.others[:] = outline.others
        system.whole, supports.renumber = SharedWhole(whole, system, parcel), system.renumber
        self.whole = whole
        self._consist_of(system)
