"""Terms of a model, its unknowns at nodes and scalar unknowns, and their sparsity pattern."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Mesh
from umform.model.bodies.bodies import Bodies
from umform.model.contact.bead import Bead
from umform.model.contact.contacts import Contacts
from umform.model.contact.encounter import sheet_thickness
from umform.model.contact.pair import Contact
from umform.model.contact.sheets import SheetContact
from umform.model.contact.tools import Tools
from umform.model.equations.assembly import Assembly
from umform.model.equations.whole import Whole
from umform.model.supports.supports import Supports
from umform.model.terms.control import Control
from umform.model.terms.controls import Controls
from umform.model.terms.present_state import Now
from umform.model.terms.state import State
from umform.model.terms.term import Global, Term
from umform.model.terms.term_checks import check_term
from umform.ranks import ONE
from umform.solvers import Pattern
from umform.timing import Timing

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Parts:
    """The parts of a model.

    Attributes
    ----------
    mesh, bodies, controls, supports, tools, contacts
        Its mesh, and objects of their own.
    now : Now
        The present state that they share.
    whole : Whole
        Access to the whole model where ranks share it.
    """

    mesh: Mesh
    bodies: Bodies
    controls: Controls
    supports: Supports
    tools: Tools
    contacts: Contacts
    now: Now
    whole: Whole

    @classmethod
    def on(cls, mesh: Mesh, bodies: Bodies) -> Self:
        """The parts of a model without supports, loads and tools."""
        now = Now(np.zeros(3 * len(mesh.points)))
        controls = Controls(now)
        tools = Tools(controls, now)
        supports, contacts = Supports(mesh, controls, now), Contacts(mesh, bodies, tools)
        return cls(mesh, bodies, controls, supports, tools, contacts, now, Whole())


class Assembled:
    """Terms and unknowns of supports, loads, tools and bodies.

    Parameters
    ----------
    parts : Parts
        Mesh, bodies, controls, supports, tools and contacts.

    Attributes
    ----------
    others : list of Term
        Terms of other kinds, see :meth:`add`.
    timing : Timing
        Timing; :func:`umform.solve` sets a new one.
    ranks : Ranks
        Ranks that share the model.
    """

    def __init__(self, parts: Parts) -> None:
        self.mesh, self.bodies, self.controls, self.supports = parts.mesh, parts.bodies, parts.controls, parts.supports
        self.tools, self.contacts, self.now, self.whole = parts.tools, parts.contacts, parts.now, parts.whole
        self.others: list[Term] = []
        self.controls.beside = [self.tools, self.contacts, self.others]
        self.timing, self.ranks = Timing(), ONE
        self._assembled: tuple[int, Assembly] | None = None

    # State ---------------------------------------------------------------------------------------------------

    @property
    def u(self) -> Floats:
        """Displacement of the converged state, shape (3 n,)."""
        return self.now.u

    @u.setter
    def u(self, value: Floats) -> None:
        self.now.u = value

    @property
    def time(self) -> float:
        """Time of the converged state."""
        return self.now.time

    @time.setter
    def time(self, value: float) -> None:
        self.now.time = value

    # Terms ---------------------------------------------------------------------------------------------------

    @property
    def terms(self) -> list[Term]:
        """All terms of the residual: bodies, contacts, pressures and loads, added terms, tools."""
        controls = [control for control in self.controls if isinstance(control, Term)]
        pressures = [control for control in controls if control.couples()]
        loads = [control for control in controls if not control.couples()]
        pressed = [tool for tool in self.tools if tool.presses or tool.load is not None]
        return [*self.bodies, *self.contacts, *pressures, *loads, *self.others, *pressed]

    def add(self, term: Term) -> Term:
        """Add a term of another kind to the residual: a foundation, a spring, your own term.

        Parameters
        ----------
        term : Term
            The term; its nodes are those of the mesh.

        Returns
        -------
        Term
            The same term.

        Raises
        ------
        InvalidValue
            If its name or its history columns are taken, or it couples a node that does not exist.
        """
        self.controls.refuse_taken(term.column_names(), term.name)
        check_term(term, self.terms, len(self.mesh.points))
        self.others.append(term)
        self.now.restructured()
        return term

    @contextmanager
    def with_term(self, term: Term) -> Iterator[None]:
        """Add a term that couples no nodes, an equation of scalar unknowns, within this block."""
        self.others.append(term)
        try:
            yield
        finally:
            self.others.remove(term)

    def pairs_of_tools(self) -> list[Contact]:
        """All terms that involve tools: contacts, and beads."""
        return [*self.contacts, *(term for term in self.others if isinstance(term, Bead))]

    @property
    def sheet_contacts(self) -> list[SheetContact]:
        """Contacts of sheets with each other and with themselves."""
        return [term for term in self.others if isinstance(term, SheetContact)]

    @property
    def penalised(self) -> list[Contact | SheetContact]:
        """All contacts with a penalty that may grow: with tools, and of sheets."""
        return [*self.contacts, *self.sheet_contacts]

    @property
    def penalties(self) -> dict[Contact | SheetContact, float]:
        """The present penalties of these contacts."""
        return {contact: contact.penalty for contact in self.penalised}

    @staticmethod
    def use_penalties(penalties: Mapping[Contact | SheetContact, float]) -> None:
        """Use other penalties."""
        for contact, penalty in penalties.items():
            contact.use_penalty(penalty)

    @property
    def multiplied(self) -> list[Contact | SheetContact]:
        """All contacts with multipliers."""
        return [contact for contact in self.penalised if contact.augmented]

    @property
    def touching(self) -> list[Any]:
        """All terms with contact points: contacts with tools, beads, and contacts of sheets."""
        return [*self.pairs_of_tools(), *self.sheet_contacts]

    @property
    def unknowns(self) -> tuple[Global, ...]:
        """Scalar unknowns of all terms."""
        return tuple(unknown for term in [*self.tools, *self.others] for unknown in term.unknowns)

    @property
    def x(self) -> Floats:
        """Displacement followed by the scalar unknowns."""
        unknowns = self.unknowns
        return self.u if not unknowns else np.concatenate([self.u, [unknown.value for unknown in unknowns]])

    # Unknowns ------------------------------------------------------------------------------------------------

    @property
    def pattern(self) -> Pattern:
        """Sparse pattern of the tangent over the unknowns at nodes."""
        return self._assembly().pattern

    @cached_property
    def thickness(self) -> float:
        """Thickness of the undeformed sheet."""
        return self.ranks.max(sheet_thickness(self.mesh) if len(self.mesh.connectivity) else 0.0)

    @cached_property
    def extent(self) -> float:
        """Largest extent of the undeformed body along an axis, over all ranks."""
        points, ranks = self.mesh.points, self.ranks
        return max(ranks.max(float(points[:, k].max())) + ranks.max(-float(points[:, k].min())) for k in range(3))

    @property
    def free(self) -> NDArray[np.int64]:
        """Degrees of freedom (3 * node + direction) without a reaction: neither held nor prescribed nor tied."""
        return self._assembly().unknowns.free

    def restrict(self, r: Floats) -> Floats:
        """Reduce forces at all degrees of freedom to the unknowns; on the first rank scalar ones follow. eq. (5.18)"""
        return self._with_scalars(self._restrict_nodes(r[: self.u.size]), r[self.u.size :])

    def coefficients(self, u: Floats) -> Floats:
        """Reduce a displacement of all degrees of freedom and scalar unknowns to the unknowns. eq. (5.18)"""
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
    def elastic(self) -> bool:
        """Whether no law has a history."""
        return all(body.block.state_size == 0 for body in self.bodies)

    @property
    def smooth(self) -> bool:
        """Whether there is neither contact nor a law with a history."""
        return self.elastic and not self.pairs_of_tools() and all(term.smooth for term in self.others)

    def largest_entry(self, values: Floats) -> float:
        """Size of the largest entry of the tangent."""
        return max(float(values.max(initial=0.0)), -float(values.min(initial=0.0)))  # no copy of the matrix

    def extend(self, x: Floats) -> Floats:
        """Displacement of all degrees of freedom and scalar unknowns from the unknowns. eqs. (5.17), (5.46)"""
        unknowns = self.unknowns
        if not unknowns:
            return self._extend_nodes(x)
        first, count = self.ranks.rank == 0, len(unknowns)
        z = self.ranks.sum(x[-count:].copy() if first else np.zeros(count))
        u = self._extend_nodes(x[:-count] if first else x)
        for unknown, value in zip(unknowns, z, strict=True):
            u += value * self.supports.displacement(unknown.rates)
        return np.concatenate([u, z])

    # Internal ------------------------------------------------------------------------------------------------

    @cached_property
    def _positions(self) -> Floats:
        return self.mesh.points.ravel()

    def prescribed_displacement(self, goal: State | None = None) -> Floats:
        """Displacement that supports prescribe at a goal, see :meth:`Supports.prescribed`."""
        return self.supports.prescribed(goal)

    def displacement_of_supports(self, values: Mapping[Control, float]) -> Floats:
        """Displacement that supports prescribe for values of controls, see :meth:`Supports.displacement`."""
        return self.supports.displacement(values)

    def _assembly(self) -> Assembly:
        if self._assembled is None or self._assembled[0] != self.now.revision:
            with self.timing.analysis:
                supports = self.supports
                made = Assembly(self.terms, supports.constrained(), supports.pairs, supports.groups, self.ranks)
                self._assembled = self.now.revision, made
        return self._assembled[1]
