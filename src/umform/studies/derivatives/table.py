"""Check of the table ``[derivatives]`` of a deck before its run."""

from __future__ import annotations

from collections.abc import Iterator

from umform.errors import InvalidValue
from umform.problem.findings import Finding, error
from umform.problem.problem import Problem
from umform.studies.derivatives.derive import held_by, known_parameters, subject_of

#: Keys of the table by the arguments of `derivatives`.
KEYS = {"by": "derivatives.by", "of": "derivatives.results", "hold": "derivatives.hold"}


def check_table(problem: Problem) -> Iterator[Finding]:
    """Errors of parameters and results that the deck does not have.

    Parameters
    ----------
    problem : Problem
        The deck.
    """
    table = problem.contents.derivatives
    if table is None:
        return
    thing = subject_of(problem, table.by)
    try:
        held = held_by(table.hold, {one.path: one for one in thing.parameters()})
        known_parameters(problem, table.by, hold=held)
        thing.refuse_unknown(thing.build(), table.results)
        thing.refuse_unknown(thing.build(), list(table.hold), "hold")
    except InvalidValue as refusal:
        where = KEYS.get(refusal.where, refusal.where)
        yield error(where, f"{refusal.what}: {refusal.value}; {refusal.cause}", refusal.remedy)
