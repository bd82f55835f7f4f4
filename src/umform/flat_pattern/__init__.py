"""The flat pattern of a part of a STEP file: contours, holes, bend lines with computed allowances, order, bending.

`flat` unfolds a part; the result is a `FlatPattern`. `bend_part` bends it by simulation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.flat_pattern.allowance import Allowance, AllowanceProvider, AllowanceTable, KFactor
    from umform.flat_pattern.bending import BentPart, bend_part
    from umform.flat_pattern.flattening import flat
    from umform.flat_pattern.order import Orders
    from umform.flat_pattern.pattern import FlatBend, FlatPattern
    from umform.flat_pattern.tooling import ComputedBends, Tooling

__all__ = [
    "Allowance",
    "AllowanceProvider",
    "AllowanceTable",
    "BentPart",
    "ComputedBends",
    "FlatBend",
    "FlatPattern",
    "KFactor",
    "Orders",
    "Tooling",
    "bend_part",
    "flat",
]

#: Files of a flat pattern.
FILES = ("flat.dxf", "flat.svg", "flat.json", "sheet.html")

_HOME = {
    "Allowance": "allowance",
    "AllowanceProvider": "allowance",
    "AllowanceTable": "allowance",
    "BentPart": "bending",
    "ComputedBends": "tooling",
    "FlatBend": "pattern",
    "FlatPattern": "pattern",
    "KFactor": "allowance",
    "Orders": "order",
    "Tooling": "tooling",
    "bend_part": "bending",
    "flat": "flattening",
}

__getattr__ = at_first_use(__name__, _HOME)
