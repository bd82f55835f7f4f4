"""Tools of decks from files: STL, STEP, DXF; offsets; what is said of files that do not do."""

from __future__ import annotations

import numpy as np
import pytest

from umform.problem import Problem
from umform.problem.check import check
from umform.problem.errors import DeckError
from umform.surfaces import Sphere, UDie, write_tool


@pytest.fixture
def ball(tmp_path):
    """A ball of radius 3 below the sheet."""
    write_tool(Sphere((5, 1, -3.05), 3.0), tmp_path / "ball.stl", ((0, -5, -9), (9, 6, 5)), chord=0.02)
    return tmp_path


def read(strip, folder, keys, shape="Drawing"):
    return Problem.read(f'{strip}[tools.it]\nshape = "{shape}"\n{keys}\n', folder=folder)


def test_stl(strip, ball, rng):
    x = rng.uniform((1, -3, -6), (9, 5, 3), (50, 3))
    for keys, true in (
        ("", Sphere((5, 1, -3.05), 3.0)),
        ("offset = 0.5", Sphere((5, 1, -3.05), 3.5)),
        ("offset = 0.5\nother_side = true", Sphere((5, 1, -3.05), 3.5, inside=True)),
        ("translation = [1, 2, 3]", Sphere((6, 3, -0.05), 3.0)),
    ):
        tool = read(strip, ball, f'file = "ball.stl"\n{keys}').build().tools["it"]
        assert np.abs(tool.gap(x)[0] - true.gap(x)[0]).max() < 5e-4


def test_a_check_sees_the_radius_of_a_drawing(strip, ball):
    contact = '[contacts.it]\ntool = "it"\nfaces = "lower"\npenalty = 100.0\n'
    deck = read(strip, ball, f'file = "ball.stl"\n{contact}')
    found = [row for row in check(deck, deck.build()) if row.about == "contact it"]
    said = [row.text for row in check(deck, deck.build()) if row.about == "tool it"]
    assert any("ball.stl" in text and "0 sharp edges" in text for text in said)
    assert any("of the radius 2." in row.text or "of the radius 3" in row.text for row in found)


def test_an_edge_is_warned_of(strip, tmp_path):
    from umform.surfaces import Box

    write_tool(Box((5, 1, -3.1), (4, 4, 6)), tmp_path / "box.stl", ((0, -5, -9), (9, 6, 5)))
    contact = '[contacts.it]\ntool = "it"\nfaces = "lower"\npenalty = 100.0\n'
    deck = read(strip, tmp_path, f'file = "box.stl"\n{contact}')
    assert any("sharp edge" in row.text for row in check(deck, deck.build()))


@pytest.mark.parametrize(
    "key", ['profile = "section.dxf"', 'profile = { file = "section.dxf", layer = "0", solid = "below" }']
)
def test_dxf(strip, tmp_path, key, rng):
    ezdxf = pytest.importorskip("ezdxf")
    doc = ezdxf.new(units=4)
    for segment in UDie(20, 18, 0, 0).profile.segments:
        doc.modelspace().add_line(segment.start, segment.end)
    doc.saveas(tmp_path / "section.dxf")
    x = rng.uniform((-28, -3, -30), (28, 3, 10), (50, 3))
    tool = read(strip, tmp_path, key, "Extruded").build().tools["it"]
    assert np.abs(tool.gap(x)[0] - UDie(20, 18, 0, 0).gap(x)[0]).max() < 1e-12


def test_files_that_do_not_do(strip, tmp_path):
    with pytest.raises(DeckError, match=r"there is no such file(.*\n)*.*nothing.stl"):
        read(strip, tmp_path, 'file = "nothing.stl"').build()
    with pytest.raises(DeckError) as broken:
        read(strip, tmp_path, r'profile = "no\nthing"', "Extruded")
    assert broken.value.errors[0].where.endswith("no thing)")  # one line
    with pytest.raises(DeckError, match="a STEP or an IGES file"):
        read(strip, tmp_path, 'file = "die.dwg"').build()
    with pytest.raises(DeckError, match="corners, segments or file"):
        read(strip, tmp_path, "profile = { layer = '0' }", "Revolved")
    with pytest.raises(DeckError, match=r"have no free forms(.*\n)*.*tools.it.tolerance"):
        read(strip, tmp_path, 'file = "ball.stl"\ntolerance = 0.01')
    (tmp_path / "empty.stl").write_text("solid nothing\nendsolid nothing\n")
    with pytest.raises(DeckError, match=r"no triangle|no STL file"):
        read(strip, tmp_path, 'file = "empty.stl"').build()
