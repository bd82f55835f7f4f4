"""The part of a sheet that remains after a cut: a model of the remaining cells in their present state."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.mesh import Mesh
from umform.mesh.fitted.layer import Layer
from umform.mesh.fitted.sheet import Sheet
from umform.mesh.part import MeshPart
from umform.model.bodies.body import Body
from umform.model.contact import Contact
from umform.model.contact.kept_history import KeptContact
from umform.model.contact.sheets import SheetContact
from umform.model.model import Model
from umform.model.terms.state import Snapshot
from umform.model.terms.term import Energies, Found
from umform.model.transfer.fitted_part import fitted_mesh
from umform.model.transfer.moved_state import move_state

Numbers = NDArray[np.int64]
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ModelPart:
    """The part that remains after a cut.

    Attributes
    ----------
    model : Model
        Its model, in the state of the sheet: displacements, history of the points, thickness points, axes. It has
        neither supports nor tools nor loads; :meth:`umform.Model.unbalanced` gives the missing forces.
    cells : ndarray of int
        For each of its cells the one of the whole sheet in which it lies.
    nodes : ndarray of int
        Index of each of its nodes in the whole sheet, -1 for new ones.
    edge_distance : float
        Largest distance of the cut edge from the line, in the view of the line: of the nodes where it follows elements,
        of the middles of the fibres where it lies on the line.
    removed_energies : Energies
        Elastic energy and plastic work in the metal that was cut off; NaN where a law does not know them.
    dropped : int
        Number of cells on the side that stays which were removed as well: they hung by an edge or a node.
    same : ndarray of bool, shape (cells,)
        Whether a cell has the places and the state of the one of the whole sheet.
    missed : int
        Number of sides of elements of the cut edge that are not on the line, where it was asked for.
    remark : str
        Why the cut edge follows elements where it was to lie on the line.
    contacts : dict of str to KeptContact
        History of the contacts, see :meth:`keep_friction`.
    """

    model: Model
    cells: Numbers
    nodes: Numbers
    edge_distance: float
    removed_energies: Energies
    dropped: int
    same: NDArray[np.bool_]
    missed: int = 0
    remark: str = ""
    contacts: dict[str, KeptContact] = field(default_factory=dict)

    @property
    def mesh(self) -> Mesh:
        """Its mesh, with the set ``cut`` of the nodes and of the faces of the cut edge."""
        return self.model.mesh

    @classmethod
    def of(cls, whole: Model, part: MeshPart, edge_distance: float, dropped: int = 0, remark: str = "") -> ModelPart:
        """The part of a model at a converged state that has some of its cells.

        Raises
        ------
        ModelError
            If the model was solved on many ranks, which hold its history.
        """
        u = whole.u.reshape(-1, 3)[part.nodes]
        model = _model(whole, part.mesh, part.cells, u)
        same = np.ones(len(part.cells), dtype=bool)
        lost = _removed(whole, model)
        return cls(
            model,
            part.cells,
            part.nodes,
            edge_distance,
            lost,
            dropped,
            same,
            remark=remark,
            contacts=_contacts(whole, part.cells, same),
        )

    @classmethod
    def fitted(
        cls, whole: Model, sheet: Sheet, x: Floats, layer: Layer, edge_distance: float, dropped: int = 0
    ) -> ModelPart:
        """The part of a model at a converged state whose edge is the outer side of a layer of new cells.

        Raises
        ------
        ModelError
            If the model was solved on many ranks, which hold its history.
        """
        made = fitted_mesh(whole.mesh, sheet, layer)
        model = _model(whole, made.mesh, made.parents, made.at_nodes(whole.u.reshape(-1, 3)))
        move_state(whole, sheet, x, layer, made, model)
        lost = _removed(whole, model)
        return cls(
            model,
            made.parents,
            made.nodes,
            edge_distance,
            lost,
            dropped,
            made.same,
            layer.missed,
            contacts=_contacts(whole, made.parents, made.same),
        )

    def __str__(self) -> str:
        lost = self.removed_energies
        hanging = f"; {self.dropped} more are cut off, which hung by an edge or a node only" if self.dropped else ""
        return (
            f"{len(self.cells)} cells are left{hanging}; {self._edge()}"
            f"the cut edge is at most {self.edge_distance:.4g} from the line; the metal that was "
            f"cut off had the elastic energy {lost.elastic:.4g} and the plastic work {lost.plastic:.4g}"
        )

    def keep_friction(self, contact: Contact | SheetContact, before: str = "") -> int:
        """Let a tool, or sheets that touch, keep friction, multipliers and penalty of their points through the cut.

        Elements that stay keep the tractions, the anchors of sticking points, and the distances slid of their points;
        those that were fitted to the line begin without, and so do points of a sheet whose facet of the other sheet is
        gone. A penalty that was estimated, and may have grown, stays. The tool must stand where it stood.

        Parameters
        ----------
        contact : Contact
            A pair of the model of this part, with the points and the friction that it had.
        before : str
            Name of the pair in the whole sheet; default: that of ``contact``.

        Returns
        -------
        int
            Number of faces that keep their history.

        Raises
        ------
        InvalidValue
            If there was no such pair, or it had other points or another law.
        """
        name = before or contact.name
        if name not in self.contacts:
            raise InvalidValue(
                "the sheet had no contact of this name",
                where="keep_friction()",
                value=name,
                cause="" if self.contacts else "the stage before had no contacts",
                remedy=f"one of {', '.join(self.contacts)}" if self.contacts else "leave keep_friction() out",
            )
        self.model.system.evaluate(self.model.system.x)
        contact.begin()
        return self.contacts[name].put(contact)

    def _edge(self) -> str:
        """How the cut edge was made, where it is not all on the line or elements were changed."""
        if self.remark:
            return f"warning: the edge follows elements, because {self.remark}; "
        changed = int((~self.same).sum())
        missed = f"warning: {self.missed} sides of elements are not on the line; " if self.missed else ""
        return missed + (f"{changed} of them were fitted to the line; " if changed else "")


_KINDS = ("elastic", "plastic")


def _model(whole: Model, mesh: Mesh, parents: Numbers, u: Floats) -> Model:
    """A model of a mesh whose cells have the state of their parents."""
    before = whole.system.snapshot()
    bodies = {body.key: kept for body in whole.bodies if (kept := _kept_body(body, parents)) is not None}
    model = Model(mesh, bodies=[made for made, _ in bodies.values()])
    terms = {
        key: {name: values[rows] for name, values in before.terms[key].items()} for key, (_, rows) in bodies.items()
    }
    model.system.restore(Snapshot(np.ascontiguousarray(u).ravel(), before.time, terms=terms, began=before.began))
    return model


def _contacts(whole: Model, parents: Numbers, same: NDArray[np.bool_]) -> dict[str, KeptContact]:
    """Histories of the contacts."""
    return {pair.name: KeptContact.of(pair).left(parents, same) for pair in whole.system.touching}


def _removed(whole: Model, model: Model) -> Energies:
    """Energies of what is missing in a model."""
    gone = [_energies(body, whole) for body in whole.bodies]
    left = [_energies(body, model) for body in model.bodies]
    return Energies(*(sum(getattr(e, kind) for e in gone) - sum(getattr(e, kind) for e in left) for kind in _KINDS))


def _energies(body: Body, model: Model) -> Energies:
    return body.energies(Found(), model.u)


def _kept_body(body: Body, parents: Numbers) -> tuple[Body, Numbers] | None:
    """The same body of the remaining cells, and the rows of their parents in it; None if no cell remains."""
    cells = np.flatnonzero(np.isin(parents, body.cells))
    if len(cells) == 0:
        return None
    order = np.argsort(body.cells, kind="stable")
    rows = order[np.searchsorted(body.cells, parents[cells], sorter=order)]
    rolling = body.rolling
    made = Body(
        body.element,
        material=body.material,
        cells=cells,
        name=body.name,
        thickness_points=body.thickness_points,
        thickness_rule=body.thickness_rule,
        rolling=rolling[rows] if rolling is not None and rolling.ndim == 2 else rolling,
    )
    return made, rows
