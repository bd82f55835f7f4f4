"""A tool of the user beside the sheet, before use: normal and Hessian against differences. eq. (4.20)"""

from __future__ import annotations

import logging
import math

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, UmformError
from umform.surfaces.check import differences
from umform.surfaces.user import UserSurface

Floats = NDArray[np.float64]

log = logging.getLogger("umform.contact")

#: Number of points, those of the sheet nearest to the tool. Medians over them ignore the edges of a tool.
_POINTS = 16
#: Step of the differences, in thicknesses of the sheet.
_STEP = 1e-4
#: Smallest cosine between normal and gradient, largest relative deviation of both, and of Hessian and differences.
_COSINE, _DEVIATION = 0.99, 0.01
#: Curvature times thickness below which a Hessian has no effect.
_FLAT = 1e-4
_REMEDY = "umform.check_surface(surface, points, step) compares all points; return g, its gradient and its Hessian"


def check_beside(surface: UserSurface, corners: Floats, thickness: float, where: str) -> None:
    """Compare normal and Hessian with differences at the points of the sheet nearest to the tool.

    Parameters
    ----------
    surface : UserSurface
        The tool.
    corners : ndarray, shape (facets, 4, 3)
        Corners of the facets that may touch it.
    thickness : float
        Thickness of the sheet.
    where : str
        Place, for messages.

    Raises
    ------
    InvalidValue
        If the normal does not have the direction of the gradient: the forces would be wrong.
    """
    try:
        x = _nearest(surface, corners)
        _, n, H = surface(x)
        dg, dn = differences(surface, x, _STEP * thickness)
    except UmformError:  # not defined beside the sheet: the run says so, should a point come there
        return
    lengths = np.linalg.norm(n, axis=1) * np.linalg.norm(dg, axis=1)
    cosine = float(np.median(np.einsum("ik,ik->i", n, dg) / np.maximum(lengths, 1e-300)))
    where = f"{where}, {surface.name}"
    if cosine < _COSINE:
        raise InvalidValue(
            "the normal of a user surface is not the gradient of its distance",
            where=where,
            value=f"median of the cosine between them {cosine:.3g} at the points of the sheet nearest to it",
            cause="a normal into the tool, or a distance that is positive inside" if cosine < 0.0 else "a wrong normal",
            remedy=_REMEDY,
        )
    deviation = float(np.median(np.linalg.norm(n - dg, axis=1) / np.linalg.norm(dg, axis=1)))
    if deviation > _DEVIATION:
        log.warning(
            "%s: the normal of the tool deviates from the gradient of its distance by %.2g: forces do not balance the "
            "energy of contact; %s",
            where, deviation, _REMEDY,
        )  # fmt: skip
    sizes = [np.linalg.norm(values, axis=(1, 2)) for values in (H, dn, H - dn)]
    largest = np.maximum(np.maximum(sizes[0], sizes[1]), _FLAT / thickness)
    deviation = float(np.median(sizes[2] / largest))
    if deviation > _DEVIATION:
        log.warning(
            "%s: the Hessian of the tool deviates from differences of its normal by %.2g: slow convergence, and a "
            "default penalty for another radius; %s",
            where, deviation, _REMEDY,
        )  # fmt: skip


def _nearest(surface: UserSurface, corners: Floats) -> Floats:
    """Points of the facets that are nearest to the tool, shape (n, 3)."""
    a = 1.0 / math.sqrt(3.0)
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    N = 0.25 * np.array([[(1 + a * r * p) * (1 + a * s * q) for p, q in signs] for r, s in signs])
    x = np.ascontiguousarray(np.einsum("qa,eak->eqk", N, corners).reshape(-1, 3))
    gap = np.abs(surface(x)[0])
    return np.ascontiguousarray(x[np.argsort(gap, kind="stable")[:_POINTS]])
