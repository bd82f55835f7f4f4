"""Export of tools for other programs."""

from __future__ import annotations

from pathlib import Path

from umform.errors import InvalidValue
from umform.io.atomic import PendingFile
from umform.surfaces.tool import Tool
from umform.surfaces.triangles import Box3

_SUFFIXES = (".stl", ".vtk", ".vtu", ".ply", ".obj")


def write_tool(tool: Tool, path: str | Path, box: Box3, chord: float = 0.0) -> Path:
    """Write the surface of a tool inside of a box as triangles, through meshio.

    Parameters
    ----------
    tool : Tool
        Any tool; one that is known by its distance only is sampled, and its edges are cut off.
    path : str or Path
        A file that ends in .stl, .vtk, .vtu, .ply or .obj.
    box : tuple of two points
        Lowest and highest corner.
    chord : float, optional
        Largest distance of a triangle from the true surface; by default 1/1000 of the diagonal of the box.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValue
        If the extension is unknown, or no part of the tool lies in the box.
    FileProblem
        If the file cannot be written.

    Examples
    --------
    >>> import umform as uf
    >>> uf.write_tool(uf.Sphere((0, 0, 0), 5), "ball.stl", ((-6, -6, -6), (6, 6, 6)))  # doctest: +SKIP
    """
    path = Path(path)
    if path.suffix not in _SUFFIXES:
        raise InvalidValue(
            "a tool is written as " + ", ".join(_SUFFIXES),
            where="write_tool",
            value=str(path),
            cause="the end of the name",
            remedy="write_tool(tool, 'tool.stl', box)",
        )
    surface = tool.triangles(box, chord)
    if len(surface.triangles) == 0:
        raise InvalidValue(
            "nothing of the tool lies in the box",
            where="write_tool",
            value=box,
            cause="a box beside the tool, or wholly inside of it",
            remedy="a box around the part of the surface that is wanted",
        )
    import meshio  # slow to import

    options = {"binary": True} if path.suffix == ".stl" else {}
    with PendingFile(path) as temporary:
        meshio.write(temporary, meshio.Mesh(surface.points, [("triangle", surface.triangles)]), **options)
    return path
