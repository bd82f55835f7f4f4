"""Compiled laws: C functions of a shared library, of numba or of ctypes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from os import PathLike
from typing import Annotated, Any, Literal

from umform import _core
from umform.errors import InvalidValue
from umform.materials.checks import check_finite
from umform.materials.library import (
    IN_FOLDER,
    Numbers,
    State,
    Symbol,
    ThicknessPoints,
    content,
    function_address,
    named_state,
    numbers,
)
from umform.materials.user_law import Floats, named_parts
from umform.spec import InDeck, ParametersInNotebook, check_fields


@dataclass(frozen=True)
class CompiledLaw(ParametersInNotebook):
    """A law that is a C function, called for all points of one cell at a time without Python's global lock.

    ::

        int law(int points, const double* strain, const double* state, const double* properties, const double* axes,
                double length, double step, double* stress, double* tangent, double* new_state)

    The values of a point are contiguous: strain (6), state (size), axes (3, 3), stress (6), tangent (6, 6) by rows, new
    state (size); Voigt order 11 22 33 12 23 13, engineering shears, in the axes of the sheet. The function must not
    change the old state. It returns 0; any other value reports failure and cuts the increment. The step of time is 0
    where that of :class:`Points` is.

    Examples
    --------
    >>> import umform as uf
    >>> law = uf.CompiledLaw("law", "law.so", state={"eqps": 1}, properties=(210e3, 0.3))  # doctest: +SKIP
    """

    function: Annotated[Any, InDeck(Symbol)] = field(compare=False)
    """Name of the function in the library; or its address, a cfunc of numba or a function of ctypes."""
    library: Annotated[str | PathLike[str] | None, replace(IN_FOLDER, needed=True)] = field(default=None, compare=False)
    """Shared library."""
    state: State = field(default=0, hash=False)
    """Number of state variables, or their names and sizes in their order; fields have these names, and ``eqps`` is the
    accumulated plastic strain. They begin at ``initial``."""
    properties: Numbers = ()
    """Constants of the law, passed on unchanged."""
    initial: Numbers = ()
    """State of the virgin material; without it zeros."""
    energy: Annotated[Any, InDeck(Symbol)] = field(default=None, compare=False)
    """Name of the function of its energies, ``int energy(int points, const double* strain, const double* state, const
    double* properties, double* energies)``: it fills elastic energy and plastic work (2) of each point, for a strain
    and the converged state at it. Without it the energies of a run are NaN."""
    strain: Literal["logarithmic", "green-lagrange"] = "logarithmic"
    """Strain that it receives; logarithmic strains make a small-strain law one of finite strain."""
    symmetric: bool = True
    """Whether the tangent is symmetric; an asymmetric one then raises an error."""
    parallel: bool = True
    """Whether several threads may call it at the same time: it has no static variables."""
    sees_points: bool = False
    """Whether it uses axes and length of the cell; else they are null and 0."""
    directional: bool = False
    """Whether it is anisotropic and needs the rolling direction."""
    thickness_points: ThicknessPoints | None = None
    """Default number of Gauss points through the thickness; without it, a law with a history has the points and the
    complete order of the element for plastic laws, mostly staggered points, and one without a history has 2."""
    name: str = ""
    """Name in messages and fingerprints of runs; without it, that of the function. Without a library, give each
    function its own name."""
    content: str = field(default="", init=False)

    def __post_init__(self) -> None:
        put = object.__setattr__
        check_fields(self)
        put(self, "name", self.name or (self.function if isinstance(self.function, str) else "compiled law"))
        where = self.name
        put(self, "state", named_state(where, self.state))
        put(self, "properties", numbers(where, "properties", self.properties))
        put(self, "initial", initial_state(where, self.state, self.initial))
        if self.library is not None:
            functions = [name for name in (self.function, self.energy) if name is not None]
            put(self, "content", f"{content(self.library, where)} {' '.join(map(str, functions))}")
        for function in (self.function, self.energy):
            self._address(function)

    def shown(self, history: Mapping[str, Floats]) -> dict[str, Floats]:
        """State variables that fields show, by name."""
        assert isinstance(self.state, Mapping)
        return named_parts(history, self.state)

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        small = self.small_strain_law()
        return small if self.strain == "green-lagrange" else _core.logarithmic_space(small)

    def small_strain_law(self) -> _core.Material:
        """The law itself."""
        assert isinstance(self.state, Mapping)
        return _core.compiled_law(
            self._address(self.function),
            self._address(self.energy),
            self.name,
            list(self.properties),
            list(self.state.items()),
            list(self.initial),
            self.symmetric,
            self.parallel,
            self.sees_points,
        )

    def _address(self, function: Any) -> int:
        return function_address(function, self.library, self.name, "CompiledLaw")


def initial_state(where: str, state: int | Mapping[str, int], initial: Sequence[float]) -> tuple[float, ...]:
    """State of the virgin material: the given values, or zeros.

    Raises
    ------
    InvalidValue
        If it has another size than the state.
    """
    values, size = numbers(where, "initial", initial), sum(named_state(where, state).values())
    check_finite(where, **{f"initial[{number}]": value for number, value in enumerate(values)})
    if values and len(values) != size:
        raise InvalidValue(
            "the initial state must have the size of the state",
            where=where,
            value=f"{size} state variables, {len(values)} initial values",
            cause="a part is missing, or a symmetric tensor was counted as nine numbers",
            remedy="one number for each, or leave initial out for zeros",
        )
    return values or (0.0,) * size
