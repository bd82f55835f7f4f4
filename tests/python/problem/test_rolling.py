"""The rolling direction in a deck: a way, a vector, an angle, a file; cards of the library by name."""

from __future__ import annotations

import numpy as np
import pytest

from umform.elements import rolling_at
from umform.problem import load
from umform.problem.errors import DeckError
from umform.sheet_metals import get

DECK = """
[mesh]
generator = "strip"
length = 4.0
width = 2.0
thickness = 0.5
cells = [2, 1]

[material]
library = "AA6016-T4"
{rolling}

[[supports]]
kind = "fix"
nodes = "x0"
directions = "xyz"

[controls.end]
kind = "displacement"
nodes = "x1"
direction = "x"

[[steps]]
kind = "move"
to = {{ end = 0.1 }}
increments = 1
"""


def body(rolling, folder):
    path = folder / "deck.toml"
    path.write_text(DECK.format(rolling=rolling))
    return load(path).build().model.bodies.only


@pytest.mark.parametrize(
    ("rolling", "expected"),
    [
        ('rolling = "y"', (0.0, 1.0, 0.0)),
        ("rolling = [3.0, 4.0, 0.0]", (0.6, 0.8, 0.0)),
        ("rolling = { angle = 30.0 }", rolling_at(30.0)),
        ('rolling = { angle = 90.0, line = "x" }', (0.0, 1.0, 0.0)),
        ('rolling = { file = "cells.csv" }', ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))),
    ],
)
def test_all_ways_to_say_it(rolling, expected, tmp_path):
    (tmp_path / "cells.csv").write_text("2,0,0\n0,1,0\n")
    found = body(rolling, tmp_path)
    assert found.rolling == pytest.approx(np.array(expected))
    assert found.material == get("AA6016-T4").law


@pytest.mark.parametrize(
    ("rolling", "message"),
    [
        ("", "needs rolling"),
        ('rolling = "w"', "rolling"),
        ("rolling = { angel = 30.0 }", "angle"),
        ("rolling = [0.0, 0.0, 0.0]", "zero vector"),
        ('rolling = { angle = 30.0, line = "z" }', "along the normal"),
        ('rolling = { file = "none.csv" }', "cannot be read"),
        ('rolling = { file = "words.csv" }', "are not numbers"),
        ('rolling = { file = "two.csv" }', "three numbers"),
        ('rolling = { file = "one.csv" }', "one for each cell"),
        ('rolling = { file = "empty.csv" }', "three numbers"),
    ],
)
def test_what_is_refused(rolling, message, tmp_path):
    for name, text in (("words", "a,b,c\n"), ("two", "1,2\n"), ("one", "1,0,0\n"), ("empty", "")):
        (tmp_path / f"{name}.csv").write_text(text)
    with pytest.raises(DeckError, match=message):
        body(rolling, tmp_path)
