"""Runs of a deck that correct the outline of its blank until the formed edge is where it is wanted. eq. (6.16)"""

from __future__ import annotations

import logging
import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.flat_pattern.net.edge import Edge
from umform.flat_pattern.net.star import Star, stretched
from umform.flat_pattern.net.wanted import OnOutline, Wanted, height
from umform.flat_pattern.one_step import corrected_blank, mid_surface
from umform.mesh import Mesh
from umform.problem.named_units import length_of
from umform.problem.problem import Problem
from umform.progress import Show
from umform.report.symmetry import mirrors_of_blank
from umform.surfaces.dxf import MILLIMETRE

log = logging.getLogger("umform")

Floats = NDArray[np.float64]

#: Smallest and largest factor on a step of the outline: beyond, the change is noise of the mesh.
_FACTORS = (0.5, 1.5)


@dataclass(frozen=True, eq=False)
class NetRun:
    """A run with a blank.

    Attributes
    ----------
    blank : Star
        Edge of the blank of the modelled part.
    formed : ndarray, shape (k, 3)
        Places of its corners at the end of the run.
    distance : ndarray, shape (k,)
        Their distances from where they are wanted.
    """

    blank: Star
    formed: Floats
    distance: Floats

    @property
    def largest(self) -> float:
        """The largest distance."""
        return float(self.distance.max())

    @property
    def mean(self) -> float:
        """Their mean."""
        return float(self.distance.mean())


@dataclass(frozen=True, eq=False)
class NetBlank:
    """A corrected blank: that of the run whose edge is nearest to where it is wanted.

    Attributes
    ----------
    deck : Problem
        The deck with the mesh of this blank.
    mesh : Path
        File of the mesh.
    edge : Edge
        The edge of the first blank.
    runs : list of NetRun
        The runs, the first with the blank as it was.
    """

    deck: Problem
    mesh: Path
    edge: Edge
    runs: list[NetRun]

    @cached_property
    def best(self) -> NetRun:
        """The run with the smallest largest distance."""
        return min(self.runs, key=lambda run: run.largest)

    @property
    def outline(self) -> Floats:
        """The whole closed outline of the blank, shape (n, 2); the last point is the first."""
        return self.edge.whole(self.best.blank)

    @property
    def table(self) -> list[tuple[str, str, str]]:
        """Header and rows: distances of the formed edge from where it is wanted, by run."""
        names = ["the blank as it was", *(f"correction {k}" for k in range(1, len(self.runs)))]
        unit = length_of(self.deck)
        digits = 3 - round(math.log10(MILLIMETRE[unit]))
        rows = [
            (name, f"{run.largest:.{digits}f}", f"{run.mean:.{digits}f}")
            for name, run in zip(names, self.runs, strict=True)
        ]
        return [("blank", f"largest distance, {unit}", f"mean, {unit}"), *rows]


