"""A sheet metal from a file: the table [material] of a deck, with remarks on top."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from umform.errors import FileProblem
from umform.io.atomic import write_text
from umform.materials import J2, Metal
from umform.materials.laws import Law
from umform.problem.deck_text import deck_text
from umform.problem.errors import DeckError
from umform.problem.keys import law_keys
from umform.problem.reading import Unfit, read
from umform.problem.source import Source, parse, read_file
from umform.sheet_metals import get

#: Ending of the names of such files.
ENDING = ".toml"


@dataclass(frozen=True)
class NamedLaw:
    """A law with its name and what is known of it.

    Attributes
    ----------
    name : str
        Of the metal, or of the file without its ending.
    law : J2 or Metal
        The law.
    note : str
        Source and limits.
    """

    name: str
    law: J2 | Metal
    note: str


def metal_of(name: str, thickness: float | None = None) -> NamedLaw:
    """A sheet metal of the library by its name, or of a file by its path.

    Parameters
    ----------
    name : str
        Name in the library, or a path that ends in ``.toml``.
    thickness : float, optional
        Thickness of the sheet in mm, on which values of a standard may depend.

    Raises
    ------
    InvalidValue
        The library has no such metal.
    FileProblem
        The file cannot be read, or has no table [material].
    DeckError
        The law in the file is wrong.
    """
    if not name.endswith(ENDING):
        metal = get(name, thickness)
        return NamedLaw(metal.name, metal.law, metal.note)
    path = Path(name)
    try:
        text = read_file(path)
    except FileProblem as error:
        error.what, error.remedy = "the file of a metal cannot be read", "look at the path, or `umform metal list`"
        raise
    source = parse(text, path.name, path.parent)
    table = source.data.get("material")
    if not isinstance(table, dict):
        raise FileProblem(
            "the file has no metal",
            where=name,
            cause="the table [material] is missing",
            remedy="a file of `umform metal fit` or `umform bend correct`, or what `umform metal show` prints",
        )
    if isinstance(table.get("library"), str):
        return metal_of(table["library"], thickness)
    remarks = [line.lstrip("# ").strip() for line in text.splitlines() if line.startswith("#")]
    return NamedLaw(path.stem, _law(source), " ".join([f"{path.name}:", *remarks]) if remarks else path.name)


def _law(source: Source) -> J2 | Metal:
    keys = {name: value for name, value in source.data["material"].items() if name != "rolling"}
    try:
        law = read(Law, keys, source.context)
    except Unfit:
        from umform.problem.messages import checked  # pydantic takes long to import

        _, errors = checked(source)
        raise DeckError([error for error in errors if "material" in error.where] or errors) from None
    if not isinstance(law, J2 | Metal):
        raise FileProblem(
            "the law of the file is none of a sheet metal",
            where=source.name,
            value=keys.get("law"),
            cause="it has no yield stress",
            remedy="J2 or Metal",
        )
    return law


def write_metal(path: Path, law: J2 | Metal, remarks: Iterable[str]) -> None:
    """Write a law that `metal_of` reads, exact to the last bit.

    Raises
    ------
    FileProblem
        The file cannot be written.
    """
    write_text(path, deck_text({"material": law_keys(law, "x")}, remarks))
