"""Sheet metals with sources, and flow curves from the certificate of a coil. Units N, mm, MPa."""

from umform.sheet_metals.curve_fit import (
    CURVE_FITS,
    fit_hardening,
    fit_linear,
    fit_linear_voce,
    fit_perfect,
    fit_swift,
    fit_table,
    fit_voce,
)
from umform.sheet_metals.cyclic_fit import fit_chaboche, fit_cycles, fit_tests, fit_yoshida_uemori
from umform.sheet_metals.directional_fit import Directions, balanced, fit_hill48, fit_yld2004, uniaxial
from umform.sheet_metals.flow_curve import read_flow_curve
from umform.sheet_metals.least_squares import Fit
from umform.sheet_metals.library import cards, get, limits, name_of, names, of_certificate, sheet_text
from umform.sheet_metals.modulus_fit import fit_falling_modulus
from umform.sheet_metals.sheet_metal import SheetMetal
from umform.sheet_metals.tensile_test import (
    TensileTest,
    swift_from_tensile_test,
    tensile_test,
    voce_from_tensile_test,
)
from umform.sheet_metals.tension_test import tension_test

__all__ = [
    "CURVE_FITS",
    "Directions",
    "Fit",
    "SheetMetal",
    "TensileTest",
    "balanced",
    "cards",
    "fit_chaboche",
    "fit_cycles",
    "fit_falling_modulus",
    "fit_hardening",
    "fit_hill48",
    "fit_linear",
    "fit_linear_voce",
    "fit_perfect",
    "fit_swift",
    "fit_table",
    "fit_tests",
    "fit_voce",
    "fit_yld2004",
    "fit_yoshida_uemori",
    "get",
    "limits",
    "name_of",
    "names",
    "of_certificate",
    "read_flow_curve",
    "sheet_text",
    "swift_from_tensile_test",
    "tensile_test",
    "tension_test",
    "uniaxial",
    "voce_from_tensile_test",
]
