"""The 3D scene of a page: outer faces, frames with their fields, tools with their poses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray

from umform.errors import UmformError
from umform.report.facets import smooth_groups
from umform.report.packing import Quantised, pack
from umform.report.symmetry import Mirror, is_symmetric, mirrors
from umform.results.forming.tool_distance import pose_in
from umform.results.shape import outer_quads
from umform.surfaces import Tool
from umform.surfaces.sampled import sampled
from umform.surfaces.triangles import Box3, Triangles, inside_of

if TYPE_CHECKING:
    from umform.model.equations.frame import Frame
    from umform.model.tools.tool import Tool as RigidTool
    from umform.results.history import History

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]
#: Poses of a tool, one for each frame: rotations (frames, 3, 3) and shifts (frames, 3).
Poses = tuple[Floats, Floats]
#: Lowest and highest corner.
Box = tuple[Floats, Floats]

#: Tools are drawn up to this part of the diagonal of the sheet around its path.
_MARGIN = 0.12
#: Largest deviation of a drawn tool from the true one, as a part of the same diagonal.
_CHORD = 5e-4
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
    shifts = _displacements(result)[:, nodes]
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
    bodies, notes = _tools(result, _around(X + shifts), planes)
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


@dataclass(frozen=True)
class _Body:
    """A tool to be drawn, and the planes at which it is mirrored separately."""

    name: str
    surface: Triangles
    poses: Poses
    mirrored: list[Mirror]


def _tools(result: History, box: Box, planes: list[Mirror]) -> tuple[list[_Body], list[str]]:
    """The tools that can be drawn, and notes on the others."""
    bodies, notes = [], []
    for tool, poses in zip(result.model.tools, _poses(result), strict=True):
        try:
            mirrored = [plane for plane in planes if not _goes_through(tool, poses, plane, box)]
            drawn = box
            for plane in planes:
                drawn = drawn if plane in mirrored else _both_sides(drawn, plane)
            surface = _surface(tool, poses, drawn)
        except UmformError as error:
            notes.append(f"The tool {tool.name} is not drawn: {error.what}.")
            continue
        if len(surface.triangles):
            bodies.append(_Body(tool.name, surface, poses, mirrored))
    return bodies, notes


def _goes_through(tool: RigidTool, poses: Poses, plane: Mirror, box: Box) -> bool:
    """Whether a tool is its own mirror image at the first and at the last frame."""
    rotations, shifts = poses
    return all(is_symmetric(partial(_gap, tool, rotations[n], shifts[n]), plane, box) for n in (0, -1))


def _gap(tool: RigidTool, rotation: Floats, shift: Floats, x: Floats) -> Floats:
    """Distances of positions to a tool in some pose."""
    gaps: Floats = np.asarray(tool.kernel.gap(np.ascontiguousarray((x - shift) @ rotation))[0])
    return gaps


def _both_sides(box: Box, plane: Mirror) -> Box:
    """The bounding box of a box and its mirror image."""
    corners = np.stack(box)
    both = np.concatenate([corners, plane.image(corners)])
    return both.min(axis=0), both.max(axis=0)


def _displacements(result: History) -> Floats:
    if not result.frames:
        return result.model.u.reshape(1, -1, 3)
    return np.stack([frame.points["displacement"] for frame in result.frames])


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


def _around(x: Floats) -> Box:
    """Lowest and highest corner of a box around the sheet on its whole path."""
    low, high = x.min(axis=(0, 1)), x.max(axis=(0, 1))
    margin = _MARGIN * np.linalg.norm(high - low)
    return low - margin, high + margin


def _poses(result: History) -> Iterator[Poses]:
    """Poses of each tool at the frames."""
    for tool in result.model.tools:
        if not result.frames:
            rotation, shift = tool.pose_now
            yield rotation[None], shift[None]
            continue
        places = [pose_in(tool, result.rows[frame.number]) for frame in result.frames]
        rotations, shifts = zip(*places, strict=True)
        yield np.stack(rotations), np.stack(shifts)


def _surface(tool: RigidTool, poses: Poses, box: Box) -> Triangles:
    """Triangles of a tool, in its frame, that enter the box in one frame at least."""
    low, high = box
    corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
    own = np.concatenate([(corners - shift) @ rotation for rotation, shift in zip(*poses, strict=True)])
    inner: Box3 = (tuple(own.min(axis=0)), tuple(own.max(axis=0)))
    surface = tool.surface
    facets = surface.facets if isinstance(surface, Tool) else partial(sampled, tool.kernel.gap)
    return inside_of(facets, inner, _CHORD * float(np.linalg.norm(high - low)))


def _tool_arrays(name: str, surface: Triangles, poses: Poses) -> dict[str, NDArray[Any] | Quantised]:
    rotations, shifts = poses
    return {
        f"{name} points": surface.points,
        f"{name} faces": surface.triangles,
        f"{name} groups": smooth_groups(surface.points, surface.triangles),
        f"{name} poses": np.concatenate([rotations, shifts[:, :, None]], axis=2),
    }
