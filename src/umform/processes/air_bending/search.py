"""Find the stroke that leaves the wanted angle after unloading; and the angles of a row of strokes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from umform.errors import InvalidValue, SolveError
from umform.processes.air_bending.brake import Brake, Loaded
from umform.processes.air_bending.checks import check_angle, check_tolerance, unreachable
from umform.processes.air_bending.measures import Measures
from umform.processes.air_bending.parameters import AirBending
from umform.progress import progress_bar

#: The punch goes down in parts of this many increments; each part ends in a remembered state.
_PART = 5
_MOST_TRIALS = 10


@dataclass(frozen=True)
class Found:
    """The stroke that leaves the wanted angle.

    Attributes
    ----------
    case : AirBending
        The parameters with this stroke.
    measures : Measures
        What is measured there.
    trials : tuple of tuple of float
        Stroke and angle after unloading of each trial, in order.
    iterations : int
        Newton iterations of loading and all trials.
    """

    case: AirBending
    measures: Measures
    trials: tuple[tuple[float, float], ...]
    iterations: int


def find_stroke(
    case: AirBending, angle: float, *, tolerance: float = 0.02, solver: str = "auto", progress: bool | None = None
) -> Found:
    """Find the stroke at which the sheet has the wanted angle after unloading.

    The sheet is loaded once. From states under load it is unloaded, measured and put back; the secant of angle over
    stroke, kept between what is known to be too little and too much, says where to try next.

    Parameters
    ----------
    case : AirBending
        The parameters; the stroke is not used.
    angle : float
        Wanted angle between the legs in degrees.
    tolerance : float
        Largest deviation of the angle in degrees, 0.001 to 10.
    solver : str
        Sparse solver.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.

    Raises
    ------
    InvalidValue
        If the sheet lies against a flank before it has the angle, or angle or tolerance are none of a bend.
    NoConvergence
        If the sheet cannot be bent so far.
    """
    check_angle(case, angle)
    check_tolerance(tolerance)
    if not tolerance > 0:
        raise InvalidValue("the tolerance of the angle must be positive", where="tolerance", value=tolerance)
    with progress_bar(progress) as tick:
        brake = Brake(case, solver)
        state, slope = _load_to_angle(brake, angle, lambda done: tick("loading", done))
        trials: list[tuple[float, float]] = []
        while True:
            measures = brake.unload()
            trials.append((state.stroke, measures.angle))
            tick("trials", min(1.0, len(trials) / 4))
            if abs(measures.angle - angle) <= tolerance:
                if state.against:
                    raise unreachable(angle, f"at this angle it lies against the {state.against}")
                return Found(replace(case, stroke=state.stroke), measures, tuple(trials), brake.iterations)
            if state.against and measures.angle > angle:
                raise unreachable(angle, f"at {measures.angle:.2f} degrees it lies against the {state.against}")
            if len(trials) == _MOST_TRIALS:
                raise SolveError("the stroke for the angle cannot be closed in", where="find_stroke", value=trials)
            state = brake.load(_next_stroke(trials, angle, slope, case.largest_stroke))


def bending_table(
    case: AirBending, strokes: Sequence[float], *, solver: str = "auto", progress: bool | None = None
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

    Returns
    -------
    list of Measures
        In the order of growing strokes.

    Notes
    -----
    An exception that ends it early has the rows before as its attribute ``rows``.
    """
    rows: list[Measures] = []
    ordered = sorted(strokes)
    for stroke in ordered:
        replace(case, stroke=stroke)  # refuses a stroke beyond air bending
    with progress_bar(progress) as tick:
        brake = Brake(case, solver)
        try:
            for number, stroke in enumerate(ordered, start=1):
                brake.load(stroke)
                rows.append(brake.unload())
                tick("table", number / len(ordered))
        except BaseException as error:
            error.rows = rows  # type: ignore[attr-defined]
            raise
    return rows


def _load_to_angle(brake: Brake, angle: float, tick: Callable[[float], None]) -> tuple[Loaded, float]:
    """First state whose angle under load is the wanted one or less; and the slope of the angle over the stroke."""
    case = brake.case
    part = _PART * case.way
    stroke, before = 0.0, 180.0
    while True:
        if stroke >= case.largest_stroke:
            raise unreachable(angle, f"at the largest stroke {stroke:.4g} it has {before:.2f} degrees under load")
        way = min(part, case.largest_stroke - stroke)
        stroke += way
        state = brake.load(stroke)
        tick(min(1.0, (180.0 - state.angle) / (180.0 - angle)))
        if state.angle <= angle:
            return state, (state.angle - before) / way
        if state.against:
            raise unreachable(angle, f"at {state.angle:.2f} degrees under load it lies against the {state.against}")
        before = state.angle


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
