"""One bend: loaded to the stroke, unloaded, measured."""

from __future__ import annotations

from umform.processes.air_bending.bend import AirBend
from umform.processes.air_bending.brake import FRAMES, Brake
from umform.processes.air_bending.goal import needed_stroke
from umform.processes.air_bending.spec import AirBending
from umform.progress import progress_bar
from umform.spec import check_arguments


def air_bending(
    case: AirBending,
    *,
    frames: int = FRAMES,
    solver: str = "auto",
    progress: bool | None = None,
    brake: Brake | None = None,
) -> AirBend:
    """Bend a sheet in a V-die to the stroke of the case, and unload it.

    Parameters
    ----------
    case : AirBending
        The parameters, with a stroke.
    frames : int
        Approximate number of states kept for pictures and for the angle under load, in loading and in unloading.
    solver : str
        Sparse solver.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.
    brake : Brake, optional
        A sheet of the same case that is already loaded, instead of a new one.

    Returns
    -------
    AirBend
        Measures, curve, sections, and the result with its history and frames.

    Raises
    ------
    InvalidValue
        If the case has no stroke.
    NoConvergence
        If it does not converge; the attribute ``result`` holds the run up to the failure.

    Examples
    --------
    >>> from umform.processes.air_bending import AirBending, air_bending
    >>> bend = air_bending(AirBending(stroke=2.0, elements_per_thickness=1, layers=1))  # a coarse mesh
    >>> bend.measures.springback > 0.5
    True
    >>> bend.write("bend")  # doctest: +SKIP
    """
    check_arguments(air_bending, case=case, frames=frames, solver=solver)
    stroke = needed_stroke(case)
    with progress_bar(progress) as tick:
        return (brake or Brake(case, solver, max(1, frames))).bend(stroke, tick)
