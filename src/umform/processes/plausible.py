"""Plausibility of the sheet of a case before its runs; the units of processes are mm, N and MPa."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from umform.problem.findings import accept
from umform.problem.plausible import of_model
from umform.processes.air_bending.problem import build
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.spec import BendSequence
from umform.processes.hemming.spec import Hemming
from umform.processes.problems import problem_of

if TYPE_CHECKING:
    from umform.model import Model


def accepted(case: Any, *, force: bool | None = None) -> list[str]:
    """Warnings of unusual numbers of the sheet in its tools; of several bends, the first one.

    Parameters
    ----------
    case : Spec
        Parameters of a process, with or without strokes.
    force : bool, optional
        Treat errors as warnings; None where no option --force does it.

    Raises
    ------
    DeckError
        Numbers that are certainly wrong, with what to change.
    """
    return accept(of_model(_first_model(case), millimetres=True), force=force)


def _first_model(case: Any) -> Model:
    if isinstance(case, Hemming):
        case = case.first
    if isinstance(case, BendSequence):
        some = case.some_strokes
        case = some.case(some.bends[0])
    return build(case)[0] if isinstance(case, AirBending) else problem_of(case).build().model
