"""Calls of OpenCASCADE for tools: files, triangles of faces, points and derivatives on them."""

from __future__ import annotations

import importlib
import math
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.errors import DrawingError, FileProblem
from umform.surfaces.triangles import Floats, Ids

#: Part of the size of a shape within which the faces of an IGES file are sewn together.
_SEWN = 1e-5
#: Part of the size of a shape within which a spline counts as a plane, a cylinder, ...
_RECOGNISED = 1e-7
#: Part of the way to the middle of a triangle at which the normal of a pole is taken.
_BESIDE = 1e-3
STEP, IGES = (".step", ".stp"), (".iges", ".igs")


@dataclass(frozen=True, eq=False)
class Face:
    """One face of a shape.

    Attributes
    ----------
    number : int
        Its place in the shape, from 1.
    points : ndarray, shape (n, 3)
        Points of its triangles, on the face.
    uv : ndarray, shape (n, 2)
        Their parameters.
    triangles : ndarray of int, shape (m, 3)
        Counter-clockwise from outside of the solid.
    reversed : bool
        The outward normal is the opposite of that of the parameters.
    surface : object
        The surface with its derivatives, of OpenCASCADE.
    formula : object
        The same as a plane, a cylinder, ... if it is one, also where the file stores a spline or a surface of
        revolution.
    """

    number: int
    points: Floats
    uv: Floats
    triangles: Ids
    reversed: bool
    surface: Any
    formula: Any

    @cached_property
    def kind(self) -> str:
        """Plane, Cylinder, Cone, Sphere, Torus, or another word for a free form."""
        return kind_of(self.formula)

    def derivatives(self, uv: Floats) -> tuple[Floats, Floats, Floats]:
        """Points and their derivatives by both parameters, each of shape (n, 3)."""
        gp = importlib.import_module("OCP.gp")
        x, du, dv = gp.gp_Pnt(), gp.gp_Vec(), gp.gp_Vec()
        rows = np.empty((len(uv), 9))
        for row, (u, v) in zip(rows, uv.tolist(), strict=True):  # the library knows single points only
            self.surface.D1(u, v, x, du, dv)
            row[:] = (x.X(), x.Y(), x.Z(), du.X(), du.Y(), du.Z(), dv.X(), dv.Y(), dv.Z())
        return rows[:, :3], rows[:, 3:6], rows[:, 6:]

    def normals(self) -> Floats:
        """Unit normals out of the solid at the points; at a pole of the parametrisation that of a place beside it."""
        n, regular = self._crosses(self.uv)
        if not regular.all():
            ids = self.triangles.ravel()
            way = np.zeros_like(self.uv)
            way[ids] = np.repeat(self.uv[self.triangles].mean(axis=1), 3, axis=0) - self.uv[ids]  # the last one counts
            near, far = (_unit(self._crosses((self.uv + k * _BESIDE * way)[~regular])[0]) for k in (1, 2))
            n[~regular] = 2.0 * near - far
        return _unit(n)

    def _crosses(self, uv: Floats) -> tuple[Floats, NDArray[np.bool_]]:
        """Cross products of the derivatives, and where these are not nearly zero."""
        _, du, dv = self.derivatives(uv)
        n = np.cross(dv, du) if self.reversed else np.cross(du, dv)
        largest = np.linalg.norm(du, axis=1).max() * np.linalg.norm(dv, axis=1).max()
        return n, np.linalg.norm(n, axis=1) > 1e-7 * largest


def _unit(n: Floats) -> Floats:
    return np.asarray(n / np.linalg.norm(n, axis=1, keepdims=True))


