"""Metals in decks: what is built of them, and what is refused, with the line and a remedy."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

import umform as uf
from umform import cli
from umform.problem import Problem
from umform.problem.check import check
from umform.problem.errors import DeckError

DECK = """
[mesh]
generator = "strip"
length = 4.0
width = 2.0
thickness = 1.0
cells = [4, 1]

[material]
law = "Metal"
E = 206e3
nu = 0.3
hardening = { curve = "Voce", yield_stress = 180.0, saturation = 330.0, rate = 14.0 }
yield_function = { function = "Hill48", r0 = 1.79, r45 = 1.51, r90 = 2.27 }
rolling = "x"
back_stress = { parts = [[4000.0, 80.0], [600.0, 6.0]] }
modulus = { saturated = 160e3, rate = 30.0 }
rate = { factor = "CowperSymonds", reference = 40.0, exponent = 5.0 }

[[supports]]
kind = "fix"
nodes = "x0"

[controls.tip]
kind = "displacement"
nodes = "x1"
direction = "z"

[[steps]]
kind = "move"
to = { tip = 0.1 }
increments = 1
time = 0.25

[[steps]]
kind = "release"
control = "tip"
time = 2.0
"""
R_VALUES = "r0 = 1.79, r45 = 1.51, r90 = 2.27"
HILL = f'yield_function = {{ function = "Hill48", {R_VALUES} }}'
STRESSES = "s0 = 1.0, s45 = 1.0, s90 = 1.9, biaxial = 2.4"
MODULUS = "modulus = { saturated = 160e3, rate = 30.0 }"
RATE = 'rate = { factor = "CowperSymonds", reference = 40.0, exponent = 5.0 }'
SURFACES = "two_surfaces = { C = 500.0, B = 168.0, growth = 190.0, b = 9.0, m = 12.0, h = 0.5 }"
BACK = "back_stress = { parts = [[4000.0, 80.0], [600.0, 6.0]] }"


def test_all_parts_are_built():
    problem = Problem.read(DECK, "deck.toml").build()
    assert problem.model.bodies.only.material == uf.Metal(
        206e3,
        0.3,
        hardening=uf.Voce(180.0, 330.0, 14.0),
        yield_function=uf.Hill48(1.79, 1.51, 2.27),
        back_stress=uf.Chaboche([(4000.0, 80.0), (600.0, 6.0)]),
        modulus=uf.FallingModulus(160e3, 30.0),
        rate=uf.CowperSymonds(40.0, 5.0),
    )
    assert [step.time for step in problem.steps] == [0.25, 2.0]


@pytest.mark.parametrize(
    ("changes", "where", "text"),
    [
        ({"r0 = 1.79": "r0 = -0.5"}, "yield_function.r0", "greater than 0"),
        ({R_VALUES: STRESSES}, "Hill48", "not convex"),
        ({"[4000.0, 80.0]": "[-4000.0, 80.0]"}, "back stress 1", "C must be positive"),
        ({"[600.0, 6.0]": "[600.0, -6.0]"}, "back stress 2", "gamma not negative"),
        ({"saturated = 160e3": "saturated = 160.0"}, "material", "one of them in GPa"),
        ({"E = 206e3": "E = 206.0"}, "material", "GPa"),
        ({"E = 206e3": "E = 206.0", MODULUS: ""}, "material", "E in GPa and the yield stress in MPa"),
        ({RATE: RATE.replace("40.0", "-40.0")}, "rate.reference", "greater than 0"),
        ({RATE: RATE.replace("5.0", "0.2")}, "rate.exponent", "greater than or equal to 1"),
        ({BACK: SURFACES}, "material", "constant size"),
        ({BACK: f"{BACK}\n{SURFACES}"}, "material (two_surfaces)", "give back_stress or two_surfaces, not both"),
        ({'rolling = "x"': ""}, "material", "rolling"),
        ({'rolling = "x"': 'rolling = "z"'}, "material.rolling", "stands on the sheet"),
        ({'rolling = "x"': 'rolling = "q"'}, "material.rolling", "x, y, z, -x, -y or -z"),
        (
            {HILL: 'yield_function = { function = "Yld91", a = -1.0, b = 1.0, c = 1.0 }'},
            "yield_function.a",
            "greater than 0",
        ),
        ({BACK: f"back_stress = {{ parts = [{', '.join(['[1.0, 1.0]'] * 5)}] }}"}, "parts", "an entry too many"),
        ({"time = 0.25": "time = 0.0"}, "steps[0].time", "greater than 0"),
    ],
)
def test_what_is_refused(changes, where, text):
    deck = DECK
    for old, new in changes.items():
        assert old in deck
        deck = deck.replace(old, new)
    with pytest.raises(DeckError) as refusal:
        Problem.read(deck, "deck.toml").build()
    message = str(refusal.value)
    assert "deck.toml, line" in message
    assert "remedy:" in message
    assert where in message
    assert text in message


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        (R_VALUES, STRESSES, "not convex"),
        ("r0 = 1.79", "r0 = -0.5", "greater than 0"),
        (R_VALUES, "F = 0.5, G = 0.5, H = -0.1, N = 1.5", "r-value at 0 degrees"),
        ("[4000.0, 80.0]", "[-4000.0, 80.0]", "C must be positive"),
        ("saturated = 160e3", "saturated = 160.0", "GPa"),
    ],
)
def test_the_command_check_finds_them(old, new, text, tmp_path):
    """A yield function that is not convex, r below 0, a back stress of the wrong sign, a modulus in GPa."""
    assert old in DECK
    path = tmp_path / "deck.toml"
    path.write_text(DECK)
    assert CliRunner().invoke(cli.app, ["check", str(path)]).exit_code == 0
    path.write_text(DECK.replace(old, new))
    found = CliRunner().invoke(cli.app, ["check", str(path)])
    assert found.exit_code == 1
    assert text in " ".join(found.output.split())


def test_r_values_are_checked_over_the_angle():
    deck = Problem.read(DECK)
    (good,) = [finding for finding in check(deck, deck.build()) if finding.about == "material"]
    assert good.text == "r-values from 1.51 to 2.27"