def net_blank(
    deck: Problem,
    wanted: ArrayLike | float,
    mesh: str | Path,
    *,
    corrections: int = 2,
    first: ArrayLike | None = None,
    progress: Show = None,
) -> NetBlank:
    """Correct the outline of a blank by runs of its deck, so that the formed edge ends where it is wanted.

    After each run the wanted places are mapped back through its deformation (`umform.corrected_blank`), the mesh of the
    blank is stretched to them, and the deck is run again. From the second correction on, a factor accounts for how the
    draw-in has changed with the blank. The formed edge is that at the end of the last step.

    Parameters
    ----------
    deck : Problem
        A deck with a flat blank of one layer of hexahedra; planes of symmetry across x or y are found.
    wanted : array_like, shape (n, 2) or (n, 3), or float
        Outline of the formed part, whole or of the modelled part, in the unit of the deck; without z it is seen along
        z. A number is the height of the edge over the bottom, both on the mid-surface: of a cup.
    mesh : str or Path
        File for the mesh of the corrected blank, ``.inp``; a relative path is from the folder of the deck.
    corrections : int
        Number of corrections, each with its run.
    first : array_like, shape (n, 2), optional
        Outline of the first blank, such as the estimate of `umform.blank`; default: that of the deck.
    progress : bool or callable, optional
        As for :func:`umform.solve`.

    Raises
    ------
    InvalidValue
        If the deck does not begin with its blank, this has several layers, holes or arms, or an outline is not one
        around the middle of the blank, does not reach over the modelled part, or is far from the formed sheet.
    NoConvergence
        If a run does not reach its end.
    """
    if not (isinstance(corrections, int) and 1 <= corrections <= 10):
        raise InvalidValue("a blank is corrected once to ten times", where="corrections", value=corrections, remedy="2")
    if deck.before is not None or deck.start is not None or deck.contents.placement is not None:
        raise InvalidValue(
            "a part of an operation before, or one that is placed elsewhere, is no flat blank",
            where="deck",
            value=deck.source.name,
            cause="its table before or placement",
            remedy="the deck of the first operation, with the edge that its part should have",
        )
    file = Path(mesh)
    trial = file.with_name(f"{file.stem}-trial{file.suffix}")
    model = deck.build().model
    edge = Edge.of(model.mesh, mirrors_of_blank(model))
    own, centre = edge.star, edge.star.centre
    rays = np.arctan2(*(own.points - centre).T[::-1])

    def around(points: ArrayLike, name: str) -> Star:
        """An outline that the rays through the corners of the edge meet."""
        star = Star.of(points, centre, name)
        star.check_reaches(rays, name)
        return star

    def on_rays(points: ArrayLike, name: str) -> Star:
        """An outline by its places on these rays, which keep them."""
        return Star(centre, around(points, name).at(rays))

    goal: Wanted = height(float(wanted)) if isinstance(wanted, int | float) else OnOutline(around(wanted, "wanted"))

    stars, runs, steps = [own if first is None else on_rays(first, "first")], list[NetRun](), list[Floats]()
    factor = 1.0
    changed = deck
    try:
        while len(runs) <= corrections:
            if first is not None or runs:
                changed = _with(deck, stretched(model.mesh, own, stars[-1]), trial)
            problem = changed.build()
            problem.solve(progress=progress)
            blank, u = problem.model.mesh, problem.model.u
            formed, surface = edge.formed(blank, u), mid_surface(blank, u).points
            runs.append(NetRun(stars[-1], formed, goal.distance(formed, surface)))
            log.info("blank %d: largest distance %.4g, mean %.4g", len(runs), runs[-1].largest, runs[-1].mean)
            if len(runs) <= corrections:
                steps.append(corrected_blank(blank, u, goal.places(formed, surface)) - stars[-1].points)
                factor = _factor(factor, steps)
                stars.append(on_rays(stars[-1].points + factor * steps[-1], "the corrected blank"))
    finally:
        (deck.source.folder / trial).unlink(missing_ok=True)
    best = min(runs, key=lambda run: run.largest)
    return NetBlank(_with(deck, stretched(model.mesh, own, best.blank), file), file, edge, runs)


def _factor(before: float, steps: list[Floats]) -> float:
    """Factor on the last step: 1 for the first one, then by what the step before has changed (Aitken). eq. (6.18)"""
    if len(steps) == 1:
        return before
    last, change = steps[-2], steps[-1] - steps[-2]
    found = -before * float((last * change).sum()) / max(float((change * change).sum()), 1e-300)
    return min(max(found, _FACTORS[0]), _FACTORS[1])


def _with(deck: Problem, mesh: Mesh, file: Path) -> Problem:
    """The deck with another mesh, which is written to a file with its sets of nodes."""
    sets = {name: mesh.nodes(name) for name in {**mesh.faces, **mesh.sets}}
    whole = meshio.Mesh(mesh.points, [("hexahedron", mesh.connectivity)], point_sets=sets)
    meshio.write(deck.source.folder / file, whole, file_format="abaqus")
    return deck.with_({"mesh": {"file": file.as_posix()}})
