"""Ctrl-C twice: the first one asks a run to end after its increment, the second one ends it at once."""

from __future__ import annotations

import logging
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType

log = logging.getLogger("umform")


@dataclass
class Interrupt:
    """Whether somebody has asked to stop."""

    asked: bool = False


@contextmanager
def gentle_interrupt() -> Iterator[Interrupt]:
    """Turn the first Ctrl-C into a question that the block may look at when it suits.

    Nothing changes outside of the main thread, or where a program has its own way with Ctrl-C.
    """
    stop = Interrupt()
    ours = threading.current_thread() is threading.main_thread()
    if not ours or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield stop
        return

    def ask(number: int, frame: FrameType | None) -> None:
        if stop.asked:
            raise KeyboardInterrupt
        stop.asked = True
        log.warning("interrupted: the run ends after this increment; Ctrl-C once more ends it at once")

    signal.signal(signal.SIGINT, ask)
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
