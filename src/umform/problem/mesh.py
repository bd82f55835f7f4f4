"""The mesh of a deck: a strip, a grid, a disc, a ring, any outline, or a file of hexahedra or quadrilaterals."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np

from umform import mesh
from umform.errors import InvertedElement, MeshError, WrongNodeOrder
from umform.mesh import Floats, Mesh
from umform.problem.notes import Discriminator, Field, Refusal, Tag
from umform.problem.outline import Outlined
from umform.problem.parts import Pair, Part, Positive, Vector, tagged_by, word_or_array

Divisions = Annotated[int, Field(ge=1, le=100_000)]
Lines = Annotated[list[float], Field(min_length=2, max_length=100_001)]

#: More cells than this are refused: a typing error should not fill the memory.
_MOST_CELLS = 1_000_000


class Strip(Part):
    """Strip or plate: x from 0 to length, y from 0 to width, mid-surface at z = 0; with the sets of a grid."""

    generator: Literal["strip", "plate"]
    """A plate is a wide strip."""
    length: Positive
    """Along x."""
    width: Positive
    """Along y."""
    thickness: Positive
    """Along z."""
    cells: tuple[Divisions, Divisions]
    """Elements along x and y."""
    layers: Annotated[int, Field(ge=1, le=100)] = 1
    """Elements through the thickness."""
    grading: Pair = (1.0, 1.0)
    """Ratio of the last to the first element size, along x and y."""
    shift: Vector = (0.0, 0.0, 0.0)
    """Translation of the mesh."""
    rolled: Positive | None = None
    """Radius of the mid-surface of a strip rolled about an axis along y at z = -rolled; x is the arc length."""

    def __post_init__(self) -> None:
        """Refuse too many cells, and a strip that cannot be rolled."""
        _refuse_too_many(self.cells[0] * self.cells[1] * self.layers)
        if min(self.grading) <= 0:
            raise Refusal("grading", "the ratios of a grading must be positive")
        if self.rolled is not None and self.rolled <= 0.5 * self.thickness:
            raise Refusal("rolled", "the radius of a rolled strip must be more than half of its thickness")
        if self.rolled is not None and self.length >= 2 * np.pi * self.rolled:
            raise Refusal("rolled", "a rolled strip must be shorter than the full circle")

    def build(self, cell: str, folder: Path) -> Mesh:
        """Mesh of cells of a type."""
        del folder
        flat = mesh.strip(
            self.length, self.width, self.thickness, self.cells, cell=cell, layers=self.layers, grading=self.grading
        )
        if self.rolled is not None:
            flat = flat.transformed(_roll(self.rolled))
        return flat.transformed(lambda X: X + np.array(self.shift)) if any(self.shift) else flat


def _roll(radius: float) -> Any:
    def rolled(X: Floats) -> Floats:
        angle, r = X[:, 0] / radius, radius + X[:, 2]
        return np.column_stack([r * np.sin(angle), X[:, 1], r * np.cos(angle) - radius])

    return rolled


class Grid(Part):
    """Grid of lines; with the sets x0, x1, y0, y1, lower, upper, and x0_lower, x0_upper, ... for their edges."""

    generator: Literal["grid"]
    x: Lines
    """Borders of the elements, increasing."""
    y: Lines
    """Borders of the elements, increasing."""
    z: Lines
    """Borders of the layers, increasing."""

    def __post_init__(self) -> None:
        """Refuse lines that do not increase, and too many cells."""
        for name in ("x", "y", "z"):
            lines = getattr(self, name)
            if any(b <= a for a, b in pairwise(lines)):
                raise Refusal("lines", f"the lines of a grid must increase, those of {name} do not")
        _refuse_too_many((len(self.x) - 1) * (len(self.y) - 1) * (len(self.z) - 1))

    def build(self, cell: str, folder: Path) -> Mesh:
        """Mesh of cells of a type."""
        del folder
        return mesh.grid(self.x, self.y, self.z, cell)


Portion = Literal["whole", "half", "quarter"]


class Blank(Part):
    """Common keys of discs and rings: they lie about the z-axis, with the mid-surface at z = 0."""

    thickness: Positive
    """Along z."""
    cells: tuple[Divisions, Divisions]
    """Elements along a side of the core (of a ring: on a quarter of the circle), and towards the rim."""
    part: Portion = "whole"
    """A half has x >= 0, a quarter y >= 0 as well."""
    layers: Annotated[int, Field(ge=1, le=100)] = 1
    """Elements through the thickness."""
    grading: Positive = 1.0
    """Ratio of the last to the first element size, towards the rim."""


class Disc(Blank):
    """A disc with a square core; with the sets rim and centre, those of parts also x0 and y0."""

    generator: Literal["disc"]
    radius: Positive
    """Of the rim."""
    core: Annotated[float, Field(ge=0.05, le=0.75)] = 0.5
    """Half-width of the core, relative to the radius."""
    radii: Lines | None = None
    """Radii of the rings, from the core to the rim, in place of the second number of cells and the grading."""

    def __post_init__(self) -> None:
        """Refuse too many cells."""
        _refuse_too_many(4 * self.cells[0] * (self.cells[0] + 2 * self.cells[1]) * self.layers)

    def build(self, cell: str, folder: Path) -> Mesh:
        """Mesh of cells of a type."""
        del folder
        how = {"part": self.part, "cell": cell, "layers": self.layers, "grading": self.grading}
        rings = {"core": self.core, "radii": self.radii}
        return mesh.disc(self.radius, self.thickness, self.cells, **how, **rings)  # type: ignore[arg-type]


class Ring(Blank):
    """A ring; with the sets rim and hole, those of parts also x0 and y0."""

    generator: Literal["ring"]
    inner: Positive
    """Radius of the hole."""
    outer: Positive
    """Radius of the rim."""

    def __post_init__(self) -> None:
        """Refuse a rim within the hole, and too many cells."""
        if self.inner >= self.outer:
            raise Refusal("ring", "the outer radius of a ring must be larger than the inner one")
        _refuse_too_many(4 * self.cells[0] * self.cells[1] * self.layers)

    def build(self, cell: str, folder: Path) -> Mesh:
        """Mesh of cells of a type."""
        del folder
        how = {"part": self.part, "cell": cell, "layers": self.layers, "grading": self.grading}
        return mesh.ring(self.inner, self.outer, self.thickness, self.cells, **how)  # type: ignore[arg-type]


Through = Annotated[
    Annotated[str, Field(min_length=1), Tag("word")] | Annotated[Vector, Tag("array")],
    Discriminator(
        word_or_array,
        custom_error_type="through",
        custom_error_message="Input should be thinnest, an axis such as z or -z, the name of a set, or three numbers",
    ),
]


class File(Part):
    """Hexahedra of a file; its groups of nodes and cells are sets of nodes, its faces have the sets lower and upper."""

    file: Annotated[str, Field(min_length=1)]
    """Path, from the folder of the deck."""
    through: Through | None = None
    """Direction through the thickness, to the upper face: thinnest, an axis, a vector, or the name of a set with all
    nodes of the lower face. Without it the first nodes of each cell are those of its lower face."""

    def build(self, cell: str, folder: Path) -> Mesh:
        """The mesh; the model checks whether it suits the element."""
        del cell
        try:
            return mesh.read(folder / self.file, self.through)
        except MeshError as error:
            error.remedy = self._remedy(error)
            raise

    def _remedy(self, error: MeshError) -> str:
        """The remedy in terms of deck keys."""
        if self.through is None and isinstance(error, WrongNodeOrder | InvertedElement):
            return "through = 'thinnest', or the axis through the thickness: then the cells are turned"
        return re.sub(
            r"umform\.mesh\.(read_shell\(path, thickness\)|thicken)", "the key thickness in [mesh]", error.remedy
        )


class Shell(Part):
    """Quadrilaterals of a file, thickened along their normals; the set NAME contains the nodes of both faces,
    NAME_lower and NAME_upper those of one face.
    """

    file: Annotated[str, Field(min_length=1)]
    """Path, from the folder of the deck."""
    thickness: Positive
    """Thickness."""
    surface: Literal["middle", "lower", "upper"] = "middle"
    """The given surface: mid-surface, lower or upper face."""
    kink: Annotated[float, Field(gt=0, lt=180)] = 100.0
    """Largest angle in degrees between the quadrilaterals at a node."""

    def build(self, cell: str, folder: Path) -> Mesh:
        """The mesh; the model checks whether it suits the element."""
        del cell
        return mesh.read_shell(folder / self.file, self.thickness, surface=self.surface, kink=self.kink)


def _refuse_too_many(cells: int) -> None:
    if cells > _MOST_CELLS:
        raise Refusal("cells", f"{cells} cells are more than {_MOST_CELLS}")


#: Keys that distinguish a surface to be thickened from hexahedra.
_OF_SHELLS = {"thickness", "surface", "kink"}


_generator_or_file = tagged_by("generator", "file")


def _kind(value: Any) -> str | None:
    if isinstance(value, Shell) or (isinstance(value, dict) and "file" in value and value.keys() & _OF_SHELLS):
        return "shell"
    return _generator_or_file(value)


MeshPart = Annotated[
    Annotated[Strip, Tag("strip")]
    | Annotated[Strip, Tag("plate")]
    | Annotated[Grid, Tag("grid")]
    | Annotated[Disc, Tag("disc")]
    | Annotated[Ring, Tag("ring")]
    | Annotated[Outlined, Tag("outline")]
    | Annotated[File, Tag("file")]
    | Annotated[Shell, Tag("shell")],
    Discriminator(
        _kind,
        custom_error_type="mesh",
        custom_error_message="a mesh has generator = strip, plate, grid, disc, ring or outline, or file = a path",
        custom_error_context={
            "key": "generator",
            "expected_tags": "'strip', 'plate', 'grid', 'disc', 'ring', 'outline'",
        },
    ),
]
