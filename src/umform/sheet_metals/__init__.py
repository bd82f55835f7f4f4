"""Sheet metals with sources, and flow curves from the certificate of a coil. Units N, mm, MPa."""

from umform.sheet_metals.flow_curve import read_flow_curve
from umform.sheet_metals.library import SheetMetal, get, names
from umform.sheet_metals.tensile_test import (
    TensileTest,
    swift_from_tensile_test,
    tensile_test,
    voce_from_tensile_test,
)

__all__ = [
    "SheetMetal",
    "TensileTest",
    "get",
    "names",
    "read_flow_curve",
    "swift_from_tensile_test",
    "tensile_test",
    "voce_from_tensile_test",
]
