"""Tools and planes of symmetry beside the fields of a file, for pictures of the whole part between its tools."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np
from numpy.typing import NDArray

from umform.io.vtkhdf_reader import read_fields, read_vtkhdf
from umform.report.bodies import displacements, tool_bodies
from umform.report.part import Part, plane_strain, widened
from umform.report.symmetry import Mirror, mirrors, mirrors_of_blank
from umform.surfaces.triangles import Triangles

if TYPE_CHECKING:
    from umform.io.vtkhdf import VtkHdfSeries
    from umform.results.history import History

Floats = NDArray[np.float64]

#: Group of the file. Its data set ``mirrors`` has a row for each plane: axis and coordinate now and in the blank, in
#: older files now only. ``wide`` has axis and width of the picture of sheet in plane strain.
_GROUP = "umform"


def attach_scene(series: VtkHdfSeries, result: History) -> None:
    """Add the tools and the planes of symmetry of a result to the file of its frames."""
    planes, wide = mirrors(result.model), plane_strain(result.model)
    places = result.model.mesh.points + displacements(result)
    bodies, _ = tool_bodies(result, places if wide is None else widened(places, *wide), planes)
    pairs = zip(planes, mirrors_of_blank(result.model), strict=True)
    table = {"mirrors": np.array([[now.axis, now.at, old.axis, old.at] for now, old in pairs]).reshape(-1, 4)}
    series.attach(_GROUP, table if wide is None else {**table, "wide": np.array(wide)})
    for number, body in enumerate(bodies):
        rotations, shifts = body.poses
        arrays: dict[str, Any] = {
            "name": np.bytes_(body.name.encode()),
            "points": body.surface.points.astype(np.float32),
            "triangles": body.surface.triangles.astype(np.int32),
            "poses": np.concatenate([rotations, shifts[:, :, None]], axis=2),
            "mirrored": np.array([planes.index(plane) for plane in body.mirrored], dtype=np.int64),
        }
        series.attach(f"{_GROUP}/tools/{number}", arrays)


def read_frame(path: Path, frame: int, *, whole: bool = True) -> tuple[Part, dict[str, Triangles]]:
    """Sheet and tools in a frame of a file of fields, which `attach_scene` has completed.

    Parameters
    ----------
    path : Path
        The file.
    frame : int
        Frame, from 0; negative ones count from the end.
    whole : bool
        Whether mirror images at the planes of symmetry are added.
    """
    X, cells = read_vtkhdf(path)
    with h5py.File(path, "r") as file:
        root = file["VTKHDF"]
        frame = range(root["Steps"].attrs["NSteps"])[frame]
        at_points, in_cells = read_fields(root, frame)
        group = file.get(_GROUP, {})
        rows = group["mirrors"][()] if "mirrors" in group else np.empty((0, 4))
        planes, of_blank = ([Mirror(int(axis), float(at)) for axis, at in part] for part in (rows[:, :2], rows[:, -2:]))
        wide = group["wide"][()] if "wide" in group else None
        tools = group.get("tools", {})
        stored = [{name: tool[name][()] for name in tool} for _, tool in sorted(tools.items(), key=_number)]
    part = Part.deformed(X, next(iter(cells.values())), at_points, in_cells)
    surfaces = {tool["name"].decode(): _at(tool, frame, planes if whole else []) for tool in stored}
    part = part.whole(planes, of_blank) if whole else part
    return part if wide is None else part.widened(int(wide[0]), float(wide[1])), surfaces


def _number(item: tuple[str, object]) -> int:
    return int(item[0])


def _at(tool: dict[str, Any], frame: int, planes: list[Mirror]) -> Triangles:
    """A tool in its pose, with its mirror images at the planes that it is mirrored at."""
    pose = tool["poses"][frame]
    points, triangles = tool["points"] @ pose[:, :3].T + pose[:, 3], tool["triangles"].astype(np.int64)
    for plane in [planes[k] for k in tool["mirrored"] if k < len(planes)]:
        triangles = np.concatenate([triangles, triangles[:, ::-1] + len(points)])
        points = np.concatenate([points, plane.image(points)])
    return Triangles(points, triangles)
