"""The 3D scene of a page: outer faces, frames with their fields, tools with their poses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray

from umform.report.bodies import Poses, displacements, tool_bodies
from umform.report.facets import smooth_groups
from umform.report.packing import Quantised, pack
from umform.report.symmetry import Mirror, mirrors
from umform.results.shape import outer_quads
from umform.surfaces.triangles import Triangles

if TYPE_CHECKING:
    from umform.model.equations.frame import Frame
    from umform.results.history import History

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: A field has two signs if the smaller extreme is more than this part of the larger one.
_TWO_SIGNS = 0.02
#: Order of the fields in the menu; others follow.
_ORDER = (
    "plastic_strain_max",
    "plastic_strain_mean",
    "thickness_change",
    "stress_von_mises",
    "back_stress_von_mises",
    "modulus",
    "displacement",
    "contact_pressure",
    "friction_traction",
    "slip",
)


@dataclass(frozen=True)
class Scene:
    """Content of the scene.

    Attributes
    ----------
    data : str
        The packed scene.
    frames : int
        Number of frames.
    fields : list of str
        Labels of the fields.
    tools : list of str
        Names of the tools that are drawn.
    notes : list of str
        What could not be drawn.
    mirrors : list of Mirror
        Planes of symmetry: the browser draws the mirror images.
    rolling : bool
        Whether it has the rolling direction of each cell.
    """

    data: str
    frames: int
    fields: list[str]
    tools: list[str]
    notes: list[str]
    mirrors: list[Mirror]
    rolling: bool = False


def scene_of(result: History) -> Scene:
    """The scene of a result; without kept frames, only its last state."""
    mesh = result.model.mesh
    faces, owners = outer_quads(mesh.connectivity.astype(np.int64))
    nodes, faces = np.unique(faces, return_inverse=True)
    cells, owners = np.unique(owners, return_inverse=True)
    faces = faces.reshape(-1, 4)
    X = mesh.points[nodes]
    shifts = displacements(result)[:, nodes]
    arrays: dict[str, NDArray[Any] | Quantised] = {
        "points": X,
        "faces": faces,
        "groups": smooth_groups(X, faces),
        "owners": owners,
        "displacements": Quantised.of(shifts),
    }
    fields: list[dict[str, Any]] = []
    for name, place, values in _fields(result.frames, shifts, nodes, cells):
        arrays[f"field {name}"] = Quantised.of(values)
        fields.append({"name": name, "label": name.replace("_", " "), "on": place, **_scale(values)})
    axes = _rolling(result.frames, cells)
    if axes is not None:
        arrays["rolling"] = Quantised.of(axes)
    planes = mirrors(result.model)
    bodies, notes = tool_bodies(result, X + shifts, planes)
    for number, body in enumerate(bodies):
        arrays |= _tool_arrays(f"tool {number}", body.surface, body.poses)
    tools = [body.name for body in bodies]
    head = {
        "frames": _marks(result),
        "fields": fields,
        "tools": tools,
        "rolling": axes is not None,
        "maps": _maps(fields),
        "mirrors": [{"axis": plane.axis, "at": plane.at} for plane in planes],
        "toolMirrors": [[planes.index(plane) for plane in body.mirrored] for body in bodies],
    }
    labels = [field["label"] for field in fields]
    return Scene(pack(head, arrays), len(shifts), labels, tools, notes, planes, axes is not None)


def _marks(result: History) -> list[dict[str, float]]:
    """Row of the history and time of each frame."""
    if not result.frames:
        return [{"row": len(result) - 1, "time": float(result.model.system.time)}]
    return [{"row": frame.number, "time": float(frame.time)} for frame in result.frames]


def _fields(frames: list[Frame], shifts: Floats, nodes: Ids, cells: Ids) -> Iterator[tuple[str, str, Floats]]:
    """Name, location and values (frames, n) of the scalar fields that are finite everywhere."""
    found: dict[str, tuple[str, Floats]] = {"displacement": ("points", np.linalg.norm(shifts, axis=2))}
    if frames:
        for place, ids in (("points", nodes), ("cells", cells)):
            for name, first in getattr(frames[0], place).items():
                if first.ndim == 1:
                    values = np.stack([getattr(frame, place)[name][ids] for frame in frames])
                    if np.isfinite(values).all():
                        found[name] = place, values
    for name in sorted(found, key=lambda name: _ORDER.index(name) if name in _ORDER else len(_ORDER)):
        yield name, *found[name]


def _rolling(frames: list[Frame], cells: Ids) -> Floats | None:
    """Rolling directions (frames, cells, 3) of the visible cells; None if no body has one."""
    if not frames or "rolling" not in frames[0].cells:
        return None
    return np.stack([frame.cells["rolling"][cells] for frame in frames])


def _scale(values: Floats) -> dict[str, object]:
    """The colour map for a field: diverging about zero if it has both signs."""
    low, high = float(values.min()), float(values.max())
    both = min(-low, high) > _TWO_SIGNS * max(-low, high)
    return {"map": "coolwarm" if both else "viridis", "symmetric": both}


def _maps(fields: list[dict[str, Any]]) -> dict[str, str]:
    """Colour maps as 64 colours in hexadecimal."""
    names = sorted({field["map"] for field in fields})
    steps = np.linspace(0.0, 1.0, 64)
    return {name: (mpl.colormaps[name](steps, bytes=True)[:, :3]).tobytes().hex() for name in names}


def _tool_arrays(name: str, surface: Triangles, poses: Poses) -> dict[str, NDArray[Any] | Quantised]:
    rotations, shifts = poses
    return {
        f"{name} points": surface.points,
        f"{name} faces": surface.triangles,
        f"{name} groups": smooth_groups(surface.points, surface.triangles),
        f"{name} poses": np.concatenate([rotations, shifts[:, :, None]], axis=2),
    }
