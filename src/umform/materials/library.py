"""Functions of shared libraries, found by name."""

from __future__ import annotations

import ctypes
import hashlib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import cache
from os import PathLike
from pathlib import Path
from typing import Annotated, Any

from annotated_types import Ge, Le, MinLen

from umform.errors import FileProblem, InvalidValue
from umform.spec import InDeck

#: Path of a shared library in a deck.
IN_FOLDER = InDeck(Annotated[str, MinLen(1)], key="file", path=True)
#: Number of state variables, or their names and sizes.
State = Annotated[int | Mapping[str, int], InDeck(Annotated[int, Ge(0)] | dict[str, Annotated[int, Ge(1)]])]
Numbers = Annotated[Sequence[float], InDeck(list[float])]
#: Name of a function.
Symbol = Annotated[str, MinLen(1)]
ThicknessPoints = Annotated[int, Ge(2), Le(20)]


#: What takes a function of Python in place of a class of C functions.
_OF_PYTHON = {"CompiledLaw": "UserLaw", "CompiledContactLaw": "ContactLaw"}


def address(library: str | PathLike[str], symbols: Sequence[str], where: str) -> int:
    """Address of the first function of a list that a library exports.

    Parameters
    ----------
    library : str or path-like
        The file.
    symbols : sequence of str
        Names to look for, in this order.
    where : str
        For messages.

    Raises
    ------
    FileProblem
        If the file is missing, is no shared library, or exports none of the functions.
    """
    loaded = _load(str(_file(library, where).resolve()), where)
    for symbol in symbols:
        try:
            found = ctypes.cast(loaded[symbol], ctypes.c_void_p).value
        except AttributeError:
            continue
        if found:
            return found
    raise FileProblem(
        "the library does not have the function",
        where=f"{where}, {library}",
        value=" or ".join(symbols),
        cause="another name, a name that a C++ compiler has decorated, or a function that is not exported",
        remedy=f'nm -D {library} lists the names; in C++ the function is extern "C"',
    )


def function_address(function: Any, library: str | PathLike[str] | None, where: str, kind: str) -> int:
    """Address of a C function: by its name in a library, an address, a cfunc of numba or a function of ctypes.

    Parameters
    ----------
    function : object
        The function; None has the address 0.
    library : str or path-like, optional
        The file.
    where, kind : str
        Name of the law and its class, for messages.

    Raises
    ------
    InvalidValue
        If it is no C function.
    """
    if function is None:
        return 0
    if isinstance(function, str) and library is not None:
        return address(library, [function], where)
    found = getattr(function, "address", function)  # numba has it
    if callable(found):
        with suppress(ctypes.ArgumentError):  # A function of ctypes has an address, a Python function has none.
            found = ctypes.cast(found, ctypes.c_void_p).value
    if not isinstance(found, int) or isinstance(found, bool) or found <= 0:
        raise InvalidValue(
            "a compiled law needs a C function",
            where=where,
            value=function,
            cause="a function of Python, or a name without the library that has it",
            remedy=f'{kind}("law", "law.so"), a numba.cfunc or a function of ctypes; {_OF_PYTHON[kind]} takes Python',
        )
    return found


def content(library: str | PathLike[str], where: str) -> str:
    """Digest of the file, which distinguishes runs with different code."""
    return hashlib.sha256(_file(library, where).read_bytes()).hexdigest()[:32]


def _file(library: str | PathLike[str], where: str) -> Path:
    path = Path(library)
    if not path.is_file():
        raise FileProblem(
            "the library of a law does not exist",
            where=where,
            value=str(library),
            cause="another folder, or it has not been compiled",
            remedy="its path; gfortran -O2 -shared -fPIC -o umat.so umat.f makes one, gcc that of a C file",
        )
    return path


@cache
def _load(path: str, where: str) -> ctypes.CDLL:
    try:
        return ctypes.CDLL(path)
    except OSError as error:
        raise FileProblem(
            "the library of a law cannot be loaded",
            where=where,
            value=path,
            cause=str(error),
            remedy="compile it with -shared -fPIC for this machine; utility routines of other programs that it calls "
            "(SINV, SPRINC, XIT) must be in it",
        ) from error


def named_state(where: str, state: int | Mapping[str, int]) -> dict[str, int]:
    """Parts of a history by name and size: the given ones, or a single part of that size.

    Raises
    ------
    InvalidValue
        If a size is not a whole number.
    """
    names = dict(state) if isinstance(state, Mapping) else {"state": state}
    least = 1 if isinstance(state, Mapping) else 0
    if any(isinstance(size, bool) or not isinstance(size, int) or size < least for size in names.values()):
        raise InvalidValue(
            "the state of a law is a number of variables, or their names and sizes",
            where=where,
            value=state,
            cause="a size that is not a whole number",
            remedy='state=13, or state={"back_stress": 6, "plastic_strain": 6, "eqps": 1}',
        )
    return {name: size for name, size in names.items() if size}


def numbers(where: str, name: str, values: Sequence[float]) -> tuple[float, ...]:
    """Finite numbers as a tuple.

    Raises
    ------
    InvalidValue
        If they are not numbers.
    """
    try:
        return tuple(float(value) for value in values)
    except (TypeError, ValueError) as error:
        raise InvalidValue(
            f"{name} must be numbers",
            where=where,
            value=values,
            cause="a single number without a list, or a name",
            remedy=f"{name}=[210e3, 0.3]",
        ) from error
