"""The sheet in a solid: its thickness, the faces of one side, how they meet, and what is no sheet."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.errors import DrawingError
from umform.surfaces.cad.solid import SMOOTH, Solid, SolidFace

Floats = NDArray[np.float64]

#: Distances below this part of the thickness are equal.
SAME = 1e-3
#: Part of the volume by which sheet and solid may differ.
_VOLUME = 1e-2
#: Number of the largest planes that the thickness is looked for on.
_LARGEST = 40


@dataclass(frozen=True, eq=False)
class Patch:
    """Faces of one side of the sheet on one plane, or on one cylinder.

    Attributes
    ----------
    face : SolidFace
        Its largest face.
    numbers : tuple of int
        Numbers of all its faces.
    edges : tuple of int
        Edges on its boundary.
    """

    face: SolidFace
    numbers: tuple[int, ...]
    edges: tuple[int, ...]

    @property
    def is_bend(self) -> bool:
        """Whether it is a cylinder."""
        return self.face.kind == "Cylinder"


@dataclass(frozen=True, eq=False)
class Skin:
    """One side of a sheet of constant thickness.

    Attributes
    ----------
    solid : Solid
        The part.
    thickness : float
        Thickness of the sheet.
    patches : tuple of Patch
        Planes and cylinders of one side; the first is the largest plane.
    neighbours : dict of int to list of (int, int)
        Of each patch, by place: the edges that it shares with others and their places.
    warnings : tuple of str
        What is unusual.
    """

    solid: Solid
    thickness: float
    patches: tuple[Patch, ...]
    neighbours: dict[int, list[tuple[int, int]]]
    warnings: tuple[str, ...]


def skin_of(solid: Solid) -> Skin:
    """Find the sheet in a solid.

    Parameters
    ----------
    solid : Solid
        The part.

    Raises
    ------
    DrawingError
        If it is no sheet of constant thickness of planes and cylinders; the message names the face.
    """
    planes = sorted((f for f in solid.faces.values() if f.kind == "Plane"), key=lambda f: -f.area)
    if not planes:
        raise _refuse(solid, "there is no flat face in this part", "", "free forms only", "export a bent sheet")
    thickness = _thickness(solid, planes)
    base = next(f for f in planes if _partner(solid, f, thickness) is not None)
    opposite = _partner(solid, base, thickness)
    assert opposite is not None
    one, other = _grown(solid, base), _grown(solid, opposite)
    for number in sorted(one):
        _check_kind(solid, solid.faces[number])
        if number in other or _partner(solid, solid.faces[number], thickness) is None:
            raise _no_partner(solid, solid.faces[number], thickness)
    warnings = _check_rest(solid, one | other)
    if _ups(solid, other) > _ups(solid, one) and all(_partner(solid, solid.faces[n], thickness) for n in other):
        one, base = other, opposite  # most bends are seen from their inner side
    patches = _patches(solid, one, base)
    _check_volume(solid, patches, thickness)
    return Skin(solid, thickness, patches, _neighbours(solid, patches), warnings)


def _refuse(solid: Solid, what: str, value: str, cause: str, remedy: str) -> DrawingError:
    return DrawingError(what, where=str(solid.path), value=value or None, cause=cause, remedy=remedy)


def _thickness(solid: Solid, planes: list[SolidFace]) -> float:
    """Distance of most of the area to the next face behind it."""
    found = list[tuple[float, float]]()
    for face in planes[:_LARGEST]:
        distances = [d for other in planes if (d := _behind(face, other)) > 1e-6]
        if distances:
            found.append((min(distances), face.area))
    if not found:
        raise _refuse(
            solid,
            "no two faces of this part are parallel",
            "",
            "no sheet: its thickness is nowhere the same",
            "export the solid of a sheet-metal part",
        )
    sums = {d: sum(area for e, area in found if abs(e - d) <= SAME * d) for d, _ in found}
    return round(float(max(sums, key=lambda d: (sums[d], -d))), 6)


def _behind(face: SolidFace, other: SolidFace) -> float:
    """Distance of a parallel face behind the middle of a face; 0 if it is not there."""
    if other.direction @ face.direction > -1.0 + 1e-9:
        return 0.0
    distance = float((face.point - other.point) @ face.direction)
    return distance if distance > 0.0 and other.covers(face.inside - distance * face.direction) else 0.0


def _partner(solid: Solid, face: SolidFace, thickness: float) -> SolidFace | None:
    """The face on the other side of the sheet at a constant distance."""
    near = [f for f in solid.faces.values() if f.kind == face.kind and _opposite(face, f, thickness)]
    return min(near, key=lambda f: float(np.linalg.norm(f.inside - face.inside)), default=None)


def _opposite(face: SolidFace, other: SolidFace, thickness: float) -> bool:
    slack = SAME * thickness
    if face.kind == "Plane":
        parallel = face.direction @ other.direction < -1.0 + 1e-9
        return bool(parallel and abs((face.point - other.point) @ face.direction - thickness) < slack)
    if face.kind != "Cylinder" or face.convex == other.convex or not _coaxial(face, other, slack):
        return False
    return abs(abs(face.radius - other.radius) - thickness) < slack and (face.radius > other.radius) == face.convex


def _coaxial(face: SolidFace, other: SolidFace, slack: float) -> bool:
    away = other.point - face.point
    parallel = abs(face.direction @ other.direction) > 1.0 - 1e-9
    return bool(parallel and np.linalg.norm(np.cross(away, face.direction)) < slack)


def _grown(solid: Solid, start: SolidFace) -> set[int]:
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


def _check_kind(solid: Solid, face: SolidFace) -> None:
    if face.kind in ("Plane", "Cylinder"):
        return
    cause = {
        "Cone": "a conical bend, which needs a rolled or bumped bend",
        "Torus": "a flanged or beaded edge, or a bend along a curve, which is drawn and not bent",
        "Sphere": "a drawn dome",
    }.get(face.kind, "a free form, which is drawn and not bent; or a bend that was exported as a spline")
    raise _refuse(
        solid,
        "a face of the sheet is neither a plane nor a cylinder",
        f"face {face.number}, a {face.kind}",
        cause,
        "only flat faces and cylindrical bends unfold; take this face out, or export cylinders as cylinders",
    )


def _no_partner(solid: Solid, face: SolidFace, thickness: float) -> DrawingError:
    what = f"radius {face.radius:.4g} mm" if face.kind == "Cylinder" else "a plane"
    return _refuse(
        solid,
        "a face of the sheet has no other face at the thickness behind it",
        f"face {face.number}, {what}; the sheet is {thickness:.4g} mm thick",
        "a varying thickness, a casting or milled part, a rounded edge, or a bend that is sharp inside",
        "draw both sides of the sheet at the same distance, with an inside radius in each bend",
    )


def _ups(solid: Solid, numbers: set[int]) -> int:
    return sum(1 for n in numbers if solid.faces[n].kind == "Cylinder" and not solid.faces[n].convex)


def _check_rest(solid: Solid, skins: set[int]) -> tuple[str, ...]:
    """Refuse faces that do not lie within the sheet; warn of edges that are not square to it."""
    on_skin = np.concatenate([solid.edges[k].points[[0, -1]] for n in skins for k in solid.faces[n].edges])
    warnings = []
    plain = ("Plane", "Cylinder")
    for number, face in sorted(solid.faces.items(), key=lambda pair: pair[1].kind in plain):  # free forms first
        if number in skins:
            continue
        if face.kind == "Cone":
            raise _refuse(
                solid,
                "a cone is no bend and no cut edge",
                f"face {number}",
                "a countersink or a chamfer",
                "take it out of the part; it is made after the bends",
            )
        ends = np.concatenate([solid.edges[k].points[[0, -1]] for k in face.edges])
        away = np.linalg.norm(ends[:, None] - on_skin, axis=2).min(axis=1)
        if away.max() > 1e-4:
            _check_kind(solid, face)
            raise _refuse(
                solid,
                "a face lies outside of the sheet",
                f"face {number}, a {face.kind}, has a corner {away.max():.3g} mm from the faces of the sheet",
                "a rib, boss or casting, a second thickness, or a bend that is sharp inside",
                "export the solid of a bent sheet of one thickness",
            )
        if not _square(solid, face, skins):
            warnings.append(
                f"face {number} is a cut edge that is not square to the sheet: the contour is that of the side of "
                "the unfolded faces"
            )
    return tuple(warnings)


def _square(solid: Solid, face: SolidFace, skins: set[int]) -> bool:
    """Whether a cut edge is square to the faces of the sheet beside it."""
    for k in face.edges:
        edge = solid.edges[k]
        beside = [solid.faces[n] for n in edge.faces if n in skins]
        if beside and face.kind in ("Plane", "Cylinder"):
            at = edge.points[len(edge.points) // 2] if edge.kind != "Line" else edge.points.mean(axis=0)
            if abs(face.normal(at) @ beside[0].normal(at)) > math.sin(SMOOTH * 2.0):
                return False
    return True


def _patches(solid: Solid, numbers: set[int], base: SolidFace) -> tuple[Patch, ...]:
    """Faces of one side, those on one surface that meet joined; the first one has the base."""
    left, found = set(numbers), list[Patch]()
    while left:
        first = base if base.number in left else solid.faces[min(left)]
        group, waiting = {first.number}, [first]
        while waiting:
            here = waiting.pop()
            for k in here.edges:
                for n in solid.edges[k].faces:
                    if n in left and n not in group and _same_surface(here, solid.faces[n]):
                        group.add(n)
                        waiting.append(solid.faces[n])
        left -= group
        count = Counter(k for n in group for k in solid.faces[n].edges)
        seams = {k for k in count if len(set(solid.edges[k].faces)) == 1}
        edges = tuple(sorted(k for k in count if count[k] == 1 and k not in seams))
        found.append(Patch(max((solid.faces[n] for n in group), key=lambda f: f.area), tuple(sorted(group)), edges))
    return tuple(found)


def _same_surface(face: SolidFace, other: SolidFace) -> bool:
    if face.kind != other.kind:
        return False
    if face.kind == "Plane":
        return bool(face.direction @ other.direction > 1.0 - 1e-9)
    return face.convex == other.convex and abs(face.radius - other.radius) < 1e-6 and _coaxial(face, other, 1e-5)


def _neighbours(solid: Solid, patches: tuple[Patch, ...]) -> dict[int, list[tuple[int, int]]]:
    of_edge = dict[int, list[int]]()
    for place, patch in enumerate(patches):
        for k in patch.edges:
            of_edge.setdefault(k, []).append(place)
    found: dict[int, list[tuple[int, int]]] = {place: [] for place in range(len(patches))}
    for k, pair in of_edge.items():
        if len(pair) == 2:
            found[pair[0]].append((k, pair[1]))
            found[pair[1]].append((k, pair[0]))
    return found


def _check_volume(solid: Solid, patches: tuple[Patch, ...], thickness: float) -> None:
    """Compare the volume of the sheet of one thickness with that of the solid."""
    volume = 0.0
    for patch in patches:
        for number in patch.numbers:
            face = solid.faces[number]
            middle = 1.0
            if face.kind == "Cylinder":
                middle += (-0.5 if face.convex else 0.5) * thickness / face.radius
            volume += face.area * thickness * middle
    if abs(volume / solid.volume - 1.0) > _VOLUME:
        raise _refuse(
            solid,
            "this solid is no sheet of one thickness",
            f"its volume is {solid.volume:.6g} mm³; {thickness:.4g} mm of sheet on its faces are {volume:.6g}",
            "a casting, a varying thickness, or a tube or fold whose sides touch",
            "export the solid of a bent sheet of one thickness",
        )
