"""All ranks end together: a common error propagates, an error of one rank ends all of them with its message."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType

from umform.parallel.mpi_ranks import MpiRanks

#: Seconds that a failed rank waits for the others, and additional seconds for the next rank, so that only one of two
#: failed ranks prints.
_PATIENCE, _NEXT = 5.0, 0.5


@contextmanager
def together(ranks: MpiRanks) -> Iterator[None]:
    """Prevent ranks from waiting for one that has failed.

    A common error of all ranks (no convergence, an invalid value) propagates, and only the first rank prints it. If one
    fails alone, the others wait for it in a sum or a factorisation: it prints its error and ends them all.
    """
    try:
        yield
    except BaseException as error:
        if not getattr(error, "on_all_ranks", False):
            if ranks.size > 1 and not ranks.arrive(_PATIENCE + _NEXT * ranks.rank):
                tell(error, ranks.rank, ranks.size)
                ranks.abort()
            error.on_all_ranks = True  # type: ignore[attr-defined]
            _leave_it_to_the_first(ranks)
        raise


def tell(error: BaseException, rank: int, size: int) -> None:
    """Print which rank failed, and why."""
    text = str(error) if type(error).__module__.startswith("umform") else f"{type(error).__name__}: {error}"
    stream = sys.__stderr__ or sys.stderr
    print(f"umform: rank {rank} of {size} has failed, and ends all: {text}", file=stream, flush=True)


def _leave_it_to_the_first(ranks: MpiRanks) -> None:
    """Print the traceback of an error that ends a script on all ranks on the first one only."""
    if ranks.rank == 0:
        return
    usual = sys.excepthook

    def quiet(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if not getattr(error, "on_all_ranks", False):
            usual(kind, error, trace)

    sys.excepthook = quiet
