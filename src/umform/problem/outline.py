"""The blank of a deck with any outline, and holes; its elements may follow the radii of the tools."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import field
from pathlib import Path
from typing import Literal

from umform import mesh
from umform.errors import InvalidValue
from umform.mesh import Mesh
from umform.problem.parts import NotNegative, Part, Positive
from umform.problem.profiles import ProfilePart, profile_of
from umform.spec.types import ElementTurn
from umform.surfaces import Tool, ToolSizes, tool_sizes

#: More cells than this are refused: a typing error should not fill the memory.
_MOST_CELLS = 1_000_000


class Outlined(Part, of=mesh.blank, leave=("cell",)):
    """Flat blank with an outline of lines and arcs, mid-surface at z = 0: quadrilaterals by gmsh. Sets: rim, edge_0,
    edge_1, ... (segments of the outline), hole_0, ...
    """

    generator: Literal["outline"]
    outline: ProfilePart
    holes: list[ProfilePart] = field(default_factory=list)
    size: Positive
    """Length of the sides of elements; with turn that of the largest ones."""
    turn: ElementTurn | None = None
    """Largest angle in degrees that an element turns over the radii of tools that travel along z, those in contact with
    lower under the sheet, those with upper over it."""
    flow: NotNegative = 0.0
    """Sliding distance over the tools: places nearer than this to a radius have its sizes too."""
    smallest: NotNegative = 0.0
    """Least size, for tools with sharp edges."""

    def build(self, cell: str, folder: Path, sizes: Callable[[float, float], float] | None = None) -> Mesh:
        """Mesh of cells of a type, of a constant size or with those of a function."""
        outline = profile_of(self.outline, folder)
        holes = [profile_of(hole, folder) for hole in self.holes]
        cells = abs(outline.area) / self.size**2 * self.of_spec()["layers"] if outline.closed else 0.0
        if cells > _MOST_CELLS:
            raise InvalidValue(
                f"some {cells:.2g} cells are more than {_MOST_CELLS}",
                where="size",
                value=self.size,
                cause="another unit of length",
                remedy="larger elements",
            )
        given = {"outline": outline, "holes": holes, "size": sizes or self.size}
        return mesh.blank(cell=cell, **self.of_spec() | given)

    def sizes(self, below: Sequence[Tool], above: Sequence[Tool], folder: Path) -> ToolSizes:
        """Sizes that follow the radii of the tools, eq. (5.69)."""
        corners = profile_of(self.outline, folder).points(0.01 * self.size)
        return tool_sizes(
            below,
            above,
            (corners.min(axis=0), corners.max(axis=0)),
            thickness=self.of_spec()["thickness"],
            turn=self.turn or 90.0,
            largest=self.size,
            flow=self.flow,
            smallest=self.smallest,
        )
