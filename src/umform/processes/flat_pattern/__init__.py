"""The flat pattern of a part of a STEP file: contours, holes and bend lines, with a computed or given allowance.

`flat` unfolds a part; the result is a `FlatPattern`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.processes.flat_pattern.allowance import Allowance, AllowanceProvider, AllowanceTable, KFactor
    from umform.processes.flat_pattern.flat import flat
    from umform.processes.flat_pattern.pattern import FlatBend, FlatPattern

__all__ = ["Allowance", "AllowanceProvider", "AllowanceTable", "FlatBend", "FlatPattern", "KFactor", "flat"]

_HOME = {
    "Allowance": "allowance",
    "AllowanceProvider": "allowance",
    "AllowanceTable": "allowance",
    "FlatBend": "pattern",
    "FlatPattern": "pattern",
    "KFactor": "allowance",
    "flat": "flat",
}

__getattr__ = at_first_use(__name__, _HOME)
