"""The 3D scene of a page: outer faces, frames with their fields, tools with their poses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from umform.report import looks
from umform.report.bodies import Poses, displacements, tool_bodies
from umform.report.facets import smooth_groups
from umform.report.looks import UNKNOWN, Units
from umform.report.packing import Quantised, pack
from umform.report.part import means_at_corners, plane_strain, widened
from umform.report.patches import Surface
from umform.report.skin import parts_of
from umform.report.symmetry import Mirror, mirrors, mirrors_of_blank
from umform.surfaces.triangles import Triangles

if TYPE_CHECKING:
    from umform.model.equations.frame import Frame
    from umform.results.history import History

Floats = NDArray[np.float64]
Ids = NDArray[np.int64]

#: Largest number of parts of a face along a side in the browser, and about how many parts all faces have.
_FINE, _PARTS = 4, 40_000


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


def scene_of(result: History, units: Units = UNKNOWN) -> Scene:
    """The scene of a result; without kept frames, only its last state.

    Parameters
    ----------
    result : History
        The result.
    units : Units
        Names of its units, for the fields.
    """
    mesh, planes, wide = result.model.mesh, mirrors(result.model), plane_strain(result.model)
    cells = mesh.connectivity.astype(np.int64)
    surface = Surface.of(mesh.points, cells, parts_of(cells, _FINE, _PARTS), mirrors_of_blank(result.model))
    nodes = np.unique(np.concatenate([kind.nodes.ravel() for kind in surface.patches]))
    arrays = _surface_arrays(surface, nodes)
    shifts = displacements(result)
    places = mesh.points + shifts if wide is None else widened(mesh.points + shifts, *wide)
    first = places[0]  # from the blank on, the way into other tools would take the digits
    arrays["points"], arrays["displacements"] = first[nodes], Quantised.of((places - first)[:, nodes])
    fields: list[dict[str, Any]] = []
    for name, kind, values in _fields(result.frames, shifts, nodes, cells):
        look = looks.look_of(name)
        arrays[f"field {name}"] = Quantised.of(look.factor * values)
        fields.append({"name": name, "label": look.label(units), "on": kind})
    axes = _rolling(result.frames)
    if axes is not None:
        arrays["rolling"] = Quantised.of(axes)
    bodies, notes = tool_bodies(result, places, planes)
    if wide is not None:
        notes.append(
            f"Plane strain: the same in each section, drawn {wide[1]:.3g}{units.length and f' {units.length}'} wide."
        )
    for number, body in enumerate(bodies):
        arrays |= _tool_arrays(f"tool {number}", body.surface, body.poses)
    tools = [body.name for body in bodies]
    head = {
        "frames": _marks(result),
        "fields": fields,
        "tools": tools,
        "rolling": axes is not None,
        "look": looks.for_page(),
        "patches": [
            {"points": kind.size, "grid": kind.nodes.shape[1:], "inner": kind.inner} for kind in surface.patches
        ],
        "lines": [line.shape[1] for line in surface.lines],
        "mirrors": [{"axis": plane.axis, "at": plane.at} for plane in planes],
        "toolMirrors": [[planes.index(plane) for plane in body.mirrored] for body in bodies],
    }
    labels = [field["label"] for field in fields]
    return Scene(pack(head, arrays), len(shifts), labels, tools, notes, planes, axes is not None)


def _surface_arrays(surface: Surface, nodes: Ids) -> dict[str, NDArray[Any] | Quantised]:
    """Matrices and numbers of a surface, whose nodes are numbered as in the scene."""
    arrays: dict[str, NDArray[Any] | Quantised] = {}
    for number, kind in enumerate(surface.patches):
        of = f"patches {number}"
        arrays |= {
            f"{of} nodes": np.searchsorted(nodes, kind.nodes),
            f"{of} groups": kind.groups,
            f"{of} owners": kind.owners,
            f"{of} position": kind.position,
            f"{of} rows": kind.rows,
            f"{of} columns": kind.columns,
            f"{of} middle": kind.middle,
            f"{of} corners": kind.corners,
        }
    arrays |= {f"lines {number}": line for number, line in enumerate(surface.lines)}
    return arrays | {f"seam {number}": seam for number, seam in enumerate(surface.seams)}


def _marks(result: History) -> list[dict[str, float]]:
    """Row of the history and time of each frame."""
    if not result.frames:
        return [{"row": len(result) - 1, "time": float(result.model.system.time)}]
    return [{"row": frame.number, "time": float(frame.time)} for frame in result.frames]


def _fields(frames: list[Frame], shifts: Floats, nodes: Ids, cells: Ids) -> Iterator[tuple[str, str, Floats]]:
    """Name, location and values (frames, n) of the scalar fields that are finite everywhere.

    Location: "nodes" for the shape functions, "corners" for means of the cells at corners of elements.
    """
    found: dict[str, tuple[str, Floats]] = {"displacement": ("nodes", np.linalg.norm(shifts[:, nodes], axis=2))}
    for name in frames[0].points if frames else ():
        values = [frame.points[name] for frame in frames]
        if values[0].ndim == 1 and np.isfinite(values).all():
            found[name] = "nodes", np.stack(values)[:, nodes]
    for name in frames[0].cells if frames else ():
        values = [frame.cells[name] for frame in frames]
        if values[0].ndim == 1 and np.isfinite(values).all():
            found[name] = "corners", np.stack([_at_corners(one, cells, shifts.shape[1])[nodes] for one in values])
    for name in sorted(found, key=looks.place):
        yield name, *found[name]


def _at_corners(values: Floats, cells: Ids, count: int) -> Floats:
    """Means of a field at the corners; at other nodes, which are not drawn, the least of them."""
    means = means_at_corners(cells, count, values)
    return np.where(np.isfinite(means), means, np.nanmin(means))


def _rolling(frames: list[Frame]) -> Floats | None:
    """Rolling directions (frames, cells, 3); None if no body has one."""
    if not frames or "rolling" not in frames[0].cells:
        return None
    return np.stack([frame.cells["rolling"] for frame in frames])


def _tool_arrays(name: str, surface: Triangles, poses: Poses) -> dict[str, NDArray[Any] | Quantised]:
    rotations, shifts = poses
    return {
        f"{name} points": surface.points,
        f"{name} faces": surface.triangles,
        f"{name} groups": smooth_groups(surface.points, surface.triangles),
        f"{name} poses": np.concatenate([rotations, shifts[:, :, None]], axis=2),
    }
