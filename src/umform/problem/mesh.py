"""The mesh of a deck: a strip, a grid, a disc, a ring, any outline, a file, or several of them together."""

from __future__ import annotations

import re
from itertools import pairwise
from math import prod
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np

from umform import mesh
from umform.errors import InvalidValue, InvertedElement, MeshError, WrongNodeOrder
from umform.mesh import Floats, Mesh
from umform.problem.material import MaterialPart
from umform.problem.notes import Built, Discriminator, Field, Tag
from umform.problem.outline import Outlined
from umform.problem.parts import Name, Part, Positive, Vector, tagged_by, word_or_array

#: More cells than this are refused: a typing error should not fill the memory.
_MOST_CELLS = 1_000_000


class Strip(Part, of=mesh.strip, leave=("cell",)):
    """Strip or plate: x from 0 to length, y from 0 to width, mid-surface at z = 0; with the sets of a grid."""

    generator: Literal["strip", "plate"]
    """A plate is a wide strip."""
    shift: Vector = (0.0, 0.0, 0.0)
    """Translation of the mesh."""
    rolled: Positive | None = None
    """Radius of the mid-surface of a strip rolled about an axis along y at z = -rolled; x is the arc length."""

    def __post_init__(self) -> None:
        """Refuse too many cells, and a strip that cannot be rolled."""
        flat = self.of_spec()
        _refuse_too_many(prod(flat["cells"]) * flat["layers"])
        if min(flat["grading"]) <= 0:
            raise InvalidValue(
                "the ratios of a grading must be positive",
                where="grading",
                value=flat["grading"],
                cause="a sign",
                remedy="last size over first size, as [0.25, 1.0]",
            )
        if self.rolled is not None and self.rolled <= 0.5 * flat["thickness"]:
            raise InvalidValue(
                "the radius of a rolled strip must be more than half of its thickness",
                where="rolled",
                value=self.rolled,
                cause="another unit, or the curvature in place of the radius",
                remedy=f"more than {0.5 * flat['thickness']:g}, the radius of the mid-surface",
            )
        if self.rolled is not None and flat["length"] >= 2 * np.pi * self.rolled:
            raise InvalidValue(
                "a rolled strip must be shorter than the full circle",
                where="length",
                value=flat["length"],
                cause="its ends would overlap",
                remedy=f"less than {2 * np.pi * self.rolled:.4g}, or a larger radius",
            )

    def build(self, cell: str, folder: Path) -> Mesh:
        """Mesh of cells of a type."""
        del folder
        flat = mesh.strip(cell=cell, **self.of_spec())
        if self.rolled is not None:
            flat = flat.transformed(_roll(self.rolled))
        return flat.moved(self.shift) if any(self.shift) else flat


def _roll(radius: float) -> Any:
    def rolled(X: Floats) -> Floats:
        angle, r = X[:, 0] / radius, radius + X[:, 2]
        return np.column_stack([r * np.sin(angle), X[:, 1], r * np.cos(angle) - radius])

    return rolled


class Grid(Part, of=mesh.grid, leave=("cell",)):
    """Grid of lines; with the sets x0, x1, y0, y1, lower, upper, and x0_lower, x0_upper, ... for their edges."""

    generator: Literal["grid"]

    def __post_init__(self) -> None:
        """Refuse lines that do not increase, and too many cells."""
        of_axes = {name: lines for name, lines in self.of_spec().items() if name != "thickness"}
        for name, lines in of_axes.items():
            if any(b <= a for a, b in pairwise(lines)):
                raise InvalidValue(
                    f"the lines of a grid must increase, those of {name} do not",
                    where=name,
                    value=lines,
                    cause="a number twice, or out of order",
                    remedy="sort them, each once",
                )
        _refuse_too_many(prod(len(lines) - 1 for lines in of_axes.values()))

    def build(self, cell: str, folder: Path) -> Mesh:
        """Mesh of cells of a type."""
        del folder
        return mesh.grid(cell=cell, **self.of_spec())


class Disc(Part, of=mesh.disc, leave=("cell",)):
    """A disc with a square core; with the sets rim and centre, those of parts also x0 and y0."""

    generator: Literal["disc"]

    def __post_init__(self) -> None:
        """Refuse too many cells."""
        flat = self.of_spec()
        sides, rings = flat["cells"]
        _refuse_too_many(4 * sides * (sides + 2 * rings) * flat["layers"])

    def build(self, cell: str, folder: Path) -> Mesh:
        """Mesh of cells of a type."""
        del folder
        return mesh.disc(cell=cell, **self.of_spec())


class Ring(Part, of=mesh.ring, leave=("cell",)):
    """A ring; with the sets rim and hole, those of parts also x0 and y0."""

    generator: Literal["ring"]

    def __post_init__(self) -> None:
        """Refuse a rim within the hole, and too many cells."""
        flat = self.of_spec()
        if flat["inner"] >= flat["outer"]:
            raise InvalidValue(
                "the outer radius of a ring must be larger than the inner one",
                where="outer",
                value=flat["outer"],
                cause="the two exchanged, or a width in place of a radius",
                remedy=f"more than {flat['inner']:g}",
            )
        _refuse_too_many(4 * prod(flat["cells"]) * flat["layers"])

    def build(self, cell: str, folder: Path) -> Mesh:
        """Mesh of cells of a type."""
        del folder
        return mesh.ring(cell=cell, **self.of_spec())


