"""Distance of the part from a tool, where the tool stands now."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.model import Tool

Floats = NDArray[np.float64]


def distance_from(tool: Tool, x: Floats) -> Floats:
    """Signed distance of some places from a tool, negative inside of it. eq. (4.1)

    Parameters
    ----------
    tool : Tool
        A tool of a model; where it stands now counts.
    x : ndarray, shape (n, 3)
        Places, such as the nodes of the deformed sheet.

    Returns
    -------
    ndarray, shape (n,)
    """
    rotation, shift = tool.pose_now
    distance: Floats = tool.surface.kernel().gap(np.ascontiguousarray((x - shift) @ rotation))[0]
    return distance
