"""Draw a part: close, draw, open."""

from __future__ import annotations

import logging
import math
from typing import cast

from umform.errors import ModelError, NoConvergence, SolveError
from umform.materials import Metal
from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.endings import Ending, ending_of
from umform.processes.draw.u_bend import UBend
from umform.results.forming import FormingLimit, KeelerBrazier, add_forming_fields
from umform.run import Result, solve
from umform.sheet_metals.tension_test import tension_test

log = logging.getLogger("umform")

#: States that each step keeps for pictures.
FRAMES = 20


def draw(
    case: Cup | UBend,
    *,
    limit: FormingLimit | None = None,
    frames: int = FRAMES,
    solver: str = "auto",
    progress: bool | None = None,
) -> Drawn:
    """Draw a part and take it out of its tools.

    A run that fails returns its last converged state; ``ending`` of the result has the cause.

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
    progress : bool, optional
        Show a progress bar; default: only on a terminal.

    Returns
    -------
    Drawn
    """
    for warning in case.warnings:
        log.warning(warning)
    model, press = case.build()
    limit = limit or KeelerBrazier(case.thickness, uniform_strain(case))
    released: Result | None = None
    failure: NoConvergence | None = None
    try:
        result = solve(model, press.closing(), frames=frames, solver=solver, progress=progress)
    except NoConvergence as error:
        failure, result = error, _reached(error)
    add_forming_fields(result, limit)
    u = model.u.copy()
    ending: Ending | None = ending_of(case, result, limit, failure)
    if failure is None:
        try:
            released = solve(model, press.opening(model), frames=2, solver=solver, progress=progress)
        except (SolveError, ModelError) as error:  # a wrinkled sheet may lie on the wrong side of a tool
            ending = ending or Ending("release", f"the part cannot be taken out of the tools: {error}")
        else:
            add_forming_fields(released, limit)
    return Drawn(case, limit, result, u, released, ending)


def _reached(error: NoConvergence) -> Result:
    result = getattr(error, "result", None)
    if not isinstance(result, Result):
        raise error
    return result


def uniform_strain(case: Cup | UBend) -> float:
    """Hardening exponent: true plastic strain at which a tensile bar necks, where slope and stress are equal."""
    law = case.material
    if getattr(law, "back_stress", None) is not None:  # which hardens the bar too
        test = tension_test(cast(Metal, law))
        stretch = 1.0 + test.uniform_elongation + test.tensile_strength / law.E
        return max(math.log(stretch) - test.tensile_strength * stretch / law.E, 1e-3)
    curve = law.hardening.curve()
    low, high = 1e-6, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        stress, slope = curve(middle)
        low, high = (middle, high) if slope > stress else (low, middle)
    return max(low, 1e-3)
