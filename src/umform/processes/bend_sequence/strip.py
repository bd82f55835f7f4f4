"""Mesh of the flat strip: at each bend line that of a single bend, coarse between them."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from umform.mesh.mesh import Floats
from umform.processes.air_bending.sheet import lines_along
from umform.processes.air_bending.spec import AirBending
from umform.processes.bend_sequence.spec import BendSequence

#: Smallest distance of two lines relative to the smaller adjacent element.
_NEAR = 0.5


def strip_lines(sequence: BendSequence) -> Floats:
    """Element borders along the strip, shape (n,).

    Near a bend line they are those of half a sheet and its mirror image, up to its end or half of the way to the next
    bend.
    """
    placed = sorted(((bend.position, sequence.case(bend)) for bend in sequence.bends), key=lambda pair: pair[0])
    positions = [position for position, _ in placed]
    middles = [0.5 * (a + b) for a, b in pairwise(positions)]
    lines = np.zeros(1)
    for (position, case), first, last in zip(placed, [0.0, *middles], [*middles, sequence.length], strict=True):
        half = lines_along(case)
        near = position + np.concatenate([-half[:0:-1], half])
        size = case.thickness / case.elements_per_thickness
        inside = near[(near > first + _NEAR * size) & (near < last - _NEAR * size)]
        lines = _filled(lines, inside[0], case)
        lines = _filled(np.concatenate([lines, inside[1:]]), last, case)
    return lines


def _filled(lines: Floats, end: float, case: AirBending) -> Floats:
    """Lines up to an end, in equal coarse elements."""
    way = end - lines[-1]
    if way <= 1e-9 * case.thickness:
        return lines
    count = math.ceil(way / max(case.thickness, case.opening / 8.0) - 1e-9)
    more: Floats = np.linspace(lines[-1], end, count + 1)[1:]
    return np.concatenate([lines, more])
