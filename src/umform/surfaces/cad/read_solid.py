"""Read one solid of a STEP file: all calls of OpenCASCADE for its faces and edges."""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from umform.errors import DrawingError, FileProblem
from umform.surfaces.cad.opencascade import STEP, kind_of, read_shape, static
from umform.surfaces.cad.solid import SMOOTH, Solid, SolidEdge, SolidFace
from umform.surfaces.directions import positive
from umform.surfaces.triangles import Floats

#: Largest distance in mm of polylines from edges that are no lines, where none is given.
DEVIATION = 0.01
#: A file with more faces is no part that a press brake bends.
MOST_FACES = 5000
#: Largest size of a STEP file in bytes.
MOST_BYTES = 50_000_000


def read_solid(path: str | Path, deviation: float = DEVIATION) -> Solid:
    """Read the only solid of a STEP file, by OpenCASCADE: `pip install "umform[cad]"`.

    Parameters
    ----------
    path : str or Path
        A file that ends in .step or .stp; its unit is converted to millimetres.
    deviation : float
        Largest distance of polylines from edges that are no lines.

    Raises
    ------
    FileProblem
        If the file cannot be read, or is too large.
    DrawingError
        If there is not exactly one solid, or its shell has gaps.
    """
    path = Path(path)
    _check_file(path)
    shape, unit = read_shape(path)
    return _Reader(path, _the_solid(shape, path), positive(deviation, "flat", "deviation")).solid(unit)


def _check_file(path: Path) -> None:
    if path.suffix.lower() not in STEP:
        raise FileProblem(
            "a part to unfold is a STEP file",
            where=str(path),
            value=path.suffix,
            cause="another format",
            remedy="export the solid as .step (AP214 or AP242)",
        )
    if path.exists() and path.stat().st_size > MOST_BYTES:
        raise FileProblem(
            "this file is too large for a bent part",
            where=str(path),
            value=f"{path.stat().st_size / 1e6:.0f} MB, {MOST_BYTES / 1e6:.0f} are read",
            cause="an assembly, or a part with threads or engraved text",
            remedy="export one sheet-metal part",
        )


def _explored(shape: Any, kind: str) -> Iterator[Any]:
    kinds = importlib.import_module("OCP.TopAbs").TopAbs_ShapeEnum
    at = importlib.import_module("OCP.TopExp").TopExp_Explorer(shape, getattr(kinds, f"TopAbs_{kind}"))
    while at.More():
        yield at.Current()
        at.Next()


def _the_solid(shape: Any, path: Path) -> Any:
    solids = list(_explored(shape, "SOLID"))
    faces = sum(1 for _ in _explored(shape, "FACE"))
    if faces > MOST_FACES:
        raise DrawingError(
            "this shape has too many faces for a bent part",
            where=str(path),
            value=f"{faces} faces, {MOST_FACES} are read",
            cause="an assembly, a scanned surface, or a part with threads or engraved text",
            remedy="export one sheet-metal part",
        )
    if len(solids) == 1:
        return solids[0]
    if solids:
        raise DrawingError(
            "there is more than one solid in the file",
            where=str(path),
            value=f"{len(solids)} solids",
            cause="an assembly, or bodies that were not joined",
            remedy="export each part to a file of its own",
        )
    raise DrawingError(
        "there is no solid in the file",
        where=str(path),
        value=f"{faces} loose faces",
        cause="surfaces or an open shell, which have no thickness",
        remedy="close the shell, or thicken the surface, and export the solid",
    )


