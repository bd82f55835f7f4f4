"""Changes of the measures by refinements, and the bands that follow."""

from __future__ import annotations

import math
from dataclasses import dataclass

from umform.results.quantity import Band

_SOURCE = (
    "root of the sum of squares of the changes by the refinements beside it: mesh, layers, points, penalty and "
    "increments. In the column stack, the sheet is eight layers of 8-node elements. Material data, friction and tools "
    "have uncertainties of their own"
)


@dataclass(frozen=True)
class Budget:
    """Sensitivities of the measures.

    Attributes
    ----------
    changes : dict of str to dict of str to float
        For each refinement, the change of each measure. NaN if the refined run failed.
    failures : dict of str to str
        Cause of the failure of refined runs.
    """

    changes: dict[str, dict[str, float]]
    failures: dict[str, str]

    def total(self, name: str) -> float:
        """Square root of the sum of squares of the changes of a measure: its uncertainty from the discretisation."""
        return math.sqrt(sum(change[name] ** 2 for change in self.changes.values()))

    @property
    def bands(self) -> dict[str, Band]:
        """The band of each measure."""
        names = next(iter(self.changes.values()), {})
        return {
            name: Band(self.total(name), _SOURCE, parts={label: change[name] for label, change in self.changes.items()})
            for name in names
        }
