"""Forces of a bead, extrapolated to zero element size."""

from __future__ import annotations

from dataclasses import dataclass

from umform.processes.extrapolation import Limit


@dataclass(frozen=True)
class Limits:
    """Both forces of a bead, extrapolated to zero element size."""

    restraint: Limit
    uplift: Limit
