"""All laws: a strip that is pulled into plastic flow, unloaded and pressed, across its rolling direction."""

from __future__ import annotations

from typing import Any

import umform as uf
from umform.spec import changed, scalars
from umform_book.derivatives.differences import Example

STEEL = {"E": 206e3, "nu": 0.3}
VOCE = uf.Voce(130.0, 300.0, 12.0)
#: Barlat et al. (2005), table 2, for 2090-T3.
YLD2004 = uf.Yld2004(
    uf.Transformation(-0.069888, 0.936408, 0.079143, 1.003060, 0.524741, 1.363180, 0.954322, 1.023770, 1.069060),
    uf.Transformation(0.981171, 0.476741, 0.575316, 0.866827, 1.145010, -0.079294, 1.404620, 1.051660, 1.147100),
)
#: Yoshida and Uemori (2002), table 1.
SURFACES = uf.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)
HILL = uf.Hill48(1.8, 1.5, 2.2)


def _metal(**parts: Any) -> uf.Metal:
    return uf.Metal(**{**STEEL, "hardening": VOCE, **parts})


LAWS: dict[str, Any] = {
    "SVK": uf.SVK(**STEEL),
    "NeoHooke": uf.NeoHooke(**STEEL),
    "NeoHookePower": uf.NeoHookePower(**STEEL),
    "J2, Perfect": uf.J2(**STEEL, hardening=uf.Perfect(160.0)),
    "J2, Linear": uf.J2(**STEEL, hardening=uf.Linear(160.0, 500.0)),
    "J2, LinearVoce": uf.J2(**STEEL, hardening=uf.LinearVoce(160.0, 500.0, 260.0, 20.0)),
    "J2, Swift": uf.J2(**STEEL, hardening=uf.Swift(500.0, 0.004, 0.21)),
    "J2, Table": uf.J2(**STEEL, hardening=uf.Table((0.0, 0.01, 0.1, 0.5), (160.0, 220.0, 250.0, 400.0))),
    "Metal, Mises": _metal(),
    "Metal, Hill48, Chaboche, FallingModulus": _metal(
        yield_function=HILL,
        back_stress=uf.Chaboche(((9000.0, 120.0), (800.0, 8.0)), first=1.2, rate=5.0),
        modulus=uf.FallingModulus(saturated=150e3, rate=40.0),
    ),
    "Metal, Yld2004": _metal(yield_function=YLD2004),
    "Metal, Hosford": _metal(yield_function=uf.Hosford(6)),
    "Metal, Yld91": _metal(yield_function=uf.Yld91(1.05, 0.97, 1.1, 1.0, 0.9, 1.08)),
    "Metal, YoshidaUemori": _metal(hardening=uf.Perfect(124.0), yield_function=HILL, back_stress=SURFACES),
    "Metal, CowperSymonds": _metal(rate=uf.CowperSymonds(40.0, 5.0)),
    "Metal, JohnsonCook": _metal(rate=uf.JohnsonCook(0.02, 2e-3)),
}


def example(law: Any) -> Example:
    """One element with all constants of a law but whole numbers and the strain 0 at which a table starts."""

    def build(**values: float) -> tuple[uf.Model, list[uf.Move]]:
        mesh = uf.mesh.strip(1.0, 0.5, 0.4, (1, 1))
        model = uf.Model(mesh, "EAS3DEAS", material=changed(law, values), rolling=(1.0, 0.4, 0.0))
        for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
            model.symmetry(face, normal=normal)
        pull, side = model.prescribe("x1", "x", "pull"), model.prescribe("y1", "y", "side")
        steps = [uf.Move([pull, side], [0.02, -0.004], 5), uf.Move(pull, 0.017, 3), uf.Move(pull, -0.005, 6)]
        return model, steps

    values = {one.path: one.value for one in scalars(law) if not isinstance(one.value, int)}
    values.pop("hardening.eqps.0", None)
    return Example(build, values, ("pull_force", "side_force", "plastic_work"))
