"""Forces of the operations of a job by workshop rules and as computed; the press must have the largest."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from umform.bench.wanted import Wanted
from umform.processes.air_bending.formulas import shop_forces
from umform.processes.air_bending.spec import AirBending
from umform.processes.hemming import Hemming
from umform.processes.hemming.formulas import flattening_forces
from umform.results.quantity import Band, Quantity

#: Force of bottoming over that in the air: what is usual.
_BOTTOMING = (3.0, 5.0)


@dataclass(frozen=True)
class Force:
    """The force of an operation in kN/m.

    Attributes
    ----------
    operation : str
        "bend", "bottom" or "flatten".
    low, high : float
        Range of the rule; equal for a given or computed force.
    basis : str
        "rule", "given" or "computed".
    beyond : bool
        Whether the force may exceed the range, as in bottoming by a way.
    band : Band or None
        Error of a computed force, in kN/m.
    """

    operation: str
    low: float
    high: float
    basis: str = "rule"
    beyond: bool = False
    band: Band | None = None

    def over(self, length: float) -> dict[str, Any]:
        """For the page, in kN over a length in mm."""
        band = self.band
        error = None if band is None or math.isnan(band.error) else band.error * length / 1e3
        return {
            "operation": self.operation,
            "force": self.high * length / 1e3,
            "basis": self.basis,
            "beyond": self.beyond,
            "band": None if band is None else {"error": error, "middle": None, "source": band.source},
        }


def rule_forces(wanted: Wanted, case: AirBending) -> list[Force]:
    """Forces of the operations in their order, by workshop rules."""
    low, high = shop_forces(case)
    bend = Force("bend", low, high)
    if wanted.choices.work == "hem":
        hem = wanted.of(Hemming)
        force = hem.get("force")
        range_ = flattening_forces(case, hem["form"], hem.get("gap"), force)
        return [bend, Force("flatten", *range_, "rule" if force is None else "given")]
    if wanted.choices.work != "bottom":
        return [bend]
    if wanted.goal.force_per_metre is not None:
        return [Force("bottom", wanted.goal.force_per_metre, wanted.goal.force_per_metre, "given")]
    return [Force("bottom", _BOTTOMING[0] * low, _BOTTOMING[1] * high, beyond=True)]


def computed_forces(wanted: Wanted, case: AirBending, computed: Mapping[str, Quantity]) -> list[Force]:
    """The same with computed forces by their operations; for air bending the larger one of rule and computation."""
    found = []
    for rule in rule_forces(wanted, case):
        one = computed[rule.operation]
        force = one.best
        assert force is not None
        larger = rule.operation == "bend" and force < rule.high
        found.append(rule if larger else Force(rule.operation, force, force, "computed", band=one.band))
    return found


def largest_of(quantities: Iterable[Quantity]) -> Quantity:
    """The largest one of the largest forces among the numbers of bends or a hem."""
    return max((one for one in quantities if one.name == "largest_force"), key=lambda one: one.best or 0.0)


def largest(forces: list[Force]) -> Force:
    """The operation that needs the largest force."""
    return max(forces, key=lambda one: one.high)
