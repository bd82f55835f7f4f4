"""The dynain file of LS-DYNA: keywords in columns of eight and ten, stresses in the long format of sixteen."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from umform.io.states.lines import blocks, columns, real, reals, whole
from umform.io.states.state import FormedState

#: Order xx yy zz xy yz zx of LS-DYNA is 11 22 33 12 23 13.
_LARGE = 16


def dynain_lines(state: FormedState) -> Iterator[str]:
    """The lines of the file."""
    kind = "shells: points from the lower to the upper face" if state.shells else "solids of one point"
    yield "*KEYWORD"
    yield f"$ umform: state of a formed part, {kind}"
    yield f"$ units: {state.units}; stresses and strains in global axes, order xx yy zz xy yz zx"
    yield "*NODE"
    for number, x in enumerate(state.points, start=1):
        yield whole([number], 8) + real(x, _LARGE) + whole([0, 0], 8)
    yield "*ELEMENT_SHELL_THICKNESS" if state.shells else "*ELEMENT_SOLID"
    for number, (part, nodes) in enumerate(zip(state.parts, state.cells + 1, strict=True), start=1):
        yield whole([number, part, *nodes], 8)
        if state.thickness is not None:
            yield real(state.thickness[number - 1], _LARGE)
    yield "*INITIAL_STRESS_SHELL" if state.shells else "*INITIAL_STRESS_SOLID"
    heights = state.heights
    for number, (stress, plastic) in enumerate(zip(state.stress, state.plastic, strict=True), start=1):
        if heights is None:
            yield whole([number, 1, 0, 1, 0, 0, 0, 0], 10)
            yield real(stress[0, :5], _LARGE)
            yield real([stress[0, 5], plastic[0]], _LARGE)
            continue
        yield whole([number, 1, len(heights), 0, 0, 1, 0, 0], 10)
        for t, s, p in zip(heights, stress, plastic, strict=True):
            yield real([t, *s[:4]], _LARGE)
            yield real([s[4], s[5], p], _LARGE)
    if state.strain is not None and heights is not None:
        yield "*INITIAL_STRAIN_SHELL"
        for number, strain in enumerate(state.strain, start=1):
            yield whole([number, 1, len(heights), 1], 10)
            for t, e in zip(heights, strain, strict=True):
                yield real(e[:5], _LARGE)
                yield real([e[5], t], _LARGE)
    yield "*END"


def read_dynain(path: Path) -> FormedState:
    """Read the keywords that `dynain_lines` writes.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    """
    found: dict[str, list[str]] = defaultdict(list)
    for keyword, lines in blocks(path, "*", ["$"]):
        found[keyword] += lines
    points = np.array([reals(line[8:], _LARGE, 3) for line in found["*NODE"]])
    shells = bool(found["*ELEMENT_SHELL_THICKNESS"])
    lines = found["*ELEMENT_SHELL_THICKNESS"] or found["*ELEMENT_SOLID"]
    cards = np.array([[int(text) for text in columns(line, 8, 6 if shells else 10)] for line in lines[:: 1 + shells]])
    thickness = np.array([reals(line, _LARGE, 4) for line in lines[1::2]]) if shells else None
    stresses = found["*INITIAL_STRESS_SHELL"] or found["*INITIAL_STRESS_SOLID"]
    count = int(stresses[0][20:30]) if shells else 1
    rows = np.array([_pair(stresses[at : at + 2], 5, 3) for at in _pairs(len(stresses), count)]).reshape(-1, count, 8)
    strains = found["*INITIAL_STRAIN_SHELL"]
    strain = None
    if strains:
        values = [_pair(strains[at : at + 2], 5, 2) for at in _pairs(len(strains), count)]
        strain = np.array(values).reshape(-1, count, 7)[..., :6]
    return FormedState(
        points=points,
        cells=cards[:, 2:] - 1,
        parts=cards[:, 1],
        stress=rows[..., 1:7] if shells else rows[..., :6],
        plastic=rows[..., 7] if shells else rows[..., 6],
        strain=strain,
        thickness=thickness,
        heights=rows[0, :, 0] if shells else None,
    )


def _pairs(lines: int, count: int) -> Iterator[int]:
    """First lines of the pairs of cards of all points: each element has a head and a pair for each point."""
    for head in range(0, lines, 1 + 2 * count):
        yield from range(head + 1, head + 1 + 2 * count, 2)


def _pair(cards: list[str], first: int, second: int) -> list[float]:
    return reals(cards[0], _LARGE, first) + reals(cards[1], _LARGE, second)
