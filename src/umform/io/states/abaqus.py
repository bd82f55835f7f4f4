"""Input files of Abaqus and CalculiX: nodes, solids and *INITIAL CONDITIONS.

Abaqus takes one state for each element, CalculiX stresses at each integration point.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from umform.io.states.lines import blocks
from umform.io.states.state import Floats, FormedState

#: Order 11 22 33 12 13 23 of both programs, from and to 11 22 33 12 23 13.
_ORDER = [0, 1, 2, 3, 5, 4]
#: Numbers in the first line and in further ones of *INITIAL CONDITIONS, TYPE=SOLUTION.
_FIRST, _MORE = 7, 8


def abaqus_lines(state: FormedState) -> Iterator[str]:
    """The lines of the file: one point an element."""
    yield from _mesh(state, "C3D8R")
    yield "*INITIAL CONDITIONS, TYPE=STRESS"
    for number, stress in enumerate(state.stress[:, 0, _ORDER], start=1):
        yield f"{number}, {_texts(stress)}"
    if state.plastic.any():
        yield "*INITIAL CONDITIONS, TYPE=HARDENING"
        for number, plastic in enumerate(state.plastic[:, 0], start=1):
            yield f"{number}, {_texts([plastic])}"
    if state.history is not None and state.history.size:
        names = ", ".join(f"{name} ({size})" for name, size in state.variables.items())
        yield f"** state variables in their order: {names}"
        yield "*INITIAL CONDITIONS, TYPE=SOLUTION"
        for number, values in enumerate(state.history, start=1):
            yield f"{number}, {_texts(values[:_FIRST])}"
            for at in range(_FIRST, len(values), _MORE):
                yield _texts(values[at : at + _MORE])


def calculix_lines(state: FormedState) -> Iterator[str]:
    """The lines of the file: eight points an element."""
    yield from _mesh(state, "C3D8I")
    yield "*INITIAL CONDITIONS, TYPE=STRESS"
    for number, stresses in enumerate(state.stress[..., _ORDER], start=1):
        for point, stress in enumerate(stresses, start=1):
            yield f"{number}, {point}, {_texts(stress)}"


def _mesh(state: FormedState, element: str) -> Iterator[str]:
    yield f"** umform: state of a formed part; units: {state.units}; global axes, order 11 22 33 12 13 23"
    yield "*NODE, NSET=SHEET"
    for number, x in enumerate(state.points, start=1):
        yield f"{number}, {_texts(x)}"
    for part in np.unique(state.parts):
        yield f"*ELEMENT, TYPE={element}, ELSET=PART{part}"
        for row in state.of_part(part):
            yield ", ".join(str(int(number)) for number in (row + 1, *(state.cells[row] + 1)))


def _texts(values: Floats | list[float]) -> str:
    return ", ".join(f"{value:.12E}" for value in map(float, values))


def read_initial_conditions(path: Path) -> FormedState:
    """Read the keywords that `abaqus_lines` and `calculix_lines` write.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    """
    found: dict[str, list[list[float]]] = {}
    cells, parts = dict[int, list[int]](), dict[int, int]()
    points = np.zeros((0, 3))
    for keyword, lines in blocks(path, "*", ["**"]):
        rows = [[float(text) for text in line.split(",")] for line in lines]
        if keyword.startswith("*NODE"):
            points = np.array(rows)[:, 1:]
        elif keyword.startswith("*ELEMENT"):
            for number, *nodes in rows:
                cells[int(number)] = [int(node) - 1 for node in nodes]
                parts[int(number)] = int(keyword.rpartition("PART")[2])
        elif keyword.startswith("*INITIAL CONDITIONS"):
            found[keyword.rpartition("=")[2]] = rows
    count = len(cells)
    stress = np.array(found["STRESS"])[:, -6:].reshape(count, -1, 6)[..., _ORDER]
    plastic = np.array(found["HARDENING"])[:, 1:] if "HARDENING" in found else np.zeros(stress.shape[:2])
    history = None
    if "SOLUTION" in found:
        flat, lines_each = found["SOLUTION"], len(found["SOLUTION"]) // count
        history = np.array([np.concatenate(flat[k : k + lines_each])[1:] for k in range(0, len(flat), lines_each)])
    of_cells = np.array([parts[number] for number in sorted(cells)])
    rows_of_cells = np.array([cells[number] for number in sorted(cells)])
    return FormedState(points, rows_of_cells, of_cells, stress, plastic, history=history)
