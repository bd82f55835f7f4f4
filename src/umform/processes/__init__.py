"""Ready parametric forming processes.

`free_bending` runs one case of a strip bent over a cylinder, `FreeBending` are its parameters, and `demo` makes
the whole picture: tables, curves, fields and a report.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from umform.processes.bending.case import Bending, free_bending
    from umform.processes.bending.parameters import FreeBending
    from umform.processes.bending.showcase import demo

__all__ = ["Bending", "FreeBending", "demo", "free_bending"]

_HOME = {"Bending": "case", "FreeBending": "parameters", "demo": "showcase", "free_bending": "case"}


def __getattr__(name: str) -> object:
    """Import a name when it is first used, so that the command line starts quickly."""
    if name not in _HOME:
        raise AttributeError(f"module 'umform.processes' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"umform.processes.bending.{_HOME[name]}"), name)
    globals()[name] = value
    return value
