"""Sequences of bends: several runs, one after the other, that have no derivatives yet."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeGuard

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.processes.bend_sequence.spec import BendSequence

if TYPE_CHECKING:
    from umform.processes.bend_sequence.part import Part

Floats = NDArray[np.float64]

#: A stroke, and an angle of a bend, by their names.
_STROKE = re.compile(r"bends\.(\d+)\.stroke")
_ANGLE = re.compile(r"bend (\d+): (?:angle|final_angle|loaded_angle)")
#: Slopes of rigid legs at which strokes are known, in degrees.
_SLOPES = np.linspace(0.0, 75.0, 200)


def is_sequence(case: Any) -> TypeGuard[BendSequence]:
    """Whether a case is a sequence of bends."""
    return isinstance(case, BendSequence)


def bent(sequence: BendSequence) -> Part:
    """The part."""
    from umform.processes.bend_sequence.run import bend_sequence

    return bend_sequence(sequence, frames=1, progress=False)


def rigid_slopes(sequence: BendSequence, wanted: Sequence[str], paths: Sequence[str]) -> Floats:
    """Change of the angles of bends with their strokes, of legs that are rigid from tip to shoulders.

    A stroke that is corrected with it moves by the springback that was found, as an angle; what it misses, secants of
    the next runs correct.

    Raises
    ------
    InvalidValue
        If there is another wanted result than an angle, or another parameter than the stroke of a bend.
    """
    angles, strokes = (_numbers(names, pattern) for names, pattern in ((wanted, _ANGLE), (paths, _STROKE)))
    slopes = np.zeros((len(angles), len(strokes)))
    for column, number in enumerate(strokes):
        bend = sequence.bends[number]
        case = sequence.case(bend)
        assert bend.stroke is not None  # a path leads to it
        known = _SLOPES[case.steepest >= _SLOPES]
        rigid = np.array([case.rigid_stroke(float(slope)) for slope in known])
        slope = np.interp(bend.stroke, rigid, np.gradient(known, rigid))
        for row, of in enumerate(angles):
            if of - 1 == number:
                slopes[row, column] = -2.0 * slope
    return slopes


def _numbers(names: Sequence[str], pattern: re.Pattern[str]) -> list[int]:
    found = [pattern.fullmatch(name) for name in names]
    for name, match in zip(names, found, strict=True):
        if match is None:
            raise InvalidValue(
                "in a sequence of bends angles are wanted, and strokes follow",
                where="want and by",
                value=name,
                cause="a run of several operations has no derivatives",
                remedy='want "bend 1: final_angle", by bends.0.stroke',
            )
    return [int(match[1]) for match in found if match]
