import pytest

import umform as uf
from umform.report.materials import material_text

STEEL = {"E": 210e3, "nu": 0.3}


@pytest.mark.parametrize(
    ("material", "text"),
    [
        (uf.SVK(**STEEL), "SVK: E = 210000, nu = 0.3"),
        (uf.NeoHooke(kappa=175e3, mu=80.77e3), "NeoHooke: E = 210002, nu = 0.299998"),
        (uf.J2(**STEEL, hardening=uf.Perfect(160.0)), "J2: E = 210000, nu = 0.3, yield stress 160, perfectly plastic"),
        (
            uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0)),
            "J2: E = 210000, nu = 0.3, yield stress 160, linear hardening 500",
        ),
        (
            uf.J2(**STEEL, hardening=uf.Voce(160.0, 320.0, 12.5)),
            "J2: E = 210000, nu = 0.3, yield stress 160, saturation 320 at the rate 12.5",
        ),
        (
            uf.J2(**STEEL, hardening=uf.Swift(520.0, 0.004, 0.22)),
            "J2: E = 210000, nu = 0.3, yield stress 154.332 (start of the curve), Swift hardening 520 (0.004 + e)^0.22",
        ),
        (
            uf.J2(**STEEL, hardening=uf.Table((0.0, 0.1, 0.2), (200.0, 300.0, 1000.0 / 3))),
            "J2: E = 210000, nu = 0.3, yield stress 200 (start of the curve), "
            "table of 3 points up to 333.333 at a plastic strain of 0.2",
        ),
        (
            uf.Metal(
                **STEEL,
                hardening=uf.Perfect(160.0),
                back_stress=uf.Chaboche([(3000.0, 100.0 / 3)]),
                modulus=uf.FallingModulus(180e3, 30.0),
            ),
            "Metal: E = 210000, nu = 0.3, yield stress 160, perfectly plastic, Mises, "
            "Chaboche(parts = ((3000, 33.3333)), first = 1, rate = 0), FallingModulus(saturated = 180000, rate = 30)",
        ),
        (uf.UserLaw(lambda E, state: (E, E, state), name="stiffening"), "user law: stiffening"),
    ],
)
def test_a_material_in_words(material, text):
    assert material_text(material) == text


def test_the_yield_stress_of_swift_is_that_of_the_curve():
    curve = uf.Swift(520.0, 0.004, 0.22)
    assert f"yield stress {curve.curve()(0.0)[0]:.6g}" in material_text(uf.J2(**STEEL, hardening=curve))
