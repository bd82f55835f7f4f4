"""AA6016-T4 of the ESAFORM benchmark 2021 with its directions: two cards of Yld2004-18p, and Hill48 of its r-values.

Constants: Habraken et al. 2022, doi 10.1007/s12289-022-01672-w.
"""

from __future__ import annotations

from umform.materials import Hill48, Metal, Transformation, Voce, Yld2004

#: Voce of NTNU and of Postech: yield stress, saturation, rate.
_NTNU, _POSTECH = Voce(125.95, 314.98, 12.22), Voce(126.24, 315.21, 12.17)


def _transformation(v: tuple[float, ...]) -> Transformation:
    return Transformation(v[0], v[1], v[2], v[3], v[4], v[5], shear12=v[6], shear23=v[7], shear13=v[8])


def aa6016(card: str = "NTNU", exponent: float = 8) -> Metal:
    """The metal of a card: "NTNU", "Postech" or "Hill48".

    Parameters
    ----------
    card : str
        Which card.
    exponent : float
        Of Yld2004; 8 for this aluminium.
    """
    if card == "Hill48":
        return Metal(70e3, 0.33, hardening=_NTNU, yield_function=Hill48(r0=0.526, r45=0.253, r90=0.601))
    first, second = _CARDS[card]
    function = Yld2004(_transformation(first), _transformation(second), exponent=exponent)
    return Metal(70e3, 0.33, hardening=_NTNU if card == "NTNU" else _POSTECH, yield_function=function)


_CARDS = {
    "NTNU": (
        (1.1998, 1.2289, 0.1315, 0.8081, 1.1386, 0.2870, 1.3739, 1.0, 1.0),
        (1.1510, -0.2576, 0.4873, 0.9934, 0.9110, 0.7965, 0.2679, 1.0, 1.0),
    ),
    "Postech": (
        (1.0, 1.0, -0.0870, 0.4496, 1.0192, 1.1724, 0.0, 1.1487, 1.2801),
        (1.3329, 1.2510, 1.0948, 1.0855, -0.0065, 0.4812, 1.5461, 0.7366, 0.5991),
    ),
}
#: Names on the command line.
NAMES = {"AA6016-T4": "NTNU", "AA6016-T4 Postech": "Postech", "AA6016-T4 Hill48": "Hill48"}
