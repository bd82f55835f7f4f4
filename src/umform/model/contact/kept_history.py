"""History and penalty that contact points keep through a cut."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.history_variables import named
from umform.mesh import Ids
from umform.model.contact.pair import Contact
from umform.model.contact.sheets import SheetContact
from umform.model.tools.tool import Pose

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Parts of the history in the frame of the tool: places, and vectors.
_PLACES = ("place",)
_VECTORS = (
    *("normal", "tangential traction", "tangential multiplier", "change of tangential multiplier"),
    *("traction", "lift"),  # of a bead
)
#: Parts of the history of sheets that add up over a run.
_ADDED = ("slip", "friction work", "contact work")


@dataclass(frozen=True)
class KeptContact:
    """The history of a pair of faces and a tool at the end of a stage.

    Attributes
    ----------
    faces : ndarray of int, shape (faces, 2)
        Rows (cell, number of the face).
    history : ndarray, shape (faces, points, size)
        That of the points, with places and vectors in global axes.
    history_variables : dict of str to int
        Its parts and their sizes.
    penalty : float
        The penalty, if it was estimated and grows; zero otherwise.
    feet : ndarray of int, shape (faces, points, 2), optional
        Of a contact of sheets: the faces that the points have met, -1 where they have met none.
    over_cells : bool, optional
        Whether the points are those of cells; None in a state of an older program.
    gaps : ndarray, shape (faces, points), optional
        Of friction on a tool: signed distances of the places of the points; None in a state of an older program.
    """

    faces: Ids
    history: Floats
    history_variables: dict[str, int]
    penalty: float = 0.0
    feet: Ids | None = None
    over_cells: bool | None = None
    gaps: Floats | None = None

    @classmethod
    def of(cls, contact: Contact | SheetContact) -> KeptContact:
        """The converged history of a pair."""
        penalty, over_cells = contact.penalty if contact.adapts else 0.0, contact.cells is not None
        history, history_variables = _history(contact)
        if isinstance(contact, SheetContact):  # its places and tractions move with the other sheet
            facet = named(history, history_variables)["facet"][..., 0].astype(np.int64)
            rows = np.where(facet > 0, contact.opposite[:, None] + facet - 1, 0)
            feet = np.where(facet[..., None] > 0, contact.faces[rows], -1).astype(np.int32)
            return cls(contact.faces, history, history_variables, penalty, feet, over_cells)
        turned = _turned(history, history_variables, contact.pose)
        gaps = _gaps(turned, history_variables, contact) if "place" in history_variables else None
        return cls(contact.faces.copy(), turned, history_variables, penalty, over_cells=over_cells, gaps=gaps)

    def left(self, parents: Numbers, same: NDArray[np.bool_]) -> KeptContact:
        """The history that remains on a part.

        Parameters
        ----------
        parents : ndarray of int
            Cell of the whole sheet for each cell of the part.
        same : ndarray of bool
            Cells that have not changed.
        """
        cell = np.full(max(int(parents.max()), int(self.faces[:, 0].max(initial=0))) + 1, -1)
        cell[parents[same]] = np.flatnonzero(same)
        kept = np.flatnonzero(cell[self.faces[:, 0]] >= 0)
        faces = np.stack([cell[self.faces[kept, 0]], self.faces[kept, 1]], axis=1).astype(np.int32)
        if self.feet is None:
            gaps = None if self.gaps is None else self.gaps[kept]
            return replace(self, faces=faces, history=self.history[kept], gaps=gaps)
        feet = self.feet[kept]
        there = np.where(feet[..., 0] >= 0, cell[feet[..., 0]], -1)
        feet = np.where(there[..., None] >= 0, np.stack([there, feet[..., 1]], axis=-1), -1).astype(np.int32)
        return replace(self, faces=faces, history=self.history[kept], feet=feet)

    def moved(self, pose: Pose) -> KeptContact:
        """That of a part and a tool that are placed elsewhere, by a rotation and a shift."""
        return replace(self, history=_turned(self.history, self.history_variables, pose))

    def put(self, contact: Contact | SheetContact) -> int:
        """Give a pair with a history of its own that of its points, and an estimated penalty that of the stage before.

        Returns the number of faces that have the history.

        Raises
        ------
        InvalidValue
            If it has other points or another law, or its tool does not stand where it stood.
        """
        history, history_variables = _history(contact)
        over_cells = contact.cells is not None
        if (
            history_variables != self.history_variables
            or history.shape[1:] != self.history.shape[1:]
            or self.over_cells not in (over_cells, None)
        ):
            now, before = (" of cells" if cells else "" for cells in (over_cells, self.over_cells))
            raise InvalidValue(
                "a contact that keeps its history has the points and the law of the one before",
                where=f"contact {contact.name}",
                value=f"{history.shape[1]} points a face{now}, {self.history.shape[1]} before{before}",
                cause="other points, nodes or cells, or friction in one of the two only",
                remedy="the same points and friction as in the stage before",
            )
        rows = _rows(self.faces, contact.faces)
        kept = np.flatnonzero(rows >= 0)
        if isinstance(contact, SheetContact):
            history[kept] = self._on(contact, kept, rows[kept])
            contact.go_on_with(history.reshape(-1, history.shape[-1]))
        else:
            self._refuse_another_place(contact, rows[kept])
            rotation, shift = contact.pose
            history[kept] = _turned(self.history[rows[kept]], history_variables, (rotation.T, -shift @ rotation))
            contact.restore({"history": history})
        contact.begin_with(self.penalty)
        return len(kept)

    def _refuse_another_place(self, contact: Contact, rows: Numbers) -> None:
        """Refuse a tool whose distance from held points is another one by more than their elastic slip."""
        if self.gaps is None:
            return
        history = self.history[rows]
        held = named(history, self.history_variables)["held"][..., 0] > 0.0
        moved = np.abs(_gaps(history, self.history_variables, contact) - self.gaps[rows])[held]
        if (moved > contact.slip).any():
            raise InvalidValue(
                "a tool that keeps its friction must stand where it stood",
                where=f"contact {contact.name}",
                value=f"its surface is up to {moved.max():.4g} away from there, at {len(moved)} points that it held",
                cause="the tool has travelled in the stage before, and has its first place here",
                remedy="shift it by that travel, or let the contact begin anew, without its friction",
            )

    def _on(self, contact: SheetContact, faces: Numbers, rows: Numbers) -> Floats:
        """The history of some faces of a contact of sheets; points whose foot is gone keep what has added up."""
        assert self.feet is not None
        history, feet = self.history[rows].copy(), self.feet[rows]
        foot = _rows(contact.faces, feet.reshape(-1, 2)).reshape(feet.shape[:2])
        foot = np.where(foot >= 0, foot - contact.opposite[faces][:, None] + 1, 0)
        parts = named(history, self.history_variables)
        lost = (foot <= 0) & (parts["facet"][..., 0] > 0)
        parts["friction work"][lost] += parts["stored"][lost]
        parts["contact work"][lost] -= parts["contact energy"][lost]
        for name, values in parts.items():
            if name not in _ADDED:
                values[lost] = 0.0
        parts["facet"][..., 0] = np.where(lost, 0, foot)
        return history


def _gaps(history: Floats, history_variables: dict[str, int], contact: Contact) -> Floats:
    """Signed distances of the places of a history, in global axes, to the tool of a contact; shape (faces, points)."""
    places = named(history, history_variables)["place"]
    return contact.gap(places.reshape(-1, 3), contact.pose).reshape(places.shape[:2])


def _history(contact: Contact | SheetContact) -> tuple[Floats, dict[str, int]]:
    """The converged history of a contact, shape (faces, points, size), and its parts."""
    history = np.asarray(contact.state()["history"])
    if isinstance(contact, SheetContact):
        return history.reshape(len(contact.faces), -1, history.shape[-1]).copy(), contact.history_variables
    return history, contact.block.history_variables


def _rows(faces: Ids, wanted: Ids) -> Numbers:
    """Row of each wanted face (cell, number of the face) among others, -1 if it is none of them."""
    row = {(int(cell), int(face)): k for k, (cell, face) in enumerate(faces)}
    return np.array([row.get((int(cell), int(face)), -1) for cell, face in wanted], dtype=np.int64)


def _turned(history: Floats, history_variables: dict[str, int], pose: Pose) -> Floats:
    """A history with its places and vectors turned, and its places shifted; places on a facet go with that."""
    rotation, shift = pose
    out = history.copy()
    for name, values in named(out, history_variables).items():
        if values.shape[-1] < 3:
            continue
        if name in _PLACES or name in _VECTORS:
            values[:] = values @ rotation.T
        if name in _PLACES:
            values += shift
    return out
