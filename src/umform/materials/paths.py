"""A material point under prescribed strains and stresses: tension at an angle, cyclic shear, changes of strain path."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from umform import _core
from umform.errors import InvalidValue, NoConvergence
from umform.history_variables import named
from umform.materials.material import Material
from umform.materials.user_law import Floats

#: Place of each entry of a tensor in Voigt order, and rows and columns of each place.
_TENSOR = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
_PAIRS = (np.array([0, 1, 2, 0, 1, 0]), np.array([0, 1, 2, 1, 2, 2]))


class SmallStrainLaw(Protocol):
    """Interface of a material with a small-strain law."""

    def small_strain_law(self) -> _core.Material:
        """The law of logarithmic strains."""


#: A law of logarithmic strains, or of the Green-Lagrange strain.
AnyLaw = SmallStrainLaw | Material


@dataclass(frozen=True)
class PointPath:
    """States of a point along its path, one row for each prescribed row.

    Attributes
    ----------
    strain, stress : ndarray, shape (n, 6)
        Logarithmic strain (engineering shears) and its conjugate stress in the axes of the test.
    history : mapping of str to ndarray, shape (n, size)
        History of the law by name.
    """

    strain: Floats
    stress: Floats
    history: Mapping[str, Floats]


def point_path(
    material: AnyLaw,
    strain: ArrayLike,
    stress: ArrayLike,
    angle: float = 0.0,
    *,
    time: ArrayLike | None = None,
) -> PointPath:
    """Integrate a law along a path; for each component either the strain or the stress is prescribed.

    Parameters
    ----------
    material : Material
        Any law. One of the Green-Lagrange strain, such as J2, gets this strain, and its stress is converted to the one
        conjugate to logarithmic strains; a UserLaw is a law of the strain that it gets.
    strain : array_like, shape (n, 6)
        Logarithmic strains 11, 22, 33, 12, 23, 13 with engineering shears; NaN where the stress is prescribed.
    stress : array_like, shape (n, 6)
        Stresses of the other components.
    angle : float
        Degrees from the rolling direction to axis 1 of the test, about the normal of the sheet.
    time : array_like, shape (n,), optional
        When each row is reached, from 0 on, for a metal with a rate.

    Returns
    -------
    PointPath
        The state at each row. The first row is reached from the virgin state.

    Raises
    ------
    NoConvergence
        If a prescribed stress cannot be reached.
    """
    wanted, given = np.array(strain, dtype=float), np.array(stress, dtype=float)
    if wanted.ndim != 2 or wanted.shape[1] != 6 or wanted.shape != given.shape:
        raise InvalidValue(
            "a path has six strains and six stresses in each row",
            where="point_path",
            value=f"strain {wanted.shape}, stress {given.shape}",
            cause="components that were left out",
            remedy="NaN in strain where the stress is prescribed",
        )
    unknown = ~np.isfinite(np.where(np.isnan(wanted), given, wanted)).all(axis=1)
    if unknown.any():
        row = int(np.argmax(unknown))
        raise InvalidValue(
            "each component of a path has a finite strain or a finite stress",
            where=f"point_path, row {row}",
            value=f"strain {wanted[row].tolist()}, stress {given[row].tolist()}",
            cause="NaN in both, or a gap in measured data",
            remedy="NaN in strain where the stress is prescribed, and the stress there",
        )
    steps = _durations(material, time, len(wanted))
    law, finite = _law(material)
    turn = _turned(math.radians(angle))
    strains, stresses, states = law.lead(turn, wanted, given, steps, finite)
    if (number := len(strains)) < len(wanted):
        raise NoConvergence(
            "a state of the path cannot be reached",
            where=f"row {number}",
            value=np.where(np.isnan(wanted[number]), given[number], wanted[number]).tolist(),
            cause="a stress beyond what the metal can carry",
            remedy="prescribe the strain along the load",
        )
    return PointPath(strains, stresses, named(states, law.history_variables))


def tension(
    material: AnyLaw,
    strains: ArrayLike,
    angle: float = 0.0,
    *,
    component: int = 0,
    time: ArrayLike | None = None,
) -> tuple[Floats, Floats, Floats]:
    """A bar under prescribed logarithmic strains, or simple shear.

    Parameters
    ----------
    material : Material
        Any law: Metal, J2, an elastic one. A UserLaw is taken as one of the strain that it gets: of one in
        Green-Lagrange strain these are Green-Lagrange strains and second Piola-Kirchhoff stresses.
    strains : array_like, shape (n,)
        Logarithmic strains, one after the other.
    angle : float
        Degrees from the rolling direction to the bar.
    component : int
        0 to 2 for tension along axis 1 to 3; 3 for simple shear in the plane of the sheet.
    time : array_like, shape (n,), optional
        When each strain is reached, from 0 on, for a metal with a rate.

    Returns
    -------
    strain, stress : ndarray, shape (n,)
        Prescribed component of the logarithmic strain, and its conjugate stress.
    plastic : ndarray, shape (n, 6)
        Plastic strain in the axes of the test, engineering shears: the part ``plastic_strain`` of the history, or of J2
        that of its plastic metric; NaN without either.

    Raises
    ------
    InvalidValue
        If the material is no law.

    Examples
    --------
    >>> import umform as uf
    >>> steel = uf.Metal(206e3, 0.3, hardening=uf.Linear(200.0, 500.0))
    >>> strain, stress, plastic = uf.materials.tension(steel, [0.01, 0.02])
    >>> stress.shape, plastic.shape
    ((2,), (2, 6))
    """
    along = np.asarray(strains, dtype=float)
    if along.ndim != 1 or not np.isfinite(along).all():
        raise InvalidValue(
            "a bar has finite strains, one after the other",
            where="tension",
            value=strains,
            cause="a gap in measured data, or a single strain",
            remedy="a list of numbers",
        )
    if component not in range(6):
        raise InvalidValue(
            "a component is a place in 11, 22, 33, 12, 23, 13",
            where="tension, component",
            value=component,
            cause="a place that is counted from 1, or from the end",
            remedy="0 for tension along axis 1, 3 for shear in the plane of the sheet",
        )
    path = np.full((len(along), 6), np.nan)
    path[:, component] = along
    found = point_path(material, path, np.zeros_like(path), angle, time=time)
    plastic = _plastic_strain(found) @ _turned(-math.radians(angle)).T
    return found.strain[:, component], found.stress[:, component], plastic


def _law(material: AnyLaw) -> tuple[_core.Material, bool]:
    """The law of a material, and whether it is one of the Green-Lagrange strain."""
    small, finite = getattr(material, "small_strain_law", None), isinstance(material, Material)
    if isinstance(material, type) or not (callable(small) or finite):
        raise InvalidValue(
            "a path needs a law",
            where="point_path",
            value=material if isinstance(material, type) else type(material).__name__,
            cause="a class in place of a law, or a metal of the library",
            remedy="Metal(E, nu, hardening=...), or metal.law of a metal of the library",
        )
    made: _core.Material = small() if callable(small) else material.law()  # type: ignore[union-attr]
    return made, not callable(small)


def _plastic_strain(found: PointPath) -> Floats:
    """The part of the history called plastic_strain, or -ln(Cp^-1) / 2, shape (n, 6); NaN if a law has neither."""
    none = np.full_like(found.strain, np.nan)
    metric = found.history.get("Cp_inv")
    if metric is not None and metric.shape == none.shape:
        values, vectors = np.linalg.eigh(metric[:, _TENSOR])
        logarithm = (vectors * (-0.5 * np.log(values))[:, None, :]) @ np.swapaxes(vectors, 1, 2)
        strain: Floats = logarithm[:, _PAIRS[0], _PAIRS[1]] * np.where(np.arange(6) < 3, 1.0, 2.0)
        return strain
    plastic = found.history.get("plastic_strain", none)
    return plastic if plastic.shape == none.shape else none


def _durations(material: AnyLaw, time: ArrayLike | None, rows: int) -> Floats:
    """Time from each row to the next, shape (rows,)."""
    if time is None:
        if getattr(material, "rate", None) is not None:
            raise InvalidValue(
                "a metal with a rate needs the times of its path",
                where="point_path",
                value=getattr(material, "rate", None),
                cause="a path without time",
                remedy="time= when each row is reached, rising from above 0",
            )
        return np.zeros(rows)
    steps = np.diff(np.asarray(time, dtype=float), prepend=0.0)
    if steps.shape != (rows,) or not (steps > 0).all():
        raise InvalidValue(
            "times of a path must rise, one for each row",
            where="point_path",
            value=time,
            cause="a first time of zero, or times of another number",
            remedy="time= when each row is reached, rising from above 0",
        )
    return steps


def _turned(angle: float) -> Floats:
    """Strain in the axes of the sheet from that in axes rotated about its normal, engineering shears."""
    c, s = math.cos(angle), math.sin(angle)
    turn = np.eye(6)
    turn[np.ix_([0, 1, 3], [0, 1, 3])] = [
        [c * c, s * s, -c * s],
        [s * s, c * c, c * s],
        [2 * c * s, -2 * c * s, c * c - s * s],
    ]
    turn[np.ix_([4, 5], [4, 5])] = [[c, s], [-s, c]]
    return turn
