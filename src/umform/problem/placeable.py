"""Common keys of all tools of a deck: pose, offset, and the radii over which a sheet may bend."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path as File

from umform import surfaces
from umform.problem.parts import Part, Vector
from umform.surfaces import Tool

ORIGIN = (0.0, 0.0, 0.0)


class Placeable(Part):
    """A tool, which may be rotated about the origin and then shifted."""

    rotation: Vector = ORIGIN
    """Rotation vector in degrees: [0, 90, 0] rotates by 90 degrees about y."""
    translation: Vector = ORIGIN
    """Shift after the rotation."""

    offset: float = 0.0
    """Outward offset of the tool; a sheet of this thickness fits between it and the drawn one."""
    other_side: bool = False
    """The tool is the region beyond this distance: the punch for a die."""
    shared: bool = False
    """One tool for all contacts with it, with its name in the history; by default each contact has its own."""

    def build(self, folder: File = File()) -> Tool:
        """The tool in its pose.

        Parameters
        ----------
        folder : Path
            Folder of its files.
        """
        tool = self._tool(folder)
        if self.other_side:
            tool = tool.counterpart(self.offset)
        elif self.offset:
            tool = tool.offset(self.offset)
        if self.rotation == ORIGIN and self.translation == ORIGIN:
            return tool
        x, y, z = (math.radians(angle) for angle in self.rotation)
        return tool.moved(self.translation, (x, y, z))

    def _tool(self, folder: File) -> Tool:
        del folder
        own = {name: getattr(self, name) for name in type(self).model_fields if name not in _NOT_OF_THE_TOOL}
        made: Tool = getattr(surfaces, type(self).__name__)(**own)
        return made

    def convex_radii(self, own: Tool) -> Iterator[float]:
        """Radii over which a sheet may bend, 0 at an edge, without offset and pose."""
        yield from ()


_NOT_OF_THE_TOOL = ("shape", "rotation", "translation", "offset", "other_side", "shared")
