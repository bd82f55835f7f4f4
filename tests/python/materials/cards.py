"""Laws, hardening curves and metals of the tests, and tensors."""

from __future__ import annotations

import numpy as np

from umform import materials as mt
from umform.history_variables import named

KAPPA, MU = 175e3, 80.77e3
ELASTIC = {
    "svk": mt.SVK(kappa=KAPPA, mu=MU),
    "neo-hooke": mt.NeoHooke(kappa=KAPPA, mu=MU),
    "neo-hooke-power": mt.NeoHookePower(kappa=KAPPA, mu=MU),
}
HARDENING = {
    "perfect": mt.Perfect(160.0),
    "linear": mt.Linear(160.0, 500.0),
    "voce": mt.Voce(160.0, 320.0, 15.0),
    "linear-voce": mt.LinearVoce(160.0, 300.0, 250.0, 40.0),
    "swift": mt.Swift(500.0, 0.004, 0.21),
    "table": mt.Table((0.0, 0.02, 0.1, 0.5), (160.0, 220.0, 220.0, 400.0)),
}
STEEL = {"E": 210e3, "nu": 0.3}
ALUMINIUM = {"E": 70e3, "nu": 0.33}
PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]
SHEAR = np.array([1, 1, 1, 2, 2, 2])

#: Barlat et al. (2005), table 2, whose shears c44, c55, c66 are 23, 13, 12.
AA2090 = mt.Yld2004(
    mt.Transformation(-0.069888, 0.936408, 0.079143, 1.003060, 0.524741, 1.363180, 0.954322, 1.023770, 1.069060),
    mt.Transformation(0.981171, 0.476741, 0.575316, 0.866827, 1.145010, -0.079294, 1.404620, 1.051660, 1.147100),
)
AA6111 = mt.Yld2004(
    mt.Transformation(1.241024, 1.078271, 1.216463, 1.223867, 1.093105, 0.889161, 1.349094, 0.501909, 0.557173),
    mt.Transformation(0.775366, 0.922743, 0.765487, 0.793356, 0.918689, 1.027625, 0.589787, 1.115833, 1.112273),
)
#: A fitted exponent; UMMDp, example 4, whose shears are 12, 23, 13.
AA5182 = mt.Yld2004(
    mt.Transformation(0.567726, 1.011906, 0.918738, 0.949253, 0.804483, 0.541426, 0.641800, 1.0, 1.0),
    mt.Transformation(0.881539, 1.281299, 1.468511, 1.694334, 0.874666, 0.562107, 1.275310, 1.0, 1.0),
    exponent=6.565182435,
)
FUNCTIONS = {
    "mises": mt.Mises(),
    "hill48": mt.Hill48(1.8, 1.5, 2.2),
    "hill48-stresses": mt.Hill48.from_stresses(1.0, 1.04, 0.97, 1.05),
    "hosford": mt.Hosford(6),
    "hosford-20": mt.Hosford(20),
    "yld91": mt.Yld91(1.05, 0.97, 1.1, 1.0, 0.9, 1.08),
    "aa2090": AA2090,
    "aa6111": AA6111,
    "aa5182": AA5182,
    "hosford-3": mt.Hosford(3),
}
CURVES = {
    "perfect": mt.Perfect(160.0),
    "voce": mt.Voce(130.0, 300.0, 12.0),
    "swift": mt.Swift(500.0, 0.004, 0.21),
    "table": mt.Table((0.0, 0.02, 0.1, 0.5), (160.0, 220.0, 250.0, 400.0)),
}
BACK = {
    "fixed": None,
    "prager": mt.Chaboche([(2000.0, 0.0)]),
    "two": mt.Chaboche([(9000.0, 120.0), (800.0, 8.0)]),
    "four": mt.Chaboche([(30000.0, 600.0), (5000.0, 60.0), (900.0, 5.0), (100.0, 0.0)]),
}
FALLING = mt.FallingModulus(saturated=55e3, rate=40.0)
SPCC = mt.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)  # Yoshida and Uemori (2002), table 1
CARDS = {
    f"{f}, {c}, {b}{', falling' if m else ''}": mt.Metal(
        **ALUMINIUM, hardening=CURVES[c], yield_function=FUNCTIONS[f], back_stress=BACK[b], modulus=m
    )
    for f, c, b, m in [
        *((f, "voce", "fixed", None) for f in FUNCTIONS),
        *(("hill48", c, "two", FALLING) for c in CURVES),
        *(("aa2090", c, b, None) for c, b in zip(CURVES, BACK, strict=True)),
        ("aa2090", "swift", "four", FALLING),
        ("mises", "perfect", "prager", None),
        ("mises", "voce", "fixed", FALLING),
    ]
}


CARDS |= {
    f"{f}, two surfaces{', falling' if m else ''}": mt.Metal(
        **ALUMINIUM, hardening=mt.Perfect(124.0), yield_function=FUNCTIONS[f], back_stress=SPCC, modulus=m
    )
    for f, m in (("mises", None), ("hill48", None), ("hill48", FALLING), ("aa2090", None))
}


def eqps(law, history):
    """Accumulated plastic strain (n, 1) of histories (n, size) of a law."""
    return named(history, law.history_variables)["eqps"]


def voigt(A, shear=1.0):
    return np.array([A[i, j] * (1.0 if i == j else shear) for i, j in PAIRS])


def tensor(v, shear=1.0):
    return np.asarray(v)[[[0, 3, 5], [3, 1, 4], [5, 4, 2]]] * (np.eye(3) + shear * (1 - np.eye(3)))


def green_lagrange(F):
    return voigt(0.5 * (F.T @ F - np.eye(3)), 2.0)


def increments(count, size, seed=0):
    steps = np.random.default_rng(seed).normal(size=(count, 6))
    return size * steps / np.linalg.norm(steps, axis=1)[:, None]


def differences(law, E, state, step, time=0.0):
    """Tangent by differences of fourth order."""
    columns = []
    for e in np.eye(6):
        one, two = (
            law.respond(E + k * step * e, state, step=time)[0] - law.respond(E - k * step * e, state, step=time)[0]
            for k in (1, 2)
        )
        columns.append((8 * one - two) / (12 * step))
    return np.stack(columns, axis=2)


def bar(function, angle):
    """Yield stress over that of the curve and r-value of a bar at an angle to the rolling direction."""
    stiff = mt.Metal(E=1e6, nu=0.3, hardening=mt.Perfect(1.0), yield_function=function)
    _, stress, plastic = mt.tension(stiff, np.linspace(1e-6, 1e-5, 10), angle)
    return stress[-1], plastic[-1, 1] / plastic[-1, 2]
