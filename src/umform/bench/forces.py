"""Forces of the operations of a job by workshop rules and as computed; the press must have the largest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from umform.bench.wanted import Wanted
from umform.processes.air_bending.formulas import shop_forces
from umform.processes.air_bending.spec import AirBending
from umform.processes.hemming import Hemming
from umform.processes.hemming.formulas import flattening_forces

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
    """

    operation: str
    low: float
    high: float
    basis: str = "rule"
    beyond: bool = False

    def over(self, length: float) -> dict[str, Any]:
        """For the page, in kN over a length in mm."""
        return {
            "operation": self.operation,
            "force": self.high * length / 1e3,
            "basis": self.basis,
            "beyond": self.beyond,
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


def computed_forces(wanted: Wanted, case: AirBending, computed: Mapping[str, float]) -> list[Force]:
    """The same with computed forces; for air bending the larger one of rule and computation."""
    found = []
    for rule in rule_forces(wanted, case):
        force = computed[rule.operation]
        larger = rule.operation == "bend" and force < rule.high
        found.append(rule if larger else Force(rule.operation, force, force, "computed"))
    return found


def largest(forces: list[Force]) -> Force:
    """The operation that needs the largest force."""
    return max(forces, key=lambda one: one.high)
