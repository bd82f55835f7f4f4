"""Contact laws of a user: the pressure as a function of the gap. docs/theory, 4.17"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidValue
from umform.materials.library import IN_FOLDER, Numbers, Symbol, content, function_address, numbers
from umform.spec import About, InDeck, check_fields

Floats = NDArray[np.float64]

#: gap (n,) -> pressure (n,), its derivative with respect to the gap (n,).
PressureFunction = Callable[[Floats], tuple[ArrayLike, ArrayLike]]
_SIGNATURE = "law(gap) -> pressure, slope: arrays (n,); the gap is negative in penetration, slope = dpressure/dgap"

#: The largest gap at which there is a pressure.
Reach = Annotated[float, About(cause="a sign, nan or inf", remedy="0.0: pressure in penetration only")]


@dataclass(frozen=True)
class ContactLaw:
    """Contact pressure as a Python function of the gap, in place of the penalty. eq. (4.280)

    Called with the gaps of all contact points of a facet, or with all points of the rule over its cells.

    Examples
    --------
    A layer that is squeezed: no pressure until the gap is 0.05, then the square of what is missing.

    >>> import umform as uf
    >>> def layer(gap):
    ...     squeezed = 0.05 - gap
    ...     return 2e4 * squeezed**2, -4e4 * squeezed
    >>> law = uf.ContactLaw(layer, reach=0.05)
    >>> bool(uf.check_contact_law(law, [-0.01, 0.0, 0.04]) < 1e-6)
    True
    """

    function: PressureFunction
    """Function of the gaps (n,), negative in penetration and none larger than the reach; returns the pressures (n,) on
    the reference area, zero or more, and their derivatives with respect to the gap (n,), negative or zero."""
    reach: Reach = 0.0
    """Largest gap at which there is a pressure; the pressure should be zero there."""
    name: str = "contact law"
    """Name in messages."""

    def __post_init__(self) -> None:
        check_fields(self)

    def __call__(self, gap: Floats) -> tuple[Floats, Floats]:
        """Evaluate the function and check what it returns.

        Raises
        ------
        InvalidValue
            If it does not return two arrays of the shape of the gap.
        """
        try:
            answer = self.function(gap)
        except Exception as error:
            error.add_note(f"in the {self.name}, called as {_SIGNATURE}")
            raise
        if not isinstance(answer, tuple) or len(answer) != 2:
            raise InvalidValue(
                "a contact law must return two arrays: the pressure and its derivative",
                where=self.name,
                value=type(answer).__name__,
                cause="the pressure alone, or a list in place of a tuple",
                remedy=_SIGNATURE,
            )
        pressure, slope = (np.ascontiguousarray(values, dtype=float) for values in answer)
        for what, values in (("pressure", pressure), ("derivative", slope)):
            if values.shape != gap.shape:
                raise InvalidValue(
                    f"the {what} of a contact law must have the shape {gap.shape}",
                    where=self.name,
                    value=values.shape,
                    cause="a constant that was not repeated for each gap",
                    remedy=f"np.full_like(gap, value) repeats a constant; {_SIGNATURE}",
                )
        return pressure, slope

    def kernel(self) -> _core.NormalLaw:
        """The law as the kernels take it."""
        return _core.normal_from_function(self, self.name, self.reach)

    def called(self, name: str) -> ContactLaw:
        """The same with another name in messages."""
        return replace(self, name=name)


@dataclass(frozen=True)
class CompiledContactLaw:
    """Contact pressure as a C function of the gap, in place of the penalty, called without Python's global lock.

    ::

        int law(int points, const double* gap, const double* properties, double* pressure, double* slope)

    It fills the pressures and their derivatives with respect to the gap (points) and returns 0; any other value ends
    the run with an error.

    Examples
    --------
    >>> import umform as uf
    >>> law = uf.CompiledContactLaw("law", "law.so", properties=(2e4, 0.05), reach=0.05)  # doctest: +SKIP
    """

    function: Annotated[Any, InDeck(Symbol)] = field(compare=False)
    """Name of the function in the library; or its address, a cfunc of numba or a function of ctypes."""
    library: Annotated[str | PathLike[str] | None, replace(IN_FOLDER, needed=True)] = field(default=None, compare=False)
    """Shared library."""
    properties: Numbers = ()
    """Constants of the law, passed on unchanged."""
    reach: Reach = 0.0
    """Largest gap at which there is a pressure; the pressure should be zero there."""
    parallel: bool = True
    """Whether several threads may call it at the same time: it has no static variables."""
    name: str = ""
    """Name in messages and fingerprints of runs; without it, that of the function."""
    content: str = field(default="", init=False)

    def __post_init__(self) -> None:
        check_fields(self)
        put = object.__setattr__
        named = self.function if isinstance(self.function, str) else "compiled contact law"
        put(self, "name", self.name or named)
        put(self, "properties", numbers(self.name, "properties", self.properties))
        if self.library is not None:
            put(self, "content", f"{content(self.library, self.name)} {self.function}")
        function_address(self.function, self.library, self.name, "CompiledContactLaw")

    def kernel(self) -> _core.NormalLaw:
        """The law as the kernels take it."""
        where = function_address(self.function, self.library, self.name, "CompiledContactLaw")
        return _core.compiled_normal_law(where, self.name, list(self.properties), self.reach, self.parallel)

    def called(self, name: str) -> CompiledContactLaw:
        """The same with another name in messages."""
        return replace(self, name=name)


#: A law of either kind.
AnyContactLaw = ContactLaw | CompiledContactLaw


class PressureCheck(float):
    """Largest deviation of a derivative from differences, relative to the largest derivative; itself a float.

    Attributes
    ----------
    jump : float
        Pressure at the reach, relative to the largest of the gaps: a jump of the force at the first touch.
    rises : float
        Largest positive derivative relative to the largest one: there the pressure falls in deeper penetration.
    """

    jump: float
    rises: float

    def __new__(cls, deviation: float, jump: float, rises: float) -> PressureCheck:
        """Make the number and its attributes."""
        check = super().__new__(cls, deviation)
        check.jump, check.rises = jump, rises
        return check

    def __repr__(self) -> str:
        return f"deviation {float(self):.2g}, jump {self.jump:.2g}, rises {self.rises:.2g}"

    __str__ = __repr__


def check_contact_law(law: AnyContactLaw, gaps: ArrayLike, step: float | None = None) -> PressureCheck:
    """Compare the derivative of a contact law with central differences of its pressure.

    Parameters
    ----------
    law : ContactLaw or CompiledContactLaw
        The law.
    gaps : array_like, shape (n,)
        Gaps at which to compare, negative in penetration, within the reach and away from kinks.
    step : float, optional
        Step of the differences; default: 1e-6 of the range of the gaps up to the reach.

    Returns
    -------
    PressureCheck
        The largest deviation relative to the largest derivative, as a float; ``jump`` and ``rises``.

    Raises
    ------
    InvalidValue
        If a gap is not within the reach.

    Examples
    --------
    >>> import umform as uf
    >>> law = uf.ContactLaw(lambda gap: (-3e4 * gap, 0.0 * gap - 3e4))
    >>> check = uf.check_contact_law(law, [-0.02, -0.01])
    >>> bool(check < 1e-7), check.jump, check.rises
    (True, 0.0, 0.0)
    """
    if not isinstance(law, AnyContactLaw):
        raise InvalidValue(
            "a check of a contact law needs a law",
            where="check_contact_law",
            value=type(law).__name__,
            cause="a function, or a class, in place of a law",
            remedy="ContactLaw(function, reach=0.05)",
        )
    at, kernel = np.atleast_1d(np.asarray(gaps, dtype=float)), law.kernel()
    step = 1e-6 * float(law.reach - at.min(initial=0.0)) if step is None else step
    if not at.size or not (at + step <= law.reach).all():
        raise InvalidValue(
            "a contact law is compared at gaps within its reach",
            where="check_contact_law",
            value=f"largest gap {at.max(initial=-np.inf):g}, reach {law.reach:g}",
            cause="penetration is a negative gap",
            remedy="np.linspace(-0.05, -0.001, 20) for a law of reach 0",
        )
    pressure, slope = kernel.pressures(at)
    differences = (kernel.pressures(at + step)[0] - kernel.pressures(at - step)[0]) / (2.0 * step)
    largest = max(float(np.abs(slope).max()), float(np.abs(differences).max()), 1e-300)
    jump = abs(float(kernel.pressures(np.array([law.reach]))[0][0])) / max(float(pressure.max()), 1e-300)
    rises = max(float(slope.max()), 0.0) / largest
    return PressureCheck(float(np.abs(slope - differences).max()) / largest, jump, rises)
