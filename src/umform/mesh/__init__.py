"""Meshes of solid-shells: the mesh, structured generators, files, and conversion of hexahedra."""

from umform.mesh.bending_sizes import Bent, Sizes, bending_sizes
from umform.mesh.blanks import disc, ring
from umform.mesh.bond import bond
from umform.mesh.files import read, read_shell
from umform.mesh.generators import graded, grid, plate, strip
from umform.mesh.mesh import FACE_NODES, FACES, Floats, Ids, Mesh, Selector
from umform.mesh.orient import orient
from umform.mesh.outlined import blank
from umform.mesh.thicken import thicken
from umform.mesh.together import together

__all__ = [
    "FACES",
    "FACE_NODES",
    "Bent",
    "Floats",
    "Ids",
    "Mesh",
    "Selector",
    "Sizes",
    "bending_sizes",
    "blank",
    "bond",
    "disc",
    "graded",
    "grid",
    "orient",
    "plate",
    "read",
    "read_shell",
    "ring",
    "strip",
    "thicken",
    "together",
]
