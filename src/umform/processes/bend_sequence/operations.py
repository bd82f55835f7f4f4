"""The bends of a part as operations, each with a stroke."""

from __future__ import annotations

from functools import partial

from umform.processes.air_bending.goal import needed_stroke
from umform.processes.bend_sequence.one_bend import placed_problem
from umform.processes.bend_sequence.problem import flat_strip
from umform.processes.bend_sequence.spec import BendSequence
from umform.processes.problems import Operation


def operations_of(sequence: BendSequence) -> list[Operation]:
    """The bends.

    Raises
    ------
    InvalidValue
        A bend has no stroke.
    """
    flat = flat_strip(sequence)
    return [
        Operation(
            f"bend-{number}",
            partial(
                placed_problem, sequence, bend, needed_stroke(sequence.case(bend), f"bends.{number - 1}"), flat=flat
            ),
        )
        for number, bend in enumerate(sequence.bends, start=1)
    ]
