"""Material sheets of FreeCAD's SheetMetal workbench: K over radius / thickness, in a FreeCAD document."""

from __future__ import annotations

import math
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

import numpy as np

from umform.io.atomic import PendingFile
from umform.studies.bend_table.formats.reading import within
from umform.studies.bend_table.head import head
from umform.studies.bend_table.stored import StoredBend
from umform.studies.bend_table.table import BendTable, Tabled

_NOTES = (
    "K by ANSI over R / T of the bend that gets it: each row is an angle. Give the bends of the part these radii.",
    "A sheet with the name of an angle has its row only: for unfolders that do not find a row between others.",
)
_HEADINGS = ("Radius / Thickness", "K-factor (ANSI)")


def write(table: BendTable, folder: Path, part: Tabled) -> Path:
    """Write the document of a setup: a sheet of all angles, and one for each angle."""
    notes = [line.replace("K-factor", "K") for line in (*head(table, part), *_NOTES)]  # the workbench looks for it
    label = f"material_{part.setup.name}"
    sheets = {label: _cells(part.by_radius, notes)}
    sheets |= {f"{label}-{one.wanted:g}deg": _cells([one], notes) for one in part.bends}
    path = folder / f"{part.setup.name}.FCStd"
    with PendingFile(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("Document.xml", _document(sheets))
    return path


def _cells(bends: Sequence[StoredBend], notes: list[str]) -> dict[str, str]:
    cells = dict(zip(("A1", "B1", "C1"), (*_HEADINGS, "angle"), strict=True))
    for row, one in enumerate(bends, start=2):
        numbers = (one.radius / one.case.thickness, one.k_factor, one.wanted)
        cells |= {f"{column}{row}": f"{number:.12g}" for column, number in zip("ABC", numbers, strict=True)}
    return cells | {f"E{row}": f"'{line}" for row, line in enumerate(notes, start=1)}


def _document(sheets: Mapping[str, Mapping[str, str]]) -> str:
    names = [f"sheet{number}" for number in range(1, len(sheets) + 1)]
    lines = ["<?xml version='1.0' encoding='utf-8'?>", '<Document SchemaVersion="4" FileVersion="1">']
    lines += ['<Properties Count="0">', "</Properties>", f'<Objects Count="{len(sheets)}">']
    lines += [f'<Object type="Spreadsheet::Sheet" name="{name}"/>' for name in names]
    lines += ["</Objects>", f'<ObjectData Count="{len(sheets)}">']
    for name, (label, cells) in zip(names, sheets.items(), strict=True):
        lines += [f'<Object name="{name}">', '<Properties Count="2">']
        lines += ['<Property name="Label" type="App::PropertyString">', f"<String value={quoteattr(label)}/>"]
        lines += ["</Property>", '<Property name="cells" type="Spreadsheet::PropertySheet">']
        lines.append(f'<Cells Count="{len(cells)}">')
        lines += [f'<Cell address="{at}" content={quoteattr(content)}/>' for at, content in cells.items()]
        lines += ["</Cells>", "</Property>", "</Properties>", "</Object>"]
    return "\n".join([*lines, "</ObjectData>", "</Document>"]) + "\n"


@dataclass(frozen=True)
class MaterialSheet:
    """K over radius / thickness.

    Attributes
    ----------
    k_factors : mapping of float to float
        K by ANSI.
    """

    k_factors: Mapping[float, float]

    def flat_length(self, angle: float, radius: float, thickness: float, sides: tuple[float, float]) -> float:
        """Flat length of a part, as of `Reading.flat_length`; K between the rows is linear."""
        known = sorted(self.k_factors)
        within(radius / thickness, known, "radius / thickness")
        k = float(np.interp(radius / thickness, known, [self.k_factors[one] for one in known]))
        theta = math.radians(180.0 - angle)
        return sum(sides) - 2.0 * (radius + thickness) * math.tan(0.5 * theta) + theta * (radius + k * thickness)


def read(path: Path) -> dict[str, MaterialSheet]:
    """Sheets of a document by their labels."""
    with zipfile.ZipFile(path) as file:
        root = ElementTree.fromstring(file.read("Document.xml"))
    found = {}
    for thing in root.iterfind("./ObjectData/Object"):
        label = thing.find("./Properties/Property[@name='Label']/String")
        assert label is not None
        cells = {cell.attrib["address"]: cell.attrib["content"] for cell in thing.iter("Cell")}
        scale = 0.5 if "DIN" in cells["B1"] else 1.0
        rows = [row for row in range(2, len(cells)) if f"A{row}" in cells]
        found[label.attrib["value"]] = MaterialSheet(
            {float(cells[f"A{row}"]): scale * float(cells[f"B{row}"]) for row in rows}
        )
    return found
