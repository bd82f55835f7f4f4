"""All bends of a part, one after the other, each from the state after the previous bend."""

from __future__ import annotations

from umform.analysis.run import Result
from umform.mesh import Mesh
from umform.processes.air_bending.goal import Goal
from umform.processes.air_bending.search import bent_to_angle
from umform.processes.bend_sequence.one_bend import bend_done
from umform.processes.bend_sequence.part import BendDone, Part
from umform.processes.bend_sequence.problem import flat_strip
from umform.processes.bend_sequence.spec import BendSequence
from umform.processes.bend_sequence.strip_brake import StripBrake
from umform.progress import Show, Tick, progress_bar
from umform.spec import check_arguments

#: Approximate number of states of a bend that are kept for pictures and for collisions.
FRAMES = 30


def bend_sequence(
    sequence: BendSequence, *, tolerance: float = Goal.tolerance, frames: int = FRAMES, progress: Show = None
) -> Part:
    """Bend a strip several times; each bend starts from the previous state: displacements, stresses, plastic strains.

    Parameters
    ----------
    sequence : BendSequence
        The parameters.
    tolerance : float
        Largest deviation of an angle in degrees.
    frames : int
        Approximate number of states of each bend that are kept; collisions are detected in these.
    progress : bool or callable, optional
        Show a progress bar; default: only on a terminal. A callable takes name, fraction and detail instead.

    Returns
    -------
    Part
        Measures of each bend, flanges, profile, collisions.

    Raises
    ------
    InvalidValue
        If an angle cannot be reached with its tools.
    NoConvergence
        If the strip cannot be bent so far. The exception has the previous bends as its attribute ``bends``.

    Examples
    --------
    >>> from umform.processes.bend_sequence import Bend, BendSequence, bend_sequence
    >>> case = BendSequence(length=60.0, bends=[Bend(20.0, angle=90.0), Bend(40.0, angle=90.0)])
    >>> part = bend_sequence(case)  # doctest: +SKIP
    >>> part.bends[1], part.quantities  # doctest: +SKIP
    """
    check_arguments(bend_sequence, sequence=sequence, tolerance=tolerance, frames=frames)
    mesh, before, done = flat_strip(sequence), None, list[BendDone]()
    with progress_bar(progress) as tick:
        for number in range(len(sequence.bends)):
            if len(sequence.bends) > 1:
                tick("all bends", number / len(sequence.bends))
            try:
                done.append(_bent(sequence, number, mesh, before, tolerance, frames, tick))
            except BaseException as error:
                error.bends = tuple(done)  # type: ignore[attr-defined]
                if len(sequence.bends) > 1:
                    error.add_note(f"  in bend {number + 1} of {len(sequence.bends)}")
                raise
            before = done[-1].result
    return Part(sequence, tuple(done))


def _bent(
    sequence: BendSequence, number: int, mesh: Mesh, before: Result | None, tolerance: float, frames: int, tick: Tick
) -> BendDone:
    """One bend."""
    bend = sequence.bends[number]
    brake = StripBrake(sequence, bend, mesh, before, frames)
    trials: tuple[tuple[float, float], ...] = ()

    def shown(name: str, fraction: float, detail: str = "") -> None:
        tick(f"bend {number + 1}, {name}", fraction, detail)

    if bend.angle is None:
        assert bend.stroke is not None
        state, measures = brake.load(bend.stroke, shown), brake.unload()
    else:
        state, measures, trials = bent_to_angle(brake, bend.angle, tolerance, shown)
    problem = brake.problem(measures.stroke)
    return bend_done(sequence, bend, measures, state.against, brake.run.close(), problem, trials)
