"""How a parameter scatters: its standard deviation, absolute or relative, or a tolerance."""

from __future__ import annotations

import re
from dataclasses import dataclass

from umform.errors import InvalidValue
from umform.processes.rules import positive
from umform.spec import Scalar
from umform.spec.types import FARTHEST

#: Standard deviations in half of a tolerance band.
BAND = 3.0
_SIGN = re.compile(r"^(±|\+/?-)")


@dataclass(frozen=True)
class Scatter:
    """Scatter of a parameter around its value.

    Attributes
    ----------
    size : float
        Standard deviation; half of the band of a tolerance.
    relative : bool
        Whether it is a part of the value of the parameter.
    tolerance : bool
        Whether it is a tolerance: a band of three standard deviations to each side.

    Examples
    --------
    >>> import umform as uf
    >>> uf.Scatter(0.02), uf.Scatter.of("5%")
    (Scatter(size=0.02, relative=False, tolerance=False), Scatter(size=0.05, relative=True, tolerance=False))
    """

    size: float
    relative: bool = False
    tolerance: bool = False

    def __post_init__(self) -> None:
        if not (positive(self.size) and self.size <= FARTHEST):
            raise InvalidValue(
                "a scatter is a positive number",
                where="scatter",
                value=self.size,
                cause=f"a sign, no number, or beyond {FARTHEST:g}",
                remedy="such as 0.02 or 5%; leave out what does not scatter",
            )

    @classmethod
    def of(cls, given: Scatter | float | str, *, tolerance: bool = False) -> Scatter:
        """The scatter of a number, or of a text such as ``5%``, ``0.02`` or ``±0.1``.

        Raises
        ------
        InvalidValue
            It is no positive number.
        """
        if isinstance(given, Scatter):
            return given
        if not isinstance(given, str):
            return cls(given, tolerance=tolerance)
        text = _SIGN.sub("", given.strip()).strip()
        relative = text.endswith("%")
        try:
            number = float(text.removesuffix("%"))
        except ValueError:
            raise InvalidValue(
                "a scatter is a number or a percentage",
                where="scatter",
                value=given,
                cause="a decimal comma" if "," in given else "",
                remedy="write 0.02, 5% or ±0.1",
            ) from None
        return cls(number / 100.0 if relative else number, relative, tolerance)

    def deviation(self, parameter: Scalar) -> float:
        """Standard deviation of a parameter.

        Raises
        ------
        InvalidValue
            A part of zero.
        """
        if self.relative and not parameter.value:
            raise InvalidValue(
                "a part of zero is no scatter",
                where=parameter.path,
                value=f"{100.0 * self.size:g} % of 0",
                cause="the value of the parameter is zero",
                remedy=f"a number{f' in {parameter.unit}' if parameter.unit else ''} instead of a percentage",
            )
        size = self.size * abs(parameter.value) if self.relative else self.size
        return size / BAND if self.tolerance else size


@dataclass(frozen=True)
class Source:
    """A parameter that scatters.

    Attributes
    ----------
    parameter : Scalar
        The parameter with its value.
    deviation : float
        Its standard deviation.
    """

    parameter: Scalar
    deviation: float

    @property
    def path(self) -> str:
        """Path of the parameter."""
        return self.parameter.path
