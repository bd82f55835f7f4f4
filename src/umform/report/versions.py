"""Versions of the software of a result."""

from __future__ import annotations

import platform
from functools import cache

import numpy

import umform
from umform.solvers import available


@cache
def versions() -> dict[str, str]:
    """Versions of umform and of the packages that affect its numbers."""
    import scipy  # the package alone, whose parts are not loaded

    return {
        "umform": umform.__version__,
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
        "platform": platform.platform(),
        "solvers": ", ".join(name for name, here in available().items() if here),
    }
