"""The part of a sheet that remains after a cut: a model of the remaining cells in their present state."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from umform.mesh import Mesh
from umform.mesh.part import MeshPart
from umform.model.body import Body
from umform.model.model import Model
from umform.model.state import Snapshot
from umform.model.term import Energies, Found

Numbers = NDArray[np.int64]


@dataclass(frozen=True)
class ModelPart:
    """The part that remains after a cut.

    Attributes
    ----------
    model : Model
        Its model, in the state of the sheet: displacements, history of the points, thickness points, axes. It has
        neither supports nor tools nor loads; :meth:`umform.Model.unbalanced` gives the missing forces.
    cells, nodes : ndarray of int
        Indices of its cells and nodes in the whole sheet, increasing.
    edge_distance : float
        Largest distance of a node of the cut edge from the line, in the view of the line.
    removed_energies : Energies
        Elastic energy and plastic work in the metal that was cut off; NaN where a law does not know them.
    dropped : int
        Number of cells on the side that stays which were removed as well: they hung by an edge or a node.
    """

    model: Model
    cells: Numbers
    nodes: Numbers
    edge_distance: float
    removed_energies: Energies
    dropped: int = 0

    @property
    def mesh(self) -> Mesh:
        """Its mesh, with the set ``cut`` of the nodes and of the faces of the cut edge."""
        return self.model.mesh

    @classmethod
    def of(cls, whole: Model, part: MeshPart, edge_distance: float, dropped: int = 0) -> ModelPart:
        """The part of a model at a converged state.

        Raises
        ------
        ModelError
            If the model was solved on many ranks, which hold its history.
        """
        before = whole.snapshot()
        bodies = {body.key: kept for body in whole.bodies if (kept := _kept_body(body, part.cells)) is not None}
        model = Model(part.mesh, bodies=[made for made, _ in bodies.values()])
        u = before.u.reshape(-1, 3)[part.nodes].ravel()
        terms = {
            key: {name: values[rows] for name, values in before.terms[key].items()} for key, (_, rows) in bodies.items()
        }
        model.restore(Snapshot(u, before.time, terms=terms, began=before.began))
        gone = [_energies(body, whole) for body in whole.bodies]
        left = [_energies(body, model) for body in model.bodies]
        removed = [sum(getattr(e, kind) for e in gone) - sum(getattr(e, kind) for e in left) for kind in _KINDS]
        return cls(model, part.cells, part.nodes, edge_distance, Energies(*removed), dropped)

    def __str__(self) -> str:
        lost = self.removed_energies
        hanging = f"; {self.dropped} more are cut off, which hung by an edge or a node only" if self.dropped else ""
        return (
            f"{len(self.cells)} cells are left{hanging}; "
            f"the cut edge is at most {self.edge_distance:.4g} from the line; the metal that was "
            f"cut off had the elastic energy {lost.elastic:.4g} and the plastic work {lost.plastic:.4g}"
        )


_KINDS = ("elastic", "plastic")


def _energies(body: Body, model: Model) -> Energies:
    return body.energies(Found(), model.u)


def _kept_body(body: Body, cells: Numbers) -> tuple[Body, Numbers] | None:
    """The same body of the remaining cells, and their rows in it; None if no cell remains."""
    rows = np.flatnonzero(np.isin(body.cells, cells))
    if len(rows) == 0:
        return None
    rolling = body.rolling
    made = Body(
        body.element,
        material=body.material,
        cells=np.searchsorted(cells, body.cells[rows]),
        name=body.name,
        thickness_points=body.thickness_points,
        thickness_rule=body.thickness_rule,
        rolling=rolling[rows] if rolling is not None and rolling.ndim == 2 else rolling,
    )
    return made, rows
