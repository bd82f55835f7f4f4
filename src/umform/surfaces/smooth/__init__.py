"""From triangles to a smooth surface: connectivity, normals at the corners, curved patches."""

from umform.surfaces.smooth.edges import Edges, connected
from umform.surfaces.smooth.net import control_points
from umform.surfaces.smooth.normals import Normals, from_drawing, from_facets
from umform.surfaces.smooth.patches import Patches, patches

__all__ = ["Edges", "Normals", "Patches", "connected", "control_points", "from_drawing", "from_facets", "patches"]
