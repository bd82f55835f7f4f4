"""Nested dictionaries and lists of numbers, texts and arrays in one HDF5 file, written whole or not at all.

One JSON document holds the tree, in which ``{"#array": k}`` stands for the dataset ``arrays/k``. Numbers come back to
the last bit. A checksum over everything tells a damaged file.
"""

from __future__ import annotations

import io
import json
import os
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.errors import FileProblem
from umform.io.atomic import PendingFile

_ARRAY = "#array"
Array = NDArray[Any]


def write_tree(path: str | os.PathLike[str], tree: dict[str, Any], kind: str) -> None:
    """Write a tree; a file of this name stays as it was until the new one is complete.

    Parameters
    ----------
    path : str or os.PathLike
        The file.
    tree : dict
        Dictionaries with text as keys, lists, tuples (which come back as lists), None, bool, int, float, str, arrays.
    kind : str
        What the file holds; `read_tree` asks for it.

    Raises
    ------
    FileProblem
        The file cannot be written.
    """
    import h5py  # slow to import, and most runs keep no checkpoints

    arrays: list[Array] = []
    document = json.dumps(_plain(tree, arrays))
    image = io.BytesIO()  # HDF5 cannot forget a write that failed: it writes to memory, and the image in one go
    with h5py.File(image, "w") as file:
        file.attrs["kind"] = kind
        file.attrs["checksum"] = _checksum(document, arrays)
        file["document"] = document
        for number, array in enumerate(arrays):
            file[f"arrays/{number}"] = array
    with PendingFile(path) as temporary:
        temporary.write_bytes(image.getbuffer())


def read_tree(path: str | os.PathLike[str], kind: str, *, whole: bool = True) -> dict[str, Any]:
    """Read a tree back.

    Parameters
    ----------
    path : str or os.PathLike
        The file.
    kind : str
        What it must hold.
    whole : bool
        Whether arrays are wanted. Without them the checksum is not looked at.

    Raises
    ------
    FileProblem
        There is no such file, it is damaged, or it holds something else.
    """
    import h5py

    try:
        with h5py.File(Path(path), "r") as file:
            found, checksum = file.attrs.get("kind"), file.attrs.get("checksum")
            if found != kind:
                raise _problem(path, f"this is not a {kind}", "it is an HDF5 file of something else")
            document = str(file["document"].asstr()[()])
            count = len(file.get("arrays", ()))
            arrays = [file[f"arrays/{number}"][()] if whole else np.empty(0) for number in range(count)]
    except FileProblem:
        raise
    except FileNotFoundError as error:
        raise _problem(path, f"there is no {kind} of this name", "a wrong folder, or none was written yet") from error
    except PermissionError as error:
        raise _problem(path, f"the {kind} cannot be read", "no permission to read it") from error
    except (OSError, KeyError, RuntimeError, ValueError, TypeError) as error:
        raise _problem(path, f"the {kind} is damaged", f"it was cut short, or is no HDF5 file: {error}") from error
    if whole and checksum != _checksum(document, arrays):
        raise _problem(path, f"the {kind} is damaged", "its checksum does not fit")
    try:
        tree = _filled(json.loads(document), arrays)
    except ValueError as error:  # nothing but the checksum would have told
        raise _problem(path, f"the {kind} is damaged", f"its text is cut: {error}") from error
    assert isinstance(tree, dict)
    return tree


def _problem(path: str | os.PathLike[str], what: str, cause: str) -> FileProblem:
    return FileProblem(
        what, where=str(path), cause=cause, remedy="check the path; else a copy of before, or begin anew"
    )


def _plain(value: Any, arrays: list[Array]) -> Any:
    """The value as JSON takes it; its arrays go to the list."""
    if isinstance(value, dict):
        return {str(key): _plain(item, arrays) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item, arrays) for item in value]
    if isinstance(value, np.ndarray):
        arrays.append(value)
        return {_ARRAY: len(arrays) - 1}
    return value.item() if isinstance(value, np.generic) else value


def _filled(value: Any, arrays: Sequence[Array]) -> Any:
    """The tree with its arrays back in place."""
    if isinstance(value, list):
        return [_filled(item, arrays) for item in value]
    if isinstance(value, dict):
        if _ARRAY in value:
            return arrays[value[_ARRAY]]
        return {key: _filled(item, arrays) for key, item in value.items()}
    return value


def _checksum(document: str, arrays: Sequence[Array]) -> int:
    check = zlib.crc32(document.encode())
    for array in arrays:
        check = zlib.crc32(np.ascontiguousarray(array).reshape(-1).view(np.uint8).data, check)
    return check
