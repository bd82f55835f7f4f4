"""Rigid tools as functions of position: signed distance, unit normal and Hessian of the distance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidValue, NotFinite

Floats = NDArray[np.float64]

#: x (n, 3) -> signed distance (n,), negative inside the tool; normal (n, 3), out of the tool; Hessian (n, 3, 3).
GapFunction = Callable[[Floats], tuple[ArrayLike, ArrayLike, ArrayLike]]

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
Direction = str | tuple[float, float, float]


def unit_vector(direction: Direction, where: str) -> tuple[float, float, float]:
    """Unit vector from "x", "-y", ... or three components."""
    if isinstance(direction, str):
        sign, name = (-1.0, direction[1:]) if direction.startswith("-") else (1.0, direction)
        if name not in _AXES:
            raise InvalidValue("a direction is x, y, z, -x, -y, -z or three numbers", where=where, value=direction)
        direction = (sign * _AXES[name][0], sign * _AXES[name][1], sign * _AXES[name][2])
    vector = np.asarray(direction, dtype=float)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise NotFinite("a direction needs three finite numbers", where=where, value=direction)
    length = float(np.linalg.norm(vector))
    if length == 0.0:
        raise InvalidValue("a direction must not be the zero vector", where=where)
    x, y, z = (float(c) for c in vector / length)
    return x, y, z


def _point(values: ArrayLike, where: str) -> list[float]:
    vector = np.asarray(values, dtype=float)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise NotFinite("a point needs three finite numbers", where=where, value=values)
    return [float(c) for c in vector]


def _radius(value: float, where: str) -> float:
    if not (np.isfinite(value) and value > 0):
        raise InvalidValue("the radius must be positive", where=where, value=value)
    return float(value)


@runtime_checkable
class Surface(Protocol):
    """A rigid tool."""

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""


@dataclass(frozen=True)
class Plane:
    """Half-space behind a plane.

    Parameters
    ----------
    point : tuple of float
        A point of the plane.
    normal : str or tuple of float
        Normal out of the tool, towards the sheet.
    """

    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    normal: Direction = "z"

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.plane(_point(self.point, "Plane.point"), unit_vector(self.normal, "Plane.normal"))


@dataclass(frozen=True)
class Cylinder:
    """Round bar of endless length, or with ``inside`` the space around a bore.

    Parameters
    ----------
    centre : tuple of float
        A point of the axis.
    axis : str or tuple of float
        Direction of the axis.
    radius : float
        Radius.
    inside : bool
        The sheet lies inside of the bore.
    """

    centre: tuple[float, float, float]
    axis: Direction
    radius: float
    inside: bool = False

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.cylinder(
            _point(self.centre, "Cylinder.centre"),
            unit_vector(self.axis, "Cylinder.axis"),
            _radius(self.radius, "Cylinder.radius"),
            self.inside,
        )


@dataclass(frozen=True)
class Sphere:
    """Ball, or with ``inside`` the space around a bowl.

    Parameters
    ----------
    centre : tuple of float
        Centre.
    radius : float
        Radius.
    inside : bool
        The sheet lies inside of the sphere.
    """

    centre: tuple[float, float, float]
    radius: float
    inside: bool = False

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.sphere(_point(self.centre, "Sphere.centre"), _radius(self.radius, "Sphere.radius"), self.inside)


@dataclass(frozen=True)
class UserSurface:
    """A tool from a function of your own.

    Parameters
    ----------
    function : callable
        Takes positions (n, 3) and returns the signed distance (n,), negative inside the tool, the normal (n, 3) out of
        the tool and the Hessian of the distance (n, 3, 3). It is called once for all contact points of a pair. Where
        the function is not a distance but close to one (a scaled level set), gap and pressure are scaled with it.
        :func:`check_surface` compares normal and Hessian with differences.
    name : str
        For messages and reports.
    """

    function: GapFunction
    name: str = "user surface"

    def __call__(self, x: Floats) -> tuple[Floats, Floats, Floats]:
        """Evaluate the function and check what it returns.

        Raises
        ------
        InvalidValue
            If the arrays have other shapes.
        NotFinite
            If one of them holds NaN or infinity.
        """
        answer = self.function(x)
        shapes = ((len(x),), (len(x), 3), (len(x), 3, 3))
        if not isinstance(answer, tuple) or len(answer) != 3:
            raise InvalidValue(
                "a surface function must return three arrays: g, n, H", where=self.name, value=type(answer).__name__
            )
        arrays = []
        for name, shape, values in zip(("g", "n", "H"), shapes, answer, strict=True):
            array = np.ascontiguousarray(values, dtype=float)
            if array.shape != shape:
                raise InvalidValue(
                    f"{name} of a surface function must have shape {shape}", where=self.name, value=array.shape
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

    def kernel(self) -> _core.Surface:
        """The surface as the kernels take it."""
        return _core.surface_from_function(self)


@dataclass(frozen=True)
class SurfaceCheck:
    """Largest deviations of a surface from differences of its own distance.

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
        """Whether normal and Hessian belong to the function."""
        return max(self.normal, self.hessian, self.asymmetry) < tolerance


def check_surface(surface: Surface, x: ArrayLike, step: float) -> SurfaceCheck:
    """Compare the normal and Hessian of a surface with central differences.

    Parameters
    ----------
    surface : Surface
        Any tool.
    x : array_like, shape (n, 3)
        Points where to look, near the surface and away from its edges.
    step : float
        Step of the differences, about 1e-5 of the size of the tool.
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
