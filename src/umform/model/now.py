"""The present time of a model, shared by its tools."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(eq=False)
class Now:
    """The present time."""

    time: float = 0.0

    def strip(self, bare: Any, twins: Any) -> None:
        """No data grows with the mesh."""
