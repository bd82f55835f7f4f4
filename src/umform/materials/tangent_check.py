"""Compare the tangent of a law with finite differences of its stress."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from umform.errors import InvalidValue
from umform.materials.material import Material, check_material
from umform.materials.user_law import Floats, UserLaw


class TangentCheck(float):
    """Largest deviation of a tangent from finite differences, relative to its largest entry; itself a float.

    Attributes
    ----------
    asymmetry : float
        Largest entry of CC - CC^T relative to that of CC. Beyond round-off the law needs ``UserLaw(symmetric=False)``.
    """

    asymmetry: float

    def __new__(cls, deviation: float, asymmetry: float) -> TangentCheck:
        """Make the number and its attribute."""
        check = super().__new__(cls, deviation)
        check.asymmetry = asymmetry
        return check

    def __repr__(self) -> str:
        return f"deviation {float(self):.2g}, asymmetry {self.asymmetry:.2g}"

    __str__ = __repr__


def check_law(
    material: Material,
    E: ArrayLike,
    state: ArrayLike | None = None,
    step: float = 1e-6,
    *,
    time_step: float = 1.0,
    size: float = 1.0,
    axes: ArrayLike | None = None,
) -> TangentCheck:
    """Compare the tangent of a law with central differences, and with its transpose.

    Parameters
    ----------
    material : Material
        Any law.
    E : array_like, shape (n, 6)
        Strains at which to compare, away from kinks such as first yield.
    state : array_like, shape (n, size), optional
        Converged history; default that of the virgin material.
    step : float
        Step of the differences.
    time_step, size : float
        Increment of time and length of the cell, for a law that depends on them: :class:`umform.materials.Points`.
    axes : array_like, shape (3, 3), optional
        Axes of the points; default: the global ones.

    Returns
    -------
    TangentCheck
        The largest deviation from finite differences relative to the largest entry, as a float; and ``asymmetry``.

    Examples
    --------
    >>> import umform as uf
    >>> look = uf.check_law(uf.SVK(E=210e3, nu=0.3), [[1e-3, 0.0, 0.0, 2e-3, 0.0, 0.0]])
    >>> look < 1e-8, look.asymmetry < 1e-12
    (True, True)
    """
    check_material(material, "check_law")
    if isinstance(material, UserLaw):
        material = replace(material, symmetric=False)  # allow an asymmetric tangent, to measure its asymmetry
    law = material.law()
    E = np.ascontiguousarray(E, dtype=float)
    if E.ndim != 2 or E.shape[1] != 6 or not E.size:
        raise InvalidValue(
            "strains at points must have shape (n, 6)",
            where="check_law",
            value=E.shape,
            cause="one strain in place of rows, tensors of 3 x 3, or none",
            remedy="rows of 11 22 33 12 23 13: [[1e-3, 0.0, 0.0, 2e-3, 0.0, 0.0]]",
        )
    frame = None if axes is None else np.ascontiguousarray(axes, dtype=float)
    history = np.tile(law.initial(), (len(E), 1)) if state is None else np.ascontiguousarray(state, dtype=float)
    sizes, shape = (len(E), law.state_size), np.shape(history)
    if shape != sizes:
        raise InvalidValue(
            f"the history of the points must have shape {sizes}",
            where="check_law",
            value=shape,
            cause="another number of points than of strains, or of the numbers of a history",
            remedy=f"one row for each strain with {law.history_variables}; without state: the virgin material",
        )

    def respond(strain: Floats) -> tuple[Floats, Floats, Floats]:
        return law.respond(strain, history, frame, size, time_step)

    _, CC, _ = respond(E)
    differences = np.empty_like(CC)
    for k in range(6):
        shift = np.zeros(6)
        shift[k] = step
        differences[:, :, k] = (respond(E + shift)[0] - respond(E - shift)[0]) / (2 * step)
    largest = np.abs(CC).max()
    asymmetry = np.abs(CC - CC.transpose(0, 2, 1)).max() / largest
    return TangentCheck(float(np.abs(CC - differences).max() / largest), float(asymmetry))
