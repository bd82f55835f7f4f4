"""Sheet metals with sources, and flow curves from the certificate of a coil. Units N, mm, MPa."""

from umform.sheet_metals.cyclic_fit import fit_cycles, fit_hardening, fit_swift, fit_voce
from umform.sheet_metals.directional_fit import Directions, balanced, fit_hill48, fit_yld2004, uniaxial
from umform.sheet_metals.flow_curve import read_flow_curve
from umform.sheet_metals.least_squares import Fit
from umform.sheet_metals.library import cards, get, names
from umform.sheet_metals.sheet_metal import SheetMetal
from umform.sheet_metals.tensile_test import (
    TensileTest,
    swift_from_tensile_test,
    tensile_test,
    voce_from_tensile_test,
)
from umform.sheet_metals.tension_test import tension_test

__all__ = [
    "Directions",
    "Fit",
    "SheetMetal",
    "TensileTest",
    "balanced",
    "cards",
    "fit_cycles",
    "fit_hardening",
    "fit_hill48",
    "fit_swift",
    "fit_voce",
    "fit_yld2004",
    "get",
    "names",
    "read_flow_curve",
    "swift_from_tensile_test",
    "tensile_test",
    "tension_test",
    "uniaxial",
    "voce_from_tensile_test",
]
