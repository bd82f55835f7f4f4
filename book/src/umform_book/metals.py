"""Metals of several chapters; constants with their sources."""

from __future__ import annotations

from typing import Any

from umform.materials import (
    Chaboche,
    FallingModulus,
    Hill48,
    Hosford,
    LinearVoce,
    Metal,
    Mises,
    Perfect,
    Swift,
    Transformation,
    Voce,
    YieldFunction,
    Yld91,
    Yld2004,
    YoshidaUemori,
)

#: Barlat et al. (2005), table 2, whose shears c44, c55, c66 are 23, 13, 12.
AA2090 = Yld2004(
    Transformation(-0.069888, 0.936408, 0.079143, 1.003060, 0.524741, 1.363180, 0.954322, 1.023770, 1.069060),
    Transformation(0.981171, 0.476741, 0.575316, 0.866827, 1.145010, -0.079294, 1.404620, 1.051660, 1.147100),
)
AA6111 = Yld2004(
    Transformation(1.241024, 1.078271, 1.216463, 1.223867, 1.093105, 0.889161, 1.349094, 0.501909, 0.557173),
    Transformation(0.775366, 0.922743, 0.765487, 0.793356, 0.918689, 1.027625, 0.589787, 1.115833, 1.112273),
)
#: r-values of the mild steel of NUMISHEET 93.
MILD = Hill48(r0=1.79, r45=1.51, r90=2.27)
YIELD_FUNCTIONS: dict[str, YieldFunction] = {
    "Mises": Mises(),
    "Hill48, mild steel": MILD,
    "Hosford, a = 8": Hosford(8),
    "Yld91": Yld91(1.05, 0.97, 1.1, 1.0, 0.9, 1.08),
    "Yld2004, AA2090-T3": AA2090,
    "Yld2004, AA6111-T4": AA6111,
}

#: SPCC of Yoshida and Uemori (2002), table 1.
SPCC = YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)
SPCC_YIELD = Perfect(124.0)
SPCC_MODULUS = FallingModulus(saturated=152e3, rate=30.8)
STEEL: dict[str, Any] = {"E": 206e3, "nu": 0.3}

#: The same steel with each kind of hardening: isotropic as its tension curve of Yoshida-Uemori to 12 %, Chaboche as a
#: cycle of it between -3 and 3 % and on to 6 %, both by least squares.
HARDENING = {
    "isotropic": Metal(**STEEL, hardening=LinearVoce(141.6, 764.0, 229.2, 35.6)),
    "Chaboche": Metal(
        **STEEL, hardening=Voce(98.0, 228.0, 10.3), back_stress=Chaboche(((24200.0, 314.0), (172.5, 6.55)))
    ),
    "Yoshida-Uemori": Metal(**STEEL, hardening=SPCC_YIELD, back_stress=SPCC),
    "Yoshida-Uemori, falling modulus": Metal(**STEEL, hardening=SPCC_YIELD, back_stress=SPCC, modulus=SPCC_MODULUS),
}
#: Laws that are tried in elements: each yield function and each kind of hardening once.
CARDS = {
    **{
        name: Metal(**STEEL, hardening=Swift(500.0, 0.004, 0.21), yield_function=f)
        for name, f in YIELD_FUNCTIONS.items()
    },
    **HARDENING,
    "AA2090-T3 with Chaboche": Metal(
        E=70e3,
        nu=0.33,
        hardening=Voce(279.0, 400.0, 12.0),
        yield_function=AA2090,
        back_stress=Chaboche(((9000.0, 120.0), (800.0, 8.0))),
    ),
    "Hill48 with Yoshida-Uemori, falling modulus": Metal(
        **STEEL, hardening=SPCC_YIELD, yield_function=MILD, back_stress=SPCC, modulus=SPCC_MODULUS
    ),
}
