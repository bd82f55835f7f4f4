import pytest

from umform.problem import DeckError, Problem
from umform.problem.check import check
from umform.problem.templates import template


@pytest.fixture
def errors():
    """All that is wrong with a text, as read or as built."""

    def found(text, **options):
        with pytest.raises(DeckError) as caught:
            Problem.read(text, "deck.toml", **options).build()
        return caught.value.errors

    return found


@pytest.fixture
def texts():
    """The template of a name."""
    return template


@pytest.fixture
def found():
    """Findings of a text about something."""

    def checked(text, about, **changes):
        deck = Problem.read(text, changes={key.replace("__", "."): value for key, value in changes.items()})
        return [finding for finding in check(deck, deck.build()) if finding.about == about]

    return checked
