"""Digests of arrays, for fingerprints of runs and for ranks that must have built the same model."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np


def digest(*arrays: Any) -> str:
    """The first half of SHA-256 of some arrays, as they lie in memory."""
    check = hashlib.sha256()
    for array in arrays:
        check.update(str(array.dtype).encode())
        check.update(np.ascontiguousarray(array).tobytes())
    return check.hexdigest()[:32]
