"""The only import of petsc4py and mpi4py, and the options of PETSc for umform."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from umform.errors import UmformError

#: Prefix of all options of PETSc for umform: -umform_ksp_type cg.
PREFIX = "umform_"


class NoPetsc(UmformError):
    """PETSc for Python is not installed, or does not start."""

    id = "petsc.missing"


def petsc() -> Any:
    """The initialised module petsc4py.PETSc.

    Raises
    ------
    NoPetsc
        If petsc4py or mpi4py cannot be imported.
    """
    try:
        import mpi4py.MPI  # noqa: F401  (PETSc hands out its communicator)
        from petsc4py import PETSc
    except (ImportError, OSError) as error:
        raise NoPetsc(
            "the solver petsc needs petsc4py and mpi4py",
            value=str(error),
            cause="they are not part of the base install",
            remedy="docs/parallel.md: Debian's python3-petsc4py and python3-mpi4py, or both from PyPI beside a PETSc",
        ) from error
    return PETSc


def set_options(words: Sequence[str]) -> None:
    """Pass options to PETSc, as ``["-umform_ksp_type", "cg"]``; they override those of PETSC_OPTIONS."""
    if words:
        petsc().Options().insertString(" ".join(words))
