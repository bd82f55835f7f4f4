"""Check the clearance between tools on both faces of the sheet, and the direction of their first strokes.

Both are found from the tools alone, at the values that the steps of kind move prescribe; a tool whose travel follows
from a force is left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from umform.model import Model
from umform.model.contact import Contact
from umform.model.contact.encounter import sheet_thickness
from umform.model.terms.control import Control
from umform.model.tools.tool import Pose, Tool
from umform.problem.controls import Drive, Moment, Press, Spring, Turn
from umform.problem.findings import Finding, ok, warning
from umform.problem.prepared import Prepared
from umform.problem.problem import Problem
from umform.problem.references import references
from umform.problem.steps import Move

Floats = NDArray[np.float64]
#: Clearance relative to the thickness below which a sheet is ironed or squeezed; a little less may be meant.
_TIGHT = 0.98
#: Points along the longer sides of the grid from which the surface of a tool is sampled; the least along the shortest
#: side, which has the spacing of the second one; and alternating projections.
_GRID, _FEW, _PROJECTIONS = 41, 3, 12
#: Growth of the gap over the travel of a tool that moves away from the sheet.
_AWAY = 0.5


def clearances(deck: Problem, problem: Prepared) -> Iterator[Finding]:
    """Smallest distance of each pair of tools on both faces of the sheet, at the ends of the steps."""
    thickness = sheet_thickness(problem.model.mesh)
    found: dict[tuple[str, str], tuple[float, Floats, int]] = {}
    for number, before, after in strokes(deck, problem):
        for lower, upper in _opposite(problem.model):
            now = [_pose(tool, after) for tool in (lower, upper)]
            then = [_pose(tool, before) for tool in (lower, upper)]
            if now[0] is None or now[1] is None or then[0] is None or then[1] is None:
                continue
            if _same(now[0], then[0]) and _same(now[1], then[1]):
                continue
            reach = np.abs(now[1][1] - then[1][1]) + np.abs(now[0][1] - then[0][1])
            distance, place = smallest_distance((lower, now[0]), (upper, now[1]), _region(problem.model, reach))
            names = lower.name, upper.name
            if np.isfinite(distance) and (names not in found or distance < found[names][0]):
                found[names] = distance, place, number
    for (lower_name, upper_name), (distance, place, number) in found.items():
        yield _judged(f"tools {lower_name}, {upper_name}", distance, place, number, thickness)


def _judged(about: str, distance: float, place: Floats, number: int, thickness: float) -> Finding:
    where = ", ".join(f"{x:.4g}" for x in place + 0.0)
    text = f"at the end of step {number} they are {distance:.4g} apart at ({where}), the sheet is {thickness:.4g} thick"
    if distance >= _TIGHT * thickness:
        return ok(about, text)
    remedy = (
        "beside a wall: a larger opening or a smaller punch, by twice the difference; at the bottom: a shorter stroke; "
        "none if the sheet is to be ironed or coined"
    )
    return warning(about, f"{text}: {100.0 * distance / thickness:.3g} % of it", remedy)


def away(deck: Problem, problem: Prepared) -> Iterator[Finding]:
    """Tools whose first stroke moves them away from the sheet, while no other tool approaches it.

    Where grips, loads or a pressure move the sheet too, as in stretch bending, it may follow a tool that moves away
    from its initial place: nothing is said.
    """
    if deck.contents.before is not None:  # tools of the operation before may open first
        return
    model, met = problem.model, set[Tool]()
    controls = deck.contents.controls
    used = {name for kind, name, _ in references(deck.source.data) if kind == "controls"}
    if not all(isinstance(controls[name], Drive | Turn | Press | Spring | Moment) for name in used & set(controls)):
        return
    for number, before, after in strokes(deck, problem):
        grown = {}
        for tool in model.tools:
            start, end = _pose(tool, before), _pose(tool, after)
            turns = start is not None and end is not None and not np.array_equal(start[0], end[0])
            if start is None or end is None or turns or _same(start, end) or not tool.pairs:
                continue
            gaps = [min(_least(pair, model.u, pose) for pair in tool.pairs) for pose in (start, end)]
            grown[tool] = gaps[0], gaps[1], float(np.linalg.norm(end[1] - start[1]))
        nearer = any(last < first for first, last, _ in grown.values())
        for tool, (first, last, way) in grown.items():
            if tool not in met and not nearer and last - first > _AWAY * way > 0.0:
                text = f"the stroke moves the tool {tool.name} away from the sheet: gap {first:.4g}, then {last:.4g}"
                names = " or ".join(control.name for control in tool.ways)
                yield warning(f"step {number}", text, f"the other sign or direction of {names}")
        met |= set(grown)


def strokes(deck: Problem, problem: Prepared) -> Iterator[tuple[int, dict[str, float], dict[str, float]]]:
    """Number of each step of kind move, and the values of the controls before and after it; NaN if unknown."""
    values = {name: float(control.value) for name, control in problem.controls.items()}
    for number, step in enumerate(deck.contents.steps, 1):
        if isinstance(step, Move):
            before, after = dict(values), values | step.to
            for name, table in step.follow.items():
                leading, following = np.array(sorted(table)).T
                after[name] = float(np.interp(next(iter(step.to.values())), leading, following))
            values = after
            yield number, before, after
        elif step.kind == "arc":
            values |= dict.fromkeys(step.to, np.nan)
        elif step.kind in ("release", "close"):
            values[step.control] = np.nan
        else:  # open tools hold nothing
            return


def _opposite(model: Model) -> list[tuple[Tool, Tool]]:
    """Pairs of tools of which one touches the lower and the other the upper faces."""
    sides = {tool: {int(side) for pair in tool.pairs for side in pair.faces[:, 1]} for tool in model.tools}
    below, above = ([tool for tool, side in sides.items() if side == {k}] for k in (0, 1))
    return [(lower, upper) for lower in below for upper in above]


def _pose(tool: Tool, values: Mapping[str, float]) -> Pose | None:
    """Pose of a tool at values of its controls; None if it is unknown."""
    at: dict[Control, float] = {way: values.get(way.name, np.nan) for way in tool.ways}
    if tool.presses or tool.motion is not None or not np.isfinite(list(at.values())).all():
        return None
    return tool.pose(at, 0.0)


def _same(one: Pose, other: Pose) -> bool:
    return np.array_equal(one[0], other[0]) and np.array_equal(one[1], other[1])


def _least(pair: Contact, u: Floats, pose: Pose) -> float:
    """Smallest gap of a contact pair."""
    gap = pair.locate(u, pose).gap
    return float(np.nanmin(gap)) if np.isfinite(gap).any() else np.nan


def _region(model: Model, reach: Floats) -> tuple[Floats, Floats]:
    """Corners of the box that the sheet may reach."""
    x = model.positions
    return x.min(axis=0) - reach, x.max(axis=0) + reach


def smallest_distance(
    one: tuple[Tool, Pose], other: tuple[Tool, Pose], box: tuple[Floats, Floats]
) -> tuple[float, Floats]:
    """Smallest distance of two tools within a box, negative where they overlap, and its place.

    Feet of a grid of points on the first tool are measured in the second one; alternating projections of the nearest
    of them lead to the nearest points of both.
    """
    sides = box[1] - box[0]
    counts = np.clip(np.ceil((_GRID - 1) * sides / np.sort(sides)[1]) + 1, _FEW, _GRID).astype(int)
    axes = [np.linspace(low, high, n) for low, high, n in zip(*box, counts, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    best, place = np.inf, np.zeros(3)
    for first, second in ((one, other), (other, one)):
        feet = _feet(*first, grid)
        feet = feet[((feet >= box[0] - 1e-9) & (feet <= box[1] + 1e-9)).all(axis=1)]
        for _ in range(_PROJECTIONS):
            if len(feet) == 0:
                break
            gap, normal = _measured(*second, feet)
            known = np.isfinite(gap) & np.isfinite(normal).all(axis=1)
            gap, normal, feet = gap[known], normal[known], feet[known]
            order = np.argsort(gap)[:64]
            if len(order) == 0:
                break
            if gap[order[0]] < best:
                best, place = float(gap[order[0]]), feet[order[0]] - 0.5 * gap[order[0]] * normal[order[0]]
            if best < 0.0:
                break
            feet = _feet(*first, feet[order] - gap[order, None] * normal[order])
    return best, place


def _feet(tool: Tool, pose: Pose, points: Floats) -> Floats:
    """Nearest points of a tool; those that do not lie on it, behind an edge, are left out."""
    gap, normal = _measured(tool, pose, points)
    feet = (points - gap[:, None] * normal)[np.isfinite(gap) & np.isfinite(normal).all(axis=1)]
    size = float(np.abs(points).max(initial=1.0))
    return feet[np.abs(_measured(tool, pose, feet)[0]) < 1e-6 * size]


def _measured(tool: Tool, pose: Pose, points: Floats) -> tuple[Floats, Floats]:
    """Signed distances (n,) and normals (n, 3) in the pose of a tool."""
    rotation, shift = pose
    gap, normal = tool.kernel.gap(np.ascontiguousarray((points - shift) @ rotation))[:2]
    return gap, normal @ rotation.T
