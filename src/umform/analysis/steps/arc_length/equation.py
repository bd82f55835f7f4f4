"""The load parameter as a scalar unknown, and its equation: the length of the arc, or a given load.

docs/theory, 5.12
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.model.terms.control import Control
from umform.model.terms.term import At, Found, Global, Into, Term

Floats = NDArray[np.float64]


class Line(Global):
    """Straight line of the controls, parametrised by the load parameter. eq. (5.20)

    Parameters
    ----------
    controls : sequence of Control
        Controls to move.
    starts, targets : sequence of float
        Their values at the load parameters 0 and 1.

    Raises
    ------
    InvalidValue
        If no control moves.
    """

    def __init__(self, controls: Sequence[Control], starts: Sequence[float], targets: Sequence[float]) -> None:
        self.ends = {c: (float(start), float(end)) for c, start, end in zip(controls, starts, targets, strict=True)}
        super().__init__("load parameter", {control: end - start for control, (start, end) in self.ends.items()})
        if not any(self.rates.values()):
            raise InvalidValue(
                "an arc needs a control that moves",
                where="Arc, to",
                value=", ".join(control.name for control in controls),
                cause="it stands at its target already",
                remedy="another value of to",
            )

    def at(self, fraction: float) -> dict[Control, float]:
        """Values of the controls; at 1 they equal the targets to the last bit."""
        return {
            c: start + fraction * (end - start) if fraction != 1.0 else end for c, (start, end) in self.ends.items()
        }

    def move(self, values: dict[Control, float], before: float, value: float) -> None:
        """Write the values of the controls at a load parameter."""
        values.update(self.at(value))

    def text(self, fraction: float) -> str:
        """The loads as text."""
        return ", ".join(f"{control.name} = {value:.6g}" for control, value in self.at(fraction).items())


class ArcLength(Term):
    """The equation of the load parameter. eq. (5.22)

    Parameters
    ----------
    line : Line
        The load parameter; its value is that of the last converged state.

    Attributes
    ----------
    load_weight : float
        Weight of the load parameter in the arc length, psi^2; zero for a cylindrical arc.
    """

    name = "arc length"

    def __init__(self, line: Line) -> None:
        self.line, self.unknowns, self.load_weight = line, (line,), 0.0
        self.hold(line.value)

    def hold(self, fraction: float) -> None:
        """Prescribe a load parameter."""
        self._fraction, self._length, self._start, self._along = fraction, 0.0, np.empty(0), np.empty(0)

    def ask(self, length: float, start: Floats) -> None:
        """Prescribe an arc length from the converged state, whose displacement (3 n,) is given."""
        self._length, self._start, self._along = length, start, np.empty(0)

    def cross(self, point: Floats, fraction: float, along: Floats, slope: float) -> None:
        """Prescribe the plane across a path at a point, with the tangent of displacement and load. eq. (5.166)"""
        self._fraction, self._length, self._start = fraction, slope, point
        self._along = along

    def evaluate(self, at: At, into: Into) -> Found:
        """Add the relative excess of the length times the force scale: a force, as in the other equations."""
        border, k, fraction = into.border, into.border.number(self.line), at.scalars[self.line]
        scale = math.sqrt(sum(found.force_scale_squared for found in into.found.values())) or 1.0
        if self._along.size:
            gone = fraction - self._fraction
            border.residual[k] = scale * (
                float(self._along @ (at.u - self._start)) + self.load_weight * self._length * gone
            )
            border.rows[k] = scale * self._along
            border.corner[k, k] = scale * self.load_weight * self._length
        elif self._length:
            scale /= self._length**2
            since, gone = at.u - self._start, fraction - self.line.value
            border.residual[k] = 0.5 * scale * (float(since @ since) + self.load_weight * gone**2 - self._length**2)
            border.rows[k] = scale * since
            border.corner[k, k] = scale * self.load_weight * gone
        else:
            border.residual[k], border.corner[k, k] = scale * (fraction - self._fraction), scale
        if at.du is not None:
            border.predictor[k] = border.rows[k] @ at.du
        return Found()
