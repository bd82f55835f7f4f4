"""Numbers of a problem from measurements of its run: least squares with its derivatives. docs/identification.md"""

from umform.studies.identification.data import MeasuredCurve, MeasuredNumber
from umform.studies.identification.found import Identified
from umform.studies.identification.identify import identify
from umform.studies.identification.sought import Sought

__all__ = ["Identified", "MeasuredCurve", "MeasuredNumber", "Sought", "identify"]
