"""Whether a command runs coarser meshes beside its own, for numbers extrapolated to zero element size."""

from __future__ import annotations

from typing import Any

from umform.errors import InvalidValue


def extrapolates(given: bool | None, want: Any, derive: Any, scatter: Any, *, usual: bool = True) -> bool:
    """Whether to extrapolate; goals, derivatives and scatter are those of the mesh of the case, as its numbers must be.

    Parameters
    ----------
    given : bool, optional
        ``--extrapolate`` or ``--no-extrapolate``.
    want, derive, scatter : object
        What is typed of these studies.
    usual : bool
        Default without studies.

    Raises
    ------
    InvalidValue
        An extrapolation beside one of the studies.
    """
    studies = [name for name, typed in (("--want", want), ("--derive", derive), ("--scatter", scatter)) if typed]
    if given and studies:
        raise InvalidValue(
            "numbers of several meshes have no goals, derivatives or scatter",
            where="--extrapolate",
            value=", ".join(studies),
            cause="these studies are those of one mesh, and its numbers are others",
            remedy="leave --extrapolate away, or the study",
        )
    return (usual and not studies) if given is None else given
