"""Fields of one converged state, for pictures and files."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.model.contact import ContactPoints

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Frame:
    """Fields of one converged state: values at points (n, ...) and cells (m, ...), and each contact at its points."""

    number: int
    time: float
    points: dict[str, Floats]
    cells: dict[str, Floats]
    contacts: dict[str, ContactPoints]

    def __repr__(self) -> str:
        found = {"points": list(self.points), "cells": list(self.cells), "contacts": list(self.contacts)}
        names = "; ".join(f"{kind} {', '.join(fields)}" for kind, fields in found.items() if fields)
        return f"Frame({self.number}, time {self.time:.6g}: {names})"
