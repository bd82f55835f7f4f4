"""Check normal and Hessian of a tool by differences of its distance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.spec import check_arguments
from umform.spec.types import Positive
from umform.surfaces.tool import Surface, check_is_surface

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class SurfaceCheck:
    """Largest deviations of a surface from differences of its distance.

    Attributes
    ----------
    normal, hessian : float
        Normal against differences of g; Hessian (times the length of the step scale) against differences of n.
    gradient_length : float
        Largest deviation of the length of the difference gradient from 1: 0 for a true distance. Where it is not, the
        pressure per penetration is scaled by the square of that length; :meth:`ok` does not look at it.
    asymmetry : float
        Largest deviation of H from its transpose.
    """

    normal: float
    hessian: float
    gradient_length: float
    asymmetry: float

    def ok(self, tolerance: float = 1e-5) -> bool:
        """Whether normal and Hessian are the derivatives of g, also of one that is no distance: see gradient_length."""
        return max(self.normal, self.hessian, self.asymmetry) < tolerance


def differences(
    gap: Callable[[Floats], tuple[Floats, Floats, Floats]], x: Floats, step: float
) -> tuple[Floats, Floats]:
    """Central differences of distance (n, 3) and normal (n, 3, 3) at points (n, 3). eq. (4.20)"""
    dg, dn = np.empty((len(x), 3)), np.empty((len(x), 3, 3))
    for k in range(3):
        shift = step * np.eye(3)[k]
        ahead, behind = gap(x + shift), gap(x - shift)
        dg[:, k] = (ahead[0] - behind[0]) / (2.0 * step)
        dn[:, :, k] = (ahead[1] - behind[1]) / (2.0 * step)
    return dg, dn


def check_surface(surface: Surface, x: ArrayLike, step: Positive) -> SurfaceCheck:
    """Compare the normal and Hessian of a surface with central differences. eq. (4.20)

    Parameters
    ----------
    surface : Surface
        Any tool.
    x : array_like, shape (n, 3)
        Points at which to compare, near the surface and away from its edges.
    step : float
        Step of the differences, about 1e-5 of the size of the tool.

    Examples
    --------
    >>> import umform as uf
    >>> uf.check_surface(uf.Sphere((0, 0, 0), 5), [(0.0, 3.0, 4.5)], step=1e-4).ok(1e-6)
    True
    """
    check_is_surface(surface, "check_surface")
    check_arguments(check_surface, step=step)
    kernel = surface.kernel()
    x = np.ascontiguousarray(x, dtype=float)
    if x.ndim != 2 or x.shape[1] != 3 or not x.size:
        raise InvalidValue(
            "points in space must have shape (n, 3)",
            where="check_surface",
            value=x.shape,
            cause="one point in place of rows, or none",
            remedy="rows of x, y, z: [(0.0, 3.0, 4.5)]",
        )
    _, n, H = kernel.gap(x)
    dg, dn = differences(kernel.gap, x, step)
    size = max(float(np.abs(H).max()), 1e-300)
    return SurfaceCheck(
        normal=float(np.abs(n - dg).max()),
        hessian=float(np.abs(H - dn).max()) / max(size, float(np.abs(dn).max())),
        gradient_length=float(np.abs(np.linalg.norm(dg, axis=1) - 1).max()),
        asymmetry=float(np.abs(H - np.swapaxes(H, 1, 2)).max()) / size,
    )
