"""A part in its present state with further sheets laid beside it, such as the inner sheet of a hem."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from umform.errors import InvalidValue
from umform.mesh import Mesh
from umform.mesh.together import together
from umform.model.bodies.body import Body
from umform.model.model import Model

#: Name of the part among the sheets: its sets are "upper of part", ...
PART = "part"


def laid_beside(part: Model, /, **sheets: Mesh) -> Model:
    """A model of a part, with its state, and of undeformed sheets beside it.

    Parameters
    ----------
    part : Model
        The part, of one body, without tools and supports.
    **sheets : Mesh
        Meshes by name, where they lie; they have the element and the metal of the part.

    Raises
    ------
    InvalidValue
        If the part has several bodies, a rolling direction in each cell, or a sheet has its name.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.model.transfer.beside import laid_beside
    >>> strip = uf.mesh.strip(10.0, 1.0, 0.2, (8, 1))
    >>> part = uf.Model(strip, material=uf.SVK(E=210e3, nu=0.3))
    >>> model = laid_beside(part, cover=strip.moved((0.0, 0.0, 0.2)))
    >>> [body.name for body in model.bodies]
    ['sheet', 'cover']
    """
    several = len(part.bodies) != 1 or getattr(part.bodies[0].rolling, "ndim", 0) > 1
    if several or PART in sheets:
        raise InvalidValue(
            "sheets are laid beside a part of one body and one rolling direction",
            where="laid_beside()",
            value=f"{len(part.bodies)} bodies; sheets: {', '.join(sheets)}",
            cause=f"a part of several metals, a direction in each cell, or a sheet that is called {PART}",
            remedy="a model of all sheets from the beginning",
        )
    own, mesh, count = part.bodies[0], together(**{PART: part.mesh}, **sheets), len(part.mesh.connectivity)
    bodies = [_like(own, np.arange(count), own.name)]
    for name, sheet in sheets.items():
        bodies.append(_like(own, count + np.arange(len(sheet.connectivity)), name))
        count += len(sheet.connectivity)
    model = Model(mesh, bodies=bodies)
    before, now = part.system.snapshot(), model.system.snapshot()
    u = np.concatenate([before.u, now.u[len(before.u) :]])
    terms = {**now.terms, bodies[0].key: before.terms[own.key]}
    model.system.restore(replace(now, u=u, time=before.time, terms=terms, began=before.began))
    return model


def _like(body: Body, cells: np.ndarray[tuple[int], np.dtype[np.int64]], name: str) -> Body:
    """A body of other cells with the element and the metal of another one."""
    return Body(
        body.element,
        material=body.material,
        cells=cells,
        name=name,
        thickness_points=body.thickness_points,
        thickness_rule=body.thickness_rule,
        rolling=body.rolling,
    )
