"""Derivative of one response with respect to one parameter."""

from __future__ import annotations

from dataclasses import dataclass

from umform.results.quantity import Quantity
from umform.spec import Scalar


@dataclass(frozen=True)
class Derivative:
    """Derivative of one response with respect to one parameter.

    Attributes
    ----------
    response : Quantity
        The response with its value.
    parameter : Scalar
        The parameter.
    value : float or None
        The derivative; None: unknown.
    switched : int
        Most points of the metal or of contacts in another state than without the change: the derivative is one-sided
        there.
    residual : float
        Largest residual of the changed run, relative to the forces.
    why : str
        Why it is unknown; empty if it is known.
    band : float or None
        Half of the width of its band; None: it has none.
    """

    response: Quantity
    parameter: Scalar
    value: float | None
    switched: int = 0
    residual: float = 0.0
    why: str = ""
    band: float | None = None

    @property
    def unit(self) -> str:
        """Its unit; lengths and stresses of decks, and those of laws, are in any unit."""
        one, other = self.response.unit, self.parameter.unit
        if other:
            return f"{one or '1'}/{other}"
        return one and f"{one} per unit of the parameter"

    @property
    def relative(self) -> float | None:
        """Relative change of the response for a relative change of the parameter; None if one of them is zero."""
        if self.value is None or not self.response.value or not self.parameter.value:
            return None
        return self.value * self.parameter.value / self.response.value

    @property
    def size(self) -> float:
        """Change of the parameter for tables and pictures: 1 % of it, or 1 of a parameter that is zero."""
        return 0.01 * self.parameter.value or 1.0

    @property
    def change(self) -> float | None:
        """Change of the response by that of the parameter; None if it is unknown."""
        return None if self.value is None else self.value * self.size
