"""Files in and out: meshes, results over time, tables. Every file is written whole or not at all."""

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
