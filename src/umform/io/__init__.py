"""Input and output: meshes, results over time, tables. All files are written atomically."""

from __future__ import annotations

from typing import TYPE_CHECKING

from umform.first_use import at_first_use

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

# A table needs neither meshio nor h5py, whose imports are slow.
__getattr__ = at_first_use(__name__, _HOME)
