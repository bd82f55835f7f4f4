"""Pairs of faces of a solid at the thickness of a sheet, and faces that go on smoothly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.errors import DrawingError
from umform.surfaces.cad.solid import Solid, SolidFace

Floats = NDArray[np.float64]

#: Distances below this part of the thickness are equal.
SAME = 1e-3
#: Number of the largest planes that the thickness is looked for on.
_LARGEST = 40


def thickness_of(solid: Solid, planes: list[SolidFace]) -> float:
    """Distance of most of the area to the next face behind it."""
    found = list[tuple[float, float]]()
    for face in planes[:_LARGEST]:
        distances = [d for other in planes if (d := behind(face, other)) > 1e-6]
        if distances:
            found.append((min(distances), face.area))
    if not found:
        raise refusal(
            solid,
            "no two faces of this part are parallel",
            "",
            "no sheet: its thickness is nowhere the same",
            "export the solid of a sheet-metal part",
        )
    sums = {d: sum(area for e, area in found if abs(e - d) <= SAME * d) for d, _ in found}
    return round(float(max(sums, key=lambda d: (sums[d], -d))), 6)


def behind(face: SolidFace, other: SolidFace) -> float:
    """Distance of a parallel face behind the middle of a face; 0 if it is not there."""
    if other.direction @ face.direction > -1.0 + 1e-9:
        return 0.0
    distance = float((face.point - other.point) @ face.direction)
    return distance if distance > 0.0 and other.covers(face.inside - distance * face.direction) else 0.0


def back_of(face: SolidFace, planes: list[SolidFace], thickness: float) -> SolidFace | None:
    """The plane behind the middle of a plane at the thickness."""
    return next((one for one in planes if abs(behind(face, one) - thickness) < SAME * thickness), None)


def partner(solid: Solid, face: SolidFace, thickness: float) -> SolidFace | None:
    """The face on the other side of the sheet at a constant distance."""
    near = [f for f in solid.faces.values() if f.kind == face.kind and _opposite(face, f, thickness)]
    return min(near, key=lambda f: float(np.linalg.norm(f.inside - face.inside)), default=None)


def _opposite(face: SolidFace, other: SolidFace, thickness: float) -> bool:
    slack = SAME * thickness
    if face.kind == "Plane":
        parallel = face.direction @ other.direction < -1.0 + 1e-9
        return bool(parallel and abs((face.point - other.point) @ face.direction - thickness) < slack)
    if face.kind != "Cylinder" or face.convex == other.convex or not coaxial(face, other, slack):
        return False
    return abs(abs(face.radius - other.radius) - thickness) < slack and (face.radius > other.radius) == face.convex


def coaxial(face: SolidFace, other: SolidFace, slack: float) -> bool:
    """Whether two cylinders have one axis."""
    away = other.point - face.point
    parallel = abs(face.direction @ other.direction) > 1.0 - 1e-9
    return bool(parallel and np.linalg.norm(np.cross(away, face.direction)) < slack)


def same_surface(face: SolidFace, other: SolidFace) -> bool:
    """Whether two faces lie on one plane or one cylinder, with the same side outside."""
    if face.kind != other.kind:
        return False
    if face.kind == "Plane":
        return bool(face.direction @ other.direction > 1.0 - 1e-9)
    return face.convex == other.convex and abs(face.radius - other.radius) < 1e-6 and coaxial(face, other, 1e-5)


def grown(solid: Solid, start: SolidFace) -> set[int]:
    """Faces that are reached from a face over smooth edges."""
    found, waiting = {start.number}, [start]
    while waiting:
        for k in waiting.pop().edges:
            edge = solid.edges[k]
            if edge.smooth:
                new = set(edge.faces) - found
                found |= new
                waiting += [solid.faces[n] for n in new]
    return found


def refusal(solid: Solid, what: str, value: str, cause: str, remedy: str) -> DrawingError:
    """Error that names the file."""
    return DrawingError(what, where=str(solid.path), value=value or None, cause=cause, remedy=remedy)
