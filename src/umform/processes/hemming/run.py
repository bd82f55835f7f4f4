"""Bend acutely, place the base on a table, move or press a plate down, unload."""

from __future__ import annotations

from umform.analysis.run.open_run import OpenRun
from umform.processes.air_bending.loading import OPTIONS
from umform.processes.bend_sequence.run import FRAMES, bend_sequence
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming.measures import Hem, measured
from umform.processes.hemming.problem import FORCE, edge_of, loading_steps, problem_of_hem, start_of, way_column
from umform.processes.hemming.spec import Hemming
from umform.progress import Show, parts, progress_bar
from umform.spec import check_arguments


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
        If the first bend is out of reach.
    NoConvergence
        If the run does not converge. While the hem is flattened, the exception has the first bend as its attribute
        ``bends``.

    Examples
    --------
    >>> from umform.processes.hemming import Hemming, hemming
    >>> hem = hemming(Hemming(form="inner", gap=0.5))  # doctest: +SKIP
    >>> hem.quantities  # doctest: +SKIP
    """
    check_arguments(hemming, case=case, tolerance=tolerance, frames=frames)
    first = bend_sequence(case.first, tolerance=tolerance, frames=frames, progress=progress)
    problem = problem_of_hem(case, first)[0]
    made = problem.build()
    model, edge, count = made.model, edge_of(case), loading_steps(case)
    run = OpenRun(model, options=OPTIONS, frames=max(1, frames // count))
    try:
        with progress_bar(progress) as tick:
            *moves, release = made.steps
            for move, show in zip(moves, parts(tick, "flattening", [1.0] * count), strict=True):
                run.take(move, tick=show)
            loaded = Strip.of(model.mesh, model.u, edge)
            force = run.result[FORCE] / case.sheet.thickness
            run.take(release)
    except BaseException as error:
        error.bends = first.bends  # type: ignore[attr-defined]
        raise
    released = Strip.of(model.mesh, model.u, edge)
    result = run.close()
    measures = measured(case, force, Strip.of(*start_of(case, first)[:2]), loaded, released)
    whole = result[FORCE] / case.sheet.thickness
    return Hem(case, first, measures, result[way_column(case)], whole, loaded, released, result, problem)
