"""Digests: of runs, of entries of the store, and of models that all ranks must have built alike."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import numpy as np


def digest(*arrays: Any) -> str:
    """The first half of SHA-256 of some arrays, as they lie in memory."""
    check = hashlib.sha256()
    for array in arrays:
        check.update(str(array.dtype).encode())
        check.update(np.ascontiguousarray(array).tobytes())
    return check.hexdigest()[:32]


def floats(data: Any) -> Any:
    """Data with integers as floats, for a digest: 1 and 1.0 are the same value."""
    if isinstance(data, Mapping):
        return {key: floats(entry) for key, entry in data.items()}
    if isinstance(data, list | tuple):
        return [floats(entry) for entry in data]
    return float(data) if isinstance(data, int) and not isinstance(data, bool) else data
