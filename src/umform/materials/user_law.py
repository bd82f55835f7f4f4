"""A material law from a function of your own, and its finite-difference check."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidValue, NotFinite
from umform.materials.laws import Material

Floats = NDArray[np.float64]

#: Strain E (n, 6) and history (n, size) -> stress S (n, 6), tangent CC (n, 6, 6), new history (n, size).
LawFunction = Callable[[Floats, Floats], tuple[ArrayLike, ArrayLike, ArrayLike]]

#: Strain E (n, 6) and the history (n, size) that belongs to it -> elastic energy (n,), plastic work (n,).
EnergyFunction = Callable[[Floats, Floats], tuple[ArrayLike, ArrayLike]]


@dataclass(frozen=True)
class UserLaw:
    """A material law from a Python function: slow (one call for each element), but ten lines to a first result.

    Parameters
    ----------
    function : callable
        Takes the Green-Lagrange strain (n, 6) in the local orthonormal frame (Voigt 11 22 33 12 23 13, engineering
        shears) and the converged history (n, size), which it must not change; returns the second Piola-Kirchhoff stress
        (n, 6), the tangent dS/dE (n, 6, 6) and the new history (n, size). :func:`check_law` compares the tangent with
        differences.
    initial : tuple of float
        History of the virgin material; its length is the size of the history.
    thickness_points : int
        Default number of points through the thickness.
    name : str
        For messages.
    energy : callable, optional
        Takes strain and history like ``function``, but the history that a converged step has left behind, and returns
        energies per reference volume: what can be had back from the strain (n,), and what has been spent so far (n,).
        Without it the energies of a run are not known, and are NaN.
    """

    function: LawFunction
    initial: tuple[float, ...] = ()
    thickness_points: int = 2
    name: str = "user law"
    energy: EnergyFunction | None = None

    def __call__(self, E: Floats, state: Floats) -> tuple[Floats, Floats, Floats]:
        """Evaluate the function and check what it returns.

        Raises
        ------
        InvalidValue
            If the arrays have other shapes.
        NotFinite
            If one of them holds NaN or infinity.
        """
        answer = self.function(E, state)
        if not isinstance(answer, tuple) or len(answer) != 3:
            raise InvalidValue("a law must return three arrays: S, CC, state", where=self.name, value=type(answer))
        S, CC, new = answer
        return (
            self._checked("S", S, (len(E), 6)),
            self._checked("CC", CC, (len(E), 6, 6)),
            self._checked("state", new, (len(E), len(self.initial))),
        )

    def _energies(self, E: Floats, state: Floats) -> tuple[Floats, Floats]:
        """Evaluate the energy function and check what it returns."""
        assert self.energy is not None
        answer = self.energy(E, state)
        if not isinstance(answer, tuple) or len(answer) != 2:
            raise InvalidValue(
                "the energy function of a law must return two arrays: elastic, plastic",
                where=self.name,
                value=type(answer),
                remedy="an elastic law has no plastic work: return np.zeros(len(E)) for it",
            )
        elastic, plastic = answer
        return (
            self._checked("elastic energy", elastic, (len(E),)),
            self._checked("plastic work", plastic, (len(E),)),
        )

    def _checked(self, name: str, values: ArrayLike, shape: tuple[int, ...]) -> Floats:
        array = np.ascontiguousarray(values, dtype=float)
        if array.shape != shape:
            raise InvalidValue(f"{name} of a law must have shape {shape}", where=self.name, value=array.shape)
        if not np.isfinite(array).all():
            raise NotFinite(
                f"{name} of a law is not finite",
                where=self.name,
                cause="a root or logarithm outside of its domain: the strain has become too large",
                remedy="take smaller steps, or widen the domain of the law",
            )
        return array

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        energies = None if self.energy is None else self._energies
        return _core.material_from_function(self, list(self.initial), energies)


def check_law(material: Material, E: ArrayLike, state: ArrayLike | None = None, step: float = 1e-6) -> float:
    """Largest deviation of the tangent of a law from central differences, relative to its largest entry.

    Parameters
    ----------
    material : Material
        Any law.
    E : array_like, shape (n, 6)
        Strains where to look, away from kinks such as first yield.
    state : array_like, shape (n, size), optional
        Converged history; default that of the virgin material.
    step : float
        Step of the differences.
    """
    law = material.law()
    E = np.ascontiguousarray(E, dtype=float)
    history = np.tile(law.initial(), (len(E), 1)) if state is None else np.ascontiguousarray(state, dtype=float)
    _, CC, _ = law.respond(E, history)
    differences = np.empty_like(CC)
    for k in range(6):
        shift = np.zeros(6)
        shift[k] = step
        differences[:, :, k] = (law.respond(E + shift, history)[0] - law.respond(E - shift, history)[0]) / (2 * step)
    return float(np.abs(CC - differences).max() / np.abs(CC).max())
