"""Tools from files; the extension selects the reader."""

from __future__ import annotations

from pathlib import Path

from umform.surfaces.cad import CadTool
from umform.surfaces.triangulated import Triangulated


def read_tool(
    path: str | Path,
    *,
    tolerance: float = 1e-3,
    sharp: float | None = None,
    open: bool = False,
    scale: float = 1.0,
) -> CadTool | Triangulated:
    """A tool from a STEP, IGES or STL file.

    Parameters
    ----------
    path : str or Path
        .stl: triangles, see :meth:`Triangulated.from_stl`. .step, .stp, .iges or .igs: faces, see :meth:`CadTool.read`.
    tolerance : float
        Largest distance from free-form faces of a STEP or IGES file.
    sharp : float, optional
        Angle in degrees from which an edge is sharp: 30 between triangles of STL, 2 between faces.
    open : bool
        The surface may have rims.
    scale : float
        Factor to the unit of the model, from millimetres for STEP and IGES, from the unit of the file for STL.

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
    if Path(path).suffix.lower() == ".stl":
        return Triangulated.from_stl(path, sharp=30.0 if sharp is None else sharp, open=open, scale=scale)
    return CadTool.read(path, tolerance=tolerance, open=open, sharp=2.0 if sharp is None else sharp, scale=scale)
