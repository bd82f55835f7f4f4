"""One draw bead: closed, and drawn through."""

from __future__ import annotations

from dataclasses import replace

from umform.analysis.run import solve
from umform.analysis.steps import Step
from umform.errors import InvalidValue
from umform.model import Model
from umform.processes.draw_bead.extrapolation import of_three
from umform.processes.draw_bead.measures import Drawn
from umform.processes.draw_bead.problem import problem_of
from umform.processes.draw_bead.spec import FEWEST, DrawBead
from umform.processes.early_end import on_mesh
from umform.processes.extrapolation import FINER
from umform.progress import Show, parts, progress_bar
from umform.spec import check_arguments

#: States that each step keeps for pictures.
FRAMES = 12


def build(case: DrawBead) -> tuple[Model, list[Step]]:
    """Model of a case, and its steps."""
    made = problem_of(case).build()
    return made.model, made.steps


def extrapolated(case: DrawBead, *, frames: int = FRAMES, solver: str = "auto", progress: Show = None) -> Drawn:
    """Draw a strip through a bead on three meshes: that of the case, and two with 0.5 and 0.7 times as many elements.

    Parameters
    ----------
    case, frames, solver, progress
        As for :func:`drawn_through`.

    Returns
    -------
    Drawn
        Results on the finest mesh, with extrapolated numbers and their errors.

    Raises
    ------
    InvalidValue
        If the coarsest mesh would have too few elements.
    """
    check_arguments(extrapolated, case=case)
    if case.elements < 2.0 * FEWEST:
        raise InvalidValue(
            "the coarsest of three meshes has too few elements",
            where="elements",
            value=f"{case.elements:g}",
            cause="--extrapolate also runs a mesh with half of them",
            remedy=f"{2.0 * FEWEST:g} or more; or --no-extrapolate, in Python drawn_through",
        )
    every: list[Drawn] = []
    shares = (0.5, 1.0 / FINER, 1.0)
    with progress_bar(progress) as bar:
        for part, tick in zip(shares, parts(bar, "3 meshes", shares, moves=2), strict=True):
            mesh, kept = replace(case, elements=case.elements * part), frames if part == 1.0 else 0
            with on_mesh(len(every) + 1, len(shares)):
                every.append(drawn_through(mesh, frames=kept, solver=solver, progress=tick))
    return replace(every[-1], limits=of_three(every))


def drawn_through(case: DrawBead, *, frames: int = FRAMES, solver: str = "auto", progress: Show = None) -> Drawn:
    """Close a strip between bead and groove, and draw it through.

    Parameters
    ----------
    case : DrawBead
        The parameters.
    frames : int
        States that each step keeps for pictures.
    solver : str
        Sparse solver.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.

    Returns
    -------
    Drawn
        Restraint, uplift, thinning, and the result with its history and frames.

    Raises
    ------
    NoConvergence
        If it does not converge; the attribute ``result`` holds the run up to the failure.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.processes.draw_bead import DrawBead, drawn_through
    >>> drawn = drawn_through(DrawBead(material=uf.sheet_metals.get("DC04").law))  # doctest: +SKIP
    >>> drawn.quantities  # doctest: +SKIP
    """
    check_arguments(drawn_through, case=case, frames=frames, solver=solver)
    model, steps = build(case)
    result = solve(model, steps, options=case.newton, frames=frames, solver=solver, progress=progress)
    return Drawn.of(case, result)
