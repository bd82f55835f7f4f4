"""The measures of a hem as rows of text: for the terminal, the report and files."""

from __future__ import annotations

from umform.processes.air_bending.measures import Quantity
from umform.processes.air_bending.remarks import coarse_mesh, extrapolated, tools_text
from umform.processes.hemming.measures import Hem, HemMeasures

#: The measures, in the order of tables, defined in docs/bending-operations.md.
QUANTITIES = {
    "force": Quantity("force", "N/mm", 1),
    "largest_force": Quantity("largest force", "N/mm", 1),
    "loaded_height": Quantity("height under load", "mm", 3),
    "height": Quantity("height", "mm", 3),
    "springback": Quantity("springback", "mm", 3),
    "tip_gap": Quantity("gap at the tip", "mm", 3),
    "loop_gap": Quantity("largest gap", "mm", 3),
    "angle": Quantity("angle of the flange", "deg", 2),
    "outer_strain": Quantity("outer strain", "", 4),
    "thinning": Quantity("smallest thickness ratio", "", 4),
}


def rows(measures: HemMeasures) -> list[list[str]]:
    """Measures as rows of text: name, value, unit."""
    return [[q.label, f"{getattr(measures, name):.{q.decimals}f}", q.unit] for name, q in QUANTITIES.items()]


def remarks(hem: Hem) -> list[str]:
    """Tools of the first bend, mesh, extrapolated flow curve."""
    sheet = hem.case.sheet
    return [tools_text(sheet), *coarse_mesh(sheet), *extrapolated(sheet, hem.measures.outer_strain)]
