"""Tools as they are drawn: triangles near the path of the sheet, their poses in all frames."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from umform.errors import UmformError
from umform.report.symmetry import Mirror, is_symmetric
from umform.results.forming.tool_distance import pose_in
from umform.surfaces import Tool
from umform.surfaces.sampled import sampled
from umform.surfaces.triangles import Box3, Triangles, inside_of

if TYPE_CHECKING:
    from umform.model.tools.tool import Tool as RigidTool
    from umform.results.history import History

Floats = NDArray[np.float64]
#: Poses of a tool, one for each frame: rotations (frames, 3, 3) and shifts (frames, 3).
Poses = tuple[Floats, Floats]
#: Lowest and highest corner.
Box = tuple[Floats, Floats]

#: Tools are drawn up to this part of the diagonal of the sheet around its path.
_MARGIN = 0.12
#: Largest deviation of a drawn tool from the true one, as a part of the same diagonal.
_CHORD = 5e-4


@dataclass(frozen=True)
class ToolBody:
    """A tool to be drawn.

    Attributes
    ----------
    name : str
        Its name in the model.
    surface : Triangles
        Near the path of the sheet, in the frame of the tool.
    poses : tuple of ndarray
        Rotations (frames, 3, 3) and shifts (frames, 3).
    mirrored : list of Mirror
        Planes of symmetry at which it is mirrored separately, because it is not its own mirror image.
    """

    name: str
    surface: Triangles
    poses: Poses
    mirrored: list[Mirror]


def tool_bodies(result: History, paths: Floats, planes: list[Mirror]) -> tuple[list[ToolBody], list[str]]:
    """The tools that can be drawn around the paths (frames, n, 3) of a sheet, and notes on the others."""
    box = _around(paths)
    bodies: list[ToolBody] = []
    notes: list[str] = []
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
            bodies.append(ToolBody(tool.name, surface, poses, mirrored))
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


def displacements(result: History) -> Floats:
    """Displacements (frames, nodes, 3); without kept frames, those of the last state."""
    if not result.frames:
        return result.model.u.reshape(1, -1, 3)
    return np.stack([frame.points["displacement"] for frame in result.frames])


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
