"""Ready parametric forming processes.

`free_bending` runs one case of a strip bent over a cylinder, `FreeBending` are its parameters, and `demo` makes
the whole picture: tables, curves, fields and a report.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

if TYPE_CHECKING:
    from umform.processes.bending.case import Bending, free_bending
    from umform.processes.bending.showcase import demo
    from umform.processes.bending.spec import FreeBending

__all__ = ["Bending", "FreeBending", "demo", "free_bending"]

_HOME = {
    "Bending": "bending.case",
    "FreeBending": "bending.spec",
    "demo": "bending.showcase",
    "free_bending": "bending.case",
}

# The command line starts quickly.
__getattr__ = at_first_use(__name__, _HOME)
