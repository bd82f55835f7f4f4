"""Errors of umform: one exception class per kind of mistake, each with place, value, cause and remedy.

A message answers five questions in the same order: what is wrong, where, which value, the likely cause, and the remedy.
The command line prints the message; Python users catch the class.
"""

from __future__ import annotations

import sys
import sysconfig
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

#: Folder of the package, whose frames a notebook does not show.
_PACKAGE = Path(__file__).parent


class UmformError(Exception):
    """Base of all errors that umform raises intentionally.

    Parameters
    ----------
    what : str
        One sentence that says what is wrong.
    where : str, optional
        Place: element, node, set, file, key, step.
    value : object, optional
        The offending value.
    cause : str, optional
        The likely cause.
    remedy : str, optional
        What to do about it.

    Examples
    --------
    >>> import umform as uf
    >>> try:
    ...     uf.Perfect(-160.0)
    ... except uf.UmformError as error:
    ...     print(type(error).__name__)
    InvalidValue
    """

    id = "umform"

    def __init__(self, what: str, *, where: str = "", value: object = None, cause: str = "", remedy: str = "") -> None:
        super().__init__(what)
        self.what = what
        self.where = where
        self.value = value
        self.cause = cause
        self.remedy = remedy

    def __str__(self) -> str:
        rows = [
            ("where", self.where),
            ("value", _shown(self.value)),
            ("cause", self.cause),
            ("remedy", self.remedy),
        ]
        lines = [f"{self.what} [{self.id}]"]
        lines += [f"  {name + ':':<8}{text}" for name, text in rows if text]
        return "\n".join(lines)

    def _render_traceback_(self) -> list[str]:
        """What IPython and notebooks print in place of a traceback: lines outside umform, then the message."""
        shell = _shell()
        if getattr(getattr(shell, "InteractiveTB", None), "mode", "") == "Verbose":
            return list(shell.InteractiveTB.structured_traceback(type(self), self, self.__traceback__))
        return [*_own_lines(self), f"{type(self).__name__}: {self}", *getattr(self, "__notes__", ()), _ALL_FRAMES]

    def __reduce__(self) -> tuple[object, ...]:
        return (_rebuild, (type(self), self.what, self.where, self.value, self.cause, self.remedy))


#: Characters of a value that are shown, of an array for example; texts are shown as they are.
_LONGEST = 200


def _shown(value: object) -> str:
    text = "" if value is None else str(value)
    if isinstance(value, str) or len(text) <= _LONGEST:
        return text
    return f"{' '.join(text.split())[:_LONGEST]} …"


#: Last line in place of a traceback.
_ALL_FRAMES = "(%xmode Verbose, then %tb, prints all frames)"


def _shell() -> Any:
    """The running IPython; None without one."""
    ipython: Any = sys.modules.get("IPython")
    return None if ipython is None else ipython.get_ipython()


def _own_lines(error: BaseException) -> list[str]:
    """Lines of the user on the way to an error: those of cells have no file."""
    found = []
    for one in traceback.extract_tb(error.__traceback__):
        file = Path(one.filename)
        if one.line and not file.is_relative_to(_PACKAGE) and "IPython" not in file.parts:
            place = one.filename if file.is_file() else "a cell"
            found.append(f"line {one.lineno} of {place}: {one.line}")
    return found


def _rebuild(kind: type[UmformError], what: str, where: str, value: object, cause: str, remedy: str) -> UmformError:
    """Rebuild an error in another process."""
    return kind(what, where=where, value=value, cause=cause, remedy=remedy)


class InvalidValue(UmformError, ValueError):
    """An invalid number or name (negative penalty, NaN, unknown option)."""

    id = "value.invalid"


@contextmanager
def placed(where: str, *arguments: str) -> Iterator[None]:
    """Name the place of arguments in errors that refuse them: an option, or a part of the case."""
    try:
        yield
    except InvalidValue as error:
        if error.where in arguments:
            error.where = where
        raise


