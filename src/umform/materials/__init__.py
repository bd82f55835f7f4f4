"""Material laws and hardening curves: immutable descriptions from which the kernels build their laws.

Each class in the files of this package is a name of the package; those that implement Hardening, YieldFunction,
RateFactor or have elastic constants can be named in decks.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from umform.first_use import at_first_use, classes_in

if TYPE_CHECKING:
    from umform.materials.back_stress import *
    from umform.materials.compiled import *
    from umform.materials.elastic import *
    from umform.materials.hardening import *
    from umform.materials.j2 import *
    from umform.materials.material import *
    from umform.materials.metal import *
    from umform.materials.paths import *
    from umform.materials.rate_factor import *
    from umform.materials.tangent_check import *
    from umform.materials.umat import *
    from umform.materials.user_law import *
    from umform.materials.yield_functions import *

_HOME = {
    "EnergyFunction": "user_law",
    "Floats": "user_law",
    "LawFunction": "user_law",
    "check_law": "tangent_check",
    "point_path": "paths",
    "tension": "paths",
}


#: Names of this package only: interfaces and results.
_INNER = {
    *("Elastic", "Hardening", "Material", "Plastic", "PointPath", "Points", "RateFactor", "SmallStrainLaw"),
    *("TangentCheck", "YieldFunction", "EnergyFunction", "Floats", "LawFunction", "point_path", "tension"),
}


@cache
def names() -> dict[str, str]:
    """Module of each public name."""
    return classes_in(__name__) | _HOME


def public() -> list[str]:
    """Names that stand in umform, too; those of new classes are among them."""
    return [name for name in names() if name not in _INNER]


def __getattr__(name: str) -> object:
    """Import a name when it is first used; all of them as ``__all__``."""
    return list(names()) if name == "__all__" else at_first_use(__name__, names())(name)
