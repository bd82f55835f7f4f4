"""What a deck writes for a law is read again as the same law, to the last bit."""

from dataclasses import dataclass, replace

import pytest
from pydantic import TypeAdapter

import umform as uf
from umform.errors import InvalidValue
from umform.problem.deck_text import toml
from umform.problem.keys import law_keys
from umform.problem.material import MaterialPart
from umform.problem.tagged import deck_type
from umform.spec import changed, scalars

SWIFT = uf.Swift(520.0, 0.004, 0.22)
CURVES = [
    uf.Perfect(200.0),
    uf.Linear(200.0, 1000.0),
    uf.Voce(100.0, 200.0, 9.0),
    uf.LinearVoce(180.0, 10.0, 240.0, 12.0),
    SWIFT,
    uf.Table((0.0, 0.1), (200.0, 300.0)),
]
FUNCTIONS = [
    uf.Mises(),
    uf.Hill48(1.8, 1.4, 2.1),
    uf.Hill48.from_stresses(1.0, 0.95, 0.98, 0.96),
    uf.Hill48.from_constants(0.4, 0.5, 0.5, 1.4, L=1.3),
    uf.Hosford(6.0),
    uf.Yld91(1.0, 0.95, 1.05, h=0.9),
    uf.Yld2004(uf.Transformation(c12=0.9), uf.Transformation(), 7),
]
LAWS = [
    uf.SVK(210e3, 0.3),
    uf.NeoHooke(kappa=171e3, mu=79.1e3),
    uf.NeoHookePower(3.0, 0.45),
    *(uf.J2(206e3, 0.3, hardening=curve) for curve in CURVES),
    *(uf.Metal(70e3, 1.0 / 3.0, hardening=SWIFT, yield_function=function) for function in FUNCTIONS),
    uf.Metal(206e3, 0.3, hardening=SWIFT, back_stress=uf.Chaboche([(4e3, 80.0), (6e2, 0.0)], first=1.2, rate=3.0)),
    uf.Metal(
        206e3,
        0.3,
        hardening=uf.Perfect(124.0),
        back_stress=uf.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5),
        modulus=uf.FallingModulus(160e3, 30.0),
    ),
    uf.Metal(206e3, 0.3, hardening=SWIFT, rate=uf.JohnsonCook(0.01, 0.02)),
    *(uf.sheet_metals.get(name).law for name in uf.sheet_metals.names()[::5]),
]


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_a_law_comes_back_from_its_keys(law):
    again = TypeAdapter(deck_type(MaterialPart)).validate_python(law_keys(law, "x")).law
    assert type(again) is type(law) and again == law
    assert (again.E, again.nu) == (law.E, law.nu)


def test_defaults_are_left_out():
    metal = uf.Metal(206e3, 0.3, hardening=SWIFT, back_stress=uf.Chaboche([(4e3, 80.0)]))
    curve = {"curve": "Swift", "strength": 520.0, "offset": 0.004, "exponent": 0.22}
    back = {"parts": ((4e3, 80.0),)}
    assert law_keys(metal) == {"law": "Metal", "E": 206e3, "nu": 0.3, "hardening": curve, "back_stress": back}


def test_an_object_without_words_is_refused_where_text_is_wanted():
    @dataclass(frozen=True)
    class Local:
        def curve(self):
            return SWIFT.curve()

    keys = law_keys(uf.J2(206e3, 0.3, hardening=Local()))
    assert keys["hardening"] == Local()
    with pytest.raises(InvalidValue, match="no words"):
        toml(keys)


def test_a_constant_of_a_law_is_changed_by_its_path():
    law = uf.J2(206e3, 0.3, hardening=SWIFT)
    assert [one.path for one in scalars(law)] == [
        *("E", "nu"),
        *("hardening.strength", "hardening.offset", "hardening.exponent"),
    ]
    assert changed(law, {"E": 2e5}) == uf.J2(2e5, 0.3, hardening=SWIFT)
    assert changed(law, {"hardening.strength": 500.0}).hardening == uf.Swift(500.0, 0.004, 0.22)
    assert replace(law, hardening=CURVES[0]) == uf.J2(206e3, 0.3, hardening=CURVES[0])
