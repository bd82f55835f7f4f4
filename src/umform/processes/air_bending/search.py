"""Find the stroke that leaves the wanted angle after unloading; and the angles of a row of strokes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate

from umform.errors import InvalidValue, SolveError
from umform.notebook import Display, InNotebook
from umform.processes.air_bending.bend import AirBend, Loaded
from umform.processes.air_bending.brake import FRAMES, Brake
from umform.processes.air_bending.goal import Goal, check_angle, unreachable
from umform.processes.air_bending.loading import INCREMENTS
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.spec import AirBending
from umform.processes.air_bending.stack import bonded_sheets
from umform.progress import Tick, progress_bar, silent
from umform.spec import check_arguments, check_value

_MOST_TRIALS = 10


@dataclass(frozen=True)
class Found(InNotebook):
    """The stroke that leaves the wanted angle.

    Attributes
    ----------
    bend : AirBend
        The bend with this stroke, as `air_bending` gives it.
    trials : tuple of tuple of float
        Stroke and angle after unloading of each trial, in order.
    iterations : int
        Newton iterations of loading and all trials.
    """

    bend: AirBend
    trials: tuple[tuple[float, float], ...]
    iterations: int

    def __repr__(self) -> str:
        return f"Found({self.bend!r}, {len(self.trials)} trials)"

    def _display(self) -> Display:
        trials = [[f"{stroke:.4f}", f"{angle:.3f}"] for stroke, angle in self.trials]
        shown = self.bend._display()
        return replace(shown, tables={**shown.tables, "Trials": [["stroke, mm", "angle, degrees"], *trials]})

    @property
    def case(self) -> AirBending:
        """The parameters with this stroke."""
        return self.bend.case

    @property
    def measures(self) -> Measures:
        """Measures of the bend with this stroke."""
        return self.bend.measures


def find_stroke(
    case: AirBending,
    angle: float,
    *,
    tolerance: float = Goal.tolerance,
    frames: int = FRAMES,
    solver: str = "auto",
    progress: bool | None = None,
    brake: Brake | None = None,
) -> Found:
    """Find the stroke at which the sheet has the wanted angle after unloading, and the bend with it.

    The sheet is loaded once, to where its angle less what it is reckoned to spring back is the wanted one. There it is
    unloaded and measured; the secant of angle over stroke, kept between what is known to be too little and too much,
    says where to try next, from the last remembered state under load. The last trial is the bend: nothing of it is
    computed again.

    Parameters
    ----------
    case : AirBending
        The parameters; the stroke is not used.
    angle : float
        Wanted angle between the legs in degrees.
    tolerance : float
        Largest deviation of the angle in degrees, 0.001 to 10.
    frames : int
        About how many states are kept for pictures, as in `air_bending`.
    solver : str
        Sparse solver.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.
    brake : Brake, optional
        A sheet of the same case that has been loaded already, instead of a new one.

    Raises
    ------
    InvalidValue
        If the sheet lies against a flank before it has the angle, or angle or tolerance are none of a bend.
    NoConvergence
        If the sheet cannot be bent so far.

    Examples
    --------
    >>> from umform.processes.air_bending import AirBending, find_stroke
    >>> found = find_stroke(AirBending(elements_per_thickness=1, layers=1), angle=150.0)
    >>> abs(found.measures.angle - 150.0) < 0.1
    True
    """
    check_arguments(find_stroke, case=case, frames=frames, solver=solver)
    check_angle(case, angle)
    check_value(Goal, "tolerance", tolerance)
    with progress_bar(progress) as tick:
        brake = brake or Brake(case, solver, max(1, frames))
        state, measures, trials = bent_to_angle(brake, angle, tolerance, tick)
        bend = replace(brake.end(state, measures), searched="angle")
        return Found(bend, trials, brake.run.iterations)


def bent_to_angle(
    brake: Brake, angle: float, tolerance: float, tick: Tick = silent
) -> tuple[Loaded, Measures, tuple[tuple[float, float], ...]]:
    """Bend and unload a sheet on a brake until it has the angle: `find_stroke` without the end of the run.

    Returns
    -------
    tuple
        State under load, measures after unloading, and the trials as pairs of stroke and angle.
    """
    state, slope = _load_to_angle(brake, angle, lambda done: tick("loading", done))
    trials: list[tuple[float, float]] = []
    while True:
        measures = brake.unload()
        trials.append((state.stroke, measures.angle))
        tick("trials", min(1.0, len(trials) / 4))
        if abs(measures.angle - angle) <= tolerance:
            if state.against:
                cause = f"at this angle, {state.angle:.2f} degrees under load, it lies against the {state.against}"
                raise unreachable(brake.case, angle, f"{cause}; the smallest one of these tools is a little larger")
            return state, measures, tuple(trials)
        if state.against and measures.angle > angle:
            raise _unreached(brake, angle, state, measures.angle)
        if len(trials) == _MOST_TRIALS:
            raise SolveError(
                "the stroke for the angle cannot be closed in",
                where="find_stroke",
                value=trials,
                cause="the angle jumps between two strokes: a coarse mesh, or large increments",
                remedy="a larger tolerance, or smaller elements or increments",
            )
        state = brake.load(_next_stroke(trials, angle, slope, brake.case.largest_stroke))


def bending_table(
    case: AirBending,
    strokes: Sequence[float],
    *,
    solver: str = "auto",
    progress: bool | None = None,
    brake: Brake | None = None,
) -> list[Measures]:
    """Measures at several strokes, from one loading and an unloading at each stroke.

    Parameters
    ----------
    case : AirBending
        The parameters; the stroke is not used.
    strokes : sequence of float
        Strokes in mm, in any order.
    solver : str
        Sparse solver.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.
    brake : Brake, optional
        A sheet of the same case that has been loaded already, instead of a new one.

    Returns
    -------
    list of Measures
        In the order of growing strokes; each as `air_bending` gives it for the stroke.

    Notes
    -----
    An exception that ends it early has the rows before as its attribute ``rows``.

    Examples
    --------
    >>> from umform.processes.air_bending import AirBending, bending_table
    >>> rows = bending_table(AirBending(elements_per_thickness=1, layers=1), [1.0, 2.0])
    >>> rows[0].angle > rows[1].angle
    True
    """
    check_arguments(bending_table, case=case, strokes=strokes, solver=solver)
    ordered = sorted(strokes)
    for stroke in ordered:
        replace(case, stroke=stroke)  # refuses a stroke beyond air bending

    def row(brake: Brake, stroke: float) -> Measures:
        brake.load(stroke)
        return brake.unload()

    return _rows(brake or Brake(case, solver), ordered, row, progress)


def angle_table(
    case: AirBending,
    angles: Sequence[float],
    *,
    tolerance: float = Goal.tolerance,
    solver: str = "auto",
    progress: bool | None = None,
    brake: Brake | None = None,
) -> list[Measures]:
    """Measures at several angles after unloading, from one loading; `find_stroke` looks for each from there.

    Parameters
    ----------
    case, solver, progress, brake
        As for :func:`bending_table`.
    angles : sequence of float
        Angles between the legs in degrees, in any order.
    tolerance : float
        Largest deviation of each angle in degrees, 0.001 to 10.

    Returns
    -------
    list of Measures
        In the order of growing strokes; each as `find_stroke` gives it for the angle.

    Raises
    ------
    InvalidValue
        If the sheet lies against a flank before it has an angle, or angles or tolerance are none of a bend.

    Notes
    -----
    An exception that ends it early has the rows before as its attribute ``rows``.

    Examples
    --------
    >>> from umform.processes.air_bending import AirBending, angle_table
    >>> rows = angle_table(AirBending(elements_per_thickness=1, layers=1), [160.0, 150.0])
    >>> rows[0].stroke < rows[1].stroke
    True
    """
    check_arguments(angle_table, case=case, angles=angles, solver=solver)
    ordered = sorted(angles, reverse=True)
    for angle in ordered:
        check_angle(case, angle)
    check_value(Goal, "tolerance", tolerance)

    def row(brake: Brake, angle: float) -> Measures:
        return bent_to_angle(brake, angle, tolerance)[1]

    return _rows(brake or Brake(case, solver), ordered, row, progress)


def _rows(
    brake: Brake, goals: Sequence[float], row: Callable[[Brake, float], Measures], progress: bool | None
) -> list[Measures]:
    """Rows of a table; an exception has those before as its attribute ``rows``."""
    rows: list[Measures] = []
    with progress_bar(progress) as tick:
        try:
            for number, goal in enumerate(goals, start=1):
                rows.append(row(brake, goal))
                tick("table", number / len(goals))
        except BaseException as error:
            error.rows = rows  # type: ignore[attr-defined]
            raise
    return rows


def _load_to_angle(brake: Brake, angle: float, tick: Callable[[float], None]) -> tuple[Loaded, float]:
    """Where the first trial is made: where the angle after springback should be the wanted one; and its slope there."""
    case = brake.case
    part = INCREMENTS * case.way
    number, before = 0, 180.0
    while True:
        number += 1
        stroke = min(number * part, case.largest_stroke)
        state = brake.load(stroke)
        tick(min(1.0, (180.0 - state.angle) / (180.0 - angle)))
        slope = (state.angle - before) / (stroke - (number - 1) * part)
        if state.against and state.angle > angle:
            raise _unreached(brake, angle, state, state.angle + _springback(case, state))
        left = state.angle + _springback(case, state) - angle
        if left <= 0.0 or (state.against and state.angle <= angle):
            return state, slope
        if stroke >= case.largest_stroke:
            if state.angle <= angle:
                return state, slope
            cause = f"at the largest stroke {stroke:.4g} it has {state.angle:.2f} degrees under load"
            raise unreachable(case, angle, cause)
        if slope < 0.0 and stroke - left / slope < min(stroke + part, case.largest_stroke):
            nearer = brake.load(stroke - left / slope)
            far = nearer.stroke - stroke > 0.2 * part
            return nearer, (nearer.angle - state.angle) / (nearer.stroke - stroke) if far else slope
        before = state.angle


def _unreached(brake: Brake, angle: float, state: Loaded, smallest: float) -> InvalidValue:
    """Error for a sheet that lies against a flank; ``smallest`` is its angle after springback."""
    return unreachable(
        brake.case,
        angle,
        f"under load it lies against the {state.against} at {state.angle:.2f} degrees, about {smallest:.1f} degrees "
        "after springback: these tools reach larger angles only",
    )


def _springback(case: AirBending, state: Loaded) -> float:
    """About how far a sheet springs back, in degrees: N l²/(E' I), N the force of a shoulder, l the length of a leg."""
    slope = math.radians(90.0 - 0.5 * state.angle)
    layers = [case.sheets[number] for number in bonded_sheets(case)[0]]
    stiff = [one.material.E / (1.0 - one.material.nu**2 if case.width is None else 1.0) for one in layers]
    stiffness = transformed_stiffness(stiff, [one.thickness for one in layers])
    lever = case.free_length(math.degrees(slope))
    return math.degrees(0.5 * state.force / math.cos(slope) * lever**2 / stiffness)


def transformed_stiffness(stiff: Sequence[float], thicknesses: Sequence[float]) -> float:
    """Bending stiffness per width of layers with these moduli, about their common neutral fibre."""
    layers = list(zip(stiff, thicknesses, strict=True))
    ends = accumulate(thicknesses)
    middles = [end - 0.5 * (t + thicknesses[0]) for end, t in zip(ends, thicknesses, strict=True)]
    whole = sum(E * t for E, t in layers)
    neutral = sum(E * t * z for (E, t), z in zip(layers, middles, strict=True)) / whole
    return sum(E * t**3 / 12.0 + E * t * (z - neutral) ** 2 for (E, t), z in zip(layers, middles, strict=True))


def _next_stroke(trials: Sequence[tuple[float, float]], angle: float, slope: float, largest: float) -> float:
    """Where the secant of the last two trials has the angle, between strokes known to be too small and too large."""
    low = max((s for s, a in trials if a > angle), default=0.0)
    high = min((s for s, a in trials if a <= angle), default=largest)
    stroke, reached = trials[-1]
    if len(trials) > 1 and trials[-2][0] != stroke:
        slope = (reached - trials[-2][1]) / (stroke - trials[-2][0])
    wanted = stroke + (angle - reached) / slope if slope < 0.0 else 0.5 * (low + high)
    if wanted >= largest and high == largest:
        return largest
    return wanted if low < wanted < high else 0.5 * (low + high)
