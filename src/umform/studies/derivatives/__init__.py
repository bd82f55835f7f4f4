"""Derivatives of results with respect to parameters, by shadows of the run. docs/derivatives.md"""

from umform.studies.derivatives.derivative import Derivative
from umform.studies.derivatives.derive import derivatives
from umform.studies.derivatives.found import Derivatives

__all__ = ["Derivative", "Derivatives", "derivatives"]
