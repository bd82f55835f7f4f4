"""File formats of bend tables: a module for each, with `write` and `read`."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from pathlib import Path

from umform.errors import InvalidValue
from umform.spec import check_arguments, each
from umform.studies.bend_table.formats import creo, freecad, inventor, solidworks, table_csv, table_json
from umform.studies.bend_table.table import BendTable, Setup, Tabled


@dataclass(frozen=True)
class Format:
    """A file format.

    Attributes
    ----------
    write : callable
        Writes the files of a table into a folder.
    file : callable
        Name of the file of a setup.
    """

    write: Callable[[BendTable, Path], list[Path]]
    file: Callable[[Setup], str]


def _each(write: Callable[[BendTable, Path, Tabled], Path]) -> Callable[[BendTable, Path], list[Path]]:
    """Write a file for each setup that has bends."""
    return lambda table, folder: [write(table, folder, part) for part in table.parts if part.bends]


#: Formats by name.
FORMATS = {
    "csv": Format(table_csv.write, lambda setup: "bends.csv"),
    "json": Format(table_json.write, lambda setup: "bends.json"),
    "freecad": Format(_each(freecad.write), lambda setup: f"{setup.name}.FCStd"),
    "inventor": Format(inventor.write, lambda setup: f"{setup.tools}.inventor.txt"),
    "creo": Format(_each(creo.write), lambda setup: f"{setup.name}.bnd"),
    "solidworks": Format(_each(solidworks.write), lambda setup: f"{setup.name}.solidworks.txt"),
}


def file_names(wanted: Iterable[Setup], formats: Iterable[str]) -> list[str]:
    """Names of the files of a table."""
    setups = list(wanted)
    return sorted({FORMATS[name].file(setup) for name in formats for setup in setups})


def check_formats(names: Iterable[str]) -> None:
    """Refuse a format that does not exist.

    Raises
    ------
    InvalidValue
    """
    for name in names:
        if name not in FORMATS:
            raise InvalidValue(
                "there is no such format of bend tables",
                where="format",
                value=name,
                cause="a typing mistake, or another CAD system",
                remedy=f"of {', '.join(FORMATS)}; csv has all numbers",
            )


def write_table(table: BendTable, folder: str | Path, formats: str | Collection[str] = ("csv", "json")) -> list[Path]:
    """Write a table into a folder.

    Parameters
    ----------
    table : BendTable
        The table.
    folder : str or Path
        It is made if it is missing.
    formats : str or collection of str
        Names of ``FORMATS``.

    Raises
    ------
    InvalidValue
        There is no such format.
    FileProblem
        A file cannot be written.
    """
    check_arguments(write_table, table=table, folder=folder, formats=formats)
    formats, folder = each(formats), Path(folder)
    check_formats(formats)
    folder.mkdir(parents=True, exist_ok=True)
    return [path for name in formats for path in FORMATS[name].write(table, folder)]