class _Reader:
    """Takes the numbers of a solid out of OpenCASCADE."""

    def __init__(self, path: Path, solid: Any, deviation: float) -> None:
        self.path, self.shape, self.deviation = path, solid, deviation
        self.adaptor = importlib.import_module("OCP.BRepAdaptor")
        self.kinds = importlib.import_module("OCP.TopAbs").TopAbs_ShapeEnum
        self.as_face, self.as_edge = (static("TopoDS", "TopoDS", name) for name in ("Face", "Edge"))
        of_shapes = importlib.import_module("OCP.collections")
        self.map = of_shapes.IndexedMap_TopoDS_Shape_TopTools_ShapeMapHasher()
        static("TopExp", "TopExp", "MapShapes")(solid, self.kinds.TopAbs_EDGE, self.map)

    def solid(self, unit: str) -> Solid:
        """All numbers."""
        mesh = importlib.import_module("OCP.BRepMesh")
        mesh.BRepMesh_IncrementalMesh(self.shape, 1.0, False, 0.5, False)
        shapes = [self.as_face(face) for face in _explored(self.shape, "FACE")]
        faces, of_edge = {}, dict[int, list[int]]()
        for number, shape in enumerate(shapes, start=1):
            ids = [self.map.FindIndex(edge) for edge in _explored(shape, "EDGE")]
            for k in ids:
                of_edge.setdefault(k, []).append(number)
            faces[number] = self._face(number, shape, tuple(sorted(set(ids))))
        self._check_closed(of_edge)
        places, edges = dict[int, int](), list[SolidEdge]()
        for k, numbers in sorted(of_edge.items()):
            edge = self.as_edge(self.map.FindKey(k))
            if static("BRep", "BRep_Tool", "Degenerated")(edge):
                continue
            places[k] = len(edges)
            edges.append(self._edge(edge, tuple(numbers), shapes, faces))
        faces = {
            number: SolidFace(**{**face.__dict__, "edges": tuple(places[k] for k in face.edges if k in places)})
            for number, face in faces.items()
        }
        return Solid(self.path, unit, faces, tuple(edges), self._volume(), self.deviation)

    def _check_closed(self, of_edge: dict[int, list[int]]) -> None:
        degenerated = static("BRep", "BRep_Tool", "Degenerated")
        for k, numbers in of_edge.items():
            if len(numbers) == 1 and not degenerated(self.as_edge(self.map.FindKey(k))):
                raise DrawingError(
                    "the shell of the solid has a gap",
                    where=str(self.path),
                    value=f"an edge of face {numbers[0]} has no other face",
                    cause="a face is missing",
                    remedy="close the shell in the program that wrote the file",
                )

    def _face(self, number: int, face: Any, edges: tuple[int, ...]) -> SolidFace:
        surface = self.adaptor.BRepAdaptor_Surface(face, True)
        kind = kind_of(surface)
        reverse = str(face.Orientation()).endswith("REVERSED")
        point, direction, radius, convex = np.zeros(3), np.zeros(3), 0.0, True
        if kind == "Plane":
            plane = surface.Plane()
            point, direction = _xyz(plane.Location()), _xyz(plane.Axis().Direction())
            direct = plane.Position().Direct()
            direction = direction * (-1.0 if reverse == direct else 1.0)
        elif kind == "Cylinder":
            cylinder = surface.Cylinder()
            point, direction = _xyz(cylinder.Location()), _xyz(cylinder.Axis().Direction())
            radius, convex = cylinder.Radius(), reverse != cylinder.Position().Direct()
        return SolidFace(
            number, kind, point, direction, radius, convex, self._area(face), self._corners(face, number), edges
        )

    def _corners(self, face: Any, number: int) -> Floats:
        """Corners of the triangles of a face."""
        location = importlib.import_module("OCP.TopLoc").TopLoc_Location()
        made = static("BRep", "BRep_Tool", "Triangulation")(face, location)
        if made is None or not made.NbTriangles():
            raise DrawingError(
                "a face cannot be triangulated",
                where=str(self.path),
                value=f"face {number}",
                cause="its boundary crosses itself",
                remedy="repair the face in the program that wrote the file",
            )
        turn = location.Transformation()
        x = np.array([_xyz(made.Node(i).Transformed(turn)) for i in range(1, made.NbNodes() + 1)])
        ids = np.array([made.Triangle(i).Get() for i in range(1, made.NbTriangles() + 1)]) - 1
        return np.asarray(x[ids])

    def _edge(self, edge: Any, numbers: tuple[int, ...], shapes: list[Any], faces: dict[int, SolidFace]) -> SolidEdge:
        curve = self.adaptor.BRepAdaptor_Curve(edge)
        kind = kind_of(curve)
        first, last = curve.FirstParameter(), curve.LastParameter()
        centre = _xyz(curve.Circle().Location()) if kind == "Circle" else None
        middle = _xyz(curve.Value(0.5 * (first + last)))
        pair = numbers if len(numbers) == 2 else numbers[:1]
        normals = [self._normal(edge, shapes[n - 1], faces[n], middle) for n in pair]
        smooth = len(numbers) == 2 and bool(normals[0] @ normals[1] > math.cos(SMOOTH))
        return SolidEdge(numbers, kind, self._points(curve, kind, first, last), centre, smooth)

    def _normal(self, edge: Any, shape: Any, face: SolidFace, middle: Floats) -> Floats:
        if face.kind in ("Plane", "Cylinder"):
            return face.normal(middle)
        gp = importlib.import_module("OCP.gp")
        on = self.adaptor.BRepAdaptor_Curve2d(edge, shape)
        uv = on.Value(0.5 * (on.FirstParameter() + on.LastParameter()))
        x, du, dv = gp.gp_Pnt(), gp.gp_Vec(), gp.gp_Vec()
        self.adaptor.BRepAdaptor_Surface(shape, True).D1(uv.X(), uv.Y(), x, du, dv)
        n = np.cross(_xyz(du), _xyz(dv)) * (-1.0 if str(shape.Orientation()).endswith("REVERSED") else 1.0)
        return np.asarray(n / max(float(np.linalg.norm(n)), 1e-300))

    def _points(self, curve: Any, kind: str, first: float, last: float) -> Floats:
        if kind == "Line":
            return np.array([_xyz(curve.Value(first)), _xyz(curve.Value(last))])
        # A fifth of the deviation: unrolling a cylinder stretches the distance of chords.
        made = importlib.import_module("OCP.GCPnts").GCPnts_TangentialDeflection(
            curve, first, last, 0.1, 0.2 * self.deviation
        )
        return np.array([_xyz(made.Value(i)) for i in range(1, made.NbPoints() + 1)])

    def _area(self, face: Any) -> float:
        made = importlib.import_module("OCP.GProp").GProp_GProps()
        static("BRepGProp", "BRepGProp", "SurfaceProperties")(face, made)
        return float(made.Mass())

    def _volume(self) -> float:
        made = importlib.import_module("OCP.GProp").GProp_GProps()
        static("BRepGProp", "BRepGProp", "VolumeProperties")(self.shape, made)
        return abs(float(made.Mass()))


def _xyz(of: Any) -> Floats:
    return np.array([of.X(), of.Y(), of.Z()])
