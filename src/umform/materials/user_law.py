"""A material law from a Python function."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidValue, NotFinite, UmformError

Floats = NDArray[np.float64]

#: Strain E (n, 6), history (n, size) and, if it takes three arguments, the :class:`Points` ->
#: stress S (n, 6), tangent CC (n, 6, 6), new history (n, size).
LawFunction = Callable[..., tuple[ArrayLike, ArrayLike, ArrayLike]]

#: Strain E (n, 6) and the converged history (n, size) at that strain -> elastic energy (n,), plastic work (n,).
EnergyFunction = Callable[[Floats, Floats], tuple[ArrayLike, ArrayLike]]

#: Asymmetry of a tangent, relative to its largest entry, that counts as round-off.
SYMMETRY = 1e-9


@dataclass(frozen=True)
class Points:
    """Geometry of the points of a cell, for laws that depend on it.

    Attributes
    ----------
    axes : ndarray, shape (n, 3, 3)
        Rows: base vectors e_1, e_2, e_3 of the local frame in global components. e_3 is normal to the sheet. e_1 lies
        along the rolling direction of the model, if it has one, else along G_1, which follows the mesh's numbering.
    size : float
        Length of the cell: root of the area of its undeformed mid-surface.
    step : float
        Increment of time; 0 at the start of a run, and where fields are read at the converged strain and history, which
        must give the converged stress.
    """

    axes: Floats
    size: float
    step: float


def named_parts(history: Mapping[str, Floats], state: Mapping[str, int]) -> dict[str, Floats]:
    """Parts of a history that fields show, by name; the plastic strain has its own fields."""
    return {name: history[name] for name in state if name != "eqps"}


@dataclass(frozen=True)
class UserLaw:
    """A material law from a Python function: slow (one call for all points of each element), but quick to write.

    NaN in stress or tangent says that the law has no answer at that strain and cuts the increment; an exception ends
    the run, with the law and the cell in its notes. :class:`LogarithmicSpace` makes a small-strain law one of finite
    strain.

    Parameters
    ----------
    function : callable
        Takes the Green-Lagrange strain (n, 6) in the local orthonormal frame (Voigt 11 22 33 12 23 13, engineering
        shears) and the converged history (n, size), which it must not change; returns the second Piola-Kirchhoff stress
        (n, 6), the tangent dS/dE (n, 6, 6) and the new history (n, size). :func:`check_law` compares the tangent with
        differences. A function of three arguments gets the :class:`Points` too: axes, size, step.
    initial : tuple of float
        History of the virgin material; its length is the size of the history.
    thickness_points : int, optional
        Default number of Gauss points through the thickness. Without it a law with a history counts as plastic: the
        points and the complete order of the element for plastic laws, mostly staggered points; one without has 2.
    name : str
        For messages.
    energy : callable, optional
        Takes strain and history like ``function``, but with the history of the converged step at that strain; returns
        energies per reference volume: the recoverable energy (n,) and the dissipated work so far (n,). Without it the
        energies of a run are NaN.
    symmetric : bool
        Whether the tangent is symmetric at any strain; an asymmetric one then raises an error. With False the solver
        stores and factorises the full matrix.
    state : mapping of str to int, optional
        Parts of the history by name and size, in their order: ``{"alpha": 6, "eqps": 1}``. They name the fields;
        ``eqps`` is the accumulated plastic strain. Without ``initial`` the history of the virgin material is zero;
        without names the whole history is called ``history``.

    Raises
    ------
    InvalidValue
        If the names do not have the size of the initial history.

    Examples
    --------
    >>> import numpy as np
    >>> import umform as uf
    >>> C = np.diag([210.0, 210.0, 210.0, 105.0, 105.0, 105.0])
    >>> def springs(E, state):
    ...     return E @ C, np.broadcast_to(C, (len(E), 6, 6)), state
    >>> law = uf.UserLaw(springs, name="springs")
    >>> uf.check_law(law, np.full((1, 6), 1e-3)) < 1e-6
    True
    """

    function: LawFunction
    initial: tuple[float, ...] = ()
    thickness_points: int | None = None
    name: str = "user law"
    energy: EnergyFunction | None = None
    symmetric: bool = True
    state: Mapping[str, int] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        if not callable(self.function):
            raise InvalidValue(
                "a law of one's own is a function of strain and history",
                where="UserLaw",
                value=type(self.function).__name__,
                cause="what the function returns, or a law",
                remedy="UserLaw(function), which returns stress, tangent and new history",
            )
        points = self.thickness_points
        if points is not None and (isinstance(points, bool) or not isinstance(points, int) or points < 1):
            raise InvalidValue(
                "thickness_points is a whole number",
                where=self.name,
                value=points,
                cause="a fraction, or a sign",
                remedy="a number such as 5, or leave it out",
            )
        initial = tuple(float(value) for value in self.initial)
        named = isinstance(self.state, Mapping)
        sizes = list(self.state.values()) if named else []
        if not named or any(isinstance(size, bool) or not isinstance(size, int) or size < 1 for size in sizes):
            raise InvalidValue(
                "parts of a history have one number or more",
                where=self.name,
                value=self.state,
                cause="names without sizes, or a size that is no whole number",
                remedy='state={"alpha": 6, "eqps": 1}',
            )
        state = dict(self.state) or ({"history": len(initial)} if initial else {})
        size = sum(state.values())
        if initial and len(initial) != size:
            raise InvalidValue(
                "the names of a history must have the size of its initial values",
                where=self.name,
                value=f"{state}, {len(initial)} initial values",
                cause="a part is missing, or a symmetric tensor was counted as nine numbers",
                remedy="six numbers for a symmetric tensor, one for a scalar; or leave initial out for zeros",
            )
        object.__setattr__(self, "initial", initial or (0.0,) * size)
        object.__setattr__(self, "state", state)

    def __call__(self, E: Floats, state: Floats, points: Points | None = None) -> tuple[Floats, Floats, Floats]:
        """Evaluate the function and check what it returns.

        Raises
        ------
        InvalidValue
            If the arrays have other shapes, or a tangent that should be symmetric is not.
        NotFinite
            If one of them holds NaN or infinity.
        """
        answer = self.function(E, state) if points is None else self.function(E, state, points)
        if not isinstance(answer, tuple) or len(answer) != 3:
            raise InvalidValue(
                "a law must return three arrays: S, CC, state",
                where=self.name,
                value=type(answer),
                cause="a return that is missing, or a list in place of a tuple",
                remedy="return S, CC, state; a law without a history returns the one it was given",
            )
        S, CC, new = answer
        checked = (
            self._checked("S", S, (len(E), 6)),
            self._checked("CC", CC, (len(E), 6, 6)),
            self._checked("state", new, (len(E), len(self.initial))),
        )
        if self.symmetric:
            self._check_symmetry(checked[1])
        return checked

    @property
    def sees_points(self) -> bool:
        """Whether the function takes a third argument."""
        try:
            parameters = inspect.signature(self.function).parameters.values()
        except (TypeError, ValueError):  # the signature of a function of C is unknown
            return False
        positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
        return sum(one.kind in positional and one.default is one.empty for one in parameters) == 3

    def _respond(
        self, E: Floats, state: Floats, cell: int, context: tuple[Floats, float, float] | None
    ) -> tuple[Floats, Floats, Floats]:
        arguments = "strain, history" if context is None else "strain, history, points"
        called = f"law({arguments}) -> stress (n, 6), tangent (n, 6, 6), new history (n, {len(self.initial)})"
        with self._naming(cell, called):
            return self(E, state, None if context is None else Points(*context))

    def _energies(self, E: Floats, state: Floats, cell: int) -> tuple[Floats, Floats]:
        """Evaluate the energy function and check what it returns."""
        assert self.energy is not None
        with self._naming(cell, "energy(strain, history) -> elastic energy (n,), plastic work (n,)"):
            answer = self.energy(E, state)
            if not isinstance(answer, tuple) or len(answer) != 2:
                raise InvalidValue(
                    "the energy function of a law must return two arrays: elastic, plastic",
                    where=self.name,
                    value=type(answer),
                    cause="one array, or a list in place of a tuple",
                    remedy="an elastic law has no plastic work: return np.zeros(len(E)) for it",
                )
            elastic, plastic = answer
            return (
                self._checked("elastic energy", elastic, (len(E),)),
                self._checked("plastic work", plastic, (len(E),)),
            )

    @contextmanager
    def _naming(self, cell: int, called: str) -> Iterator[None]:
        """Add the cell and how the function is called to an error, and return the same object."""
        try:
            yield
        except UmformError as error:
            if cell >= 0 and ", cell " not in error.where:  # the same object may be raised again
                error.where = f"{error.where or self.name}, cell {cell}"
            raise
        except Exception as error:
            place = f"in the law {self.name!r}" + (f", cell {cell}" if cell >= 0 else "")
            error.add_note(f"{place}, called as {called}")
            raise

    def _check_symmetry(self, CC: Floats) -> None:
        largest = np.abs(CC).max(axis=(1, 2), initial=0.0)
        deviation = np.abs(CC - CC.transpose(0, 2, 1)).max(axis=(1, 2), initial=0.0)
        if (deviation > SYMMETRY * largest).any():
            point = int(np.argmax(deviation / np.maximum(largest, 1e-300)))
            raise InvalidValue(
                "the tangent of a law is not symmetric",
                where=self.name,
                value=f"CC - CC^T is {deviation[point] / largest[point]:.2g} of the largest entry of CC",
                cause="flow that is not associated, a tangent by differences, or a mistake in it",
                remedy="UserLaw(..., symmetric=False) where it is meant, else correct it: check_law compares it",
            )

    def _checked(self, name: str, values: ArrayLike, shape: tuple[int, ...]) -> Floats:
        array = np.ascontiguousarray(values, dtype=float)
        if array.shape != shape:
            raise InvalidValue(
                f"{name} of a law must have shape {shape}",
                where=self.name,
                value=array.shape,
                cause="an answer for one point, or with its axes in another order",
                remedy="points come first: one row for each row of the strain",
            )
        if not np.isfinite(array).all():
            raise NotFinite(
                f"{name} of a law is not finite",
                where=self.name,
                cause="a root or logarithm outside of its domain: the strain has become too large",
                remedy="take smaller steps, or widen the domain of the law",
            )
        return array

    def shown(self, history: Mapping[str, Floats]) -> dict[str, Floats]:
        """Named parts of the history that fields show."""
        return named_parts(history, self.state)

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        energies = None if self.energy is None else self._energies
        names = list(self.state.items())
        return _core.material_from_function(
            self._respond, list(self.initial), names, energies, self.symmetric, self.sees_points
        )

    def small_strain_law(self) -> _core.Material:
        """The law itself, of the strain that it gets."""
        return self.law()
