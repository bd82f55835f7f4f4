"""The tools of a deck: those of umform.surfaces and drawings, each with a pose."""

from __future__ import annotations

import math
from collections import ChainMap
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from umform.problem.parts import Way
from umform.problem.profiles import ReadProfile
from umform.problem.reading import write_as
from umform.spec import OneOf, check_fields
from umform.spec.known import known
from umform.surfaces import Direction, Drawing, OffsetField, Profile, Tool, ToolSpec
from umform.surfaces.directions import Point

ORIGIN = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Posed:
    """A tool, which may be rotated about the origin and then shifted."""

    inside: ClassVar = "tool"

    tool: Tool | Drawing
    """The tool in its own frame."""
    rotation: Point = ORIGIN
    """Rotation vector in degrees: [0, 90, 0] rotates by 90 degrees about y."""
    translation: Point = ORIGIN
    """Shift after the rotation."""
    offset: float = 0.0
    """Outward offset of the tool; a sheet of this thickness fits between it and the drawn one."""
    other_side: bool = False
    """The tool is the region beyond this distance: the punch for a die."""
    offset_field: OffsetField | None = None
    """Further outward offset, which varies over the tool."""
    shared: bool = False
    """One tool for all contacts with it, with its name in the history; by default each contact has its own."""

    def __post_init__(self) -> None:
        check_fields(self)

    def build(self, folder: Path = Path()) -> Tool:
        """The tool in its pose.

        Parameters
        ----------
        folder : Path
            Folder of its files.
        """
        tool = self.tool.read(folder) if isinstance(self.tool, Drawing) else self.tool
        if self.other_side:
            tool = tool.counterpart(self.offset)
        elif self.offset:
            tool = tool.offset(self.offset)
        if self.offset_field is not None:
            tool = tool.offset(self.offset_field)
        if self.rotation == ORIGIN and self.translation == ORIGIN:
            return tool
        x, y, z = (math.radians(angle) for angle in self.rotation)
        return tool.moved(self.translation, (x, y, z))


def _shapes() -> Mapping[str, type]:
    """All tools by the words of decks."""
    return ChainMap({"Drawing": Drawing}, known("umform.surfaces", ToolSpec))  # type: ignore[arg-type]


write_as(Direction, Way)
write_as(Profile, ReadProfile)
ToolPart = Annotated[Posed, OneOf("shape", _shapes, Posed)]
