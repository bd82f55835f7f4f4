"""History of friction, and the penalty, that contact points keep through a cut."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.history_variables import named
from umform.mesh import Ids
from umform.model.contact.pair import Contact
from umform.model.tools.tool import Pose

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]

#: Parts of the history in the frame of the tool: places, and vectors.
_PLACES = ("place",)
_VECTORS = ("normal", "tangential traction", "tangential multiplier", "change of tangential multiplier")


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
        The penalty, if it has grown; zero otherwise.
    """

    faces: Ids
    history: Floats
    history_variables: dict[str, int]
    penalty: float = 0.0

    @classmethod
    def of(cls, contact: Contact) -> KeptContact:
        """The converged history of a pair with friction."""
        history_variables = contact.block.history_variables
        history = _turned(contact.state()["history"], history_variables, contact.pose)
        grown = contact.adapts and contact.penalty > contact.initial_penalty
        return cls(contact.faces.copy(), history, history_variables, contact.penalty if grown else 0.0)

    def left(self, parents: Numbers, same: NDArray[np.bool_]) -> KeptContact:
        """What a part keeps of it.

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
        return replace(self, faces=faces, history=self.history[kept])

    def put(self, contact: Contact) -> int:
        """Give a pair with a history of its own that of its points, and the penalty that the stage before has found.

        Returns the number of faces that have the history.

        Raises
        ------
        InvalidValue
            If it has other points or another law.
        """
        history_variables, history = contact.block.history_variables, contact.state()["history"]
        if history_variables != self.history_variables or history.shape[1:] != self.history.shape[1:]:
            raise InvalidValue(
                "a contact that keeps its history has the points and the law of the one before",
                where=f"contact {contact.name}",
                value=f"{history.shape[1]} points a face, {self.history.shape[1]} before",
                cause="other points, nodes or cells, or a contact without friction",
                remedy="the same points and friction as in the stage before",
            )
        row = {(int(cell), int(face)): k for k, (cell, face) in enumerate(self.faces)}
        rows = np.array([row.get((int(cell), int(face)), -1) for cell, face in contact.faces])
        kept = np.flatnonzero(rows >= 0)
        rotation, shift = contact.pose
        history[kept] = _turned(self.history[rows[kept]], history_variables, (rotation.T, -shift @ rotation))
        contact.restore({"history": history})
        contact.begin_with(self.penalty)
        return len(kept)


def _turned(history: Floats, history_variables: dict[str, int], pose: Pose) -> Floats:
    """A history with its places and vectors turned, and its places shifted."""
    rotation, shift = pose
    out = history.copy()
    for name, values in named(out, history_variables).items():
        if name in _PLACES or name in _VECTORS:
            values[:] = values @ rotation.T
        if name in _PLACES:
            values += shift
    return out
