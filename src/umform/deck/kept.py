"""What a checkpoint keeps of a deck, so that a run can be taken up with the checkpoint alone."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from umform.deck.deck import Deck
from umform.errors import FileProblem
from umform.run.checkpoint import read_note


@dataclass(frozen=True)
class Kept:
    """A run of a deck as far as the command line has it.

    Attributes
    ----------
    deck : Deck
        The deck, with its changes.
    out : Path
        Folder for what comes out.
    solver : str or None
        Another sparse solver than that of the deck.
    """

    deck: Deck
    out: Path
    solver: str | None = None

    @property
    def chosen_solver(self) -> str:
        """The solver of the run."""
        return self.solver or self.deck.contents.solution.solver

    def note(self, checkpoint: Path) -> dict[str, Any]:
        """What goes into a checkpoint; folders also as seen from there, for the case that all of them move."""
        source, here = self.deck.source, checkpoint.parent
        return {
            "deck": source.text,
            "name": source.name,
            "changes": dict(source.changes),
            "folder": str(source.folder.resolve()),
            "folder_from_here": os.path.relpath(source.folder, here),
            "out_from_here": os.path.relpath(self.out, here),
            "solver": self.solver,
        }

    @classmethod
    def read(cls, checkpoint: Path) -> Kept:
        """What a checkpoint has kept.

        Raises
        ------
        FileProblem
            If it cannot be read, is no checkpoint, or was not written by a run of a deck.
        DeckError
            If the deck in it cannot be read any more.
        """
        note = read_note(checkpoint)
        if "deck" not in note:
            raise FileProblem(
                "the checkpoint has no deck",
                where=str(checkpoint),
                cause="it was written by umform.solve, and the model was built in Python",
                remedy=f"build the model again and call umform.resume({str(checkpoint)!r}, model, steps)",
            )
        here, folder = checkpoint.parent, Path(note["folder"])
        if not folder.is_dir():
            folder = here / note["folder_from_here"]
        deck = Deck.read(note["deck"], note["name"], folder, note["changes"])
        return cls(deck, Path(os.path.normpath(here / note["out_from_here"])), note["solver"])
