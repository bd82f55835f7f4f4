"""A U-bend on three meshes: springback and forces extrapolated to zero element size, with their errors."""

from __future__ import annotations

from dataclasses import replace

from umform.errors import InvalidValue
from umform.processes.draw.case import FRAMES, draw
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.u_bend import UBend
from umform.processes.limit import FINER, Limit
from umform.progress import Show, parts, progress_bar
from umform.results.forming import FormingLimit

#: Measures that are extrapolated; of a radius the curvature is, which has a limit even if the wall is straight.
_QUANTITIES = ("largest punch force", "draw-in, mean", "largest springback", "theta1", "theta2", "radius of the wall")
_RADIUS = "radius of the wall"


def extrapolated(
    case: UBend,
    *,
    limit: FormingLimit | None = None,
    frames: int = FRAMES,
    solver: str = "auto",
    progress: Show = None,
) -> Drawn:
    """Draw a U-bend on three meshes: that of the case, and two whose elements turn 2 and 1.4 times as far.

    Without angles on a coarser mesh (the sheet tears, or there is no wall), only the mesh of the case is run on.

    Parameters
    ----------
    case, limit, frames, solver, progress
        See :func:`umform.processes.draw.draw`.

    Returns
    -------
    Drawn
        That of the finest mesh; ``estimates`` has the limits of its measures.

    Raises
    ------
    InvalidValue
        If the coarsest mesh is too coarse.
    """
    if not FINER**2 * case.turn <= 45.0:
        raise InvalidValue(
            "the coarsest of three meshes has too large elements",
            where="turn",
            value=case.turn,
            cause="its elements turn twice as far, which may be 45 degrees at most",
            remedy="a smaller angle, or one mesh: --no-extrapolate",
        )
    coarser: list[Drawn] = []
    turns = [part * case.turn for part in (FINER**2, FINER, 1.0)]
    with progress_bar(progress) as bar:
        ticks = parts(bar, "3 meshes", [1.0 / turn for turn in turns])
        for turn, tick in zip(turns[:2], ticks, strict=False):
            drawn = draw(replace(case, turn=turn), limit=limit, frames=0, solver=solver, progress=tick)
            if drawn.ending is not None or drawn.angles is None:
                coarser.clear()
                break
            coarser.append(drawn)
        *_, last = ticks
        finest = draw(case, limit=limit, frames=frames, solver=solver, progress=last)
    if not coarser or finest.angles is None:
        return finest
    return replace(finest, coarser=tuple(coarser), estimates=estimates_of([*coarser, finest]))


def estimates_of(meshes: list[Drawn]) -> dict[str, Limit]:
    """Limits of the measures of a part on three meshes with one ratio of element sizes, coarsest first.

    Elements of 18 nodes converge faster than with the square once they are small: the error reaches the finest mesh.
    """
    found = {}
    for name in _QUANTITIES:
        numbers = [number for drawn in meshes if (number := drawn.values[name]) is not None]
        if name == _RADIUS:
            found[name] = Limit.of_three([1.0 / number for number in numbers], FINER, least=1.0).inverse
        else:
            found[name] = Limit.of_three(numbers, FINER, least=1.0)
    return found
