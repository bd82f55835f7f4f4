"""Laws of the corpus by name, in any unit of stress."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import umform as uf
from umform import sheet_metals
from umform.materials import Material

_HILL = {"r0": 1.8, "r45": 1.4, "r90": 2.1}


def _swift(s: float) -> uf.Swift:
    return uf.Swift(565.32 * s, 0.007117, 0.2589)


#: Functions of the number of units in a megapascal.
LAWS: dict[str, Callable[[float], Material]] = {
    "elastic": lambda s: uf.SVK(E=210e3 * s, nu=0.3),
    "rubber": lambda s: uf.NeoHooke(E=2.0 * s, nu=0.4),
    "perfect": lambda s: uf.J2(E=210e3 * s, nu=0.3, hardening=uf.Perfect(200.0 * s)),
    "linear": lambda s: uf.J2(E=210e3 * s, nu=0.3, hardening=uf.Linear(160.0 * s, 500.0 * s)),
    "swift": lambda s: uf.J2(E=206e3 * s, nu=0.3, hardening=_swift(s)),
    "voce": lambda s: uf.J2(E=70e3 * s, nu=0.33, hardening=uf.Voce(125.95 * s, 314.98 * s, 12.22)),
    "chaboche": lambda s: uf.Metal(
        206e3 * s,
        0.3,
        hardening=uf.Perfect(150.0 * s),
        back_stress=uf.Chaboche(((20e3 * s, 200.0), (1e3 * s, 0.0))),
    ),
    "rate": lambda s: uf.Metal(206e3 * s, 0.3, hardening=_swift(s), rate=uf.CowperSymonds(40.0, 5.0)),
    "hill": lambda s: uf.Metal(206e3 * s, 0.3, hardening=_swift(s), yield_function=uf.Hill48(**_HILL)),
    "yoshida": lambda s: sheet_metals.get("SPCC").law,
    "yld2004": lambda s: sheet_metals.get("AA6016-T4").law,
}


def law(name: str, stress: float = 1.0) -> dict[str, Any]:
    """Arguments of a model: the law, or that of a sheet metal in MPa; and the rolling direction if it has one."""
    material = LAWS[name](stress) if name in LAWS else sheet_metals.get(name).law
    rolling = {"rolling": (1.0, 0.0, 0.0)} if getattr(material, "directional", False) else {}
    return {"material": material, **rolling}
