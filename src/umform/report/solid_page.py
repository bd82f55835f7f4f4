"""A page with the 3D view of a solid: the triangles of its faces, bends in another colour."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.report import looks, parts
from umform.report.facets import smooth_groups
from umform.report.live import shape_part, shape_scripts, style
from umform.report.packing import Quantised, pack
from umform.report.scene import Scene
from umform.surfaces.cad.solid import Solid

#: In a frame of another page: the view alone.
_STYLE = """
main { max-width: none; padding: 0 .2rem; }
header, footer, .player, .panel label, .legend { display: none; }
.panel { margin: 0; }
#shape-bar { display: flex !important; }
.stage { height: calc(100vh - 4.2rem); min-height: 12rem; }
"""
_SCRIPTS = ("unpack.js", "surfaces.js", "space.js", "shape.js", "start_solid.js")
#: Colours of flat faces and of bends.
_FLAT, _BENT = np.array([176, 186, 197]), np.array([230, 159, 0])
#: Decimals of positions in mm that are one.
_PLACES = 6


def write_solid(path: Path, solid: Solid, title: str) -> Path:
    """Write the page of a solid.

    Parameters
    ----------
    path : Path
        The page, ending in .html.
    solid : Solid
        Its faces with their triangles.
    title : str
        Of the page.
    """
    scene = scene_of_solid(solid)
    scripts = shape_scripts(scene, _SCRIPTS)
    return parts.write_html(path, title, "", [shape_part(scene)], style=style() + _STYLE, scripts=scripts)


def scene_of_solid(solid: Solid) -> Scene:
    """The scene of a solid: flat faces grey, cylinders in the colour of sheets."""
    corners = np.concatenate([face.corners for face in solid.faces.values()])
    bent = np.concatenate([np.full(len(face.corners), float(face.radius > 0.0)) for face in solid.faces.values()])
    outward = np.concatenate([_outward(face, face.corners) for face in solid.faces.values()])
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    turned = np.einsum("ei,ei->e", normals, outward) < 0.0
    corners[turned] = corners[turned, ::-1]
    points, ids = np.unique(corners.reshape(-1, 3).round(_PLACES), axis=0, return_inverse=True)
    triangles = ids.reshape(-1, 3)
    arrays: dict[str, NDArray[Any] | Quantised] = {
        "points": points,
        "faces": triangles,
        "groups": smooth_groups(points, triangles),
        "owners": np.arange(len(triangles)),
        "displacements": Quantised.of(np.zeros((1, *points.shape))),
        "field bent": Quantised.of(bent[None]),
    }
    head = {
        "frames": [{"row": 0, "time": 0.0}],
        "fields": [{"name": "bent", "label": "cylindrical", "on": "faces"}],
        "tools": [],
        "rolling": False,
        "look": looks.for_page() | {"map": _map()},
        "mirrors": [],
        "toolMirrors": [],
    }
    return Scene(pack(head, arrays), 1, ["cylindrical"], [], [], [])


def _map() -> str:
    """The colours of the field, 64 in hexadecimal."""
    steps = np.linspace(0.0, 1.0, 64)[:, None]
    colours = np.round((1.0 - steps) * _FLAT + steps * _BENT)
    return bytes(colours.astype(np.uint8)).hex()


def _outward(face: Any, corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """Normals out of the solid at the middles of triangles; of other faces those of the triangles."""
    middles = corners.mean(axis=1)
    if face.kind == "Plane":
        return np.broadcast_to(face.direction, middles.shape).copy()
    if face.kind == "Cylinder":
        return np.stack([face.normal(x) for x in middles])
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
