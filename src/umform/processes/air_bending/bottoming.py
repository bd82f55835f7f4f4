"""Bottoming: press the sheet onto the flanks of the die with a given force."""

from __future__ import annotations

import math
from dataclasses import replace

from umform.errors import InvalidValue, SolveError
from umform.processes.air_bending.bend import Loaded
from umform.processes.air_bending.brake import FRAMES, Brake
from umform.processes.air_bending.goal import Goal
from umform.processes.air_bending.loading import part_end
from umform.processes.air_bending.search import Found
from umform.processes.air_bending.spec import AirBending
from umform.progress import Tick, progress_bar
from umform.spec import check_arguments, check_value

#: Relative tolerance of the force, and number of trials.
_TOLERANCE, _MOST_TRIALS = 0.005, 30


def press_to_force(
    case: AirBending,
    force_per_metre: float,
    *,
    tolerance: float = _TOLERANCE,
    frames: int = FRAMES,
    solver: str = "auto",
    progress: bool | None = None,
    brake: Brake | None = None,
) -> Found:
    """Bend a sheet onto the flanks of the die, press it with a force, and unload it.

    Parameters
    ----------
    case : AirBending
        The parameters, with ``bottoming=True``; the stroke is not used.
    force_per_metre : float
        Force of the punch in kN/m.
    tolerance : float
        Largest relative deviation of the force.
    frames : int
        Approximate number of states kept for pictures, as in `air_bending`.
    solver : str
        Sparse solver.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.
    brake : Brake, optional
        A sheet of the same case that is already loaded, instead of a new one.

    Returns
    -------
    Found
        The bend with the stroke of this force; its trials are pairs of stroke and angle after unloading.

    Raises
    ------
    InvalidValue
        If the case does not bottom, air bending already needs a larger force, or the force compresses the sheet by more
        than half of its thickness.
    NoConvergence
        If the sheet cannot be pressed to this force.
    """
    check_arguments(press_to_force, case=case, tolerance=tolerance, frames=frames, solver=solver)
    force = force_per_metre
    check_value(Goal, "force_per_metre", force)
    if not case.bottoming:
        raise InvalidValue(
            "these tools are for air bending",
            where="bottoming",
            value=case.bottoming,
            cause="bottoming=False",
            remedy="AirBending(bottoming=True, punch_angle=88, die_angle=88)",
        )
    with progress_bar(progress) as tick:
        brake = brake or Brake(case, solver, max(1, frames))
        state = _closed_in(brake, force, tolerance, *_bracket(brake, force, tick))
        measures = brake.unload()
        bend = replace(brake.end(state, measures), searched="force")
    return Found(bend, ((measures.stroke, measures.angle),), brake.run.iterations)


def _bracket(brake: Brake, force: float, tick: Tick) -> tuple[tuple[float, float], tuple[float, float]]:
    """Strokes and forces of two successive increments between which the force is reached."""
    case, limit = brake.case, brake.case.stroke_limit
    number, in_the_air = 0, 0.0
    while True:
        number += 1
        stroke = min(part_end(case, number), limit)
        state = brake.load(stroke)
        tick("loading", stroke / limit)
        if not state.against:
            in_the_air = state.largest_force
        if force <= in_the_air:
            raise InvalidValue(
                "the force is that of air bending: the sheet does not lie on the flanks yet",
                where="force_per_metre",
                value=force,
                cause=f"in the air the sheet needs up to {in_the_air:.4g} kN/m",
                remedy="3 to 5 times that force, or a wider opening",
            )
        forces, strokes = brake.forces(), brake.run.result["stroke"]
        beyond = int((forces >= force).argmax())
        if forces[beyond] >= force:
            return tuple((float(strokes[k]), float(forces[k])) for k in (beyond - 1, beyond))  # type: ignore[return-value]
        if stroke == limit:
            raise InvalidValue(
                "the force squeezes the sheet by more than half of its thickness",
                where="force_per_metre",
                value=force,
                cause=f"half a thickness beyond the bottom the force is {state.force:.4g} kN/m",
                remedy="a smaller force",
            )


def _closed_in(
    brake: Brake, force: float, tolerance: float, low: tuple[float, float], high: tuple[float, float]
) -> Loaded:
    """The state under the force: secants of the logarithm of the force, bisection if they converge slowly."""
    for trial in range(_MOST_TRIALS):
        part = 0.5
        if trial % 3 < 2 and low[1] > 0.0:
            part = min(max(math.log(force / low[1]) / math.log(high[1] / low[1]), 0.02), 0.98)
        state = brake.load(low[0] + part * (high[0] - low[0]))
        if abs(state.force - force) <= tolerance * force:
            return state
        low, high = ((state.stroke, state.force), high) if state.force < force else (low, (state.stroke, state.force))
    raise SolveError(
        "the stroke for the force cannot be closed in",
        where="press_to_force",
        value=f"{low}, {high}",
        cause="the force jumps: a coarse mesh, or large increments",
        remedy="smaller elements or increments, or --travel in place of the force",
    )


def with_travel(case: AirBending, travel: float) -> AirBending:
    """The case with the stroke that ends at a distance beyond contact of the sheet with flanks and tip.

    Raises
    ------
    InvalidValue
        If it compresses the sheet by more than half of its thickness.
    """
    return replace(case, bottoming=True, stroke=case.bottom_stroke + travel)
