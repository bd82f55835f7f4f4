"""Metals in decks: yield functions, back stresses, a falling modulus, the rolling direction; and what is refused."""

from __future__ import annotations

import pytest

from umform import materials as mt
from umform.problem import Problem
from umform.problem.errors import DeckError
from umform.problem.templates import template

HEAD = 'law = "Metal"\nE = 210e3\nnu = 0.3\nhardening = { curve = "Perfect", yield_stress = 160.0 }\n'
FUNCTIONS = {
    'function = "Mises"': mt.Mises(),
    'function = "Hill48", r0 = 1.8, r45 = 1.5, r90 = 2.2': mt.Hill48(1.8, 1.5, 2.2),
    'function = "Hill48", s0 = 1.0, s45 = 1.04, s90 = 0.97, biaxial = 1.05': mt.Hill48.from_stresses(
        1.0, 1.04, 0.97, 1.05
    ),
    'function = "Hosford", exponent = 6': mt.Hosford(6),
    'function = "Yld91", a = 1.1, b = 0.9, c = 1.0, h = 1.05': mt.Yld91(1.1, 0.9, 1.0, h=1.05),
    'function = "Yld2004", first = { c12 = 0.5 }, second = { shear12 = 1.4 }': mt.Yld2004(
        mt.Transformation(c12=0.5), mt.Transformation(shear12=1.4)
    ),
}


def deck(more):
    text = template("free-bending")
    begin, end = text.index("[material]"), text.index("\n[", text.index("[material]"))
    return Problem.read(f"{text[:begin]}[material]\n{HEAD}{more}\n{text[end:]}")


@pytest.mark.parametrize("words", FUNCTIONS)
def test_yield_functions(words):
    model = deck(f'rolling = "y"\nyield_function = {{ {words} }}').build().model
    assert model.bodies.only.material == mt.Metal(
        210e3, 0.3, hardening=mt.Perfect(160.0), yield_function=FUNCTIONS[words]
    )
    assert model.bodies.only.rolling.tolist() == [0.0, 1.0, 0.0]
    assert model.bodies.only.block.history_variables == {"plastic_strain": 6, "eqps": 1}


def test_all_parts():
    more = (
        "back_stress = { parts = [[3000.0, 30.0], [500.0, 0.0]], first = 0.5, rate = 6.0 }\n"
        "modulus = { saturated = 180e3, rate = 30.0 }"
    )
    metal = deck(more).build().model.bodies.only.material
    assert metal.back_stress == mt.Chaboche([(3000.0, 30.0), (500.0, 0.0)], first=0.5, rate=6.0)
    assert metal.modulus == mt.FallingModulus(180e3, 30.0)
    assert metal.yield_function == mt.Mises()


def test_two_surfaces():
    metal = (
        deck("two_surfaces = { C = 500.0, B = 268.0, growth = 190.0, b = 9.0, m = 12.0, h = 0.5 }")
        .build()
        .model.bodies.only.material
    )
    assert metal.back_stress == mt.YoshidaUemori(C=500.0, B=268.0, growth=190.0, b=9.0, m=12.0, h=0.5)


@pytest.mark.parametrize(
    ("more", "text"),
    [
        ('yield_function = { function = "Hill48", r0 = 1.8, r45 = 1.5, r90 = 2.2 }', "needs rolling"),
        ('rolling = "x"\nyield_function = { function = "Hill48", r0 = -1.8, r45 = 1.5, r90 = 2.2 }', "greater than 0"),
        ('rolling = "x"\nyield_function = { function = "Hill48", r0 = 1.8, r45 = 1.5 }', "r0, r45 and r90"),
        (
            'rolling = "x"\nyield_function = { function = "Hill48", s0 = 1.0, s45 = 2.5, s90 = 1.0, biaxial = 1.0 }',
            "not convex",
        ),
        ('yield_function = { function = "Hosford", exponent = 1.5 }', "greater than or equal to 2"),
        ("back_stress = { parts = [[-3000.0, 30.0]] }", "C must be positive"),
        ("back_stress = { parts = [] }", "at least 1"),
        ("two_surfaces = { C = 500.0, B = 68.0, growth = 190.0, b = 9.0, m = 12.0, h = 0.5 }", "larger than the yield"),
        (
            "two_surfaces = { C = 500.0, B = 268.0, growth = 190.0, b = 9.0, m = 12.0, h = 5 }",
            "less than or equal to 1",
        ),
        ("modulus = { saturated = 180.0e4, rate = 30.0 }", "must fall"),
        ("modulus = { saturated = 180.0, rate = -30.0 }", "greater than 0"),
    ],
)
def test_mistakes(more, text):
    with pytest.raises(DeckError) as error:
        deck(more).build()
    assert text in str(error.value)


def test_moduli_in_two_units_are_found():
    """152 GPa beside 210e3 MPa: a modulus does not fall to less than a third."""
    with pytest.raises(DeckError) as error:
        deck("modulus = { saturated = 152.0, rate = 30.0 }").build()
    assert "GPa" in str(error.value)
