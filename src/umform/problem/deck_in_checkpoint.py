"""Deck and folders in a checkpoint, so that the checkpoint alone suffices to resume a run."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from umform.analysis.run.checkpoint import CHECKPOINT_KIND, read_note
from umform.errors import FileProblem
from umform.problem.problem import Problem


@dataclass(frozen=True)
class Kept:
    """A run of a deck with the options of the command line.

    Attributes
    ----------
    deck : Problem
        The deck, with its changes.
    out : Path
        Folder of the results.
    solver : str or None
        Another sparse solver than that of the deck.
    budget : bool
        Whether the run ends with an error budget.
    """

    deck: Problem
    out: Path
    solver: str | None = None
    budget: bool = False

    @property
    def chosen_solver(self) -> str:
        """The solver of the run."""
        return self.solver or self.deck.contents.solution.solver

    def note(self, checkpoint: Path) -> dict[str, Any]:
        """Note for a checkpoint; folders also relative to it, in case all of them are moved."""
        source, here = self.deck.source, checkpoint.parent
        return {
            "deck": source.written,
            "name": source.name,
            "changes": dict(source.changes),
            "folder": str(source.folder.resolve()),
            "folder_from_here": os.path.relpath(source.folder, here),
            "out_from_here": os.path.relpath(self.out, here),
            "solver": self.solver,
            "budget": self.budget,
        }

    @classmethod
    def read(cls, checkpoint: Path, trust: bool = False, kind: str = CHECKPOINT_KIND) -> Kept:
        """Content of the note of a checkpoint, or of a state; its deck may name classes of Python if it is trusted.

        Raises
        ------
        FileProblem
            If it cannot be read, is no checkpoint, or was not written by a run of a deck.
        DeckError
            If the deck in it is no longer valid.
        """
        note = read_note(checkpoint, kind)
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
        deck = Problem.read(note["deck"], note["name"], folder, note["changes"], trust)
        out = Path(os.path.normpath(here / note["out_from_here"]))
        return cls(deck, out, note["solver"], note.get("budget", False))
