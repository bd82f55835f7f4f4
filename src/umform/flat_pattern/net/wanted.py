"""Where the edge of a formed part is wanted: on an outline, or at a height of the part."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from umform.errors import FileProblem, InvalidValue
from umform.flat_pattern.net.star import Star
from umform.flat_pattern.one_step import distance_to_outline
from umform.spec.types import FARTHEST
from umform.surfaces import Profile
from umform.surfaces.chains import chain
from umform.surfaces.dxf import MILLIMETRE, read_dxf

Floats = NDArray[np.float64]

#: Distance of a polyline from arcs of a drawing, mm.
_CHORD = 0.005


class Wanted(Protocol):
    """Where an edge is wanted."""

    def places(self, edge: Floats, surface: Floats) -> Floats:
        """The place wanted for each point of the formed edge, shape (k, 2) or (k, 3).

        The points of the edge and of the whole mid-surface have the shapes (k, 3), (n, 3).
        """

    def distance(self, edge: Floats, surface: Floats) -> Floats:
        """Distance of each point of the formed edge from where it is wanted, shape (k,)."""


@dataclass(frozen=True, eq=False)
class OnOutline:
    """An outline, seen along z if it has no z: of a flange.

    Attributes
    ----------
    star : Star
        The outline: the whole, or that of the modelled part.
    """

    star: Star

    def places(self, edge: Floats, surface: Floats) -> Floats:
        """Where the ray through each point of the edge meets the outline."""
        del surface
        return self.star.at(np.arctan2(*(edge[:, :2] - self.star.centre).T[::-1]))

    def distance(self, edge: Floats, surface: Floats) -> Floats:
        """Distance from the outline."""
        del surface
        points = self.star.points
        line = np.concatenate([points, points[:1]]) if self.star.closed else points
        return distance_to_outline(edge[:, : points.shape[1]], line)


@dataclass(frozen=True)
class AtHeight:
    """A height of the edge over the bottom of the part, along z: of a cup.

    Attributes
    ----------
    height : float
        From the mid-surface of the bottom.
    """

    height: float

    def places(self, edge: Floats, surface: Floats) -> Floats:
        """The points of the edge at the height."""
        z = surface[:, 2]
        below = edge[:, 2].mean() > 0.5 * (z.min() + z.max())
        level = z.min() + self.height if below else z.max() - self.height
        return np.concatenate([edge[:, :2], np.full((len(edge), 1), level)], axis=1)

    def distance(self, edge: Floats, surface: Floats) -> Floats:
        """Distance from the height."""
        return np.asarray(abs(self.places(edge, surface)[:, 2] - edge[:, 2]))


def outline_of(path: str | Path, layer: str | None = None, unit: str = "mm") -> Floats:
    """Corners of an outline in a file, shape (n, 2) or (n, 3).

    Parameters
    ----------
    path : str or Path
        A DXF drawing of one closed curve, or a CSV table with the columns x, y or x, y, z; a heading is left out.
    layer : str, optional
        The layer of the drawing with the curve; by default all of it is the curve.
    unit : str
        Unit to which a drawing is converted.

    Raises
    ------
    FileProblem, OpenSection
        If the file cannot be read.
    InvalidValue
        If there is no such layer, or the file has no layers.
    """
    if Path(path).suffix.lower() == ".dxf":
        chord = _CHORD * MILLIMETRE[unit]
        return Profile(*chain(*read_dxf(path, layer, unit, chord), str(path))).points(chord)  # a half has no solid
    if layer is not None:
        raise InvalidValue("only a drawing has layers", where=str(path), value=layer, remedy="leave the layer out")
    try:
        with warnings.catch_warnings(action="ignore"):  # of an empty file
            rows = np.genfromtxt(path, delimiter=",", comments="#", ndmin=2)
        if rows.shape[1] not in (2, 3):
            raise ValueError(f"it has {rows.shape[1]} columns between commas")
    except (OSError, ValueError) as error:
        raise FileProblem(
            "the outline cannot be read",
            where=str(path),
            cause=" ".join(str(error).split())[:200],
            remedy="a DXF drawing with one closed curve, or a CSV file with columns x, y or x, y, z",
        ) from error
    known = np.isfinite(rows).all(axis=1)
    heading = not np.isfinite(rows[0]).any()
    if not known[heading:].all():
        raise FileProblem(
            "a row of the outline is no point",
            where=f"{path}, row {int(np.argmin(known[heading:])) + heading + 1}",
            cause="an empty cell, or a unit behind a number",
            remedy="x, y or x, y, z in each row below the heading",
        )
    return np.asarray(rows[known])


def height(value: float) -> AtHeight:
    """A wanted height.

    Raises
    ------
    InvalidValue
        If it is not positive and finite.
    """
    if not 0.0 < value <= FARTHEST:
        raise InvalidValue(
            "the height of a part is positive",
            where="height",
            value=value,
            cause=f"a sign, nan, or beyond {FARTHEST:g}",
            remedy="from the bottom to the edge, in the unit of the deck",
        )
    return AtHeight(value)
