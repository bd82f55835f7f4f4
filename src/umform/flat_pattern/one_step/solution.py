"""The way to the places in the flat: conformal start, minimum of an energy, equilibrium, first with softer laws."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.errors import SolveError
from umform.flat_pattern.one_step.forces import Friction, Restraint, outer_sides, smoothed
from umform.flat_pattern.one_step.law import PathLaw
from umform.flat_pattern.one_step.part import Sheet
from umform.flat_pattern.one_step.places import CONVERGED, ROUGH, Balance, FlatProblem
from umform.flat_pattern.one_step.start import first_places, with_outline
from umform.flat_pattern.one_step.strain import Formed, areas, flat_sides, log_strains, work
from umform.flat_pattern.one_step.tool_friction import ToolFriction

Floats = NDArray[np.float64]

#: Part of the drawing stress that pulls the edge: its mean over the flange and the way. eq. (6.11)
DRAWN = 0.5
#: Distance along the edge over which the drawing stress is averaged, over its length.
_REACH = 0.02
#: A sheet of less than this part of its thickness is torn.
_TORN = 0.4
#: How often it is determined under all loads at most, and its relative change at which it is steady.
_SWEEPS, _STEADY = 6, 0.02
#: First and least increment of the loads, and the least mean strain that sets the law.
_FIRST_PART, _LEAST, _LEAST_STRAIN = 0.5, 0.02, 0.02


@dataclass(frozen=True, eq=False)
class Found:
    """Places in the flat.

    Attributes
    ----------
    X : ndarray, shape (n, 2)
        Places, with x and y of the part.
    loads : float
        Part of the forces and of the drawing stress for which an equilibrium exists; 1 for all.
    iterations : int
        Of Newton's method.
    ironed : float
        Part of the ironing for which an equilibrium exists under all forces.
    """

    X: Floats
    loads: float
    iterations: int
    ironed: float = 1.0


def flat_places(
    sheet: Sheet,
    law: PathLaw,
    forces: Sequence[Friction | Restraint] = (),
    *,
    friction: float = 0.0,
    clamped: bool = False,
) -> Found:
    """Places of all points in the flat.

    Parameters
    ----------
    sheet : Sheet
        The formed part.
    law : PathLaw
        Law of the sheet.
    forces : sequence of Friction or Restraint
        What holds the sheet back.
    friction : float
        Coefficient of friction of punch and die where the sheet is curved; not of clamped parts.
    clamped : bool
        Whether the outer edge has not moved in x and y.

    Raises
    ------
    NoConvergence
        If the sheet has no equilibrium without forces.
    """
    formed = Formed.of(sheet.points, sheet.triangles)
    held = np.zeros(len(sheet.points), dtype=bool)
    if clamped:
        held[sheet.loops[0]] = True
    problem = FlatProblem(sheet, formed, law, held)
    X = with_outline(sheet, formed) if clamped else first_places(sheet, formed)
    X = problem.minimum(X, law.linear.isotropic)
    if clamped:
        for of_flat in (False, True):
            X = problem.minimum(X, law, of_flat=of_flat)
        return Found(Balance(problem, X).solve(X), 1.0, problem.iterations)
    problem.law = law.linear
    X = laid(X, sheet, formed)
    balance = Balance(problem, X)
    tools = ToolFriction.of(sheet, formed, friction) if friction else None
    return _drawn(balance, balance.solve(X, ROUGH), law, forces, tools)


def _drawn(
    balance: Balance, X: Floats, law: PathLaw, forces: Sequence[Friction | Restraint], tools: ToolFriction | None
) -> Found:
    """With forces and drawing stress, then with ironing, or as much of them as has an equilibrium.

    The path goes to 1 with the forces, and to 2 with the ironing of what is thicker than the gap.
    """
    problem, formed = balance.problem, balance.problem.formed
    end = 1.0 if math.isinf(law.thickest) else 2.0
    done, way, more = 0.0, _FIRST_PART, _SWEEPS
    before: list[Restraint] = []
    reached: tuple[PathLaw, Sequence[Friction | Restraint]] = problem.law, ()
    while more and way >= _LEAST:
        part = min(done + way, end)
        now = [drawing_tension(problem, X, law), *([tools.at(X, problem.law)] if tools else [])]
        mean = [a.mean(b) for a, b in zip(now, before, strict=True)] if before else now
        steady = done == part and all(a.differs(b) < _STEADY for a, b in zip(mean, before, strict=True))
        D = flat_sides(X, problem.sheet.triangles)
        strain = law.equivalent(log_strains(X, problem.sheet.triangles, formed))
        smooth = law.smooth(max(float(formed.area @ strain / formed.area.sum()), _LEAST_STRAIN))
        thick = float(np.log(areas(D) / formed.area).max())
        left = (end - part) * max(thick - law.thickest, 0.0) / max(end - done, 1e-9)
        problem.law = replace(smooth, thickest=law.thickest + left if part > 1.0 else math.inf)
        problem.forces = [force.times(min(part, 1.0)) for force in (*mean, *forces)]
        try:
            other = balance.solve(X, CONVERGED if steady or more == 1 else ROUGH)
            thinnest = float((areas(flat_sides(other, problem.sheet.triangles)) / formed.area).min())
        except SolveError:
            thinnest = 0.0
        if thinnest < _TORN:
            way *= 0.5
            continue
        X = other
        done, before, reached = part, mean, (problem.law, problem.forces)
        more = 0 if steady else more - (done == end)
    if done < end:
        problem.law, problem.forces = reached
        X = balance.solve(X)
    return Found(X, min(done, 1.0), problem.iterations, ironed=max(done - 1.0, 0.0) if end > 1.0 else 1.0)


def drawing_tension(problem: FlatProblem, X: Floats, law: PathLaw) -> Restraint:
    """The tension that drew the sheet: a part of the work that formed its outer edge, by volume. eq. (6.11)"""
    sheet, formed = problem.sheet, problem.formed
    D = flat_sides(X, sheet.triangles)
    outer = outer_sides(sheet)
    owner = sheet.boundary_triangles[outer]
    W = work(D[owner], formed.inverse[owner], replace(law, thickest=math.inf), second=False).value
    sides = sheet.points[sheet.boundary[outer]]
    lengths = np.linalg.norm(sides[:, 1] - sides[:, 0], axis=1)
    per_length = DRAWN * W * areas(D)[owner] / formed.area[owner]
    return Restraint.on(sheet, formed, smoothed(per_length, lengths, _REACH * float(lengths.sum())))


def laid(X: Floats, sheet: Sheet, formed: Formed) -> Floats:
    """The flat moved and turned in its plane onto the part as seen along z, by least squares; never mirrored."""
    share = formed.area / formed.area.sum()
    x, y = X[sheet.triangles], sheet.points[sheet.triangles, :2]
    from_x, to_y = (share @ corners.mean(axis=1) for corners in (x, y))
    x, y = x - from_x, y - to_y
    C = np.einsum("m,mai,maj->ij", share / 12.0, x, y)
    C += np.einsum("m,mi,mj->ij", share / 12.0, x.sum(axis=1), y.sum(axis=1))
    angle = math.atan2(C[0, 1] - C[1, 0], C[0, 0] + C[1, 1])
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray((X - from_x) @ np.array([[c, s], [-s, c]]) + to_y)
