"""Slopes of results over a range of their parameters, from whole runs. docs/derivatives.md"""

from umform.studies.slopes.found import Slopes
from umform.studies.slopes.study import slopes

__all__ = ["Slopes", "slopes"]