class NotFinite(InvalidValue):
    """A NaN or an infinity in the input."""

    id = "value.not-finite"


class InvalidPath(InvalidValue):
    """The path of a number is unknown, ambiguous, or that of no parameter of a study."""

    id = "value.path"


class InvalidPenalty(InvalidValue):
    """A contact penalty that is not a positive number."""

    id = "contact.penalty"


class InvalidFriction(InvalidValue):
    """An invalid friction law."""

    id = "contact.friction"


class InvalidBead(InvalidValue):
    """An invalid draw bead, or one that is not on its tool."""

    id = "contact.bead"


class HardeningNotMonotone(InvalidValue):
    """A hardening table whose strain or stress does not increase."""

    id = "material.hardening-not-monotone"


class MeshError(UmformError):
    """A mesh that cannot be used."""

    id = "mesh"


class InvertedElement(MeshError):
    """An element with a negative volume at one of its points."""

    id = "mesh.inverted-element"


class FoldedElement(MeshError):
    """An element whose volume changes sign inside: it is folded over itself."""

    id = "mesh.folded-element"


class WrongNodeOrder(MeshError):
    """Elements that become valid in another node order."""

    id = "mesh.node-order"


class WrongCellType(MeshError):
    """Cells that the chosen element does not support."""

    id = "mesh.cell-type"


class UnknownSet(MeshError, KeyError):
    """A set name that the mesh does not have."""

    id = "mesh.unknown-set"

    __str__ = UmformError.__str__


class EmptySet(MeshError):
    """A set that selects nothing."""

    id = "mesh.empty-set"


class DrawingError(UmformError):
    """A drawing that defines no tool."""

    id = "drawing"


class UnfitTriangles(DrawingError):
    """Triangles that are no surface: without area, or more than two at an edge."""

    id = "drawing.triangles"


class TurnedNormals(DrawingError):
    """Normals of a surface that point to different sides, or into the sheet."""

    id = "drawing.turned-normals"


class TurnedFaces(TurnedNormals):
    """Neighbouring faces of a tool have their normals on different sides."""

    id = "drawing.turned-faces"


class HoleInSurface(DrawingError):
    """A surface with a rim that must be closed."""

    id = "drawing.hole"


class OpenSection(DrawingError):
    """Lines and arcs of a drawing that do not meet, or form several curves."""

    id = "drawing.section"


class ModelError(UmformError):
    """A model that cannot be solved."""

    id = "model"


class RigidBodyMotion(ModelError):
    """Supports that leave a rigid-body motion free."""

    id = "model.rigid-body-motion"


class ToolSwallowsSheet(ModelError):
    """A tool that overlaps the sheet at the start."""

    id = "model.tool-swallows-sheet"


class SolveError(UmformError):
    """The solution failed; the last converged state is kept."""

    id = "solve"


class NoConvergence(SolveError):
    """Newton's method did not converge at the smallest allowed step."""

    id = "solve.no-convergence"


class SingularMatrix(SolveError):
    """A tangent that cannot be factorised.

    Attributes
    ----------
    motion : ndarray, shape (n,), optional
        The displacement of the unknowns that it does not resist, if the solver knows it.
    """

    id = "solve.singular-matrix"
    motion: Any = None


class FileProblem(UmformError, OSError):
    """A file that cannot be read or written."""

    id = "file"

    __str__ = UmformError.__str__


def own_code(error: BaseException) -> str:
    """File and line of the code of the user, called by umform, in which an error arose; empty if there is none."""
    installed = [Path(sysconfig.get_path(name)) for name in ("stdlib", "platlib")]
    place, below = "", False
    for frame in traceback.extract_tb(error.__traceback__):
        file = Path(frame.filename)
        if file.is_relative_to(_PACKAGE):
            below = True
        elif below and file.is_file() and not any(file.is_relative_to(one) for one in installed):
            place = f"{file}, line {frame.lineno}"
    return place
