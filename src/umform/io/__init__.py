"""Input and output: meshes, results over time, tables. All files are written atomically."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from umform.io.atomic import PendingFile
    from umform.io.meshes import MeshArrays, read_mesh_arrays, write_mesh_arrays
    from umform.io.tables import write_csv, write_json
    from umform.io.vtkhdf import VtkHdfSeries

__all__ = [
    "MeshArrays",
    "PendingFile",
    "VtkHdfSeries",
    "read_mesh_arrays",
    "write_csv",
    "write_json",
    "write_mesh_arrays",
]

_HOME = {
    "MeshArrays": "meshes",
    "PendingFile": "atomic",
    "VtkHdfSeries": "vtkhdf",
    "read_mesh_arrays": "meshes",
    "write_csv": "tables",
    "write_json": "tables",
    "write_mesh_arrays": "meshes",
}


def __getattr__(name: str) -> object:
    """Import a name when it is first used: a table needs neither meshio nor h5py, whose imports are slow."""
    if name not in _HOME:
        raise AttributeError(f"module 'umform.io' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"umform.io.{_HOME[name]}"), name)
    globals()[name] = value
    return value
