"""Draw a part: close, draw, open."""

from __future__ import annotations

import logging

from umform.analysis.run import Result, solve
from umform.errors import ModelError, NoConvergence, SolveError
from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.endings import Ending, ending_of
from umform.processes.draw.outcome import FRAMES
from umform.processes.draw.u_bend import UBend
from umform.progress import Show
from umform.results.forming import FormingLimit, KeelerBrazier, add_forming_fields
from umform.spec import check_arguments

log = logging.getLogger("umform")


def draw(
    case: Cup | UBend,
    *,
    limit: FormingLimit | None = None,
    frames: int = FRAMES,
    solver: str = "auto",
    progress: Show = None,
) -> Drawn:
    """Draw a part and take it out of its tools.

    A run that fails returns its last converged state; ``ending`` of the result has the cause. An exception that ends
    the opening of the tools has the whole drawing as its attribute ``result``.

    Parameters
    ----------
    case : Cup or UBend
        The parameters.
    limit : callable, optional
        Forming limit: largest major strain over the minor one. Default: Keeler and Brazier with the thickness and the
        hardening of the sheet.
    frames : int
        States that each step keeps for pictures.
    solver : str
        Sparse solver.
    progress : bool or callable, optional
        Show a progress bar; default: only on a terminal. A callable takes name, fraction and detail instead.

    Returns
    -------
    Drawn

    Examples
    --------
    >>> import umform as uf
    >>> from umform.processes.draw import Cup, draw
    >>> steel = uf.sheet_metals.get("DC04").law
    >>> case = Cup(material=steel, thickness=1.0, blank_radius=45.0, punch_radius=30.0, punch_edge=6.0, die_edge=8.0)
    >>> cup = draw(case)  # doctest: +SKIP
    >>> cup.quantities, cup.fields["limit_margin"].min()  # doctest: +SKIP
    """
    check_arguments(draw, case=case, limit=limit, frames=frames, solver=solver)
    for warning in case.warnings:
        log.warning(warning)
    model, press = case.build()
    limit = limit or KeelerBrazier.of(case.thickness, case.material)
    released: Result | None = None
    failure: NoConvergence | None = None
    try:
        result = solve(model, press.closing, options=case.newton, frames=frames, solver=solver, progress=progress)
    except NoConvergence as error:
        failure, result = error, _reached(error)
    add_forming_fields(result, limit)
    u = model.u.copy()
    ending: Ending | None = ending_of(case, result, limit, failure)
    if failure is None:
        try:
            released = solve(model, press.opening, options=case.newton, frames=2, solver=solver, progress=progress)
        except (SolveError, ModelError) as error:  # a wrinkled sheet may lie on the wrong side of a tool
            ending = ending or Ending("release", f"the part cannot be taken out of the tools: {error}")
        except BaseException as error:
            error.result = result  # type: ignore[attr-defined]
            raise
        else:
            add_forming_fields(released, limit)
    return Drawn(case, limit, result, u, released, ending)


def _reached(error: NoConvergence) -> Result:
    result = getattr(error, "result", None)
    if not isinstance(result, Result):
        raise error
    return result
