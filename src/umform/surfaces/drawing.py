"""Tools from files; the extension selects the reader."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from umform.errors import InvalidValue
from umform.spec import check_fields, takes
from umform.spec.types import Positive, Sharp, Text
from umform.surfaces.cad import CadTool
from umform.surfaces.triangulated import Triangulated


@dataclass(frozen=True)
class Drawing:
    """The faces of a STEP or IGES file, or the triangles of an STL file."""

    file: Text
    """Path, from the folder of the deck; it ends in .step, .stp, .iges, .igs or .stl."""
    tolerance: Positive | None = None
    """Largest distance of the tool from free-form faces of a STEP or IGES file; by default 0.001 mm."""
    sharp: Sharp | None = None
    """Angle from which an edge is sharp: by default 30 between triangles of STL, 2 between faces."""
    open: bool = False
    """The surface may have rims; beyond them there is no contact."""
    scale: Positive = 1.0
    """Factor to the unit of the model: from millimetres for STEP and IGES, from the unit of an STL file."""

    def __post_init__(self) -> None:
        check_fields(self)
        if self.tolerance is not None and self._triangles:
            raise InvalidValue(
                "the triangles of an STL file have no free forms that a tolerance is for",
                where="tolerance",
                value=self.tolerance,
                cause="a key of STEP and IGES files",
                remedy="leave it out; a STEP file in place of the STL file has the true surface",
            )

    @property
    def _triangles(self) -> bool:
        return Path(self.file).suffix.lower() == ".stl"

    def read(self, folder: Path = Path()) -> CadTool | Triangulated:
        """The tool.

        Parameters
        ----------
        folder : Path
            Folder from which its path begins.

        Raises
        ------
        FileProblem
            If the file cannot be read.
        DrawingError
            If it has no surface for a tool; the message names places.
        """
        path = folder / self.file
        sharp = {} if self.sharp is None else {"sharp": self.sharp}
        if self._triangles:
            return Triangulated.from_stl(path, open=self.open, scale=self.scale, **sharp)
        return CadTool.read(path, tolerance=self.tolerance, open=self.open, scale=self.scale, **sharp)


@takes(Drawing, "file")
def read_tool(path: str | Path, **options: Any) -> CadTool | Triangulated:
    """A tool from a STEP, IGES or STL file.

    Parameters
    ----------
    path : str or Path
        .stl: triangles, see :meth:`Triangulated.from_stl`. .step, .stp, .iges or .igs: faces, see :meth:`CadTool.read`.
    **options
        Other fields of :class:`umform.surfaces.Drawing`.

    Raises
    ------
    FileProblem
        If the file cannot be read.
    DrawingError
        If it has no surface for a tool; the message names places.

    Examples
    --------
    >>> import umform as uf
    >>> die = uf.read_tool("die.step")  # doctest: +SKIP
    >>> punch = uf.read_tool("punch.stl", scale=1000.0)  # doctest: +SKIP
    """
    return Drawing(str(path), **options).read()
