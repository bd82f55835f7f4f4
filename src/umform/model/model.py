"""The model: mesh, bodies, supports, loads and tools; residual and tangent at a displacement."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.elements import Element
from umform.errors import InvalidValue, UmformError
from umform.materials import Material
from umform.mesh import Mesh
from umform.model import removal
from umform.model.assembly import Assembly
from umform.model.bodies import Embodied
from umform.model.body import Body
from umform.model.checks import check_model, check_term
from umform.model.contact import Contact
from umform.model.control import Control
from umform.model.dead_load import Load
from umform.model.evaluation import Evaluation, first_failure
from umform.model.loads import Loaded
from umform.model.state import Snapshot
from umform.model.support import Support
from umform.model.supports import Supported
from umform.model.term import At, Border, Global, Into, Term
from umform.model.touched import Touched
from umform.model.whole import Whole
from umform.ranks import ONE, Ranks
from umform.solvers import Pattern
from umform.timing import Timing

__all__ = ["Evaluation", "Model", "Snapshot"]

Floats = NDArray[np.float64]


class Model(Supported, Loaded, Touched, Embodied, Whole):
    """Solid-shells with supports, loads and rigid tools.

    Parameters
    ----------
    mesh : Mesh
        Points and cells.
    element : str or Element
        Name in the catalogue (:data:`umform.elements.CATALOGUE`) or an element of your own.
    material : Material
        SVK, NeoHooke, NeoHookePower or J2.
    bodies : sequence of Body, optional
        Several bodies instead of element and material: each cell belongs to one.
    thickness_points : int, optional
        Points through the thickness, 2 to 15, at least thickness_order + 1. Default: 2 with an elastic law; 5 with a
        plastic one, but 12 with BEND8 and BEND18.
    thickness_rule : {"gauss", "lobatto", "split"}, optional
        Where they lie; default gauss, but split where the default of the points is 12.
    rolling : array_like, shape (3,) or (cells, 3), optional
        Rolling direction of the sheet: e_1 of the local axes is its projection onto the layer, eq. (1.26). By default
        e_1 lies along G_1 and follows the numbering of the mesh, which an isotropic law does not see.
    **options
        Options of the element: thickness_modes, thickness_order, order_modes, membrane_modes, tie_E33,
        compatible_E12.

    Raises
    ------
    WrongCellType
        If the element does not stand on the cells of the mesh.
    InvalidValue
        If an option does not fit.
    """

    #: Who shares the model.
    ranks: Ranks = ONE

    def __init__(
        self,
        mesh: Mesh,
        element: str | Element = "ANS3DEAS",
        *,
        material: Material | None = None,
        bodies: Sequence[Body] | None = None,
        thickness_points: int | None = None,
        thickness_rule: str | None = None,
        rolling: ArrayLike | None = None,
        **options: int | bool | None,
    ) -> None:
        super().__init__(mesh)
        if bodies is None:
            given: dict[str, Any] = {"thickness_rule": thickness_rule, "rolling": rolling, **options}
            bodies = [Body(element, material=material, thickness_points=thickness_points, **given)]  # type: ignore[arg-type]
        elif material is not None:
            raise InvalidValue("give bodies, or element and material", where="Model", remedy="leave one of them away")
        self._embody(bodies)
        self.u: Floats = np.zeros(3 * len(mesh.points))
        #: Terms of other kinds, see :meth:`add`.
        self.others: list[Term] = []
        self._evaluations, self._converged_time = 0, 0.0
        #: Where the time goes; :func:`umform.solve` puts a new one here.
        self.timing = Timing()

    # What there is -------------------------------------------------------------------------------------------

    @property
    def time(self) -> float:
        """Present time."""
        return self.now.time

    @time.setter
    def time(self, value: float) -> None:
        self.now.time = value

    @property
    def terms(self) -> list[Term]:
        """All that adds to the residual: bodies, contacts, pressures and loads, what was added, and pressed tools."""
        controls = [control for control in self.controls if isinstance(control, Term)]
        pressures = [control for control in controls if control.couples()]
        loads = [control for control in controls if not control.couples()]
        pressed = [tool for tool in self.tools if tool.unknowns]
        return [*self.bodies, *self.contacts, *pressures, *loads, *self.others, *pressed]

    def add(self, term: Term) -> Term:
        """Let a term of another kind add to the residual: a foundation, a spring, one of your own.

        Raises
        ------
        InvalidValue
            If its name or its columns of the history are taken, or it couples a node that is not there.
        """
        self._refuse_taken(term.column_names(), term.name)
        check_term(term, self.terms, len(self.mesh.points))
        self.others.append(term)
        self._assembled = None
        return term

    def _named(self) -> Iterable[Any]:
        """All that has columns in the history."""
        return [*self.controls, *self.tools, *self.contacts, *self.others]

    @property
    def unknowns(self) -> tuple[Global, ...]:
        """Scalar unknowns of all terms."""
        return tuple(unknown for term in [*self.tools, *self.others] for unknown in term.unknowns)

    @property
    def x(self) -> Floats:
        """Displacement, and the scalar unknowns behind it."""
        unknowns = self.unknowns
        return self.u if not unknowns else np.concatenate([self.u, [unknown.value for unknown in unknowns]])

    # Unknowns ------------------------------------------------------------------------------------------------

    @property
    def pattern(self) -> Pattern:
        """Sparse pattern of the tangent over the unknowns at nodes."""
        return self._assembly().pattern

    @property
    def effort(self) -> float:
        """What an evaluation costs for each equation; 1 for 8-node elements with 20 points.

        Each point adds to all entries of an element's matrix; in a regular mesh of one layer an element of 8 nodes has
        one fibre of its own, one of 18 nodes has four.
        """
        nodes = self.mesh.connectivity.shape[1]
        fibres = 1 if nodes == 8 else 4
        size = nodes / 8
        points = self.ranks.sum(float(sum(body.block.points * len(body.cells) for body in self.bodies)))
        cells = self.ranks.sum(float(sum(len(body.cells) for body in self.bodies)))
        return float(points / max(cells, 1.0) / 20 * size * size / fibres)

    @cached_property
    def extent(self) -> float:
        """Largest extent of the undeformed body along an axis."""
        return self.ranks.max(float(np.ptp(self.mesh.points, axis=0).max()))

    @property
    def free(self) -> NDArray[np.int64]:
        """Degrees of freedom (3 * node + direction) without a reaction: neither held nor prescribed nor tied."""
        return self._assembly().unknowns.free

    def restrict(self, r: Floats) -> Floats:
        """Unknowns' share of forces at all degrees of freedom; on the first rank scalar ones follow. eq. (5.18)"""
        return self._with_scalars(self._restrict_nodes(r[: self.u.size]), r[self.u.size :])

    def coefficients(self, u: Floats) -> Floats:
        """Unknowns in a displacement of all degrees of freedom and scalar unknowns. eq. (5.18)"""
        return self._with_scalars(self._coefficients_nodes(u[: self.u.size]), u[self.u.size :])

    def _with_scalars(self, at_nodes: Floats, scalars: Floats) -> Floats:
        return np.concatenate([at_nodes, scalars]) if scalars.size and self.ranks.rank == 0 else at_nodes

    def _restrict_nodes(self, r: Floats) -> Floats:
        """T^T r. eq. (5.18)"""
        return self._assembly().unknowns.restrict(r)

    def _coefficients_nodes(self, u: Floats) -> Floats:
        return self._assembly().unknowns.restrict(u)

    def _extend_nodes(self, q: Floats) -> Floats:
        """T q. eq. (5.17)"""
        return self._assembly().unknowns.extend(q)

    @property
    def smooth(self) -> bool:
        """Whether there is neither contact nor a law with a history."""
        return not self.contacts and all(body.block.state_size == 0 for body in self.bodies)

    def largest_entry(self, values: Floats) -> float:
        """Size of the largest entry of the tangent."""
        return max(float(values.max(initial=0.0)), -float(values.min(initial=0.0)))  # no copy of the matrix

    def extend(self, x: Floats) -> Floats:
        """Displacement of all degrees of freedom and scalar unknowns that the unknowns make. eqs. (5.17), (5.41)"""
        unknowns = self.unknowns
        if not unknowns:
            return self._extend_nodes(x)
        first, count = self.ranks.rank == 0, len(unknowns)
        z = self.ranks.sum(x[-count:].copy() if first else np.zeros(count))
        u = self._extend_nodes(x[:-count] if first else x)
        for unknown, value in zip(unknowns, z, strict=True):
            u += value * self.displacement_of_supports(unknown.rates)
        return np.concatenate([u, z])

    # Evaluation ----------------------------------------------------------------------------------------------

    def evaluate(
        self,
        x: Floats,
        du: Floats | None = None,
        rates: Mapping[Control, float] | None = None,
        until: float | None = None,
        *,
        tangent: bool = True,
    ) -> Evaluation:
        """Residual and tangent at ``x``, at the present values of controls and time; changes no converged history.

        Parameters
        ----------
        x : ndarray, shape (3 n + k,)
            Displacement, and the scalar unknowns behind it.
        du : ndarray, shape (3 n + k,), optional
            Increment of the prescribed degrees of freedom, for the predictor. eq. (5.6)
        rates : mapping of Control to float, optional
            Rates of the controls instead of ``du``: the predictor is the rate of the residual while the unknowns are
            held. eq. (5.21)
        until : float, optional
            With ``rates``, that are then changes: the time at which tools that move by a function of time arrive, whose
            way counts too. eq. (4.37)
        tangent : bool
            Whether the tangent is wanted; else forces alone are evaluated. The last tangent is then still that which
            enhanced parameters are recovered with.
        """
        assembly, unknowns, dofs = self._assembly(), self.unknowns, self.u.size
        u, rates = x[:dofs], rates or {}
        if rates or until is not None:
            du = self.displacement_of_supports(rates)
        values_now, step = self._values(unknowns, x[dofs:]), self.time - self._converged_time
        at = At(u, self.time, values_now, step, None if du is None else du[:dofs], rates, until)
        values = np.zeros(assembly.entries) if tangent else None
        border = Border.of(unknowns, dofs)
        into = Into(np.zeros(dofs), values, np.zeros(dofs), assembly.scatters, self._positions, self.ranks, border)
        if not unknowns:
            self._evaluate_terms(self.terms, at, into)
        else:
            self._evaluate_with_scalars(at, into)
        if (self.ties or self.rows) and values is not None:
            with self.timing.ties:
                values = assembly.reduce(values)
        return self._evaluation(x, at, into, values)

    def _evaluate_terms(self, terms: Iterable[Term], at: At, into: Into) -> None:
        for term in terms:
            with self.timing.of(term.timed_as):
                into.found[term] = term.evaluate(at, into)

    def _evaluate_with_scalars(self, at: At, into: Into) -> None:
        """Terms with scalar unknowns come last: they sum over the ranks, which none may have left with an error."""
        local = [term for term in self.terms if not term.unknowns]
        problem = None
        try:
            if into.values is not None:
                self._move(at, into)
            self._evaluate_terms(local, at, into)
        except UmformError as error:
            problem = error
        self.ranks.agree(problem)
        self._evaluate_terms([term for term in self.terms if term.unknowns], at, into)

    def _evaluation(self, x: Floats, at: At, into: Into, values: Floats | None) -> Evaluation:
        """What the terms have added and found, together."""
        self._evaluations += 1
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
            x=x,
            time=at.time,
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

    def _values(self, unknowns: Sequence[Global], z: Floats) -> dict[Control, float]:
        """Values of all controls, with those that scalar unknowns move where these have them."""
        values = {control: control.value for control in self.controls}
        for unknown, value in zip(unknowns, z, strict=True):
            for control, rate in unknown.rates.items():
                values[control] += rate * float(value - unknown.value)
        return values

    def _move(self, at: At, into: Into) -> None:
        """Rates of the residual with each scalar unknown while the unknowns at nodes are held. eq. (5.42)"""
        for column, unknown in zip(into.border.columns, into.border.unknowns, strict=True):
            along = self.displacement_of_supports(unknown.rates)
            supports = bool(along.any())
            for term in self.terms:
                moves = term.moves_with(unknown.rates)
                if moves or (supports and term.couples()):
                    part = self._rate(term, at, into, along, unknown.rates)
                    column += part
                    if moves:
                        into.moved[term, unknown] = part
        for pair in self.contacts:
            if pair.moves_with(at.rates):
                into.moved[pair, None] = self._rate(pair, at, into, np.zeros(at.u.size), at.rates)

    @staticmethod
    def _rate(term: Term, at: At, into: Into, along: Floats, rates: Mapping[Control, float]) -> Floats:
        """Rate of the forces of one term with controls, shape (3 n,)."""
        part, forces = np.zeros(at.u.size), np.zeros(at.u.size)
        scratch = Into(forces, None, part, into.scatters, into.positions, into.ranks, into.border)
        term.evaluate(At(at.u, at.time, at.values, at.step, along, rates), scratch)
        return part

    def recover(self, du: Floats, s: float, mixed: bool = False) -> None:
        """Update the enhanced parameters after ``u += s du``. eq. (2.19)

        With ``mixed`` the tangent of the evaluation that follows has the geometric stiffness of the stress that
        ``s du`` foresaw instead of the present one. eq. (5.39)
        """
        with self.timing.recovery:
            for term in self.terms:
                term.recover(du[: self.u.size], s, mixed)

    def prepare(self) -> None:
        """Let enhanced parameters be recovered from the converged state, after an attempt that failed."""
        if self.ranks.any(not all(body.block.keeps_blocks for body in self.bodies if len(body.cells))):
            self.evaluate(self.x)

    def undo_recover(self) -> None:
        """Take the last :meth:`recover` back."""
        for term in self.terms:
            term.undo_recover()

    # State ---------------------------------------------------------------------------------------------------

    def commit(self, evaluation: Evaluation) -> None:
        """Make the state of an evaluation, which must be the last one, the converged state."""
        for control, value in evaluation.controls.items():
            control.value = value
        for unknown, value in zip(self.unknowns, evaluation.x[self.u.size :], strict=True):
            unknown.value = float(value)
        for term in self.terms:
            term.commit(evaluation.found[term])
        self.u, self._converged_time = evaluation.u.copy(), evaluation.time

    def stand(self, evaluation: Evaluation) -> None:
        """Let contacts know what was found at the converged state, where no commit has told them."""
        for contact in self.contacts:
            contact.stand(evaluation.found[contact])

    def repeat(self, before: Mapping[str, Floats]) -> Evaluation:
        """Repeat the evaluation of the converged state, from the histories that it had read.

        Parameters
        ----------
        before : mapping of str to ndarray
            :attr:`Term.before` of each term that had any, by its key.

        Returns
        -------
        Evaluation
            To the last bit what the evaluation was, with the blocks that enhanced parameters are recovered with.
        """
        for term in self.terms:
            if term.key in before:
                term.go_back(before[term.key])
        evaluation = self.evaluate(self.x)
        self.commit(evaluation)
        return evaluation

    def revert(self) -> None:
        """Forget everything since the last commit."""
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
        )

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot."""
        removal.put_supports(self, snapshot.supports)
        self.u, self.time, self._converged_time = snapshot.u.copy(), snapshot.time, snapshot.time
        for control in self.controls:
            control.value = snapshot.controls.get(control.name, 0.0)
        for unknown in self.unknowns:
            unknown.value = snapshot.unknowns.get(unknown.name, 0.0)
        for term in self.terms:
            if term.key in snapshot.terms:
                term.restore(snapshot.terms[term.key])
            else:
                term.revert()

    def remove(self, thing: Support | Contact) -> Load:
        """Take a support or a contact away; the forces that it exerted stay as a dead load of factor 1.

        Move the load to zero to let the sheet go gradually, see docs/supports.md. A step :class:`umform.Free` does both
        within a run.

        Parameters
        ----------
        thing : Support or Contact
            What ``fix``, ``symmetry``, ``hinge``, ``hold_director`` or ``contact`` returned. With a contact its
            controls go too.

        Returns
        -------
        Load
            The control of the forces.

        Raises
        ------
        InvalidValue
            If the model does not have it, or it has been removed already.
        """
        return removal.remove(self, thing)

    def put_back(self, support: Support, *, here: bool = True) -> None:
        """Let a support that was removed act again.

        Parameters
        ----------
        support : Support
            The support.
        here : bool
            Hold its nodes where they are now, not where they were in the undeformed mesh.
        """
        removal.put_back(self, support, here=here)

    def check(self) -> None:
        """Refuse what cannot be solved before time is spent on it, see :func:`umform.model.checks.check_model`."""
        check_model(self)

    # Inside --------------------------------------------------------------------------------------------------

    @cached_property
    def _positions(self) -> Floats:
        return self.mesh.points.ravel()

    def _assembly(self) -> Assembly:
        if self._assembled is None:
            with self.timing.analysis:
                self._assembled = Assembly(self.terms, self.constrained(), self.pairs, self.groups, self.ranks)
        assembled: Assembly = self._assembled
        return assembled
