"""Tools from functions of the user."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidValue, NotFinite
from umform.surfaces.sampled import sampled
from umform.surfaces.tool import Tool
from umform.surfaces.triangles import Triangles

Floats = NDArray[np.float64]

#: x (n, 3) -> signed distance (n,), negative inside the tool; normal (n, 3), out of the tool; Hessian (n, 3, 3).
GapFunction = Callable[[Floats], tuple[ArrayLike, ArrayLike, ArrayLike]]


@dataclass(frozen=True)
class UserSurface(Tool):
    """A tool from a Python function.

    Parameters
    ----------
    function : callable
        Takes positions (n, 3) and returns the signed distance (n,), negative inside the tool, the normal (n, 3) out of
        the tool and the Hessian of the distance (n, 3, 3). It is called once for all contact points of a pair. A level
        set that is no distance returns its gradient, not normalised, and its own Hessian: the gap is scaled by the
        length of the gradient, the pressure per penetration by the square. A contact compares normal and Hessian with
        differences beside the sheet, :func:`check_surface` at any points.
    name : str
        For messages and reports.

    Examples
    --------
    >>> import numpy as np
    >>> import umform as uf
    >>> def wall(x):
    ...     return x[:, 0], np.tile([1.0, 0.0, 0.0], (len(x), 1)), np.zeros((len(x), 3, 3))
    >>> uf.check_surface(uf.UserSurface(wall, name="wall"), [(0.3, 0.2, 0.1)], step=1e-4).ok(1e-6)
    True
    """

    function: GapFunction
    name: str = "user surface"

    def __post_init__(self) -> None:
        if not callable(self.function):
            raise InvalidValue(
                "a surface of one's own is a function of positions",
                where="UserSurface",
                value=type(self.function).__name__,
                cause="what the function returns, or a surface of the catalogue",
                remedy="UserSurface(function), which returns distance, normal and Hessian",
            )

    def __call__(self, x: Floats) -> tuple[Floats, Floats, Floats]:
        """Evaluate the function and check what it returns.

        Raises
        ------
        InvalidValue
            If the arrays have other shapes.
        NotFinite
            If one of them holds NaN or infinity.
        """
        try:
            answer = self.function(x)
        except Exception as error:
            error.add_note(
                f"in the surface {self.name!r}, called as surface(x) with x (n, 3) -> distance (n,), normal (n, 3), "
                "Hessian (n, 3, 3)"
            )
            raise
        shapes = ((len(x),), (len(x), 3), (len(x), 3, 3))
        if not isinstance(answer, tuple) or len(answer) != 3:
            raise InvalidValue(
                "a surface function must return three arrays: g, n, H",
                where=self.name,
                value=type(answer).__name__,
                cause="only the distance is returned, or an array of all",
                remedy="return g, n, H: distance (n,), normal (n, 3), Hessian of the distance (n, 3, 3)",
            )
        arrays = []
        for name, shape, values in zip(("g", "n", "H"), shapes, answer, strict=True):
            array = np.ascontiguousarray(values, dtype=float)
            if array.shape != shape:
                raise InvalidValue(
                    f"{name} of a surface function must have shape {shape}",
                    where=self.name,
                    value=array.shape,
                    cause="a constant that was not repeated for each point, or points as columns",
                    remedy="np.broadcast_to repeats a constant",
                )
            if not np.isfinite(array).all():
                at = int(np.argwhere(~np.isfinite(array))[0][0])
                raise NotFinite(
                    f"{name} of a surface function is not finite",
                    where=f"{self.name} at x = {x[at]}",
                    cause="a square root or division outside of its domain",
                    remedy="make the function smooth around the tool, inside of it too",
                )
            arrays.append(array)
        return arrays[0], arrays[1], arrays[2]

    def facets(self, centre: Floats, reach: float, chord: float) -> Triangles:
        """Triangles from samples of the function, which may return NaN away from the tool."""
        return sampled(self.function, centre, reach, chord)

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.surface_from_function(self)
