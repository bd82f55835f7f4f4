"""Nested dictionaries and lists of numbers, texts and arrays in one HDF5 file, written atomically.

A dictionary is a group, an array a data set; a list of numbers or texts is a data set too, any other list a group with
a member for each item. Numbers are restored to the last bit. A checksum over all data detects a damaged file.
"""

from __future__ import annotations

import io
import os
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote

import numpy as np

from umform.errors import FileProblem
from umform.io.atomic import PendingFile

if TYPE_CHECKING:
    import h5py

#: Attribute that marks anything but a dictionary, an array, a number or a text, and its values.
_IS, _LIST, _NONES, _ROWS, _SCALAR_ARRAY = "is", "list", "list of None", "rows of equal length", "array without axes"
#: Types whose lists are stored as one data set.
_PLAIN = (bool, int, float, str)


def write_tree(path: str | os.PathLike[str], tree: dict[str, Any], kind: str) -> None:
    """Write a tree; an existing file is kept until the new one is complete.

    Parameters
    ----------
    path : str or os.PathLike
        The file.
    tree : dict
        Dictionaries with text as keys, lists, tuples (which come back as lists), None, bool, int, float, str, arrays.
    kind : str
        Type of the content; `read_tree` checks it.

    Raises
    ------
    FileProblem
        The file cannot be written.
    """
    import h5py  # imported late: slow, and most runs keep no checkpoints

    image = io.BytesIO()  # HDF5 cannot forget a failed write: it writes to memory, and the image is written at once
    with h5py.File(image, "w", track_order=True) as file:
        file.attrs["kind"] = kind
        file.attrs["checksum"] = _checksum(tree)
        _write(file, "tree", tree)
    with PendingFile(path) as temporary:
        temporary.write_bytes(image.getbuffer())


def read_tree(path: str | os.PathLike[str], kind: str, *, part: str | None = None) -> dict[str, Any]:
    """Read a tree back.

    Parameters
    ----------
    path : str or os.PathLike
        The file.
    kind : str
        Required type of the content.
    part : str, optional
        Key of a single dictionary of the tree to read; the checksum is then not checked.

    Raises
    ------
    FileProblem
        There is no such file, it is damaged, or it has other content.
    """
    import h5py

    try:
        with h5py.File(Path(path), "r") as file:
            found, checksum = file.attrs.get("kind"), file.attrs.get("checksum")
            if found != kind:
                raise _problem(path, f"this is not a {kind}", "it is an HDF5 file of something else")
            tree: dict[str, Any] = _read(file["tree" if part is None else f"tree/{_name(part)}"])
    except FileProblem:
        raise
    except FileNotFoundError as error:
        raise _problem(path, f"there is no {kind} of this name", "a wrong folder, or none was written yet") from error
    except PermissionError as error:
        raise _problem(path, f"the {kind} cannot be read", "no permission to read it") from error
    except (OSError, KeyError, RuntimeError, ValueError, TypeError, AttributeError) as error:
        raise _problem(path, f"the {kind} is damaged", "it was cut short, or is no HDF5 file") from error
    if part is None and checksum != _checksum(tree):
        raise _problem(path, f"the {kind} is damaged", "its checksum does not fit")
    return tree


def kind_of(path: str | os.PathLike[str]) -> str:
    """What a tree in a file is; empty if the file has none.

    Raises
    ------
    FileProblem
        It is an HDF5 file that is damaged.
    """
    import h5py

    if not h5py.is_hdf5(path):
        return ""
    with opened(path) as file:
        return str(file.attrs.get("kind", ""))


def opened(path: str | os.PathLike[str]) -> h5py.File:
    """An HDF5 file, open for reading.

    Raises
    ------
    FileProblem
        It is damaged; HDF5 does not name the file.
    """
    import h5py

    try:
        return h5py.File(Path(path), "r")
    except OSError as error:
        raise _problem(path, "this HDF5 file is damaged", f"it was cut short: {error}") from error


def _problem(path: str | os.PathLike[str], what: str, cause: str) -> FileProblem:
    return FileProblem(what, where=str(path), cause=cause, remedy="check the path; use an older copy, or start again")


def _write(group: h5py.Group, name: str, value: Any) -> None:
    """Add a value to a group."""
    import h5py

    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, dict):
        inner = group.create_group(name, track_order=True)
        for key, item in value.items():
            _write(inner, _name(str(key)), item)
    elif isinstance(value, list | tuple):
        _write_list(group, name, value)
    elif value is None:
        group[name] = h5py.Empty("f8")
    else:
        group[name] = value
        if isinstance(value, np.ndarray) and value.ndim == 0:
            group[name].attrs[_IS] = _SCALAR_ARRAY


def _write_list(group: h5py.Group, name: str, items: list[Any] | tuple[Any, ...]) -> None:
    """Add a list: as one data set, as one for each column, or item by item."""
    items = [item.item() if isinstance(item, np.generic) else item for item in items]
    kinds = {type(item) for item in items}
    if len(kinds) == 1 and kinds <= set(_PLAIN):
        group[name] = items
        group[name].attrs[_IS] = _LIST
        return
    if kinds == {type(None)}:
        group.create_dataset(name, dtype="f8", shape=(len(items), 0)).attrs[_IS] = _NONES
        return
    inner = group.create_group(name, track_order=True)
    table = kinds == {list} and len({len(item) for item in items}) == 1 and len(items[0]) > 0
    inner.attrs[_IS] = _ROWS if table else _LIST
    for number, item in enumerate(zip(*items, strict=True) if table else items):
        _write(inner, str(number), item)


def _name(key: str) -> str:
    """Name of a member of a group, which may be neither empty nor a dot, and has no slash."""
    return {"": "%", ".": "%2E"}.get(key, key.replace("%", "%25").replace("/", "%2F"))


def _key(name: str) -> str:
    """The key for a name."""
    return "" if name == "%" else unquote(name)


def _read(node: h5py.Group | h5py.Dataset) -> Any:
    """The value of a group or a data set."""
    import h5py

    what = node.attrs.get(_IS)
    if isinstance(node, h5py.Group):
        if what is None:
            return {_key(name): _read(item) for name, item in node.items()}
        items = [_read(item) for item in node.values()]
        return [list(row) for row in zip(*items, strict=True)] if what == _ROWS else items
    if node.shape is None:
        return None
    value = node.asstr()[()] if h5py.check_string_dtype(node.dtype) else node[()]
    if what == _NONES:
        return [None] * len(value)
    if what == _LIST:
        return value.tolist()
    if what == _SCALAR_ARRAY:
        return np.asarray(value)
    return value.item() if isinstance(value, np.generic) else value


def _checksum(tree: Any) -> int:
    check = 0
    for part in _bytes_of(tree):
        check = zlib.crc32(part, check)
    return check


def _bytes_of(value: Any) -> Iterator[Any]:
    """All values of a tree, in order."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield str(key).encode()
            yield from _bytes_of(item)
    elif isinstance(value, list | tuple):
        yield str(len(value)).encode()
        for item in value:
            yield from _bytes_of(item)
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype.str} {value.shape}".encode()
        yield np.ascontiguousarray(value).reshape(-1).view(np.uint8).data
    else:
        yield repr(value.item() if isinstance(value, np.generic) else value).encode()
