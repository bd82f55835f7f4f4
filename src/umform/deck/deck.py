"""A deck: one TOML file that describes a problem."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from umform.deck.contents import Contents
from umform.deck.errors import DeckError, DeckKey
from umform.deck.messages import messages
from umform.deck.problem import Problem, build
from umform.deck.references import unknown_names
from umform.deck.source import Source, parse, read_file


@dataclass(frozen=True)
class Deck:
    """A deck that was read and found right in its keys, types and names.

    Attributes
    ----------
    contents : Contents
        What stands in it.
    source : Source
        Its text, and where in it each key stands.
    """

    contents: Contents
    source: Source

    @classmethod
    def read(
        cls,
        text: str,
        name: str = "deck",
        folder: str | Path = ".",
        changes: Mapping[str, Any] | None = None,
    ) -> Deck:
        """Read a deck from its text.

        Parameters
        ----------
        text : str
            TOML.
        name : str
            For messages.
        folder : str or Path
            Where files that it names are looked for.
        changes : mapping of str to object, optional
            Other values of some keys: ``{"steps.0.increments": 3}``.

        Raises
        ------
        DeckError
            With all that is wrong with it.
        """
        source = parse(text, name, Path(folder), changes)
        errors: list[DeckKey] = []
        contents = None
        try:
            contents = Contents.model_validate(source.data)
        except ValidationError as error:
            errors += messages(error, source)
        errors += unknown_names(source)
        if errors or contents is None:
            raise DeckError(errors)
        return cls(contents, source)

    def build(self, solver: str | None = None) -> Problem:
        """Build the model and all that happens to it.

        Parameters
        ----------
        solver : str, optional
            Another sparse solver than that of the deck.

        Raises
        ------
        DeckError
            With all that does not fit.
        """
        return build(self.contents, self.source, solver)


def load(path: str | Path, changes: Mapping[str, Any] | None = None) -> Deck:
    """Read a deck from a file.

    Parameters
    ----------
    path : str or Path
        The file.
    changes : mapping of str to object, optional
        Other values of some keys: ``{"steps.0.increments": 3}``.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    DeckError
        With all that is wrong with the deck.

    Examples
    --------
    >>> from umform.deck import load
    >>> result = load("deck.toml").build().solve()  # doctest: +SKIP
    """
    path = Path(path)
    return Deck.read(read_file(path), path.name, path.parent, changes)
