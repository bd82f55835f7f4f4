"""Ctrl-C or SIGTERM twice: the first one ends a run after its increment, the second one immediately."""

from __future__ import annotations

import logging
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType

log = logging.getLogger("umform")

#: Signals that end a run, with their default handlers.
_USUAL = {
    signal.SIGINT: (signal.default_int_handler,),
    signal.SIGTERM: (signal.default_int_handler, signal.SIG_DFL),
}


@dataclass
class Interrupt:
    """Whether a stop was requested."""

    asked: bool = False


@contextmanager
def gentle_interrupt() -> Iterator[Interrupt]:
    """Turn the first Ctrl-C or SIGTERM into a request that the block can poll.

    No effect outside of the main thread, or for a signal with another handler.
    """
    stop = Interrupt()
    if threading.current_thread() is not threading.main_thread():
        yield stop
        return

    def ask(number: int, frame: FrameType | None) -> None:
        if stop.asked:
            raise KeyboardInterrupt
        stop.asked = True
        log.warning("interrupted: the run ends after this increment; Ctrl-C once more ends it at once")

    before = {number: signal.getsignal(number) for number, usual in _USUAL.items() if signal.getsignal(number) in usual}
    for number in before:
        signal.signal(number, ask)
    try:
        yield stop
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
