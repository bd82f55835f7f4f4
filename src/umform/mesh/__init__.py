"""Meshes of solid-shells: the mesh itself, structured generators, files."""

from umform.mesh.files import read
from umform.mesh.generators import graded, grid, plate, strip
from umform.mesh.mesh import FACE_NODES, FACES, Floats, Ids, Mesh, Selector

__all__ = ["FACES", "FACE_NODES", "Floats", "Ids", "Mesh", "Selector", "graded", "grid", "plate", "read", "strip"]
