"""Error budget: changes of numbers by other meshes, points, penalties and increments, and the bands that follow."""

from __future__ import annotations

import math
from dataclasses import dataclass

from umform.results.quantity import Band


@dataclass(frozen=True)
class Budget:
    """Sensitivities of numbers.

    Attributes
    ----------
    changes : dict of str to dict of str to float
        For each other run, the change of each number. NaN if that run failed.
    failures : dict of str to str
        Cause of the failure of other runs.
    runs : str
        What the other runs are, for the note below the numbers.
    safety : float
        Factor on the root of the sum of squares.
    """

    changes: dict[str, dict[str, float]]
    failures: dict[str, str]
    runs: str
    safety: float = 1.0

    def total(self, name: str) -> float:
        """Root of the sum of squares of the changes of a number, with the factor: the error of the discretisation."""
        return self.safety * math.sqrt(sum(change[name] ** 2 for change in self.changes.values()))

    @property
    def bands(self) -> dict[str, Band]:
        """The band of each number."""
        names = next(iter(self.changes.values()), {})
        times = "" if self.safety == 1.0 else f"{self.safety:g} times the "
        source = (
            f"{times}root of the sum of squares of the changes by the {self.runs}. Material data, friction and tools "
            "have uncertainties of their own"
        )
        return {
            name: Band(self.total(name), source, parts={label: change[name] for label, change in self.changes.items()})
            for name in names
        }
