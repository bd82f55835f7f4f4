"""What a result was computed with."""

from __future__ import annotations

import platform

import numpy
import scipy

import umform
from umform.solvers import available


def versions() -> dict[str, str]:
    """Versions of umform and of all that its numbers depend on."""
    return {
        "umform": umform.__version__,
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
        "platform": platform.platform(),
        "solvers": ", ".join(name for name, here in available().items() if here),
    }
