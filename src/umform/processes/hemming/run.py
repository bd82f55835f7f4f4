"""Bend acutely, place the base on a table, move a plate down, unload."""

from __future__ import annotations

from umform.analysis.run.open_run import OpenRun
from umform.errors import InvalidValue
from umform.processes.air_bending.brake import OPTIONS
from umform.processes.bend_sequence.run import FRAMES, bend_sequence
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming.measures import Hem, clearances, measured
from umform.processes.hemming.problem import PARTS, problem_of_hem
from umform.processes.hemming.spec import Hemming
from umform.progress import Show, parts, progress_bar

#: Gap that counts as contact, relative to the thickness.
_TOUCHES = -0.01


def hemming(case: Hemming, *, tolerance: float = 0.1, frames: int = FRAMES, progress: Show = None) -> Hem:
    """Make a hem: an acute bend, flattened between a plate and a table.

    Parameters
    ----------
    case : Hemming
        The parameters.
    tolerance : float
        Largest deviation of the angle of the first bend in degrees.
    frames : int
        Approximate number of states kept of each operation.
    progress : bool or callable, optional
        Show a progress bar; default: only on a terminal. A callable takes name, fraction and detail instead.

    Raises
    ------
    InvalidValue
        If the flange of an open hem would touch the base, or the first bend is out of reach.
    NoConvergence
        If the run does not converge.
    """
    first = bend_sequence(case.first, tolerance=tolerance, frames=frames, progress=progress)
    problem, way = problem_of_hem(case, first)
    made = problem.build()
    model = made.model
    run = OpenRun(model, options=OPTIONS, frames=max(1, frames // PARTS))
    with progress_bar(progress) as tick:
        *moves, release = made.steps
        for part, (move, show) in enumerate(zip(moves, parts(tick, "flattening", [1.0] * PARTS), strict=True), 1):
            run.take(move, tick=show)
            strip = Strip.of(model.mesh, model.u)
            if not case.insert:
                _refuse_touch(case, strip, way * (1.0 - part / PARTS))
        force = run.result["stroke_force"] / case.sheet.thickness
        run.take(release)
    released = Strip.of(model.mesh, model.u)
    result = run.close()
    whole = result["stroke_force"] / case.sheet.thickness
    return Hem(case, first, measured(case, force, strip, released), result["stroke"], whole, released, result, problem)


def _refuse_touch(case: Hemming, strip: Strip, left: float) -> None:
    """Refuse a flange that has passed through the base."""
    if clearances(case, strip).min() < _TOUCHES * case.sheet.thickness:
        raise InvalidValue(
            "the flange of an open hem touches the base, and the sheet has no contact with itself",
            where="gap",
            value=case.gap,
            cause=f"it touches at a gap of about {case.gap + left:.3g}: the bend stands higher than the tip",
            remedy="a larger gap, or insert=True: a plate of the thickness gap between flange and base",
        )
