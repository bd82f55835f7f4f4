"""How a drawing operation ends: tears, wrinkles, a holder force that is too large, a bottoming punch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from umform.errors import NoConvergence
from umform.results.bottoming import bottoming, bottoms
from umform.results.forming import FormingLimit, distance_from, forming_fields
from umform.results.forming.strains import beyond_limit
from umform.run import Result

if TYPE_CHECKING:
    from umform.processes.draw.cup import Cup
    from umform.processes.draw.u_bend import UBend

#: Thinning in per cent beyond which a sheet counts as torn if Newton's method has not converged.
_TORN = 30.0
#: Distance in thicknesses from both die and holder, beyond the initial one, that counts as a wrinkle.
_WRINKLED = 0.5


@dataclass(frozen=True)
class Ending:
    """Cause of an early end, or a defect of the part.

    Attributes
    ----------
    kind : str
        "torn", "wrinkled", "held", "bottomed", "release" or "solver".
    text : str
        Explanation.
    early : bool
        Whether the run ended before the end of the stroke.
    """

    kind: str
    text: str
    early: bool = False


def ending_of(case: Cup | UBend, result: Result, limit: FormingLimit, failure: NoConvergence | None) -> Ending | None:
    """The ending of an operation; None without a failure or defect.

    Parameters
    ----------
    case : Cup or UBend
        The parameters.
    result : Result
        The run so far.
    limit : callable
        Forming limit.
    failure : NoConvergence, optional
        The error that ended it early.
    """
    model = result.model
    found = forming_fields(model.mesh, model.u, limit)
    torn, thinnest = beyond_limit(model.mesh, found), float(found["thinning"].max())
    stroke = float(result["stroke"][-1])
    early = failure is not None
    reached = f" at a stroke of {stroke:.4g} of {case.way:.4g}" if early else ""
    if torn is not None or (early and thinnest > _TORN):
        still = early and _drawn_in(case, result) < 0.02 * case.way
        what = "the holder is too strong: the sheet does not flow in and tears" if still else "the sheet tears"
        text = f"{what}{reached}: " + (f"{torn}; " if torn else "")
        remedy = "less holder force or friction, larger radii, a smaller blank"
        return Ending("held" if still else "torn", f"{text}thinning up to {thinnest:.3g} %; {remedy}", early)
    air = wrinkle(result, case.thickness)
    if air > _WRINKLED * case.thickness:
        text = f"the sheet wrinkles under the holder{reached}: it stands off both tools by {air:.3g}; a stronger holder"
        return Ending("wrinkled", text, early)
    bottom = bottoming(result["stroke"], result["punch_fz"])
    punch = next(tool for tool in model.tools if tool.name == "punch")
    if bottom is not None and bottoms(model, punch, {pair: pair.found for pair in model.contacts}):
        text = f"the punch bottoms at a stroke of {abs(bottom.at):.4g}{reached}: its force rises from"
        remedy = "a shorter stroke, or more clearance"
        return Ending("bottomed", f"{text} {bottom.before:.4g} to {bottom.largest:.4g}; {remedy}", early)
    if early:
        return Ending("solver", f"the run cannot be continued{reached}: {failure}", True)
    return None


def wrinkle(result: Result, thickness: float) -> float:
    """Largest distance of the flange from both die and holder; where it touches neither, it wrinkles.

    Parameters
    ----------
    result : Result
        A run with tools named die and holder; its last state is used.
    thickness : float
        Thickness of the sheet. The flange is where the holder is at most three thicknesses from the flat of the die.
    """
    model = result.model
    tools = {tool.name: tool for tool in model.tools}
    if not {"die", "holder"} <= tools.keys():
        return 0.0
    x = model.mesh.points + model.u.reshape(-1, 3)
    cells = model.mesh.connectivity
    half = cells.shape[1] // 2
    lower, upper = x[cells[:, :half].ravel()], x[cells[:, half:].ravel()]
    below, above = distance_from(tools["die"], lower), distance_from(tools["holder"], upper)
    rotation, shift = tools["die"].pose_now
    normal = tools["die"].surface.kernel().gap(np.ascontiguousarray((lower - shift) @ rotation))[1] @ rotation.T
    foot = lower - below[:, None] * normal
    flat = (normal[:, 2] > 1.0 - 1e-9) & (distance_from(tools["holder"], foot) < 3.0 * thickness)
    return float(np.minimum(below, above)[flat].max(initial=0.0))


def _drawn_in(case: Cup | UBend, result: Result) -> float:
    """Mean inward travel of the edge of the blank."""
    model = result.model
    ids = model.mesh.nodes(case.edge)
    X, u = model.mesh.points[ids, :2], model.u.reshape(-1, 3)[ids, :2]
    return float(-(u * X).sum(axis=1).mean() / np.linalg.norm(X, axis=1).mean())
