"""What a result was computed with."""

from __future__ import annotations

import platform
from importlib.metadata import version

import numpy

import umform
from umform.solvers import available


def versions() -> dict[str, str]:
    """Versions of umform and of all that its numbers depend on."""
    return {
        "umform": umform.__version__,
        "python": platform.python_version(),
        "numpy": numpy.__version__,
        "scipy": version("scipy"),  # without the time of its import
        "platform": platform.platform(),
        "solvers": ", ".join(name for name, here in available().items() if here),
    }
