"""Arrays and scripts for embedding in a page: quantised, compressed, as base64."""

from __future__ import annotations

import json
import zlib
from base64 import b64encode
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Largest code of a quantised number.
_TOP = 65535
#: Names of typed arrays of the browser.
_TYPES = {"<f4": "Float32Array", "<u4": "Uint32Array"}


@dataclass(frozen=True)
class Quantised:
    """Numbers as integers of 16 bits: value = low + step * code, with an error of half a step at most.

    Attributes
    ----------
    codes : ndarray of uint16, shape (frames, n)
        The integers.
    low, step : float
        Value of code 0, and the difference between successive codes.
    """

    codes: NDArray[np.uint16]
    low: float
    step: float

    @classmethod
    def of(cls, values: NDArray[np.float64]) -> Quantised:
        """Quantise finite values, one row a frame, over their whole range."""
        flat = values.reshape(len(values), -1)
        low, high = float(flat.min(initial=np.inf)), float(flat.max(initial=-np.inf))
        step = (high - low) / _TOP if high > low else 1.0
        return cls(np.round((flat - low) / step).astype(np.uint16), low, step)

    def planes(self) -> NDArray[np.uint8]:
        """Differences of the codes from frame to frame, all low bytes before all high bytes, which compresses well."""
        changes = np.diff(self.codes, axis=0, prepend=np.uint16(0))  # modulo 65536, as the browser adds them
        return np.concatenate([(changes & 255).astype(np.uint8).ravel(), (changes >> 8).astype(np.uint8).ravel()])


def compressed(data: bytes) -> str:
    """Bytes in the format of gzip, without a date, as base64."""
    packer = zlib.compressobj(6, wbits=31)
    return b64encode(packer.compress(data) + packer.flush()).decode("ascii")


def pack(head: Mapping[str, Any], arrays: Mapping[str, NDArray[Any] | Quantised]) -> str:
    """Pack a record and arrays.

    Parameters
    ----------
    head : mapping
        JSON data.
    arrays : mapping of str to ndarray or Quantised
        Arrays of float, of int that is not negative, or quantised numbers.

    Returns
    -------
    str
        Base64 of gzip of: length of the JSON in 4 bytes, the JSON with the table of the arrays, the arrays.
    """
    table: dict[str, dict[str, object]] = {}
    blocks: list[bytes] = []
    start = 0
    for name, array in arrays.items():
        if isinstance(array, Quantised):
            block = array.planes().tobytes()
            entry: dict[str, object] = {"low": array.low, "step": array.step, "frames": len(array.codes)}
        else:
            kind = "<f4" if array.dtype.kind == "f" else "<u4"
            block, entry = array.astype(kind).tobytes(), {"type": _TYPES[kind]}
        table[name] = entry | {"start": start, "bytes": len(block)}
        blocks.append(block)
        start += len(block)
    text = json.dumps({**head, "arrays": table}, allow_nan=False).encode()
    return compressed(len(text).to_bytes(4, "little") + text + b"".join(blocks))
