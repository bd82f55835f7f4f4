"""Parameters and angles of a drawn part as text."""

from __future__ import annotations

from typing import Any

from umform.elements import element
from umform.materials.laws import full_text
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
    found |= {"element": element(case.element).name, "material": full_text(case.material)}
    return case.record() | found | {"newton": vars(case.newton), "pace": vars(case.pace)}


def angles_text(drawn: Drawn) -> str:
    """Angles and radius of a U-bend in a line, with their errors if there are any; empty without angles."""
    shown = ("theta1", "theta2", "radius of the wall")
    return ", ".join(f"{one.label} {one.full_text}" for one in drawn.quantities if one.name in shown)


def before_the_run(case: Cup | UBend) -> str:
    """Description of the mesh, printed before the run."""
    stacked, needed = case.stacked, case.needed_layers
    layers = "1 layer" if stacked == 1 else f"{stacked} layers"
    advice = f" (the sharpest radius needs {needed}, eq. (2.29): --layers {needed})" if needed > stacked else ""
    return f"along the section: {case.sizes}; {layers}{advice}"
