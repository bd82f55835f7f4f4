"""``umform new``: templates of decks, and their JSON schema."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from umform.cli.root import Debug, app, console
from umform.errors import InvalidValue


@app.command()
def new(
    template: Annotated[str | None, typer.Argument(help="Name of a template; without it, list them.")] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="FILE", help="Write the deck and the files that it reads.")
    ] = None,
    schema: Annotated[bool, typer.Option("--schema", help="Print the JSON schema of decks, for editors.")] = False,
    debug: Debug = False,
) -> None:
    """Print a template deck: `umform new air-bending > deck.toml`."""
    from umform.problem import templates

    if out is not None and (schema or template is None):
        raise InvalidValue(
            "only a template is written to a file" if schema else "there is no template to write",
            where="--out",
            value=str(out),
            remedy="umform new --schema > deck-schema.json" if schema else "umform new TEMPLATE --out FILE",
        )
    if schema:
        from umform.problem.contents import json_schema  # without the rest of umform, which the list does not need

        typer.echo(json_schema(), nl=False)
    elif template is None:
        _list_templates()
    elif out is None:
        typer.echo(templates.template(template), nl=False)
    else:
        for file in templates.write_template(template, out):
            typer.echo(f"Written: {file}", err=True)


def _list_templates() -> None:
    """All templates with their titles."""
    from rich import box
    from rich.table import Table

    from umform.problem.templates import templates

    table = Table("name", "deck", box=box.SIMPLE_HEAD)
    for name, title in templates().items():
        table.add_row(name, title)
    console().print(table)
