"""The present time of a model, which its tools share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(eq=False)
class Now:
    """The present time."""

    time: float = 0.0

    def strip(self, bare: Any, twins: Any) -> None:
        """Nothing grows with the mesh."""
