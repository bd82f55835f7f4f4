"""Short work in a process of its own, with limits of time, memory and number: checks of decks, drawings."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from typing import Any

from umform.errors import InvalidValue, UmformError

#: Such processes at a time.
AT_ONCE = 2
_places = threading.BoundedSemaphore(AT_ONCE)


class NoAnswer(UmformError):
    """A process that has not answered."""

    id = "bench.no-answer"


def answer_of(arguments: list[str], seconds: float, what: str) -> Any:
    """What a module of this package prints as JSON.

    Parameters
    ----------
    arguments : list of str
        The module and its arguments.
    seconds : float
        Most time.
    what : str
        What it does, for messages.

    Raises
    ------
    InvalidValue
        If too many run already.
    NoAnswer
        If it takes too long, or dies.
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
            f"{what} has not ended within {seconds:g} s",
            where="check",
            remedy="a smaller file or model, or the command line",
        ) from error
    except ValueError as error:
        raise NoAnswer(
            f"{what} has died", where="check", cause="it may need more memory than there is", remedy="a smaller one"
        ) from error
    finally:
        _places.release()
