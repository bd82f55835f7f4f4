"""Scatter of results from the scatter of parameters, by derivatives of one run. docs/scatter.md"""

from umform.studies.scatter.found import Scattered
from umform.studies.scatter.limits import Limits
from umform.studies.scatter.source import Scatter
from umform.studies.scatter.spread import Spread
from umform.studies.scatter.study import scatter

__all__ = ["Limits", "Scatter", "Scattered", "Spread", "scatter"]
