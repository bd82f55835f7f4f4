"""Material laws and hardening curves: immutable descriptions from which the kernels build their laws."""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.materials.back_stress import Chaboche, YoshidaUemori
    from umform.materials.compiled import CompiledLaw
    from umform.materials.elastic import SVK, Elastic, NeoHooke, NeoHookePower
    from umform.materials.hardening import Hardening, Linear, LinearVoce, Perfect, Swift, Table, Voce
    from umform.materials.j2 import J2, Plastic
    from umform.materials.material import Material
    from umform.materials.metal import FallingModulus, LogarithmicSpace, Metal
    from umform.materials.paths import PointPath, point_path, tension
    from umform.materials.rate_factor import CowperSymonds, JohnsonCook, RateFactor
    from umform.materials.tangent_check import TangentCheck, check_law
    from umform.materials.umat import Umat
    from umform.materials.user_law import EnergyFunction, Floats, LawFunction, Points, UserLaw
    from umform.materials.yield_functions import Hill48, Hosford, Mises, Transformation, YieldFunction, Yld91, Yld2004

__all__ = [
    "J2",
    "SVK",
    "Chaboche",
    "CompiledLaw",
    "CowperSymonds",
    "Elastic",
    "EnergyFunction",
    "FallingModulus",
    "Floats",
    "Hardening",
    "Hill48",
    "Hosford",
    "JohnsonCook",
    "LawFunction",
    "Linear",
    "LinearVoce",
    "LogarithmicSpace",
    "Material",
    "Metal",
    "Mises",
    "NeoHooke",
    "NeoHookePower",
    "Perfect",
    "Plastic",
    "PointPath",
    "Points",
    "RateFactor",
    "Swift",
    "Table",
    "TangentCheck",
    "Transformation",
    "Umat",
    "UserLaw",
    "Voce",
    "YieldFunction",
    "Yld91",
    "Yld2004",
    "YoshidaUemori",
    "check_law",
    "point_path",
    "tension",
]

_HOME = {
    "J2": "j2",
    "SVK": "elastic",
    "Chaboche": "back_stress",
    "CompiledLaw": "compiled",
    "CowperSymonds": "rate_factor",
    "Elastic": "elastic",
    "EnergyFunction": "user_law",
    "FallingModulus": "metal",
    "Floats": "user_law",
    "Hardening": "hardening",
    "Hill48": "yield_functions",
    "Hosford": "yield_functions",
    "JohnsonCook": "rate_factor",
    "LawFunction": "user_law",
    "Linear": "hardening",
    "LinearVoce": "hardening",
    "LogarithmicSpace": "metal",
    "Material": "material",
    "Metal": "metal",
    "Mises": "yield_functions",
    "NeoHooke": "elastic",
    "NeoHookePower": "elastic",
    "Perfect": "hardening",
    "Plastic": "j2",
    "PointPath": "paths",
    "Points": "user_law",
    "RateFactor": "rate_factor",
    "Swift": "hardening",
    "Table": "hardening",
    "TangentCheck": "tangent_check",
    "Transformation": "yield_functions",
    "Umat": "umat",
    "UserLaw": "user_law",
    "Voce": "hardening",
    "YieldFunction": "yield_functions",
    "Yld91": "yield_functions",
    "Yld2004": "yield_functions",
    "YoshidaUemori": "back_stress",
    "check_law": "tangent_check",
    "point_path": "paths",
    "tension": "paths",
}

__getattr__ = at_first_use(__name__, _HOME)
