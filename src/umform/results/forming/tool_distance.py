"""Distance of the part from a tool, where the tool stands now."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from umform.model import Tool

Floats = NDArray[np.float64]


def pose_in(tool: Tool, row: Mapping[str, float]) -> tuple[Floats, Floats]:
    """Rotation and shift of a tool in a row of a history.

    Ways that were added to the tool after the run, such as by opening it, are zero in it.
    """
    return tool.pose({way: row.get(way.name, 0.0) for way in tool.ways}, row["time"])


def distance_from(tool: Tool, x: Floats, row: Mapping[str, float] | None = None) -> Floats:
    """Signed distance of some places from a tool, negative inside of it. eq. (4.1)

    Parameters
    ----------
    tool : Tool
        A tool of a model.
    x : ndarray, shape (n, 3)
        Places, such as the nodes of the deformed sheet.
    row : mapping of str to float, optional
        Row of the history that says where the tool stands; default: where it stands now.

    Returns
    -------
    ndarray, shape (n,)
    """
    rotation, shift = tool.pose_now if row is None else pose_in(tool, row)
    distance: Floats = tool.surface.kernel().gap(np.ascontiguousarray((x - shift) @ rotation))[0]
    return distance
