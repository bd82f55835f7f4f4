"""How far the forces and energies of a run are out of balance: for the random jobs and for the corpus."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

import umform as uf

#: Largest resultant of all external forces, and of their moments, relative to their magnitudes: what the convergence
#: criterion of Newton's method leaves.
FORCES = 1e-6
#: Drift of the energies, over the largest energy, above which it must be that of coarse increments.
ENERGIES = 0.02
#: What a run says of a penetration and of a drift that are larger than promised, of a mesh that changes its volume,
#: and of a residual above its tolerance.
DEEP, DRIFTS, COARSE = "the penetration of", "the external work and the energies differ", "% of its volume, which"
MISSED = "of the forces is above the tolerance"
#: Largest resultant where a run says so: that of the drawing processes, whose tolerance limits such a residual.
MISSED_FORCES = 1e-2


def largest_drift(results: Iterable[uf.Result]) -> float:
    """Largest drift of the energies in some runs, over the largest energy of each."""
    return max((float(np.abs(result.balance().drift).max()) for result in results), default=0.0)
