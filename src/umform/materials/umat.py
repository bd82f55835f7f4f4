"""User subroutines UMAT, with the interface of Abaqus, as laws of finite strain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike
from typing import Annotated

from annotated_types import MaxLen, MinLen

from umform import _core
from umform.materials.compiled import initial_state
from umform.materials.library import (
    IN_FOLDER,
    Numbers,
    State,
    Symbol,
    ThicknessPoints,
    address,
    content,
    named_state,
    numbers,
)
from umform.materials.user_law import Floats, named_parts
from umform.spec import ParametersInNotebook, check_fields

#: Names that Fortran compilers, C and Windows give the subroutine.
_SYMBOLS = ("umat_", "umat", "UMAT", "umat__")


@dataclass(frozen=True)
class Umat(ParametersInNotebook):
    """A UMAT for three-dimensional small strains, in logarithmic space and the axes of the sheet (theory, 3.15).

    STRAN and DSTRAN are logarithmic strains, STRESS is work-conjugate to them. The subroutine does not get F or
    coordinates: DFGRD0, DFGRD1 and DROT are the identity, COORDS and TEMP are zero. NDI = NSHR = 3. TIME counts from 0
    over the whole run, KSTEP is 1, KINC is 1 in the first increment and 2 later, NOEL is the number of the cell plus
    one, CELENT its length. PNEWDT below 1 cuts the increment in half.

    ``gfortran -O2 -shared -fPIC -o umat.so umat.f`` makes the library.

    Examples
    --------
    >>> import umform as uf
    >>> law = uf.Umat("umat.so", state=7, properties=(210e3, 0.3, 200.0))  # doctest: +SKIP
    """

    library: Annotated[str | PathLike[str], IN_FOLDER] = field(compare=False)
    """Shared library."""
    state: State = field(default=0, hash=False)
    """Number of state variables, or their names and sizes in their order; fields have these names, and ``eqps`` is the
    accumulated plastic strain. They begin at ``initial``."""
    properties: Numbers = ()
    """Constants of the law, PROPS."""
    initial: Numbers = ()
    """State of the virgin material; without it zeros."""
    symmetric: bool = True
    """Whether the tangent DDSDDE is symmetric; an asymmetric one then raises an error."""
    energies: bool = False
    """Whether it fills SSE, SPD and SCD, which enter the energy balance; otherwise the energies of a run are NaN."""
    parallel: bool = False
    """Whether several threads may call it at the same time: no SAVE, no COMMON, no files. MPI ranks always do."""
    directional: bool = True
    """Whether it is anisotropic and needs the rolling direction."""
    thickness_points: ThicknessPoints | None = None
    """Default number of Gauss points through the thickness; without it, a law with a history has the points and the
    complete order of the element for plastic laws, mostly staggered points, and one without a history has 2."""
    symbol: Symbol | None = None
    """Name of the function; without it the usual names that compilers give to UMAT."""
    name: Annotated[str, MinLen(1), MaxLen(80)] = "UMAT"
    """CMNAME, and name in messages."""
    content: str = field(default="", init=False)

    def __post_init__(self) -> None:
        check_fields(self)
        where, put = self.name, object.__setattr__
        put(self, "state", named_state(where, self.state))
        put(self, "properties", numbers(where, "properties", self.properties))
        put(self, "initial", initial_state(where, self.state, self.initial))
        put(self, "content", content(self.library, where))
        self._address()

    def shown(self, history: Mapping[str, Floats]) -> dict[str, Floats]:
        """State variables that fields show, by name."""
        assert isinstance(self.state, Mapping)
        return named_parts(history, self.state)

    def law(self) -> _core.Material:
        """The law as the kernels take it."""
        return _core.logarithmic_space(self.small_strain_law())

    def small_strain_law(self) -> _core.Material:
        """The law of logarithmic strains."""
        assert isinstance(self.state, Mapping)
        return _core.umat_law(
            self._address(),
            self.energies,
            self.name,
            list(self.properties),
            list(self.state.items()),
            list(self.initial),
            self.symmetric,
            self.parallel,
        )

    def _address(self) -> int:
        return address(self.library, [self.symbol] if self.symbol else _SYMBOLS, self.name)
