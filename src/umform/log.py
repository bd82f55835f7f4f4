"""The log of a run on the terminal, for the command line and the processes that it starts."""

from __future__ import annotations

import logging


def log_to_stderr(level: int) -> None:
    """Print the messages of umform from a level upwards on standard error."""
    handler = logging.StreamHandler()
    handler.setFormatter(logging.Formatter("%(processName)s  %(message)s"))
    logger = logging.getLogger("umform")
    logger.handlers[:] = [handler]
    logger.setLevel(level)
