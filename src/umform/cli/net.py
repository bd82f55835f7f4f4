"""``umform net``: the blank of a deck whose formed edge ends where it is wanted."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from umform.cli.check import Changes, DeckFile, Force, Trust, deck_errors, read_to_run
from umform.cli.folders import say_written
from umform.cli.options import option
from umform.cli.outcome_screen import print_table
from umform.cli.root import Debug, Overwrite, Verbose, app, printing
from umform.cli.warnings import print_warnings_once
from umform.errors import InvalidValue

_WANTED, _BLANK = "Wanted edge", "Blank"


@app.command()
def net(
    deck: DeckFile,
    outline: Annotated[
        Path | None,
        option("Outline of the formed part: a DXF drawing, or a CSV file with columns x, y or x, y, z.", _WANTED),
    ] = None,
    outline_layer: Annotated[str | None, option("Layer of this drawing with the outline.", _WANTED)] = None,
    height: Annotated[
        float | None, option("Height of the edge over the bottom, both on the mid-surface: of a cup.", _WANTED)
    ] = None,
    corrections: Annotated[int, option("Number of corrections, each with its run.", _BLANK)] = 2,
    first: Annotated[
        Path | None,
        option("Outline of the first blank, such as blank.dxf of `umform blank`.", _BLANK),
    ] = None,
    first_layer: Annotated[str | None, option("Layer of this drawing with the outline.", _BLANK)] = None,
    changes: Changes = None,
    overwrite: Overwrite = False,
    force: Force = False,
    trust: Trust = False,
    verbose: Verbose = 0,
    debug: Debug = False,
) -> None:
    """Correct the blank of a deck by its runs, so that the formed edge ends on an outline or at a height.

    Writes DECK-net.toml, its mesh, the outline of the blank as DXF, and a table of the edge beside the deck. See
    docs/blank.md.
    """
    from umform.flat_pattern.net import net_blank
    from umform.flat_pattern.net.files import names, write_files
    from umform.flat_pattern.net.wanted import outline_of
    from umform.io.folders import chosen_folder
    from umform.problem import running
    from umform.problem.named_units import length_of

    print_warnings_once()
    if (outline is None) == (height is None):
        raise InvalidValue(
            "the edge is wanted on an outline or at a height",
            where="--outline and --height",
            cause="both, or none of them",
            remedy="--outline flange.dxf for a flange, --height 20 for a cup",
        )
    for option_of, layer, file in (("--outline", outline_layer, outline), ("--first", first_layer, first)):
        if layer is not None and file is None:
            raise InvalidValue(
                "a layer is that of a drawing", where=f"{option_of}-layer", value=layer, remedy=f"{option_of} FILE.dxf"
            )
    stem = f"{deck.stem}-net"
    place = chosen_folder(deck.parent, list(names(stem).values()), overwrite=overwrite)
    with deck_errors("height", "corrections", "first", wanted="--outline"):
        loaded = read_to_run(deck, changes or (), trust)
        running.refuse_implausible(loaded, loaded.build(), force=force)
        unit = length_of(loaded)
        wanted = height if outline is None else outline_of(outline, outline_layer, unit)
        assert wanted is not None
        found = net_blank(
            loaded,
            wanted,
            names(stem)["mesh"],
            corrections=corrections,
            first=None if first is None else outline_of(first, first_layer, unit),
        )
    files = write_files(place, stem, found)
    with printing(f"the files of the blank are in {place}"):
        print_table(found.table)
    say_written(place, files)
