"""A model without data that grow with its mesh: bodies, tools, controls, terms and steps, on all ranks."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from umform.analysis.steps import Free, Move, Step
from umform.errors import InvalidValue
from umform.model import Body, Model, Tool
from umform.model.contact import Contact
from umform.model.supports.support import Support
from umform.model.supports.ties import MidLine
from umform.model.terms.control import Control, Twins
from umform.model.terms.present_state import Now
from umform.model.terms.term import Term
from umform.parallel.mpi_ranks import MpiRanks


@dataclass(frozen=True, eq=False)
class Outline:
    """Data of a model that each rank needs besides its nodes and cells: copies without a mesh.

    Attributes
    ----------
    now : Now
        Time.
    bodies, controls, tools, contacts, others : list
        In the order of the model.
    tied : list of MidLine or None
        The control of each tie.
    holders : list of Support
        Supports and controls that hold nodes, including inactive ones.
    steps : list of Step
        Steps with these controls.
    """

    now: Now
    bodies: list[Body]
    controls: list[Control]
    tools: list[Tool]
    contacts: list[Contact]
    others: list[Term]
    tied: list[MidLine | None]
    holders: list[Support]
    steps: list[Step]

    @classmethod
    def of(cls, model: Model, steps: Sequence[Step] = ()) -> Outline:
        """Remove from a model all data that grow with its mesh."""
        twins = Twins()
        return cls(
            twins.of(model.system.now),
            [twins.of(body) for body in model.bodies],
            [twins.of(control) for control in model.controls],
            [twins.of(tool) for tool in model.tools],
            [twins.of(contact) for contact in model.contacts],
            [_own(term, twins) for term in model.system.others],
            [None if tie.control is None else twins.of(tie.control) for tie in model.supports.ties],
            [twins.of(holder) for holder in model.supports.holders],
            [_moving(step, twins) for step in steps],
        )

    @classmethod
    def from_first(cls, outline: Outline | None, ranks: MpiRanks) -> Outline:
        """The outline that the first rank has.

        Raises
        ------
        InvalidValue
            If there is none, or a part of it cannot be pickled.
        """
        text = ranks.comm.bcast(ranks.on_first(lambda: _pickled(outline)))
        if ranks.rank == 0:
            assert outline is not None
            return outline
        received: Outline = pickle.loads(text)
        return received

    def pieces_for(self) -> list[Any]:
        """All objects with a piece of the mesh, in the order of the pieces of a parcel."""
        return [*self.bodies, *self.controls, *self.tools, *self.contacts, *self.others, *self.holders]


def _own(term: Term, twins: Twins) -> Term:
    """The twin of a term, with its scalar unknowns."""
    twin = twins.of(term)
    both = [unknown.name for unknown in term.unknowns if unknown in twin.unknowns]
    if both:
        raise InvalidValue(
            "a term cannot be shared with the solver petsc",
            where=f"term {type(term).__name__} {term.name!r}",
            value=", ".join(both),
            cause="its strip() leaves the scalar unknowns of the whole model in the copy",
            remedy="bare.unknowns = tuple(twins.of(unknown) for unknown in self.unknowns) in strip()",
        )
    return twin


def _moving(step: Step, twins: Twins) -> Step:
    """The same step of the controls of an outline."""
    own: Any
    if isinstance(step, Free):
        on = None if step.on is None else twins.of(step.on)
        given = step.support
        own = [twins.of(thing) for thing in given] if isinstance(given, Sequence) else twins.of(given)
        return replace(step, support=own, on=on)
    moved = step.control
    own = twins.of(moved) if isinstance(moved, Control) else [twins.of(control) for control in moved]
    if isinstance(step, Move):
        return replace(step, control=own, follow={twins.of(control): law for control, law in step.follow.items()})
    return replace(step, control=own)


def _pickled(outline: Outline | None) -> bytes:
    if outline is None:
        raise InvalidValue(
            "the first rank has no model",
            cause="another rank has built it",
            remedy="build the model on the rank 0 of MPI.COMM_WORLD, or on all ranks",
        )
    try:
        return pickle.dumps(outline)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise InvalidValue(
            "the first rank has a model that cannot be sent to the others",
            value=str(error),
            cause="a function that was defined inside of another one, or without a name (lambda)",
            remedy="define functions of tools, laws and motions at the top of a file, or build the model on all ranks",
        ) from error
