"""Initial state of OpenRadioss: nodes, elements and blocks /INISHE or /INIBRI in the format of 2021."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from umform.io.states.lines import blocks, columns, real, reals, whole
from umform.io.states.state import FormedState

_TEN, _TWENTY = 10, 20


def radioss_lines(state: FormedState) -> Iterator[str]:
    """The lines of the file."""
    yield "#RADIOSS STARTER"
    yield f"# umform: state of a formed part; units: {state.units}; global axes"
    yield "/NODE"
    for number, x in enumerate(state.points, start=1):
        yield whole([number], _TEN) + real(x, _TWENTY)
    for part in np.unique(state.parts):
        yield f"/{'SHELL' if state.shells else 'BRICK'}/{part}"
        for row in state.of_part(part):
            yield whole([row + 1, *(state.cells[row] + 1)], _TEN)
    yield "/INISHE/STRS_F/GLOB" if state.shells else "/INIBRI/STRS_FGLO"
    for number, (stress, plastic) in enumerate(zip(state.stress, state.plastic, strict=True), start=1):
        if state.heights is None or state.thickness is None:
            yield "# brick_ID Nb_integr   Isolnod    Isolid      nptr      npts      nptt      nlay grbric_ID"
            yield whole([number, 1, 8, 1, 1, 1, 1, 0, 0], _TEN)
            yield real([0.0, 0.0], _TWENTY)
            yield real(stress[0, :3], _TWENTY)
            yield real(stress[0, 3:], _TWENTY)
            yield real(plastic, _TWENTY)
            continue
        yield "# shell_ID nb_integr       npg               Thick"
        yield whole([number, len(state.heights), 1], _TEN) + real([state.thickness[number - 1].mean()], _TWENTY)
        yield real([0.0] * 5, _TWENTY)
        for t, s, p in zip(state.heights, stress, plastic, strict=True):
            yield real(s[:3], _TWENTY)
            yield real([*s[3:], p, t], _TWENTY)


def read_radioss(path: Path) -> FormedState:
    """Read the blocks that `radioss_lines` writes; a shell has one thickness.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    """
    points, stresses = list[list[float]](), list[str]()
    cells, parts = dict[int, list[int]](), dict[int, int]()
    shells = False
    for keyword, lines in blocks(path, "/", ["#"]):
        if keyword == "/NODE":
            points = [reals(line[_TEN:], _TWENTY, 3) for line in lines]
        elif keyword.startswith(("/SHELL/", "/BRICK/")):
            shells = keyword.startswith("/SHELL/")
            for line in lines:
                number, *nodes = map(int, columns(line, _TEN, 5 if shells else 9))
                cells[number], parts[number] = nodes, int(keyword.split("/")[-1])
        else:
            stresses = lines
    rows = np.array([cells[number] for number in sorted(cells)]) - 1
    of_cells = np.array([parts[number] for number in sorted(cells)])
    if not shells:
        cards = [
            reals(stresses[at + 2], _TWENTY, 3) + reals(stresses[at + 3], _TWENTY, 3) for at in _heads(stresses, 5)
        ]
        plastic = np.array([reals(stresses[at + 4], _TWENTY, 1) for at in _heads(stresses, 5)])
        return FormedState(np.array(points), rows, of_cells, np.array(cards)[:, None], plastic)
    count = int(stresses[0][_TEN : 2 * _TEN])
    size = 2 + 2 * count
    values = np.array(
        [
            [
                reals(stresses[at + 2 + 2 * k], _TWENTY, 3) + reals(stresses[at + 3 + 2 * k], _TWENTY, 5)
                for k in range(count)
            ]
            for at in _heads(stresses, size)
        ]
    )
    thickness = np.array([reals(stresses[at][3 * _TEN :], _TWENTY, 1) * 4 for at in _heads(stresses, size)])
    return FormedState(
        points=np.array(points),
        cells=rows,
        parts=of_cells,
        stress=values[..., :6],
        plastic=values[..., 6],
        thickness=thickness,
        heights=values[0, :, 7],
    )


def _heads(lines: list[str], size: int) -> range:
    return range(0, len(lines), size)
