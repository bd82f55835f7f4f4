"""The equations of a model and its converged state, which it can commit and restore."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from umform.model.changes import removal
from umform.model.changes.kept_gap import check_kept_gaps
from umform.model.contact.sheets.start import check_overlap
from umform.model.equations.checks import check_model
from umform.model.equations.evaluated import Evaluated
from umform.model.equations.evaluation import Evaluation
from umform.model.equations.sparse_tangent import settled, sparse_tangent
from umform.model.supports.support import Support
from umform.model.terms.state import Snapshot, State

if TYPE_CHECKING:
    from scipy import sparse

Floats = NDArray[np.float64]


class System(Evaluated):
    """The equations of a model: its terms and unknowns, their evaluation, and the converged state.

    Newton's method, steps and results use it; :class:`umform.Model` has what users need to build a model.

    Parameters
    ----------
    parts : Parts
        Mesh, bodies, controls, supports, tools and contacts.
    """

    def tangent(self, evaluation: Evaluation | None = None) -> sparse.csr_matrix:
        """Tangent over the unknowns, both triangles: the derivative of ``restrict(residual)``. eqs. (5.18), (5.48)

        Parameters
        ----------
        evaluation : Evaluation, optional
            Where it was evaluated; default: at the present state.

        Returns
        -------
        scipy.sparse.csr_matrix, shape (n + k, n + k)
            Over the n unknowns at nodes, then the k scalar ones (the ways of pressed tools).

        Raises
        ------
        InvalidValue
            If the evaluation is of forces only.
        ModelError
            If ranks share the model.
        """
        return sparse_tangent(self, self.evaluate(self.state) if evaluation is None else evaluation)

    def settle(self, state: State | Floats) -> Evaluation:
        """Residual and tangent at a state, with the enhanced parameters in equilibrium at its displacement. eq. (2.19)

        Then the residual depends on the displacement alone, and differences of it are those of its tangent. Elements
        without enhanced strains need one evaluation. Changes no converged history; :meth:`revert` takes it back.

        Parameters
        ----------
        state : State or ndarray, shape (3 n + k,)
            As for :meth:`evaluate`.

        Raises
        ------
        NoConvergence
            If they do not come to rest at the displacement, or a cell fails; what was evaluated is discarded.
        """
        return settled(self, state if isinstance(state, State) else self.state_at(state))

    def commit(self, evaluation: Evaluation) -> None:
        """Commit the state of an evaluation, which must be the last one."""
        for control, value in evaluation.controls.items():
            control.value = value
        for unknown, value in zip(self.unknowns, evaluation.x[self.u.size :], strict=True):
            unknown.value = float(value)
        for term in self.terms:
            term.commit(evaluation.found[term])
        self.u, self.time = evaluation.u.copy(), evaluation.time
        self.now.began, self.now.converged = self.now.converged, evaluation.time
        for term in self.others:
            term.settled(self, evaluation)

    def stand(self, evaluation: Evaluation) -> None:
        """Store the results of contacts at the converged state, if there was no commit."""
        for contact in self.touching:
            contact.stand(evaluation.found[contact])

    def begin(self, evaluation: Evaluation) -> None:
        """Use the last evaluation as the present state: the reference for slip where there is no history yet."""
        self.stand(evaluation)
        for contact in self.touching:
            contact.begin()

    @property
    def inputs(self) -> dict[str, Floats]:
        """Histories that the evaluation of the converged state used as input, by the keys of their terms."""
        return {term.key: term.before for term in self.terms if self.ranks.any(term.before.size > 0)}

    def repeat(self, before: Mapping[str, Floats]) -> Evaluation:
        """Repeat the evaluation of the converged state from the histories that it used as input.

        Parameters
        ----------
        before : mapping of str to ndarray
            Its `inputs`.

        Returns
        -------
        Evaluation
            Identical to the evaluation to the last bit, with the blocks for the recovery of enhanced parameters.
        """
        for term in self.terms:
            if term.key in before:
                term.go_back(before[term.key])
        self.now.converged = self.now.began  # the time increment, for rate-dependent laws
        evaluation = self.evaluate(self.x)
        self.commit(evaluation)
        return evaluation

    @property
    def enhanced(self) -> list[Floats]:
        """Converged enhanced parameters of each body."""
        return [body.block.alpha for body in self.bodies]

    def recover_by(self, change: Sequence[Floats]) -> None:
        """Add a known change to the enhanced parameters of each body, in place of :meth:`recover`."""
        for body, part in zip(self.bodies, change, strict=True):
            body.block.recover_by(part)

    def take_blocks(self, other: System) -> None:
        """Take the tangents with which enhanced parameters are recovered from a similar model."""
        for body, like in zip(self.bodies, other.bodies, strict=True):
            body.block.take_blocks(like.block)

    def revert(self) -> None:
        """Discard all changes since the last commit."""
        for term in self.terms:
            term.revert()

    def snapshot(self) -> Snapshot:
        """Copy of the converged state."""
        states = {term.key: term.state() for term in self.terms}
        return Snapshot(
            self.u.copy(),
            self.time,
            {control.name: control.value for control in self.controls},
            {unknown.name: unknown.value for unknown in self.unknowns},
            {key: tree for key, tree in states.items() if tree},
            removal.states_of_supports(self),
            self.now.began,
        )

    def restore(self, snapshot: Snapshot) -> None:
        """Return to an earlier converged state.

        Parameters
        ----------
        snapshot : Snapshot
            Return value of :meth:`snapshot`.
        """
        removal.put_supports(self, snapshot.supports)
        self.u, self.time = snapshot.u.copy(), snapshot.time
        self.now.converged, self.now.began = snapshot.time, snapshot.began
        for control in self.controls:
            control.value = snapshot.controls.get(control.name, 0.0)
        for unknown in self.unknowns:
            unknown.value = snapshot.unknowns.get(unknown.name, 0.0)
        for term in self.terms:
            if term.key in snapshot.terms:
                term.restore(snapshot.terms[term.key])
            else:
                term.revert()
        for tool in self.tools:
            if tool.open and tool.key not in snapshot.terms:  # it is a term since a step has opened it
                tool.stay_open(False)

    def check(self, gauge: Support | None = None) -> None:
        """Reject a model that cannot be solved, before the run starts, see `check_model`."""
        check_model(self, gauge)
        for contact in self.sheet_contacts:
            check_overlap(contact, self.u)
        check_kept_gaps(self)

    def mechanism(self, values: Floats, motion: Floats) -> Floats | None:
        """What can move although a tangent looks singular; None for a very thin sheet that is held. eq. (5.99)"""
        from umform.model.equations.mechanisms import mechanism

        return mechanism(self, values, motion)
