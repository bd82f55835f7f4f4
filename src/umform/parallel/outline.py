"""A model without what grows with its mesh: element, law, tools, controls and steps, which all ranks have."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from umform.elements import Element
from umform.errors import InvalidValue
from umform.materials import Material
from umform.model import Model
from umform.model.boundary import Control, Load, Prescribed, Pressure
from umform.model.contact import Contact
from umform.model.ties import MidLine
from umform.parallel.mpi_ranks import MpiRanks
from umform.steps.arc_length.arc import Arc
from umform.steps.free import Free
from umform.steps.move import Move
from umform.steps.release import Release

Step = Move | Release | Arc | Free


@dataclass(frozen=True, eq=False)
class Outline:
    """What a rank has to know of a model beside its own nodes and cells; its controls are copies without a mesh.

    Attributes
    ----------
    element, material, thickness_points, thickness_rule, time
        As in :class:`umform.Model`.
    controls : list of Control
        In the order of the model.
    contacts : list of Contact
        Without faces.
    tied : list of MidLine or None
        The control of each tie.
    steps : list of Step
        What happens to these controls.
    """

    element: Element
    material: Material
    thickness_points: int
    thickness_rule: str
    time: float
    controls: list[Control]
    contacts: list[Contact]
    tied: list[MidLine | None]
    steps: list[Step]

    @classmethod
    def of(cls, model: Model, steps: Sequence[Step] = ()) -> Outline:
        """Leave out of a model all that grows with its mesh."""
        twin: dict[Control, Any] = {control: _bare(control) for control in model.controls}
        contacts = []
        for contact in model.contacts:
            contacts.append(contact.bare())
            contacts[-1].translations = [twin[motion] for motion in contact.translations]
        return cls(
            model.element,
            model.material,
            model.thickness_points,
            model.thickness_rule,
            model.time,
            list(twin.values()),
            contacts,
            [None if tie.control is None else twin[tie.control] for tie in model.ties],
            [_moving(step, twin) for step in steps],
        )

    @classmethod
    def from_first(cls, outline: Outline | None, ranks: MpiRanks) -> Outline:
        """The outline that the first rank has.

        Raises
        ------
        InvalidValue
            If there is none, or something in it cannot be sent.
        """
        text = ranks.comm.bcast(ranks.on_first(lambda: _pickled(outline)))
        if ranks.rank == 0:
            assert outline is not None
            return outline
        received: Outline = pickle.loads(text)
        return received


def _bare(control: Control) -> Control:
    """A copy of a control without what it has of the mesh."""
    bare: Any = copy.copy(control)
    if isinstance(control, Prescribed | MidLine):
        bare.dofs = np.empty(0, dtype=np.int32)
    elif isinstance(control, Load):
        bare.vector = np.empty(0)
    elif isinstance(control, Pressure):
        bare.block, bare.faces = None, np.empty((0, 2), dtype=np.int32)
    return bare  # type: ignore[no-any-return]


def _moving(step: Step, twin: dict[Control, Any]) -> Step:
    """The same step of the controls of an outline."""
    assert not isinstance(step, Free)  # refused before
    moved = step.control
    own: Any = twin[moved] if isinstance(moved, Control) else [twin[control] for control in moved]
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
