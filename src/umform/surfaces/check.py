"""Check normal and Hessian of a tool by differences of its distance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from umform.surfaces.tool import Surface


@dataclass(frozen=True)
class SurfaceCheck:
    """Largest deviations of a surface from differences of its distance.

    Attributes
    ----------
    normal, hessian : float
        Normal against differences of g; Hessian (times the length of the step scale) against differences of n.
    gradient_length : float
        Largest deviation of the length of the difference gradient from 1: 0 for a true distance.
    asymmetry : float
        Largest deviation of H from its transpose.
    """

    normal: float
    hessian: float
    gradient_length: float
    asymmetry: float

    def ok(self, tolerance: float = 1e-5) -> bool:
        """Whether normal and Hessian are derivatives of the distance."""
        return max(self.normal, self.hessian, self.asymmetry) < tolerance


def check_surface(surface: Surface, x: ArrayLike, step: float) -> SurfaceCheck:
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
    kernel = surface.kernel()
    x = np.ascontiguousarray(x, dtype=float)
    _, n, H = kernel.gap(x)
    dg, dn = np.empty_like(n), np.empty_like(H)
    for k in range(3):
        shift = np.zeros(3)
        shift[k] = step
        ahead, behind = kernel.gap(x + shift), kernel.gap(x - shift)
        dg[:, k] = (ahead[0] - behind[0]) / (2 * step)
        dn[:, :, k] = (ahead[1] - behind[1]) / (2 * step)
    size = max(float(np.abs(H).max()), 1e-300)
    return SurfaceCheck(
        normal=float(np.abs(n - dg).max()),
        hessian=float(np.abs(H - dn).max()) / max(size, float(np.abs(dn).max())),
        gradient_length=float(np.abs(np.linalg.norm(dg, axis=1) - 1).max()),
        asymmetry=float(np.abs(H - np.swapaxes(H, 1, 2)).max()) / size,
    )
