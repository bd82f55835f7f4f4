"""Hemming: an acute bend in a V-die, then flattened between two plates, over an insert or open.

`hemming` runs a `Hemming`; the result is a `Hem`.
"""

from umform.processes.hemming.measures import Hem, HemMeasures
from umform.processes.hemming.run import hemming
from umform.processes.hemming.spec import Hemming

__all__ = ["Hem", "HemMeasures", "Hemming", "hemming"]
