"""Where a command writes: the option --out, the folder of a run, the line with the names of its files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import typer

from umform.cli.root import console, say


def out_option(content: str, default: str) -> Any:
    """The option for a folder: what it is for, and the folder without the option."""
    return typer.Option("--out", "-o", metavar="FOLDER", help=f"Folder for {content}; default: {default}.")


def results_folder(
    out: str | Path | None,
    name: str,
    files: Sequence[str],
    *,
    overwrite: bool,
    say: Callable[[str], object] = say,
) -> Path:
    """The folder of a run: the given one, or that of a name in ``results``; see `umform.io.folders.folder_for`."""
    from umform.io.folders import folder_for

    return folder_for(out, Path("results") / name, files, overwrite=overwrite, say=say)


def say_written(place: Path, files: Iterable[Path | str]) -> None:
    """Print the names of files in a folder; texts as they are."""
    names = ", ".join(file.name if isinstance(file, Path) else file for file in files)
    console().print(f"Written to {place}: {names}", soft_wrap=True, markup=False)
