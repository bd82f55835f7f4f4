"""Parameters and measures of a drawn part as text: for the terminal, the report and files."""

from __future__ import annotations

import math
from typing import Any

from umform.elements import element
from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.u_bend import UBend


def parameters(case: Cup | UBend) -> dict[str, Any]:
    """Parameters with their defaults; the material as text."""
    found: dict[str, Any] = {"stroke": case.way, "layers": case.stacked}
    if isinstance(case, Cup):
        found |= {"holder_gap": case.gap, "die_radius": case.throat}
    else:
        found["opening"] = case.throat
    found |= {"element": element(case.element).name, "material": repr(case.material)}
    return case.record() | found | {"newton": vars(case.newton), "pace": vars(case.pace)}


#: The error of a value of one mesh.
UNKNOWN = "unknown"


def title(drawn: Drawn) -> str:
    """Heading of the report."""
    case = drawn.case
    if isinstance(case, Cup):
        return f"Cup: punch of {2.0 * case.punch_radius:g} mm, {case.thickness:g} mm sheet"
    return f"U-bend: punch of {case.punch_width:g} mm, {case.thickness:g} mm sheet"


def summary(drawn: Drawn) -> list[list[str]]:
    """Rows of all measures, the names of the columns first: name, value, unit.

    Each value has its error, or the mark that it is unknown. With estimates from three meshes there is one more column:
    the value is that at zero element size, then follows that on the finest mesh.
    """
    extrapolated, errors = bool(drawn.estimates), drawn.errors()
    rows = [["quantity", "value", "error", *["finest mesh"] * extrapolated, "unit"]]
    for name, (value, unit) in drawn.measures().items():
        limit = drawn.estimates.get(name)
        shown = _with_error(value if limit is None else limit.value, errors.get(name))
        rows.append([name, *shown, *[f"{value:.4g}" if limit else ""] * extrapolated, unit])
    return rows


def _with_error(value: float, error: float | None) -> tuple[str, str]:
    """A value and its error, both to the second digit of the error."""
    if not error:
        return f"{value:.4g}", UNKNOWN if error is None else ""
    digits = max(1 - math.floor(math.log10(error)), 0)
    return f"{value:.{digits}f}", f"± {error:.{digits}f}"


def angles_text(drawn: Drawn) -> str:
    """Angles and radius of a U-bend in a line, with their errors if there are any; empty without angles."""
    if drawn.angles is None:
        return ""
    rows = {name: row for name, *row in summary(drawn)[1:]}
    shown = {"theta1": ("theta1", "°"), "theta2": ("theta2", "°"), "radius of the wall": ("radius", " mm")}
    return ", ".join(
        f"{label} {rows[name][0]}{' ' + rows[name][1] if drawn.estimates else ''}{unit}"
        for name, (label, unit) in shown.items()
    )


def meshes(drawn: Drawn) -> list[list[str]]:
    """Rows of the measures on each mesh that gave the estimates, the names of the columns first."""
    names = list(drawn.estimates)
    rows = [["degrees per element", "elements", *names]]
    for mesh in (*drawn.coarser, drawn):
        measures, elements = mesh.measures(), len(mesh.result.model.mesh.connectivity)
        rows.append([f"{mesh.case.turn:.4g}", str(elements), *(f"{measures[name][0]:.4g}" for name in names)])
    return rows


def about_errors(drawn: Drawn) -> str:
    """Note on values without an error; empty if there are none."""
    if drawn.estimates:
        return ""
    text = f"values of one mesh, whose elements turn up to {drawn.case.turn:g} degrees: most errors are unknown"
    if isinstance(drawn.case, UBend):
        return f"{text}; three meshes (without --coarse, or --extrapolate) give it"
    return f"{text}; repeat with half of --turn, and twice --around, to see it"


def before_the_run(case: Cup | UBend) -> str:
    """Description of the mesh, printed before the run."""
    stacked, needed = case.stacked, case.needed_layers
    layers = "1 layer" if stacked == 1 else f"{stacked} layers"
    advice = f" (the sharpest radius needs {needed}, eq. (2.29): --layers {needed})" if needed > stacked else ""
    return f"along the section: {case.sizes}; {layers}{advice}"
