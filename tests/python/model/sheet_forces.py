"""Forces of a contact of sheets alone, and the check of their tangent."""

from __future__ import annotations

import numpy as np


def forces_of(model, contact, u, du=None):
    """Forces of the contact alone, and K du."""
    pattern, f, Kdu = model.system._assembly().whole_pattern, np.zeros(u.size), np.zeros(u.size)
    for one in contact.passes:
        one.evaluate(u, pattern, f, None, du, None if du is None else Kdu)
    return f, Kdu


def check_tangent(model, contact, u, seed, h=1e-6):
    """Compare the tangent with differences of fourth order in three random directions."""
    rng = np.random.default_rng(seed)
    for _ in range(3):
        du = rng.standard_normal(u.size)
        f = [forces_of(model, contact, u + k * h * du)[0] for k in (-2, -1, 1, 2)]
        difference = (f[0] - 8.0 * f[1] + 8.0 * f[2] - f[3]) / (12.0 * h)
        assert np.abs(difference - forces_of(model, contact, u, du)[1]).max() < 1e-7 * np.abs(difference).max()
