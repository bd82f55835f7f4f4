"""Residual and tangent of a model at a displacement: a loop over its terms."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, UmformError
from umform.model.contact.pair import Contact
from umform.model.contact.sheets import SheetContact
from umform.model.equations.assembled import Assembled, Parts
from umform.model.equations.evaluation import Evaluation, first_failure
from umform.model.terms.control import Control
from umform.model.terms.state import State
from umform.model.terms.term import At, Border, Into, Term

Floats = NDArray[np.float64]


class Evaluated(Assembled):
    """Terms that can be evaluated.

    Parameters
    ----------
    parts : Parts
        Mesh, bodies, controls, supports, tools and contacts.
    """

    def __init__(self, parts: Parts) -> None:
        super().__init__(parts)
        self._evaluations = 0
        #: Whether enhanced parameters were recovered since the last evaluation.
        self.recovered = False

    def too_deep(self, evaluation: Evaluation) -> dict[Contact | SheetContact, float]:
        """Contacts beyond their allowed penetration that may become stiffer, and their share of it. eq. (4.200)"""
        shares: dict[Contact | SheetContact, float] = {}
        for contact in self.penalised:
            if contact.adapts and contact.penalty < contact.largest_penalty:
                assert contact.allowed is not None
                shares[contact] = contact.deepest(evaluation.found[contact], self.ranks) / contact.allowed
        return {contact: share for contact, share in shares.items() if share > 1.0}

    @property
    def state(self) -> State:
        """The present state."""
        controls = {control.name: control.value for control in self.controls}
        return State(self.x, self.time, controls, self.now.converged)

    def state_at(self, x: Floats, goal: State | None = None) -> State:
        """A goal, or the present state, with other unknowns: scalar ones move their controls.

        Parameters
        ----------
        x : ndarray, shape (3 n + k,)
            Displacement, followed by the scalar unknowns.
        goal : State, optional
            The present unknowns with the time and the controls of an increment; default: the present state.
        """
        goal, dofs = goal or self.state, self.u.size
        if x.size == dofs:
            return replace(goal, x=x)
        values = self.controls.values_at(goal)
        for unknown, before, value in zip(self.unknowns, goal.x[dofs:].tolist(), x[dofs:].tolist(), strict=True):
            unknown.move(values, before, value)
        return replace(goal, x=x, controls={control.name: value for control, value in values.items()})

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
        """Residual and tangent at a state; changes no converged history.

        Parameters
        ----------
        state : State or ndarray, shape (3 n + k,)
            Unknowns, time and values of the controls, see :attr:`state`; or the unknowns alone, at the present time.
        du : ndarray, shape (3 n + k,), optional
            Increment of the prescribed degrees of freedom, for the predictor. eq. (5.6)
        rates : mapping of Control to float, optional
            Rates of the controls instead of ``du``: the predictor is the rate of the residual at fixed unknowns. eq.
            (5.21)
        until : float, optional
            With ``rates``, which are then increments: the end time of tools whose motion is a function of time; their
            displacement counts too. eq. (4.37)
        tangent : bool
            Whether to evaluate the tangent; else forces only. The previous tangent then remains valid for the recovery
            of enhanced parameters.
        keep : bool
            Whether tools hold all points that they hold in the converged state, whatever the gap. eq. (4.230)
        """
        unknowns, dofs = self.unknowns, self.u.size
        x = state.x if isinstance(state, State) else state
        if not isinstance(x, np.ndarray) or x.shape != (dofs + len(unknowns),):
            raise InvalidValue(
                "a state has the displacement and the scalar unknowns of its model",
                where="evaluate",
                value=f"shape {x.shape}" if isinstance(x, np.ndarray) else type(x).__name__,
                cause="a row for each node, the travels of pressed tools are missing, or no array",
                remedy=f"the state of the model, or an array of shape ({dofs + len(unknowns)},): {dofs} displacements, "
                f"{len(unknowns)} scalar unknowns",
            )
        state = state if isinstance(state, State) else self.state_at(x)
        u, rates = x[:dofs], rates or {}
        if [term for term in self.others if not term.covers(u)]:  # all of them are asked
            self.now.restructured()
        assembly = self._assembly()
        if rates or until is not None:
            du = self.supports.displacement(rates)
        scalars, step = dict(zip(unknowns, x[dofs:].tolist(), strict=True)), state.time - state.since
        du = None if du is None else du[:dofs]
        at = At(u, state.time, self.controls.values_at(state), step, du, rates, until, scalars, keep)
        values = np.zeros(assembly.entries) if tangent else None
        border = Border.of(unknowns, dofs)
        into = Into(np.zeros(dofs), values, np.zeros(dofs), assembly.scatters, self._positions, self.ranks, border)
        into = replace(into, pattern=assembly.whole_pattern)
        if not unknowns:
            self._evaluate_terms(self.terms, at, into)
        else:
            self._evaluate_with_scalars(at, into)
        if (self.supports.ties or self.supports.rows) and values is not None:
            with self.timing.ties:
                values = assembly.reduce(values)
        return self._evaluation(state, at, into, values)

    def _evaluate_terms(self, terms: Iterable[Term], at: At, into: Into) -> None:
        for term in terms:
            with self.timing.of(term.timed_as):
                into.found[term] = term.evaluate(at, into)

    def _evaluate_with_scalars(self, at: At, into: Into) -> None:
        """Terms with scalar unknowns come last: they sum over the ranks, all of which must take part."""
        local = [term for term in self.terms if not term.unknowns]
        problem, moving = None, (at, into)
        try:
            if into.values is not None:
                moving = self._move(at, into)
            self._evaluate_terms(local, *moving)
        except UmformError as error:
            problem = error
        self.ranks.agree(problem)
        self._evaluate_terms([term for term in self.terms if term.unknowns], *moving)

    def _evaluation(self, state: State, at: At, into: Into, values: Floats | None) -> Evaluation:
        """Sums of the contributions and results of the terms."""
        self._evaluations += 1
        self.recovered = False
        self.timing.attempts.evaluations += 1
        k, found = len(into.border.unknowns), into.found
        scale = round_off = 0.0
        for one in found.values():
            scale += one.force_scale_squared
            round_off += one.round_off_squared
        failed, failure = first_failure(found)
        residual, predictor = into.residual, into.predictor
        if k:
            residual = np.concatenate([residual, into.border.residual])
            predictor = np.concatenate([predictor, into.border.predictor])
        return Evaluation(
            state=state,
            controls=at.values,
            residual=residual,
            values=np.empty(0) if values is None else values,
            predictor=predictor,
            force_scale=float(np.sqrt(scale)),
            failed=failed,
            failure=failure,
            round_off=float(np.sqrt(round_off)),
            found=found,
            border=into.border,
            number=self._evaluations,
        )

    def _move(self, at: At, into: Into) -> tuple[At, Into]:
        """Rates of the residual with each scalar unknown at fixed nodal unknowns. eq. (5.47)

        For a single unknown, without a predictor and without tools that need the rate of each pair, the terms add the
        rates together with their forces at the returned point.
        """
        border = into.border
        if len(border.unknowns) == 1 and at.du is None and not any(tool.unknowns for tool in self.tools):
            rates, unused = border.unknowns[0].rates, replace(border, predictor=np.zeros(1))
            along = self.supports.displacement(rates)
            return replace(at, du=along, rates=rates), replace(into, predictor=border.columns[0], border=unused)
        for column, unknown in zip(into.border.columns, into.border.unknowns, strict=True):
            along = self.supports.displacement(unknown.rates)
            supports = bool(along.any())
            for term in self.terms:
                moves = term.moves_with(unknown.rates)
                if moves or (supports and term.couples()):
                    part = self._rate(term, at, into, along, unknown.rates)
                    column += part
                    if moves:
                        into.moved[term, unknown] = part
        for pair in self.pairs_of_tools():
            if pair.moves_with(at.rates):
                into.moved[pair, None] = self._rate(pair, at, into, np.zeros(at.u.size), at.rates)
        return at, into

    @staticmethod
    def _rate(term: Term, at: At, into: Into, along: Floats, rates: Mapping[Control, float]) -> Floats:
        """Rate of the forces of one term with controls, shape (3 n,)."""
        part, forces = np.zeros(at.u.size), np.zeros(at.u.size)
        scratch = Into(forces, None, part, into.scatters, into.positions, into.ranks, into.border)
        scratch = replace(scratch, pattern=into.pattern, rates_only=True)
        term.evaluate(At(at.u, at.time, at.values, at.step, along, rates, scalars=at.scalars), scratch)
        return part

    def rate(self, state: State, rates: Mapping[Control, float]) -> Floats:
        """Rate of the residual with controls, at fixed unknowns, shape (3 n,); without scalar unknowns. eq. (5.21)"""
        dofs = self.u.size
        if self.ranks.any(bool(self.supports.displacement(rates).any())):
            return self.evaluate(state, rates=rates, tangent=False).predictor
        at = At(state.x[:dofs], state.time, self.controls.values_at(state), state.time - state.since)
        part = np.zeros(dofs)
        into = Into(part, None, part, self._assembly().scatters, self._positions, self.ranks, Border.of((), dofs))
        for term in self.terms:
            if term.moves_with(rates):
                part += self._rate(term, at, into, np.zeros(dofs), rates)
        return part

    def resultants(self, evaluation: Evaluation) -> tuple[float, float]:
        """Largest resultant along an axis of the residual of the unknowns, and of the forces of a tool. eq. (5.130)"""
        ranks, r, sums = self.ranks, self.restrict(evaluation.residual), []
        for axis in range(3):
            shift = np.zeros_like(evaluation.x)
            shift[axis : self.u.size : 3] = 1.0
            sums.append(abs(ranks.dot(r, self.coefficients(shift))))
        tools = [np.abs(tool.resultant(evaluation.found, ranks)[0]).max() for tool in self.tools]
        return max(sums), max(map(float, tools), default=0.0)

    def recover(self, du: Floats, mixed: bool = False) -> None:
        """Update the enhanced parameters after ``u += du``. eq. (2.19)

        With ``mixed`` the tangent of the next evaluation has the geometric stiffness of the stress that ``du`` predicts
        instead of the present one. eq. (5.39)
        """
        self.recovered = True
        with self.timing.recovery:
            for term in self.terms:
                term.recover(du[: self.u.size], mixed)

    def prepare(self, goal: State | None = None) -> None:
        """Recover enhanced parameters from the converged state, on the way to a goal, after a failed attempt."""
        if self.ranks.any(not all(body.block.keeps_blocks for body in self.bodies if len(body.cells))):
            self.evaluate(goal or self.state)

    def follow(self) -> None:
        """After an evaluation of forces only: let :meth:`recover` use them, with the previous tangent."""
        for term in self.terms:
            term.follow()

    def shorten(self, part: float) -> None:
        """Scale the change of the last :meth:`recover`. eq. (5.12)"""
        for term in self.terms:
            term.shorten(part)
