"""Errors of numbers estimated from studies of other parts: a run on the finest mesh beside that of the default.

`STUDIES` is made by ``make bands`` from runs of a corpus of small parts; docs/bands.md has the parts and the check.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from umform.results.quantity import Band, Quantity

#: The errors that the studies have found.
STUDIES = Path(__file__).with_name("error_studies.json")
#: The mesh that a process has by default, and its coarse one.
DEFAULT, COARSE = "default", "coarse"
#: Numbers that are others times a length, or the same at another time.
_SAME = {"final_angle": "angle", "total_force": "largest_force", "force_on_width": "largest_force"}
#: A number of one of several equal features, such as bends and flanges.
_NUMBERED = re.compile(r"^bend \d+: |(?<=^flange) \d+$")


@dataclass(frozen=True)
class StudiedMesh:
    """The mesh of a run beside those of the studies.

    Attributes
    ----------
    process : str
        Process of the studies.
    mesh : str
        The nearest mesh of the studies, `DEFAULT` or `COARSE`.
    size : float
        Size of the elements over those of that mesh.
    softness : float
        What makes the errors of this run larger than those of others: they follow a power of it.
    length : float
        Length that errors in mm are proportional to, unless they are to the number.
    """

    process: str
    mesh: str = DEFAULT
    size: float = 1.0
    softness: float = 1.0
    length: float = 1.0

    @classmethod
    def nearest(cls, process: str, size: float, coarse: float, softness: float = 1.0) -> StudiedMesh:
        """The mesh of a process whose coarse mesh has elements of a relative size.

        Parameters
        ----------
        process : str
            Process of the studies.
        size, coarse : float
            Size of the elements over that of the default mesh: of the run, and of the coarse mesh of the studies.
        softness : float
            See above.
        """
        mesh, over = (COARSE, size / coarse) if size**2 > coarse else (DEFAULT, size)
        return cls(process, mesh, over, softness)

    @property
    def factor(self) -> float:
        """Error over that of the mesh of the studies: with the square of the size above it, linear below."""
        return max(self.size, self.size**2)


def studied_name(name: str) -> str:
    """Name of a number in the studies: that of a bend or flange without its number."""
    name = _NUMBERED.sub("", name)
    return _SAME.get(name, name)


@cache
def _found() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(STUDIES.read_text(encoding="utf-8"))
    return found


def estimated(one: Quantity, at: StudiedMesh) -> Band | None:
    """Band of a number from the studies of its process; None if they have not seen it.

    Parameters
    ----------
    one : Quantity
        The number.
    at : StudiedMesh
        Its process and mesh.
    """
    process = _found().get(at.process)
    row = None if process is None else process["quantities"].get(studied_name(one.name))
    if process is None or row is None or one.value is None:
        return None
    at = at if one.unit == "mm" else replace(at, length=1.0)
    return band_of(row, process["exponent"], one.value, at, f"studies of {_parts(process['parts'])} ({at.process})")


def _parts(count: int) -> str:
    return f"{count} other part{'s' * (count > 1)}"


def band_of(row: Mapping[str, Any], exponent: float, value: float, at: StudiedMesh, studies: str) -> Band | None:
    """Band from a row of the studies; None if it has not that mesh.

    Parameters
    ----------
    row : mapping
        ``factor`` of Student's distribution for the number of studies, whether errors are ``relative`` to the values,
        root mean squares of the errors by ``meshes`` and ``sources``.
    exponent : float
        Power of the softness that the errors follow.
    value : float
        The number.
    at : StudiedMesh
        Its process and mesh.
    studies : str
        What they are, in words.
    """
    meshes: Mapping[str, float] = row["meshes"]
    if at.mesh not in meshes:
        return None
    scale = (abs(value) if row["relative"] else at.length) * row["factor"] * at.softness**exponent
    parts = {name: scale * change for name, change in row["sources"].items()}
    if "mesh" in parts:
        parts["mesh"] *= at.factor
    return Band(scale * at.factor * meshes[at.mesh], f"estimated from {studies}, not from this run", sources=parts)
