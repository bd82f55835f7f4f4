"""Export of tools for other programs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from umform.errors import InvalidValue
from umform.io.atomic import PendingFile
from umform.spec import check_arguments
from umform.surfaces.dxf import check_unit, write_dxf
from umform.surfaces.tool import Tool
from umform.surfaces.triangles import Box3, Triangles

#: Endings of files of triangles, and of those of exact shapes.
_TRIANGLES, _DXF, _STEP = (".stl", ".vtk", ".vtu", ".ply", ".obj"), (".dxf",), (".step", ".stp")


def write_tool(
    tool: Tool | Mapping[str, Tool],
    path: str | Path,
    box: Box3 | None = None,
    chord: float = 0.0,
    unit: str = "mm",
) -> Path:
    """Write a tool as a drawing of its section, as a solid, or as triangles: the end of the name chooses.

    Parameters
    ----------
    tool : Tool, or mapping of str to Tool
        Any tool, or several by their names, which are those of layers and of parts.
    path : str or Path
        .dxf: lines and arcs of tools that are extruded along one direction or revolved about one axis; the drawing is
        the plane of the section, (x, z) for one along y, and (radius, height) for one about z. Of a box it is the
        section across its second direction. .step or .stp: solids of such tools and of boxes. Both need
        `pip install "umform[cad]"`, and have the tool as it is. .stl, .vtk, .vtu, .ply or .obj: triangles of any tool,
        through meshio; one that is known by its distance only is sampled, and its edges are cut off.
    box : tuple of two points, optional
        Lowest and highest corner of what is written; not for .dxf.
    chord : float, optional
        Largest distance of a triangle from the true surface; by default 1/1000 of the diagonal of the box.
    unit : str
        Unit of the model: mm, cm, m, um, in or ft. A .dxf names it, a .step is in mm; triangles have none.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InvalidValue
        If the extension or the unit is unknown, no part of the tool lies in the box, or a tool has no exact shape.
    FileProblem
        If the file cannot be written.

    Examples
    --------
    >>> import umform as uf
    >>> uf.write_tool(uf.Sphere((0, 0, 0), 5), "ball.stl", ((-6, -6, -6), (6, 6, 6)))  # doctest: +SKIP
    >>> tools = {"punch": uf.Punch(1.5, 84), "die": uf.VDie(16, 84, 2)}
    >>> uf.write_tool(tools, "bend.dxf")  # doctest: +SKIP
    """
    check_arguments(write_tool, path=path)
    check_unit(unit, "write_tool")
    path = Path(path)
    suffix = path.suffix.lower()
    tools = tool if isinstance(tool, Mapping) else {path.stem: tool}
    if suffix in _DXF:
        from umform.surfaces.sections import sections

        return write_dxf(path, sections(tools), unit)
    if suffix not in _TRIANGLES + _STEP:
        raise InvalidValue(
            "a tool is written as " + ", ".join(_DXF + _STEP + _TRIANGLES),
            where="write_tool",
            value=str(path),
            cause="the end of the name",
            remedy="write_tool(tool, 'tool.stl', box)",
        )
    if box is None:
        raise InvalidValue(
            "a tool goes on for ever, a file does not",
            where="write_tool",
            value=str(path),
            cause="there is no box",
            remedy="write_tool(tool, path, box=((x0, y0, z0), (x1, y1, z1)))",
        )
    if suffix in _STEP:
        from umform.surfaces.cad.writing import write_step

        return write_step(path, tools, box, unit)
    return _write_triangles(Triangles.all_of([one.triangles(box, chord) for one in tools.values()]), path, box)


def _write_triangles(surface: Triangles, path: Path, box: Box3) -> Path:
    if len(surface.triangles) == 0:
        raise InvalidValue(
            "nothing of the tool lies in the box",
            where="write_tool",
            value=box,
            cause="a box beside the tool, or wholly inside of it",
            remedy="a box around the part of the surface that is wanted",
        )
    import meshio  # slow to import

    from umform.io.meshes import quiet  # slow to import

    options = {"binary": True} if path.suffix.lower() == ".stl" else {}
    with PendingFile(path) as temporary, quiet():  # it prints warnings
        meshio.write(temporary, meshio.Mesh(surface.points, [("triangle", surface.triangles)]), **options)
    return path
