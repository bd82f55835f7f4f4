"""Sections of tools in the plane of one drawing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from umform.errors import InvalidValue
from umform.surfaces.directions import right_angle, unit_vector
from umform.surfaces.segments import Floats, Segment
from umform.surfaces.swept import Extruded, Revolved
from umform.surfaces.tool import Tool

#: Directions to the right and upwards in the drawing of what is extruded along x, y, z.
_PLANES = ((1, 2), (0, 2), (0, 1))
#: Sine of the angle between directions that are one.
_SAME = 1e-9


def sections(tools: Mapping[str, Tool]) -> dict[str, Sequence[Segment]]:
    """Sections of tools that are extruded along one direction, or revolved about one axis, in common coordinates.

    Extruded along y the coordinates are (x, z), along x (y, z), along z (x, y), along another direction those of the
    first profile. Revolved they are the distance from the axis, and the coordinate along it. Open sections go on
    straight at their ends.

    Parameters
    ----------
    tools : mapping of str to Tool
        The tools by their names.

    Raises
    ------
    InvalidValue
        If a tool is neither extruded nor revolved, or they have no common direction.
    """
    found: dict[str, Sequence[Segment]] = {}
    first: Extruded | Revolved | None = None
    for name, tool in tools.items():
        section = tool.section()
        if not isinstance(section, Extruded | Revolved):
            raise InvalidValue(
                "this tool has no section that a drawing shows",
                where=name,
                value=type(tool).__name__,
                cause="it is neither extruded nor revolved",
                remedy="write its triangles, as .stl",
            )
        first = first or section
        if not _together(first, section):
            raise InvalidValue(
                "tools in one drawing are extruded along one direction, or revolved about one axis",
                where=name,
                cause=f"this is another one than that of {next(iter(tools))}",
                remedy="a drawing for each of them",
            )
        found[name] = _drawn(section, first)
    return found


def _direction(section: Extruded | Revolved) -> Floats:
    return np.array(section.along() if isinstance(section, Extruded) else unit_vector(section.axis))


def _together(one: Extruded | Revolved, other: Extruded | Revolved) -> bool:
    if type(one) is not type(other) or np.linalg.norm(np.cross(_direction(one), _direction(other))) > _SAME:
        return False
    away = np.cross(np.subtract(one.origin, other.origin), _direction(one))
    return isinstance(one, Extruded) or float(np.linalg.norm(away)) <= _SAME * max(one.profile.size, 1.0)


def _drawn(section: Extruded | Revolved, first: Extruded | Revolved) -> Sequence[Segment]:
    """Segments in the coordinates of the drawing."""
    origin, along = np.array(section.origin), _direction(first)
    if isinstance(section, Revolved):
        axis = np.abs(along) if np.abs(along).max() > 1.0 - _SAME else along
        matrix = np.diag([1.0, float(np.sign(_direction(section) @ axis))])
        shift = np.array([0.0, float(origin @ axis)])
    else:
        assert isinstance(first, Extruded)
        k = int(np.abs(along).argmax())
        known = abs(along[k]) > 1.0 - _SAME
        plane = np.eye(3)[list(_PLANES[k])] if known else np.array(right_angle(first.x, first.y))
        matrix, shift = plane @ np.array(right_angle(section.x, section.y)).T, plane @ origin
    segments = [segment.seen(matrix, shift) for segment in section.profile.segments]
    return segments if np.linalg.det(matrix) > 0.0 else [segment.reversed() for segment in reversed(segments)]
