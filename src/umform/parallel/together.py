"""All ranks end together: an error that all have goes on, an error of one alone ends them all with its message."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType

from umform.parallel.mpi_ranks import MpiRanks

#: Seconds that a rank which has failed waits for the others, and how much longer the next one waits, so that one of two
#: that have failed speaks.
_PATIENCE, _NEXT = 5.0, 0.5


@contextmanager
def together(ranks: MpiRanks) -> Iterator[None]:
    """Let no rank wait for one that has failed.

    An error that all ranks come out with (no convergence, a wrong value) goes on as it is, and the first rank alone
    tells it. Where one fails alone, the others wait for it in a sum or a factorisation: it says so and ends them all.
    """
    try:
        yield
    except BaseException as error:
        if not getattr(error, "on_all_ranks", False):
            if ranks.size > 1 and not ranks.arrive(_PATIENCE + _NEXT * ranks.rank):
                tell(error, ranks)
                ranks.abort()
            error.on_all_ranks = True  # type: ignore[attr-defined]
            _leave_it_to_the_first(ranks)
        raise


def tell(error: BaseException, ranks: MpiRanks) -> None:
    """Say which rank has failed, and of what."""
    text = str(error) if type(error).__module__.startswith("umform") else f"{type(error).__name__}: {error}"
    stream = sys.__stderr__ or sys.stderr
    print(f"umform: rank {ranks.rank} of {ranks.size} has failed, and ends all: {text}", file=stream, flush=True)


def _leave_it_to_the_first(ranks: MpiRanks) -> None:
    """Print no traceback of an error that ends a script on all ranks, but on the first one."""
    if ranks.rank == 0:
        return
    usual = sys.excepthook

    def quiet(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if not getattr(error, "on_all_ranks", False):
            usual(kind, error, trace)

    sys.excepthook = quiet
