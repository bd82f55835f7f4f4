"""Material laws and hardening curves: immutable descriptions from which the kernels build their laws."""

from umform.materials.back_stress import Chaboche, YoshidaUemori
from umform.materials.compiled import CompiledLaw
from umform.materials.elastic import SVK, Elastic, NeoHooke, NeoHookePower
from umform.materials.hardening import Hardening, Linear, LinearVoce, Perfect, Swift, Table, Voce
from umform.materials.j2 import J2, Plastic
from umform.materials.material import Material
from umform.materials.metal import FallingModulus, LogarithmicSpace, Metal
from umform.materials.point_path import PointPath, point_path, tension
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
