"""A command under mpiexec: one rank prints, PETSc gets its options, and errors end all ranks."""

from __future__ import annotations

import os
import re
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer
from typer.core import TyperCommand

from umform.errors import InvalidValue, UmformError

_OPTION = "-umform_"
_KEY = "options of PETSc"

#: Seconds in which mpiexec ends this process, if the first one has failed, too.
_PATIENCE = 10.0


class WithPetscOptions(TyperCommand):
    """A command that passes words such as ``-umform_ksp_type cg`` to PETSc."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Remove the options of PETSc, with their values, before the others are parsed."""
        own, petsc = split(args)
        ctx.meta[_KEY] = petsc
        return super().parse_args(ctx, own)


def split(words: Sequence[str]) -> tuple[list[str], list[str]]:
    """Words for the command, and those for PETSc: options with its prefix, each with a value if one follows."""
    own: list[str] = []
    petsc: list[str] = []
    value_may_follow = False
    for word in words:
        option = word.startswith(_OPTION)
        (petsc if option or (value_may_follow and not _is_option(word)) else own).append(word)
        value_may_follow = option
    return own, petsc


def _is_option(word: str) -> bool:
    return word.startswith("-") and not re.match(r"-[\d.]", word)


def petsc_options(ctx: typer.Context) -> list[str]:
    """Options of PETSc on the command line."""
    found: list[str] = ctx.meta.get(_KEY, [])
    return found


def let_the_first_talk() -> None:
    """Print on the first of the ranks started by mpiexec only."""
    if launched()[0] > 0:
        sys.stdout = sys.stderr = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115  (to the end)


@contextmanager
def let_the_first_end_all() -> Iterator[None]:
    """Keep another process from ending before the first one, which prints the error of all.

    mpiexec ends all processes once one has failed. Errors before MPI is started, as those in a deck, are in each of
    them: without a wait, the message might be lost. An error of this process alone is printed here.
    """
    try:
        yield
    except UmformError as error:
        number, size = launched()
        if number > 0 and not getattr(error, "on_all_ranks", False):
            time.sleep(_PATIENCE)
            from umform.parallel.together import tell

            tell(error, number, size)
        raise


@contextmanager
def on_all_ranks(solver: str, options: Sequence[str]) -> Iterator[None]:
    """Run the block on all ranks started by mpiexec, or in this process.

    Raises
    ------
    InvalidValue
        If there are several processes, or options of PETSc, without the solver petsc.
    """
    _, size = launched()
    if solver != "petsc":
        if size > 1 or options:
            raise InvalidValue(
                "this solver runs in one process and knows no options of PETSc",
                where=f"solver {solver}",
                value=" ".join(options) or f"{size} processes",
                cause="each process would do the whole run" if size > 1 else "",
                remedy="--solver petsc",
            )
        yield
        return
    from umform.parallel.mpi_ranks import world
    from umform.parallel.petsc import set_options
    from umform.parallel.together import together

    set_options(options)
    with together(world()):
        yield


def launched() -> tuple[int, int]:
    """Number of this process, and number of those started by mpiexec, from the environment; (0, 1) without it."""
    for rank, size in (("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"), ("PMI_RANK", "PMI_SIZE")):
        if rank in os.environ and size in os.environ:
            return int(os.environ[rank]), int(os.environ[size])
    return 0, 1
