"""The sheet in a solid: its thickness, the faces of one side and how they meet."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

from umform.flat_pattern.no_sheet import check_kind, check_rest, check_volume, no_partner
from umform.flat_pattern.sides import back_of, grown, partner, refusal, same_surface, thickness_of
from umform.surfaces.cad.solid import Solid, SolidFace


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
        raise refusal(solid, "there is no flat face in this part", "", "free forms only", "export a bent sheet")
    thickness = thickness_of(solid, planes)
    base, opposite = next((f, back) for f in planes if (back := back_of(f, planes, thickness)) is not None)
    one, other = grown(solid, base), grown(solid, opposite)
    for number in sorted(one):
        check_kind(solid, solid.faces[number])
        if number in other or partner(solid, solid.faces[number], thickness) is None:
            raise no_partner(solid, solid.faces[number], thickness)
    warnings = check_rest(solid, one | other)
    check_volume(solid, one | other, thickness)
    if _ups(solid, other) > _ups(solid, one) and all(partner(solid, solid.faces[n], thickness) for n in other):
        one, base = other, opposite  # most bends are seen from their inner side
    patches = _patches(solid, one, base)
    return Skin(solid, thickness, patches, _neighbours(solid, patches), warnings)


def _ups(solid: Solid, numbers: set[int]) -> int:
    return sum(1 for n in numbers if solid.faces[n].kind == "Cylinder" and not solid.faces[n].convex)


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
                    if n in left and n not in group and same_surface(here, solid.faces[n]):
                        group.add(n)
                        waiting.append(solid.faces[n])
        left -= group
        count = Counter(k for n in group for k in solid.faces[n].edges)
        seams = {k for k in count if len(set(solid.edges[k].faces)) == 1}
        edges = tuple(sorted(k for k in count if count[k] == 1 and k not in seams))
        found.append(Patch(max((solid.faces[n] for n in group), key=lambda f: f.area), tuple(sorted(group)), edges))
    return tuple(found)


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
