"""Parameters and measures of a drawn part as text: for the terminal, the report and files."""

from __future__ import annotations

from typing import Any

from umform.elements import element
from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.u_bend import UBend


def parameters(case: Cup | UBend) -> dict[str, Any]:
    """Parameters with their defaults; the material as text."""
    found: dict[str, Any] = {"stroke": case.way, "layers": case.stacked}
    if isinstance(case, Cup):
        found["holder_gap"] = case.gap
    return case.record() | found | {"element": element(case.element).name, "material": repr(case.material)}


def title(drawn: Drawn) -> str:
    """Heading of the report."""
    case = drawn.case
    if isinstance(case, Cup):
        return f"Cup: punch of {2.0 * case.punch_radius:g} mm, {case.thickness:g} mm sheet"
    return f"U-bend: punch of {case.punch_width:g} mm, {case.thickness:g} mm sheet"


def summary(drawn: Drawn) -> list[list[str]]:
    """Rows of all measures: name, value, unit."""
    return [[name, f"{value:.4g}", unit] for name, (value, unit) in drawn.measures().items()]


def before_the_run(case: Cup | UBend) -> str:
    """Description of the mesh, printed before the run."""
    stacked, needed = case.stacked, case.needed_layers
    layers = "1 layer" if stacked == 1 else f"{stacked} layers"
    advice = f" (the sharpest radius needs {needed}, eq. (2.29): --layers {needed})" if needed > stacked else ""
    return f"along the section: {case.sizes}; {layers}{advice}"