class Shape:
    """A shape of a file.

    Parameters
    ----------
    path : str or Path
        The file.
    scale : float
        Factor on millimetres, in which OpenCASCADE reads.

    Raises
    ------
    FileProblem
        If OpenCASCADE is not installed, or cannot read the file.
    """

    def __init__(self, path: str | Path, scale: float = 1.0) -> None:
        self.path = Path(path)
        self._shape = scaled(read_shape(self.path)[0], scale)
        self.size = self._size()
        if self.path.suffix.lower() in IGES or not self._has_solid():  # loose faces have no common orientation
            self._shape = _sewn(self._shape, _SEWN * self.size)

    def faces(self, arrow: float, angle: float) -> list[Face]:
        """Its faces with triangles that turn by at most an angle and deviate from the faces by at most a distance.

        Raises
        ------
        DrawingError
            If a face cannot be triangulated.
        """
        mesh = importlib.import_module("OCP.BRepMesh")
        static("BRepTools", "BRepTools", "Clean")(self._shape)
        mesh.BRepMesh_IncrementalMesh(self._shape, arrow, False, angle, False)
        return [self._face(face, number) for number, face in enumerate(self._explored(), start=1)]

    def _has_solid(self) -> bool:
        exploring = importlib.import_module("OCP.TopExp").TopExp_Explorer
        kinds = importlib.import_module("OCP.TopAbs").TopAbs_ShapeEnum
        return bool(exploring(self._shape, kinds.TopAbs_SOLID).More())

    def _explored(self) -> list[Any]:
        exploring = importlib.import_module("OCP.TopExp").TopExp_Explorer
        kinds = importlib.import_module("OCP.TopAbs").TopAbs_ShapeEnum
        cast = static("TopoDS", "TopoDS", "Face")
        at, faces = exploring(self._shape, kinds.TopAbs_FACE), []
        while at.More():
            faces.append(cast(at.Current()))
            at.Next()
        if not faces:
            raise DrawingError(
                "there is no face in the file",
                where=str(self.path),
                cause="curves and points only, or an assembly without its parts",
                remedy="export the solid, or its faces",
            )
        return faces

    def _face(self, face: Any, number: int) -> Face:
        location = importlib.import_module("OCP.TopLoc").TopLoc_Location()
        made = static("BRep", "BRep_Tool", "Triangulation")(face, location)
        surface = importlib.import_module("OCP.BRepAdaptor").BRepAdaptor_Surface(face, True)
        if made is None or not made.NbTriangles() or not made.HasUVNodes():
            raise DrawingError(
                "a face cannot be triangulated",
                where=str(self.path),
                value=f"face {number}, a {kind_of(surface)}",
                cause="its boundary crosses itself, or leaves the surface",
                remedy="repair the face in the program that wrote the file",
            )
        turn = location.Transformation()
        nodes = range(1, made.NbNodes() + 1)
        points = np.array([(p.X(), p.Y(), p.Z()) for p in (made.Node(i).Transformed(turn) for i in nodes)])
        uv = np.array([(p.X(), p.Y()) for p in (made.UVNode(i) for i in nodes)])
        triangles = np.array([made.Triangle(i).Get() for i in range(1, made.NbTriangles() + 1)], dtype=np.int64) - 1
        reverse = str(face.Orientation()).endswith("REVERSED")
        return Face(
            number, points, uv, triangles[:, :: -1 if reverse else 1], reverse, surface, self._formula(face, surface)
        )

    def _formula(self, face: Any, surface: Any) -> Any:
        """The surface as OpenCASCADE recognises it."""
        if kind_of(surface) in ("Plane", "Cylinder", "Cone", "Sphere", "Torus"):
            return surface
        convert = importlib.import_module("OCP.GeomConvert").GeomConvert_SurfToAnaSurf
        found = convert(static("BRep", "BRep_Tool", "Surface")(face)).ConvertToAnalytical(_RECOGNISED * self.size)
        return surface if found is None else importlib.import_module("OCP.GeomAdaptor").GeomAdaptor_Surface(found)

    def _size(self) -> float:
        bounds = importlib.import_module("OCP.Bnd").Bnd_Box()
        static("BRepBndLib", "BRepBndLib", "Add")(self._shape, bounds)
        return math.sqrt(bounds.SquareExtent()) if not bounds.IsVoid() else 1.0


def kind_of(surface: Any) -> str:
    """The word of OpenCASCADE for a kind of surface."""
    return str(surface.GetType()).rpartition("_")[2]


def static(module: str, name: str, function: str) -> Any:
    """A static function; where the wheel has others of its name, or in older wheels, it ends in _s."""
    of = getattr(importlib.import_module(f"OCP.{module}"), name)
    return getattr(of, f"{function}_s", None) or getattr(of, function)


def quiet() -> None:
    """Keep counts of entities of OpenCASCADE, in colours, off the terminal; its failures are printed."""
    least = importlib.import_module("OCP.Message").Message_Gravity.Message_Fail
    for printer in static("Message", "Message", "DefaultMessenger")().Printers():
        printer.SetTraceLevel(least)


def read_shape(path: Path) -> tuple[Any, str]:
    """The shape of a STEP or IGES file in millimetres, and the unit that a STEP file names."""
    suffix = path.suffix.lower()
    if suffix not in STEP + IGES:
        raise FileProblem(
            "a drawing in space is a STEP or an IGES file",
            where=str(path),
            value=suffix,
            cause="another format",
            remedy="export as .step or .stl; a section in a DXF drawing is a profile, such as that of an Extruded tool",
        )
    if not path.exists():
        raise FileProblem(
            "there is no such file",
            where=str(path),
            cause="another name or folder; in a deck the path begins at its folder",
            remedy="give the path of a STEP or IGES file",
        )
    try:
        if suffix in STEP:
            reader = importlib.import_module("OCP.STEPControl").STEPControl_Reader()
        else:
            reader = importlib.import_module("OCP.IGESControl").IGESControl_Reader()
    except ImportError as error:
        raise FileProblem(
            "reading STEP and IGES files needs OpenCASCADE",
            where=str(path),
            cause=str(error),
            remedy='pip install "umform[cad]"',
        ) from error
    quiet()
    done = importlib.import_module("OCP.IFSelect").IFSelect_ReturnStatus.IFSelect_RetDone
    shape, unit = None, ""
    if reader.ReadFile(str(path)) == done:
        unit = _unit_of(reader) if suffix in STEP else ""
        reader.TransferRoots()
        shape = reader.OneShape()
    if shape is None or shape.IsNull():
        raise FileProblem(
            "this file cannot be read",
            where=str(path),
            cause="it was cut off, or is of another kind than its name says",
            remedy="export it again as STEP AP214 or AP242",
        )
    return shape, unit


def _unit_of(reader: Any) -> str:
    names = [importlib.import_module("OCP.collections").Sequence_TCollection_AsciiString() for _ in range(3)]
    reader.FileUnits(*names)
    return str(names[0].Value(1).ToCString()).lower() if names[0].Length() else ""


def scaled(shape: Any, scale: float) -> Any:
    """The shape made larger by a factor."""
    if scale == 1.0:
        return shape
    gp = importlib.import_module("OCP.gp")
    transformation = gp.gp_Trsf()
    transformation.SetScale(gp.gp_Pnt(0.0, 0.0, 0.0), scale)
    return importlib.import_module("OCP.BRepBuilderAPI").BRepBuilderAPI_Transform(shape, transformation, True).Shape()


def _sewn(shape: Any, tolerance: float) -> Any:
    sewing = importlib.import_module("OCP.BRepBuilderAPI").BRepBuilderAPI_Sewing(tolerance)
    sewing.Add(shape)
    sewing.Perform()
    return sewing.SewedShape()
