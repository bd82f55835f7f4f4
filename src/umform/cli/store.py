"""``umform store``: the results that are kept."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from umform.cli.outcome_screen import print_table
from umform.cli.root import Debug, Overwrite, app
from umform.errors import FileProblem, InvalidValue

if TYPE_CHECKING:
    from umform.io.store import Store

stores = typer.Typer(no_args_is_help=True, rich_markup_mode="markdown")
app.add_typer(stores, name="store")

Folder = Annotated[Path | None, typer.Option("--store", help="Folder; default: UMFORM_STORE, or that of `path`.")]


@stores.callback()
def store() -> None:
    """Bends that were computed once: list, export, remove."""


@stores.command("path")
def path(store: Folder = None) -> None:
    """Print the folder of the store."""
    from umform.io.store import Store

    typer.echo(Store(store).folder)


@stores.command("list")
def list_entries(store: Folder = None, debug: Debug = False) -> None:
    """Show what is stored."""
    from umform.studies.bend_table.listing import listed

    rows = listed(_store(store))
    print_table(rows)
    typer.echo(f"{len(rows) - 1} bends in {_store(store).folder}")


@stores.command("export")
def export(
    file: Annotated[Path, typer.Argument(help="File to write: .csv or .json.")],
    store: Folder = None,
    overwrite: Overwrite = False,
    debug: Debug = False,
) -> None:
    """Write all stored bends to a file."""
    from umform.studies.bend_table.listing import export as write

    if file.suffix not in (".csv", ".json"):
        raise InvalidValue(
            "bends are exported as CSV or JSON", where="FILE", value=file.name, remedy="bends.csv or bends.json"
        )
    if file.exists() and not overwrite:
        raise FileProblem("there is a file of this name", where=str(file), remedy="another name, or --overwrite")
    typer.echo(f"{write(_store(store), file)} bends written to {file}")


@stores.command("prune")
def prune(
    older_than: Annotated[
        float | None, typer.Option(help="Remove bends that are older than this number of days.")
    ] = None,
    everything: Annotated[bool, typer.Option("--all", help="Remove all bends.")] = False,
    store: Folder = None,
    debug: Debug = False,
) -> None:
    """Remove bends of other versions of umform, which no command would find, and damaged files."""
    if older_than is not None and not older_than >= 0.0:
        raise InvalidValue("an age is a number of days", where="--older-than", value=older_than, remedy="such as 90")
    typer.echo(f"{_store(store).prune(older_than, everything=everything)} files removed")


def _store(folder: Path | None) -> Store:
    import umform.studies.bend_table.stored  # noqa: F401  (the version of bends)
    from umform.io.store import Store

    if folder is not None and not folder.is_dir():
        raise FileProblem(
            "this is no store",
            where=str(folder),
            cause="it is a file" if folder.exists() else "there is no such folder",
            remedy="the folder that --store of another command has made; without --store that of `umform store path`",
        )
    return Store(folder)
