"""Material laws and hardening curves: frozen descriptions that make the laws of the kernels."""

from umform.materials.elastic import SVK, Elastic, NeoHooke, NeoHookePower
from umform.materials.hardening import Hardening, Linear, LinearVoce, Perfect, Swift, Table, Voce
from umform.materials.j2 import J2
from umform.materials.material import Material
from umform.materials.tangent_check import TangentCheck, check_law
from umform.materials.user_law import EnergyFunction, Floats, LawFunction, Points, UserLaw

__all__ = [
    "J2",
    "SVK",
    "Elastic",
    "EnergyFunction",
    "Floats",
    "Hardening",
    "LawFunction",
    "Linear",
    "LinearVoce",
    "Material",
    "NeoHooke",
    "NeoHookePower",
    "Perfect",
    "Points",
    "Swift",
    "Table",
    "TangentCheck",
    "UserLaw",
    "Voce",
    "check_law",
]
