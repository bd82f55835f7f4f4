"""Hemming: an acute bend in a V-die, then flattened between two plates, over an insert or open.

`hemming` runs a `Hemming`; the result is a `Hem`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.processes.hemming.measures import Hem, HemMeasures
    from umform.processes.hemming.run import hemming
    from umform.processes.hemming.spec import Hemming

__all__ = ["Hem", "HemMeasures", "Hemming", "hemming"]

_HOME = {
    "Hem": "measures",
    "HemMeasures": "measures",
    "Hemming": "spec",
    "hemming": "run",
}

# The command line reads the parameters without the run.
__getattr__ = at_first_use(__name__, _HOME)
