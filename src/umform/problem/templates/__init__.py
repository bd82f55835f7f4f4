"""Templates of decks with their files, and the decks of ready processes."""

from __future__ import annotations

import tomllib
from pathlib import Path

from umform.errors import InvalidValue
from umform.problem.errors import slip

_FOLDER = Path(__file__).parent
#: Files beside a deck that it reads.
_COMPANIONS = {"own-mesh": ("sheet.inp",)}


def templates() -> dict[str, str]:
    """Names of all templates, with their titles."""
    decks = {path.stem: path for path in sorted(_FOLDER.glob("*.toml"))}
    return {name: str(tomllib.loads(path.read_text(encoding="utf-8"))["title"]) for name, path in decks.items()}


def template(name: str) -> str:
    """Text of a template.

    Raises
    ------
    InvalidValue
        If the name is unknown.
    """
    return template_file(name).read_text(encoding="utf-8")


def template_file(name: str) -> Path:
    """File of a template; its other files lie beside it."""
    known = templates()
    if name not in known:
        raise InvalidValue(
            "there is no template of this name",
            where="template",
            value=name,
            cause=slip(name, known),
            remedy="one of " + ", ".join(known),
        )
    return _FOLDER / f"{name}.toml"


def write_template(name: str, path: str | Path) -> list[Path]:
    """Write a template, and the files that it reads beside it.

    Parameters
    ----------
    name : str
        Of the template.
    path : str or Path
        The deck to write.

    Returns
    -------
    list of Path
        The written files.

    Raises
    ------
    InvalidValue
        If there is no such template, or one of the files exists.
    FileProblem
        If a file cannot be written.
    """
    from umform.io.atomic import write_text

    path = Path(path)
    texts = {path: template(name)}
    texts |= {
        path.with_name(other): (_FOLDER / other).read_text(encoding="utf-8") for other in _COMPANIONS.get(name, ())
    }
    for target in texts:
        if target.exists():
            raise InvalidValue(
                "there is a file of this name",
                where=str(target),
                cause="an earlier deck",
                remedy="choose another name, or move the file away",
            )
    for target, text in texts.items():
        write_text(target, text)
    return list(texts)
