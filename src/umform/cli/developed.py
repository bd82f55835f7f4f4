"""Outside dimensions of a part on the command line: flat length and bend lines before the part is bent."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from umform.cli.root import console
from umform.errors import InvalidValue

if TYPE_CHECKING:
    from umform.flat_pattern.developed import Developed
    from umform.processes.air_bending.spec import AirBending
    from umform.processes.bend_sequence import BendSequence


def sequence_of(file: Path, sheet: AirBending, *, flat_only: bool) -> BendSequence:
    """The bends of a file; of outside dimensions, flat length and bend lines are computed and printed.

    Parameters
    ----------
    file : Path
        TOML file.
    sheet : AirBending
        Sheet and default tools.
    flat_only : bool
        Whether nothing else is wanted; a file without outside dimensions is then refused.

    Raises
    ------
    FileProblem, DeckKey, InvalidValue
    """
    from umform.flat_pattern.developed import developed_of
    from umform.processes.bend_sequence.form import OutsideForm, read_sequence

    form = read_sequence(file)
    if isinstance(form, OutsideForm):
        found = developed_of(form, sheet, file.parent)
        _show(found)
        if flat_only:  # a run says them again
            _remarks(found)
        return found.sequence(sheet, form.bodies)
    if flat_only:
        raise InvalidValue(
            "the flat length is in this file already",
            where="--flat-only",
            value=str(file),
            cause="it has the positions of the bend lines, not the outside dimensions",
            remedy="flanges = [30, 50, 30] in place of length and positions",
        )
    return form.sequence(sheet)


def _show(found: Developed) -> None:
    from rich import box
    from rich.table import Table

    flanges = " + ".join(f"{flange:g}" for flange in found.part.flanges)
    console().print(f"Flat length: {found.length:.3f} mm, from the outside dimensions {flanges} mm", soft_wrap=True)
    table = Table("bend", "direction", box=box.SIMPLE_HEAD)
    for name in ("angle", "bend line at, mm", "bend deduction, mm", "R, mm"):
        table.add_column(name, justify="right")
    table.add_column("from")
    for number, (bend, place, one) in enumerate(zip(found.part.bends, found.positions, found.deductions), start=1):
        numbers = (f"{bend.angle:g}°", f"{place:.3f}", f"{one.value:.3f}", f"{one.radius:.3f}")
        table.add_row(str(number), bend.direction, *numbers, one.source)
    console().print(table)


def _remarks(found: Developed) -> None:
    for note in dict.fromkeys(note for one in found.deductions for note in one.notes):
        console().print(f"Remark: {note}", soft_wrap=True)
