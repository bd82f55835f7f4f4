"""Checks of decks and drawings in separate processes, with limits of time, memory and number."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from typing import Any

from umform.errors import InvalidValue, UmformError

#: Largest number of such processes at a time.
AT_ONCE = 2
_places = threading.BoundedSemaphore(AT_ONCE)


class NoAnswer(UmformError):
    """A process without an answer."""

    id = "bench.no-answer"


def json_of_module(arguments: list[str], seconds: float, what: str) -> Any:
    """Run a module in a separate process and read the JSON that it prints.

    Parameters
    ----------
    arguments : list of str
        The module and its arguments.
    seconds : float
        Largest duration.
    what : str
        What it does, for messages.

    Raises
    ------
    InvalidValue
        If too many run already.
    NoAnswer
        If it takes too long, or ends without an answer.
    """
    if not _places.acquire(blocking=False):
        raise InvalidValue(
            f"{AT_ONCE} checks run already",
            where="check",
            cause="several pages check at once, or a check of a large model",
            remedy="try again in a moment",
        )
    try:
        command = [sys.executable, "-m", *arguments]
        done = subprocess.run(command, capture_output=True, timeout=seconds, stdin=subprocess.DEVNULL, check=False)
        return json.loads(done.stdout)
    except subprocess.TimeoutExpired as error:
        raise NoAnswer(
            f"{what} did not end within {seconds:g} s",
            where="check",
            remedy="a smaller file or model, or the command line",
        ) from error
    except ValueError as error:
        raise NoAnswer(
            f"{what} ended without an answer",
            where="check",
            cause="it may need more memory than is available",
            remedy="a smaller one",
        ) from error
    finally:
        _places.release()
