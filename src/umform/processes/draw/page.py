"""The report of a drawn part: measures, pictures, parameters, settings, versions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from matplotlib.figure import Figure

from umform.processes.draw.cup import Cup
from umform.processes.draw.drawn import Drawn
from umform.processes.draw.u_bend import UBend
from umform.processes.draw.words import before_the_run, parameters
from umform.processes.solution import solution_texts
from umform.report import parts
from umform.report.live import Live, style
from umform.report.looks import MILLIMETRES
from umform.report.materials import material_text
from umform.report.page import outcome_parts
from umform.report.symmetry import modelled_part

_CAPTIONS = {
    "blank": "Mesh of the blank over the sizes that keep the angle of an element over the radii of the tools.",
    "curve": "Forces of the tools on the whole part over the stroke; shades are bands.",
    "thinning": "Thinning of the part out of its tools.",
    "major_middle": "Major strain in the middle of the sheet.",
    "limit_margin": "Strain that is left up to the forming limit; below zero the sheet tears.",
    "wrinkling": "Thickening: where it is large and no tools hold both faces, the sheet wrinkles.",
    "punch_distance": "Distance of the upper face of the part from the punch at the end of its stroke.",
    "gauge": "The whole part in a gauge of the shape at the end of the stroke: by the best fit, and on three points.",
    "limits": "Forming limit diagram: strains of all elements on both skins and in the middle; beside it, the "
    "effective strain over the direction of its rate, with the limit that does not depend on the path. Shades are "
    "bands.",
    "outline": "Edge of the blank before and at the end of the stroke; the shade is the band of the draw-in.",
    "thinning_section": "Thinning along the section at y = 0, out of the tools; the shade is its band.",
    "section": "Section at y = 0, at the end of the stroke and out of the tools.",
    "ears": "Height of the cup over the angle to the rolling direction; the shade is its band.",
}


def write_page(path: Path, drawn: Drawn, figures: Mapping[str, Figure], note: str = "") -> Path:
    """Write the report of a part.

    Parameters
    ----------
    path : Path
        The page, ending in .html.
    drawn : Drawn
        The part.
    figures : mapping of str to Figure
        Pictures by their names.
    note : str
        Source of the material data; may be empty.
    """
    elements = len(drawn.result.model.mesh.connectivity)
    lead = f"{elements} elements; computed in {drawn.seconds:.1f} s"
    live = Live.of(drawn.result, stills=False, first=("stroke", "stroke_force"), units=MILLIMETRES)
    given = parameters(drawn.case) | _texts(drawn.case)
    content = outcome_parts(drawn, live.shape, _middle(drawn, live, figures), given, note)
    return parts.write_html(path, drawn.title, lead, content, style=style(), scripts=live.scripts)


def _middle(drawn: Drawn, live: Live, figures: Mapping[str, Figure]) -> Iterator[str]:
    yield from map(parts.note, live.notes)
    shown = [name for name in figures if name != "blank"]
    yield parts.side_by_side(parts.figure(figures[name], _CAPTIONS[name]) for name in shown)
    mesh = [parts.figure(figures["blank"], _CAPTIONS["blank"]), parts.paragraph(before_the_run(drawn.case))]
    yield parts.section("Mesh", mesh)
    yield parts.section("History", [parts.paragraph(modelled_part(drawn.result.model)), live.curves, live.table])


def _texts(case: Cup | UBend) -> dict[str, str]:
    """Parameters that are objects, as text."""
    return solution_texts(case.newton, case.pace) | {"material": material_text(case.material)}
