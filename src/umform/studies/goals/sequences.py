"""Sequences of bends whose strokes follow angles: slopes of rigid legs in place of derivatives."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from umform.processes.bend_sequence.spec import BendSequence

if TYPE_CHECKING:
    from umform.processes.bend_sequence.part import Part

Floats = NDArray[np.float64]

#: A stroke, and an angle of a bend, by their names.
_STROKE = re.compile(r"bends\.(\d+)\.stroke")
_ANGLE = re.compile(r"bend (\d+): (?:angle|final_angle|loaded_angle)")
#: Slopes of rigid legs at which strokes are known, in degrees.
_SLOPES = np.linspace(0.0, 75.0, 200)


def by_rigid_legs(case: Any, wanted: Sequence[str], paths: Sequence[str]) -> bool:
    """Whether a case is a sequence of bends of which angles are wanted, and strokes follow."""
    strokes = all(map(_STROKE.fullmatch, paths))
    return isinstance(case, BendSequence) and strokes and all(map(_ANGLE.fullmatch, wanted))


def bent(sequence: BendSequence) -> Part:
    """The part."""
    from umform.processes.bend_sequence.run import bend_sequence

    return bend_sequence(sequence, frames=1, progress=False)


def rigid_slopes(sequence: BendSequence, wanted: Sequence[str], paths: Sequence[str]) -> Floats:
    """Change of the angles of bends with their strokes, of legs that are rigid from tip to shoulders.

    A stroke that is corrected with it moves by the springback that was found, as an angle; what it misses, secants of
    the next runs correct.
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
    return [int(match[1]) for match in map(pattern.fullmatch, names) if match]
