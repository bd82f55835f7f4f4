"""Forming limit curves: the largest major strain over the minor one; Keeler and Brazier, a table, or any function."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.materials import Metal, Plastic
from umform.materials.checks import check_finite
from umform.sheet_metals.tensile_test import necking_strain
from umform.sheet_metals.tension_test import tension_test

Floats = NDArray[np.float64]

#: Largest major strain of minor ones, both logarithmic.
FormingLimit = Callable[[Floats], Floats]

#: Thickness in mm beyond which the curve of Keeler and Brazier does not rise any more, and the largest n that counts.
_THICKEST, _LARGEST_N = 3.1, 0.21
#: Logarithmic strain that no sheet reaches before it tears; a table in per cent exceeds it.
LARGEST_STRAIN = 3.0


@dataclass(frozen=True)
class KeelerBrazier:
    """Forming limit of low-carbon steels from thickness and hardening exponent. eqs. (5.63), (5.64)

    Parameters
    ----------
    thickness : float
        Of the undeformed sheet, in mm.
    n : float
        Hardening exponent; more than 0.21 counts as 0.21.
    """

    thickness: float
    n: float

    def __post_init__(self) -> None:
        check_finite("KeelerBrazier", thickness=self.thickness, n=self.n)
        for name in ("thickness", "n"):
            if not getattr(self, name) > 0:
                raise InvalidValue(
                    f"{name} must be positive",
                    where="KeelerBrazier",
                    value=getattr(self, name),
                    cause="a sign, or a metal that does not harden",
                    remedy="thickness in mm, and n of about 0.1 to 0.25; a table for other metals",
                )

    @classmethod
    def of(cls, thickness: float, material: Plastic) -> KeelerBrazier:
        """The curve of a metal: n is the true plastic strain at which slope and stress are equal in tension."""
        return cls(thickness, _necking_strain(material))

    @property
    def plane_strain(self) -> float:
        """Largest major strain without a minor one, logarithmic."""
        percent = (23.3 + 14.13 * min(self.thickness, _THICKEST)) * min(self.n, _LARGEST_N) / _LARGEST_N
        return float(np.log1p(percent / 100.0))

    def __call__(self, minor: Floats) -> Floats:
        """Largest major strain, logarithmic."""
        left = self.plane_strain - minor
        percent = 100.0 * np.expm1(np.maximum(minor, 0.0))
        right = 100.0 * np.expm1(self.plane_strain) + percent * (0.784854 - 0.008565 * percent)
        limit: Floats = np.where(minor < 0.0, left, np.log1p(right / 100.0))
        return limit


def _necking_strain(law: Plastic) -> float:
    """True plastic strain at which a tensile bar necks."""
    if getattr(law, "back_stress", None) is not None:  # which hardens the bar too
        test = tension_test(cast(Metal, law))
        stretch = 1.0 + test.uniform_elongation + test.tensile_strength / law.E
        return max(math.log(stretch) - test.tensile_strength * stretch / law.E, 1e-3)
    return max(necking_strain(law.hardening), 1e-3)


@dataclass(frozen=True)
class LimitTable:
    """Forming limit through points of a test, straight between them and as at its ends beyond them.

    Parameters
    ----------
    minor, major : array_like, shape (n,)
        Logarithmic strains; minor strains in ascending order.
    """

    minor: ArrayLike
    major: ArrayLike
    _points: Floats = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        try:
            points = np.array([self.minor, self.major], dtype=float)
        except ValueError:
            points = np.empty((0, 0))
        if points.ndim != 2 or points.shape[1] < 2 or not np.isfinite(points).all() or (np.diff(points[0]) <= 0).any():
            raise InvalidValue(
                "a table of forming limits has as many minor as major strains, at least two, the minor ones ascending",
                where="LimitTable",
                value=f"minor {self.minor!r}, major {self.major!r}",
                cause="strains that are not sorted, or a value that is missing",
                remedy="LimitTable(minor=[-0.2, 0, 0.2], major=[0.5, 0.3, 0.4])",
            )
        if abs(points).max() > LARGEST_STRAIN:
            raise InvalidValue(
                "the strains of a forming limit are logarithmic",
                where="LimitTable",
                value=f"up to {abs(points).max():.4g}",
                cause="per cent",
                remedy="0.262 = ln(1.3) for an elongation of 30 %",
            )
        object.__setattr__(self, "_points", points)

    def __call__(self, minor: Floats) -> Floats:
        """Largest major strain, logarithmic."""
        limit: Floats = np.interp(minor, *self._points)
        return limit


def limit_margin(limit: FormingLimit, major: Floats, minor: Floats) -> Floats:
    """Strain that is left up to the limit, at the same minor strain: negative beyond it.

    Parameters
    ----------
    limit : callable
        Largest major strain for an array of minor ones.
    major, minor : ndarray, shape (n,)
        Logarithmic strains.

    Returns
    -------
    ndarray, shape (n,)
    """
    allowed = np.asarray(limit(minor), dtype=float)
    if allowed.shape != major.shape:
        raise InvalidValue(
            "a forming limit returns one major strain for each minor one",
            where="limit",
            value=f"shape {allowed.shape} for {minor.shape}",
            remedy="a function of an array, such as lambda minor: 0.3 + 0.5 * abs(minor)",
        )
    return allowed - major