Through = Annotated[
    Annotated[str, Field(min_length=1), Tag("word")] | Annotated[Vector, Tag("array")],
    Discriminator(
        word_or_array,
        custom_error_type="through",
        custom_error_message="Input should be thinnest, an axis such as z or -z, the name of a set, or three numbers",
    ),
]


class File(Part, of=mesh.read, leave=("path",)):
    """Hexahedra of a file; its groups of nodes and cells are sets of nodes, its faces have the sets lower and upper."""

    file: Annotated[str, Field(min_length=1)]
    """Path, from the folder of the deck."""
    through: Through | None

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


class Shell(Part, of=mesh.thicken, leave=("points", "quads", "thickness", "sets")):
    """Quadrilaterals of a file, thickened along their normals; the set NAME contains the nodes of both faces,
    NAME_lower and NAME_upper those of one face.
    """

    file: Annotated[str, Field(min_length=1)]
    """Path, from the folder of the deck."""
    thickness: Positive
    """Thickness."""

    def build(self, cell: str, folder: Path) -> Mesh:
        """The mesh; the model checks whether it suits the element."""
        del cell
        return mesh.read_shell(folder / self.file, self.thickness, **self.of_spec())


def _refuse_too_many(cells: int) -> None:
    if cells > _MOST_CELLS:
        raise InvalidValue(
            f"{cells} cells are more than {_MOST_CELLS}",
            where="cells",
            cause="sizes in place of numbers, or a typing error",
            remedy="fewer cells in each direction",
        )


#: Keys that distinguish a surface to be thickened from hexahedra.
_OF_SHELLS = {"thickness", "surface", "kink"}


_generator_or_file = tagged_by("generator", "file")


def _kind(value: Any) -> str | None:
    if isinstance(value, Shell) or (isinstance(value, dict) and "file" in value and value.keys() & _OF_SHELLS):
        return "shell"
    return _generator_or_file(value)


_ONE = (
    Annotated[Strip, Tag("strip")]
    | Annotated[Strip, Tag("plate")]
    | Annotated[Grid, Tag("grid")]
    | Annotated[Disc, Tag("disc")]
    | Annotated[Ring, Tag("ring")]
    | Annotated[Outlined, Tag("outline")]
    | Annotated[File, Tag("file")]
    | Annotated[Shell, Tag("shell")]
)


def _generators(*words: str) -> Discriminator:
    """Tells meshes apart by their generator or their file."""
    return Discriminator(
        _kind,
        custom_error_type="mesh",
        custom_error_message=f"a mesh has generator = {', '.join(words[:-1])} or {words[-1]}, or file = a path",
        custom_error_context={"key": "generator", "expected_tags": ", ".join(f"'{word}'" for word in words)},
    )


def _of_constant_size(part: Any, folder: Path) -> Any:
    """Refuse sizes that follow the tools."""
    del folder
    if isinstance(part, Outlined) and part.turn is not None:
        raise InvalidValue(
            "elements that follow the tools need a deck with one sheet",
            where="turn",
            value=part.turn,
            cause="this deck has several",
            remedy="leave turn out; size is that of all elements of this sheet",
        )
    return part


_WORDS = ("strip", "plate", "grid", "disc", "ring", "outline")
#: The mesh of one of several sheets.
OneMesh = Annotated[Annotated[_ONE, _generators(*_WORDS)], Built(Part, _of_constant_size)]


class SheetPart(Part):
    """One of the sheets of a deck."""

    mesh: OneMesh
    """Its mesh."""
    shift: Vector = (0.0, 0.0, 0.0)
    """Translation of the mesh."""
    material: MaterialPart | None = None
    """Its law, in place of that of the deck."""

    def build(self, cell: str, folder: Path) -> Mesh:
        """Its mesh of cells of a type."""
        return self.mesh.build(cell, folder).moved(self.shift)


class Together(Part):
    """Several sheets; the sets of the sheet NAME have their names with "of NAME" behind: "upper of NAME"."""

    generator: Literal["together"]
    sheets: Annotated[dict[Name, SheetPart], Field(min_length=1)]
    """The sheets by name."""
    bonds: tuple[tuple[str, str], ...] = ()
    """Pairs of sets of faces that are bonded, with nodes at the same places: ``["upper of base", "lower of foil"]``."""

    def build(self, cell: str, folder: Path) -> Mesh:
        """Mesh of cells of a type."""
        made = mesh.together(**{name: part.build(cell, folder) for name, part in self.sheets.items()})
        for faces, others in self.bonds:
            made = mesh.bond(made, faces, others)
        return made


MeshPart = Annotated[_ONE | Annotated[Together, Tag("together")], _generators(*_WORDS, "together")]
