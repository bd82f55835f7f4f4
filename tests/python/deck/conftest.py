import pytest

from umform.deck import Deck, DeckError
from umform.deck.check import check
from umform.deck.templates import template

STRIP = """
[mesh]
generator = "strip"
length = 10.0
width = 2.0
thickness = 1.0
cells = [4, 2]
[material]
law = "SVK"
E = 210e3
nu = 0.3
[[supports]]
kind = "fix"
nodes = "x0"
[controls.pull]
kind = "displacement"
nodes = "x1"
direction = "x"
[[steps]]
kind = "move"
to = { pull = 0.1 }
increments = 2
"""


@pytest.fixture
def strip():
    """A small deck that solves in no time."""
    return STRIP


@pytest.fixture
def errors():
    """All that is wrong with a text, as read or as built."""

    def found(text, **options):
        with pytest.raises(DeckError) as caught:
            Deck.read(text, "deck.toml", **options).build()
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
        deck = Deck.read(text, changes={key.replace("__", "."): value for key, value in changes.items()})
        return [finding for finding in check(deck, deck.build()) if finding.about == about]

    return checked
