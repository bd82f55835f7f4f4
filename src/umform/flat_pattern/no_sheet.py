"""What makes a solid no bent sheet of one thickness: the face, and the likely cause."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from umform.errors import DrawingError
from umform.flat_pattern.sides import refusal
from umform.surfaces.cad.solid import SMOOTH, Solid, SolidFace

#: Part of the volume by which sheet and solid may differ.
_VOLUME = 1e-2


def check_kind(solid: Solid, face: SolidFace) -> None:
    """Refuse a face that is neither a plane nor a cylinder."""
    if face.kind in ("Plane", "Cylinder"):
        return
    cause = {
        "Cone": "a conical bend, which needs a rolled or bumped bend",
        "Torus": "a flanged or beaded edge, or a bend along a curve, which is drawn and not bent",
        "Sphere": "a drawn dome",
    }.get(face.kind, "a free form, which is drawn and not bent; or a bend that was exported as a spline")
    raise refusal(
        solid,
        "a face of the sheet is neither a plane nor a cylinder",
        f"face {face.number}, a {face.kind}",
        cause,
        "only flat faces and cylindrical bends unfold; take this face out, or export cylinders as cylinders",
    )


def no_partner(solid: Solid, face: SolidFace, thickness: float) -> DrawingError:
    """Error for a face of one side without a face of the other."""
    what = f"radius {face.radius:.4g} mm" if face.kind == "Cylinder" else "a plane"
    return refusal(
        solid,
        "a face of the sheet has no other face at the thickness behind it",
        f"face {face.number}, {what}; the sheet is {thickness:.4g} mm thick",
        "a varying thickness, a casting or milled part, a rounded edge, or a bend that is sharp inside",
        "draw both sides of the sheet at the same distance, with an inside radius in each bend",
    )


def check_rest(solid: Solid, skins: set[int]) -> tuple[str, ...]:
    """Refuse faces that do not lie within the sheet; warn of edges that are not square to it."""
    on_skin = np.concatenate([solid.edges[k].points[[0, -1]] for n in skins for k in solid.faces[n].edges])
    warnings = []
    plain = ("Plane", "Cylinder")
    for number, face in sorted(solid.faces.items(), key=lambda pair: pair[1].kind in plain):  # free forms first
        if number in skins:
            continue
        if face.kind == "Cone":
            raise refusal(
                solid,
                "a cone is no bend and no cut edge",
                f"face {number}",
                "a countersink or a chamfer",
                "take it out of the part; it is made after the bends",
            )
        ends = np.concatenate([solid.edges[k].points[[0, -1]] for k in face.edges])
        away = np.linalg.norm(ends[:, None] - on_skin, axis=2).min(axis=1)
        if away.max() > 1e-4:
            check_kind(solid, face)
            raise refusal(
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


def check_volume(solid: Solid, sides: Iterable[int], thickness: float) -> None:
    """Compare the volume of the solid with that of the sheet: thickness times the mean area of its two sides."""
    volume = 0.5 * thickness * sum(solid.faces[number].area for number in sides)
    if abs(volume / solid.volume - 1.0) > _VOLUME:
        raise refusal(
            solid,
            "this solid is no sheet of one thickness",
            f"its volume is {solid.volume:.6g} mm³; {thickness:.4g} mm of sheet on its faces are {volume:.6g}",
            "a casting, a varying thickness, or a tube or fold whose sides touch",
            "export the solid of a bent sheet of one thickness",
        )
