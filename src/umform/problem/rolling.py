"""The rolling direction of a deck: a vector, an angle to the bend line, or a file with a vector for each cell."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from umform.elements import Rolling, rolling_at
from umform.errors import FileProblem
from umform.problem.notes import Discriminator, Field, Tag
from umform.problem.parts import Part, Vector, Way, word_or_array
from umform.surfaces import unit_vector


class AtAngle(Part):
    """An angle to the bend line in the plane of the sheet."""

    angle: float
    """Degrees from the bend line to the rolling direction: 0 along the line, 90 across it."""
    line: Way = "y"
    """Bend line."""
    normal: Way = "z"
    """Normal of the sheet."""


class EachCell(Part):
    """A vector for each cell."""

    file: Annotated[str, Field(min_length=1)]
    """CSV file, three numbers for each cell in the order of the mesh; path from the folder of the deck."""


def _kind(value: Any) -> str | None:
    if isinstance(value, dict):
        return "file" if "file" in value else "angle"
    if isinstance(value, AtAngle | EachCell):
        return "file" if isinstance(value, EachCell) else "angle"
    return word_or_array(value)


RollingPart = Annotated[
    Annotated[str, Field(pattern="^-?[xyz]$"), Tag("word")]
    | Annotated[Vector, Tag("array")]
    | Annotated[AtAngle, Tag("angle")]
    | Annotated[EachCell, Tag("file")],
    Discriminator(
        _kind,
        custom_error_type="rolling",
        custom_error_message="rolling is x, -y, ..., three numbers, { angle = 45 } or { file = 'cells.csv' }",
    ),
]


def direction(part: str | Vector | AtAngle | EachCell, folder: Path) -> Rolling:
    """The rolling direction in the form of a model.

    Raises
    ------
    FileProblem
        If the file cannot be read, or has rows other than three numbers.
    """
    if isinstance(part, AtAngle):
        return rolling_at(part.angle, unit_vector(part.line, "line"), unit_vector(part.normal, "normal"))
    if isinstance(part, EachCell):
        return _vectors(folder / part.file)
    return unit_vector(part, "rolling")


def _vectors(path: Path) -> np.ndarray[Any, np.dtype[np.float64]]:
    remedy = "a CSV file with three numbers in each row, one row for each cell, and no header"
    try:
        with warnings.catch_warnings(action="ignore"):  # of an empty file
            rows = np.loadtxt(path, delimiter=",", ndmin=2)
    except OSError as error:
        raise FileProblem(
            "the rolling directions cannot be read", where=str(path), cause=error.strerror or "", remedy=remedy
        ) from None
    except ValueError as error:
        raise FileProblem(
            "the rolling directions are not numbers", where=str(path), cause=str(error), remedy=remedy
        ) from None
    if rows.shape[1] != 3:
        raise FileProblem(
            "a rolling direction has three numbers",
            where=str(path),
            value=f"{rows.shape[1]} columns" if rows.size else "no row",
            cause="another separator than a comma, or another table" if rows.size else "an empty file",
            remedy=remedy,
        )
    return rows
