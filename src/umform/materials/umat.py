"""User subroutines UMAT, with the interface of Abaqus, as laws of finite strain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import PathLike

from umform import _core
from umform.materials.compiled import initial_state
from umform.materials.library import address, content, named_state, numbers
from umform.materials.user_law import Floats, named_parts

#: Names that Fortran compilers, C and Windows give the subroutine.
_SYMBOLS = ("umat_", "umat", "UMAT", "umat__")


@dataclass(frozen=True)
class Umat:
    """A UMAT for three-dimensional small strains, in logarithmic space and the axes of the sheet (theory, 3.15).

    STRAN and DSTRAN are logarithmic strains, STRESS is work-conjugate to them. The subroutine does not get F or
    coordinates: DFGRD0, DFGRD1 and DROT are the identity, COORDS and TEMP are zero. NDI = NSHR = 3. TIME counts from 0
    over the whole run, KSTEP is 1, KINC is 1 in the first increment and 2 later, NOEL is the number of the cell plus
    one, CELENT its length. PNEWDT below 1 cuts the increment in half.

    Parameters
    ----------
    library : str or path-like
        Shared library: ``gfortran -O2 -shared -fPIC -o umat.so umat.f``.
    state : int or mapping of str to int
        Number of state variables, or their names and sizes in their order, which name the fields: ``eqps`` is the
        accumulated plastic strain. They begin at ``initial``, by default at zero.
    properties : sequence of float
        PROPS.
    initial : sequence of float
        State of the virgin material; default: zeros.
    symmetric : bool
        Whether DDSDDE is symmetric at any strain; an asymmetric one then raises an error.
    energies : bool
        Whether it fills SSE, SPD and SCD, which enter the energy balance; otherwise the energies of a run are NaN.
    parallel : bool
        Whether several threads may call it at the same time: no SAVE, no COMMON, no files. MPI ranks always do.
    directional : bool
        Whether it is anisotropic, so that a model needs the rolling direction; False for an isotropic one.
    thickness_points : int, optional
        Default number of Gauss points through the thickness. Without it a law with a history counts as plastic: the
        points and the complete order of the element for plastic laws, mostly staggered points; one without has 2.
    symbol : str, optional
        Name of the function; default: the usual names that compilers give to UMAT.
    name : str
        CMNAME, and for messages.

    Examples
    --------
    >>> import umform as uf
    >>> law = uf.Umat("umat.so", state=7, properties=(210e3, 0.3, 200.0))  # doctest: +SKIP
    """

    library: str | PathLike[str] = field(compare=False)
    state: int | Mapping[str, int] = field(default=0, hash=False)
    properties: Sequence[float] = ()
    initial: Sequence[float] = ()
    symmetric: bool = True
    energies: bool = False
    parallel: bool = False
    directional: bool = True
    thickness_points: int | None = None
    symbol: str | None = None
    name: str = "UMAT"
    content: str = field(default="", init=False)

    def __post_init__(self) -> None:
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
