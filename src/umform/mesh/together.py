"""Several sheets as one mesh."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue, WrongCellType
from umform.mesh.mesh import Mesh


def together(**sheets: Mesh) -> Mesh:
    """Put sheets that share no node into one mesh.

    Parameters
    ----------
    **sheets : Mesh
        Meshes of one cell type by name.

    Returns
    -------
    Mesh
        Its sets are those of the sheets, as ``"upper of a"``, and all nodes of each, as ``"a"``; points and cells
        follow each other in the order given.

    Raises
    ------
    InvalidValue, WrongCellType
        If there is none, or they have cells of different types.

    Examples
    --------
    >>> import umform as uf
    >>> strip = uf.mesh.strip(length=10.0, width=1.0, thickness=0.2, cells=(8, 1))
    >>> stack = uf.mesh.together(a=strip, b=strip.moved((0.0, 0.0, 0.2)))
    >>> len(stack.points), "upper of a" in stack.faces
    (72, True)
    """
    if not sheets:
        raise InvalidValue("there is no sheet", where="together()", remedy="together(a=mesh, b=another)")
    for name, mesh in sheets.items():
        if not isinstance(mesh, Mesh):
            raise InvalidValue(
                "sheets are meshes",
                where=f"together(), {name}",
                value=type(mesh).__name__,
                cause="a model, or a list of meshes",
                remedy="together(a=uf.mesh.strip(...), b=...)",
            )
    kinds = {name: mesh.cell for name, mesh in sheets.items()}
    if len(set(kinds.values())) > 1:
        raise WrongCellType(
            "sheets in one mesh have cells of one type",
            where="together()",
            value=", ".join(f"{name}: {kind}" for name, kind in kinds.items()),
            remedy="generate all of them with the same order",
        )
    sets: dict[str, NDArray[np.integer]] = {}
    faces: dict[str, NDArray[np.integer]] = {}
    nodes = cells = 0
    for name, mesh in sheets.items():
        sets[name] = np.arange(nodes, nodes + len(mesh.points))
        sets |= {f"{what} of {name}": ids + nodes for what, ids in mesh.sets.items()}
        faces |= {f"{what} of {name}": rows + np.array([cells, 0]) for what, rows in mesh.faces.items()}
        nodes, cells = nodes + len(mesh.points), cells + len(mesh.connectivity)
    starts = np.cumsum([0, *(len(mesh.points) for mesh in sheets.values())])
    return Mesh(
        np.concatenate([mesh.points for mesh in sheets.values()]),
        {
            next(iter(kinds.values())): np.concatenate(
                [mesh.connectivity + start for mesh, start in zip(sheets.values(), starts, strict=False)]
            )
        },
        sets,
        faces,
    )
