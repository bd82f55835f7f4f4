"""The share of a rank in a model: its own cells, supports, loads and contacts in numbers of its own.

A share is a model like any other. Only where sums over all ranks are wanted it asks PETSc or the ranks.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.assembly import Evaluation
from umform.boundary import Control, Load, Prescribed, Pressure, rigid_body_modes
from umform.contact import ToolMotion
from umform.distributed.exchange import Exchange
from umform.distributed.gathering import Gathering
from umform.distributed.mpi_ranks import MpiRanks
from umform.distributed.numbering import Owners, SharedPattern, tied_pairs
from umform.errors import UmformError
from umform.mesh import Ids, Mesh
from umform.model import Model
from umform.model_checks import check_held, middle
from umform.solvers import Pattern
from umform.ties import MidLine, Tie

if TYPE_CHECKING:
    from umform.results import Frame

Floats = NDArray[np.float64]


class Share(Model):
    """What one rank has of a model.

    Parameters
    ----------
    whole : Model
        The model, which all ranks have built alike.
    part : ndarray of int32, shape (cells,)
        Rank of each cell.
    ranks : MpiRanks
        Those that share the model.

    Attributes
    ----------
    whole : Model
        The model.
    cells, nodes : ndarray of int
        Numbers in the whole mesh of the cells and nodes that are here. A node may be on several ranks.
    facets_here : list of ndarray of int
        For each contact, which of its facets are here.
    twin : dict of Control to Control
        Controls of this share by those of the whole model.
    """

    ranks: MpiRanks
    owned: NDArray[np.int64]

    def __init__(self, whole: Model, part: Ids, ranks: MpiRanks) -> None:
        owners = Owners.of(whole, part, ranks.size)
        self.whole, self.cells = whole, np.flatnonzero(part == ranks.rank)
        corners, pairs = whole.mesh.connectivity[self.cells], tied_pairs(whole)
        known = np.zeros(len(whole.mesh.points), dtype=bool)
        known[corners] = True
        tied: NDArray[np.bool_] = np.logical_or(*known[pairs // 3].T)
        known[pairs[tied] // 3] = True  # the partner of a tied node is here too, even without a cell
        self.nodes = np.flatnonzero(known)
        self._place = np.where(known, np.cumsum(known) - 1, -1).astype(np.int32)
        mesh = Mesh(whole.mesh.points[self.nodes], {whole.mesh.cell: self._place[corners]})
        through = {"thickness_points": whole.thickness_points, "thickness_rule": whole.thickness_rule}
        super().__init__(mesh, whole.element, material=whole.material, **through)  # type: ignore[arg-type]
        self.ranks, self.owned = ranks, np.flatnonzero(owners.node[self.nodes] == ranks.rank)
        self._cell_place = np.full(len(part), -1, dtype=np.int32)
        self._cell_place[self.cells] = np.arange(len(self.cells))
        self._share_contacts()
        self.twin = {control: self._share_control(control) for control in whole.controls}
        self.controls = list(self.twin.values())
        self._fixed = whole._fixed.reshape(-1, 3)[self.nodes].ravel()
        self._share_ties()
        self._number(owners, tied)
        self._stand_where(whole)
        del self._place, self._cell_place  # as long as the whole mesh

    # From the whole model ------------------------------------------------------------------------------------

    def _dofs(self, dofs: Ids) -> Ids:
        """Degrees of freedom here of those of the whole model; others fall out."""
        node = self._place[dofs // 3]
        return (3 * node + dofs % 3)[node >= 0].astype(np.int32)

    def _faces(self, faces: Ids) -> tuple[Ids, NDArray[np.int64]]:
        """Faces here of rows (cell, face) of the whole mesh, and which rows these are."""
        here = np.flatnonzero(self._cell_place[faces[:, 0]] >= 0)
        return np.stack([self._cell_place[faces[here, 0]], faces[here, 1]], axis=1), here

    def _share_contacts(self) -> None:
        self.facets_here: list[NDArray[np.int64]] = []
        for contact in self.whole.contacts:
            faces, here = self._faces(contact.faces)
            self.contacts.append(contact.part(self.mesh, faces))
            self.facets_here.append(here)

    def _share_control(self, control: Control) -> Control:
        """The control with what is here; a load on a node that several ranks have counts for its owner."""
        own = copy.copy(control)
        if isinstance(own, Prescribed | MidLine):
            own.dofs = self._dofs(own.dofs)
        elif isinstance(own, Load):
            vector = own.vector.reshape(-1, 3)[self.nodes]
            own.vector = np.zeros(vector.size)
            own.vector.reshape(-1, 3)[self.owned] = vector[self.owned]
        elif isinstance(own, Pressure):
            own.faces, _ = self._faces(own.faces)
            facets = self.mesh.facets(own.faces) if len(own.faces) else self._no_facets()
            own.block = _core.pressure_block(facets, self.mesh.points)
        elif isinstance(own, ToolMotion):
            number = next(k for k, contact in enumerate(self.whole.contacts) if control in contact.translations)
            self.contacts[number].translations.append(own)
        return own

    def _no_facets(self) -> Ids:
        return np.empty((0, self.mesh.connectivity.shape[1] // 2), dtype=np.int32)

    def _share_ties(self) -> None:
        for tie in self.whole.ties:
            here = self._place[tie.dofs // 3]
            dofs = (3 * here + tie.dofs % 3)[(here >= 0).all(axis=1)].astype(np.int32)
            control = None if tie.control is None else self.twin[tie.control]
            assert control is None or isinstance(control, MidLine)
            self.ties.append(Tie(dofs, control))

    def _number(self, owners: Owners, tied: NDArray[np.bool_]) -> None:
        """Global numbers of the unknowns and nodes that are here, and the ways to sum shares of them up."""
        number = owners.equation.reshape(-1, 3)[self.nodes].ravel()
        self._numbers = np.concatenate([number[number >= 0], owners.tie[tied]])
        self._own = int(owners.own[self.ranks.rank])
        self._unknowns = Exchange(self._numbers, self._own, self.ranks)
        self._at_nodes = Exchange(owners.consecutive_nodes()[self.nodes], len(self.owned), self.ranks)
        number = self._numbers - owners.own[: self.ranks.rank].sum()
        self._owned_places = np.flatnonzero((number >= 0) & (number < self._own))
        self._owned_numbers = number[self._owned_places]
        self._count = int(owners.own.sum())
        self._shared: SharedPattern | None = None

    def _stand_where(self, whole: Model) -> None:
        """Begin in the state that the whole model is in."""
        self.u, self.time = whole.u.reshape(-1, 3)[self.nodes].ravel(), whole.time
        if "block" in vars(whole):  # else no element has a history yet
            self.block.restore(whole.block.state[self.cells], whole.block.alpha[self.cells])
        for contact, one, here in zip(self.contacts, whole.contacts, self.facets_here, strict=True):
            if "multipliers" in vars(one):
                contact.multipliers = one.multipliers.reshape(len(one.facets), -1)[here].ravel()
                contact.revert()

    # What all ranks have together ----------------------------------------------------------------------------

    @property
    def described(self) -> Model:
        """The whole model."""
        return self.whole

    @cached_property
    def gathering(self) -> Gathering:
        """The way of its arrays to the first rank and back."""
        return Gathering(self)

    def check(self) -> None:
        """Refuse what cannot be solved; all ranks look at their own nodes and contact points."""
        check_held(self)

    def node_number(self, node: int) -> int:
        """Number of a node in the whole mesh."""
        return int(self.nodes[node])

    def sum_at_nodes(self, shares: Floats) -> Floats:
        """Sums over the ranks at the nodes, shape (n, k)."""
        sums = [self._at_nodes.spread(self._at_nodes.sum(column)) for column in shares.T]
        return np.stack(sums, axis=1)

    def whole_frame(self, frame: Frame) -> Frame | None:
        """The frame over the whole model, on the first rank."""
        return self.gathering.frame(frame)

    def whole_state(self, tree: dict[str, Any]) -> dict[str, Any]:
        """The state of a run over the whole model, on the first rank."""
        return self.gathering.state(tree)

    def own_state(self, read: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """What is here of the state of a run, which the first rank reads."""
        return self.gathering.own_state(read)

    # What Newton asks ----------------------------------------------------------------------------------------

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

    def restrict(self, r: Floats) -> Floats:
        """Forces at the unknowns that this rank owns, summed over the ranks. eq. (5.18)"""
        return self._unknowns.sum(super().restrict(r))

    def coefficients(self, u: Floats) -> Floats:
        """Unknowns that this rank owns in a displacement."""
        found = np.empty(self._own)
        found[self._owned_numbers] = super().coefficients(u)[self._owned_places]
        return found

    def extend(self, x: Floats) -> Floats:
        """Displacement of the nodes that are here, from the unknowns that each rank owns. eq. (5.17)"""
        return super().extend(self._unknowns.spread(x))

    def largest_entry(self, values: Floats) -> float:
        """Size of the largest entry; the diagonal ones, among which it is, are summed over the ranks."""
        pattern = self.pattern
        diagonal = self._unknowns.sum(values[pattern.indices == pattern.rows])
        return self.ranks.max(max(super(Share, self).largest_entry(part) for part in (diagonal, values)))

    def evaluate(
        self,
        u: Floats,
        du: Floats | None = None,
        rates: Mapping[Control, float] | None = None,
        until: float | None = None,
    ) -> Evaluation:
        """Shares of residual and tangent; scale, round-off, failed cell and errors are those of all ranks."""
        problem, found = None, None
        try:
            found = super().evaluate(u, du, rates, until)
        except UmformError as error:
            problem = error
        self.ranks.agree(problem)
        assert found is not None
        first = -self.ranks.max(-float(self.cells[found.failed]) if found.failed >= 0 else -np.inf)
        scale, round_off = np.sqrt(self.ranks.sum(np.array([found.force_scale, found.round_off]) ** 2))
        failed = int(first) if np.isfinite(first) else -1
        return replace(found, force_scale=float(scale), round_off=float(round_off), failed=failed)
