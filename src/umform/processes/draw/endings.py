"""How a drawing operation ends: tears, wrinkles, a holder force that is too large, a bottoming punch."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.errors import NoConvergence
from umform.results.bottoming import bottoming, bottoms
from umform.results.forming import FormingLimit, distance_from, forming_fields
from umform.results.forming.strains import beyond_limit

if TYPE_CHECKING:
    from umform.processes.draw.cup import Cup
    from umform.processes.draw.u_bend import UBend

Floats = NDArray[np.float64]

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

    Of tearing and wrinkling, what came first is the cause.

    Parameters
    ----------
    case : Cup or UBend
        The parameters.
    result : Result
        The run so far, with the fields of forming in its frames.
    limit : callable
        Forming limit.
    failure : NoConvergence, optional
        The error that ended it early.
    """
    early = failure is not None
    reached = f"; the run ends at a stroke of {float(result['stroke'][-1]):.4g} of {case.way:.4g}" if early else ""
    torn, folded = _tearing(case, result, limit, early), _wrinkling(case, result)
    if torn is not None and folded is not None and folded.since <= torn.since:
        return Ending("wrinkled", f"{folded.text}; then it tears: {torn.found}{reached}; {folded.remedy}", early)
    for defect in (torn, folded):
        if defect is not None:
            return Ending(defect.kind, f"{defect.text}{reached}; {defect.remedy}", early)
    model = result.model
    bottom = bottoming(result["stroke"], result["punch_fz"])
    punch = next(tool for tool in model.tools if tool.name == "punch")
    if bottom is not None and bottoms(model, punch, {pair: pair.found for pair in model.contacts}):
        text = f"the punch bottoms at a stroke of {abs(bottom.at):.4g}{reached}: its force rises from"
        remedy = "a shorter stroke, or more clearance"
        return Ending("bottomed", f"{text} {bottom.before:.4g} to {bottom.largest:.4g}; {remedy}", early)
    if early:
        return Ending("solver", f"the run cannot be continued{reached}: {failure}", True)
    return None


@dataclass(frozen=True)
class _Defect:
    """A torn or wrinkled sheet: since which stroke, infinite if unknown, what was found, and the remedy."""

    kind: str
    since: float
    what: str
    found: str
    remedy: str

    @property
    def text(self) -> str:
        since = f" from a stroke of about {self.since:.3g}" if np.isfinite(self.since) else ""
        return f"{self.what}{since}: {self.found}"


def _tearing(case: Cup | UBend, result: Result, limit: FormingLimit, early: bool) -> _Defect | None:
    """Elements beyond the forming limit, or a large thinning where the run has failed."""
    model = result.model
    found = forming_fields(model.mesh, model.u, limit)
    beyond, thinnest = beyond_limit(model.mesh, found), float(found["thinning"].max())
    if beyond is None and not (early and thinnest > _TORN):
        return None
    still = early and _drawn_in(case, result) < 0.02 * case.way
    what = "the holder is too strong: the sheet does not flow in and tears" if still else "the sheet tears"
    text = (f"{beyond}; " if beyond is not None else "") + f"thinning up to {thinnest:.3g} %"
    hold = "a larger holder gap, less friction" if case.holder_force is None else "less holder force or friction"
    remedy = f"{hold}, larger radii, a smaller blank"
    return _Defect("held" if still else "torn", tears_from(result), what, text, remedy)


def tears_from(result: Result) -> float:
    """Stroke at which the first element passes the forming limit, between frames; infinite if none does."""
    return _first_below(_strokes(result), np.array([frame.cells["limit_margin"].min() for frame in result.frames]))


def _wrinkling(case: Cup | UBend, result: Result) -> _Defect | None:
    """A flange that stands off both die and holder."""
    allowed, lift = _WRINKLED * case.thickness, _lift(result)
    air = wrinkle(result, case.thickness)
    if not air > allowed:
        return None
    place = np.interp([frame.time for frame in result.frames], result["time"], lift)
    states = zip(result.frames, place, strict=True)
    airs = np.array([wrinkle(result, case.thickness, frame.points["displacement"], up) for frame, up in states])
    since = _first_below(_strokes(result), allowed - airs)
    text = f"it stands off both tools by {air:.3g}"
    if lift[-1] > allowed:
        text += f" and lifts the holder by {lift[-1]:.3g}"
    remedy = "a smaller holder gap" if case.holder_force is None else "a stronger holder"
    return _Defect("wrinkled", since, "the sheet wrinkles under the holder", text, remedy)


def _strokes(result: Result) -> Floats:
    """Stroke at each frame."""
    return np.interp([frame.time for frame in result.frames], result["time"], result["stroke"])


def _first_below(stroke: Floats, value: Floats) -> float:
    """Stroke at which a value falls below zero for the first time, straight between the frames; infinite if never."""
    below = np.flatnonzero(value < 0.0)
    if len(below) == 0:
        return math.inf
    k = int(below[0])
    if k == 0:
        return float(stroke[0])
    return float(stroke[k - 1] + (stroke[k] - stroke[k - 1]) * value[k - 1] / (value[k - 1] - value[k]))


def _lift(result: Result) -> Floats:
    """Travel of the holder away from the die in each increment; zero for a fixed one."""
    fixed = np.zeros(len(result["stroke"]))
    return result["hold_way"] if any(control.name == "hold" for control in result.model.controls) else fixed


def wrinkle(result: Result, thickness: float, u: Floats | None = None, lift: float | None = None) -> float:
    """Largest distance of the flange from both die and holder; where it touches neither, it wrinkles.

    Parameters
    ----------
    result : Result
        A run with tools named die and holder.
    thickness : float
        Thickness of the sheet. The flange is where the holder is at most three thicknesses, and the travel by which
        wrinkles have lifted it, from the flat of the die.
    u : ndarray, shape (n, 3), optional
        Displacement of the nodes; default: that of the last state.
    lift : float, optional
        Travel of the holder away from the die at that displacement; default: that of the last state.
    """
    model = result.model
    tools = {tool.name: tool for tool in model.tools}
    if not {"die", "holder"} <= tools.keys():
        return 0.0
    now = float(_lift(result)[-1])
    up = now if lift is None else lift
    x = model.mesh.points + (model.u if u is None else u).reshape(-1, 3)
    cells = model.mesh.connectivity
    half = cells.shape[1] // 2
    lower, upper = x[cells[:, :half].ravel()], x[cells[:, half:].ravel()]
    back = np.array([0.0, 0.0, now - up])  # from where the holder was to where it is
    below, above = distance_from(tools["die"], lower), distance_from(tools["holder"], upper + back)
    rotation, shift = tools["die"].pose_now
    normal = tools["die"].surface.kernel().gap(np.ascontiguousarray((lower - shift) @ rotation))[1] @ rotation.T
    foot = lower - below[:, None] * normal
    under = distance_from(tools["holder"], foot + back) < 3.0 * thickness + max(up, 0.0)
    flat = (normal[:, 2] > 1.0 - 1e-9) & under
    return float(np.minimum(below, above)[flat].max(initial=0.0))


def _drawn_in(case: Cup | UBend, result: Result) -> float:
    """Mean inward travel of the edge of the blank."""
    model = result.model
    ids = model.mesh.nodes(case.edge)
    X, u = model.mesh.points[ids, :2], model.u.reshape(-1, 3)[ids, :2]
    return float(-(u * X).sum(axis=1).mean() / np.linalg.norm(X, axis=1).mean())
