"""A U-bend on two meshes: springback and forces extrapolated to zero element size, with their errors."""

from __future__ import annotations

from dataclasses import replace

from umform.errors import InvalidValue
from umform.processes.draw.case import draw
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.outcome import FRAMES
from umform.processes.draw.u_bend import UBend
from umform.processes.early_end import on_mesh
from umform.processes.extrapolation import Limit
from umform.progress import Show, parts, progress_bar
from umform.results.forming import FormingLimit
from umform.spec import check_arguments

#: Measures that are extrapolated. The radius of the wall is not: it does not converge evenly.
EXTRAPOLATED = ("largest punch force", "draw-in, mean", "largest springback", "theta1", "theta2")
#: Size of the elements of the coarser mesh over that of the case; its points through the thickness at most.
COARSER, _POINTS = 2.0, 7


def extrapolated(
    case: UBend,
    *,
    limit: FormingLimit | None = None,
    frames: int = FRAMES,
    solver: str = "auto",
    progress: Show = None,
) -> Drawn:
    """Draw a U-bend on two meshes: that of the case, and one with fewer points whose elements turn twice as far.

    Without angles on the coarser mesh (the sheet tears, or there is no wall), only the mesh of the case is run on.

    Parameters
    ----------
    case, limit, frames, solver, progress
        As for :func:`draw`.

    Returns
    -------
    Drawn
        That of the finer mesh; ``estimates`` has the limits of its measures.

    Raises
    ------
    InvalidValue
        If the coarser mesh is too coarse.
    """
    check_arguments(extrapolated, case=case)
    if not COARSER * case.turn <= 45.0:
        raise InvalidValue(
            "the coarser of two meshes has too large elements",
            where="turn",
            value=case.turn,
            cause="its elements turn twice as far, which may be 45 degrees at most",
            remedy="a smaller angle, or one mesh: --no-extrapolate",
        )
    other = coarser(case)
    with progress_bar(progress) as bar:
        first, last = parts(bar, "2 meshes", [1.0 / other.turn, 1.0 / case.turn])
        with on_mesh(1, 2):
            coarse = draw(other, limit=limit, frames=0, solver=solver, progress=first)
        with on_mesh(2, 2):
            fine = draw(case, limit=limit, frames=frames, solver=solver, progress=last)
    if any(drawn.ending is not None or drawn.angles is None for drawn in (coarse, fine)):
        return fine
    return replace(fine, coarser=coarse, estimates=estimates_of(coarse, fine))


def coarser(case: UBend) -> UBend:
    """The case on a mesh that takes two fifths of its time: elements twice as long, fewer points."""
    through = _POINTS if case.thickness_points is None else min(case.thickness_points, _POINTS)
    contacts = max(case.contact_points - 1, 2)
    return replace(case, turn=COARSER * case.turn, thickness_points=through, contact_points=contacts)


def estimates_of(coarse: Drawn, fine: Drawn) -> dict[str, Limit]:
    """Limits of the measures of a part on two meshes."""
    found = {}
    for name in EXTRAPOLATED:
        before, last = coarse.values[name], fine.values[name]
        if before is not None and last is not None:
            found[name] = Limit.of_two(before, last, COARSER)
    return found
