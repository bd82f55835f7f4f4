"""A term of single nodes: forces between each node and the ground. Springs, foundations and dampers are such terms.

A derived class defines a function of the displacement of a node, :meth:`NodalTerm.respond`; assembly, history,
checkpoints and ranks are implemented here. docs/extending.md
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.errors import InvalidValue
from umform.model.terms.control import Twins
from umform.model.terms.cut import Cut
from umform.model.terms.elsewhere import not_here
from umform.model.terms.into import checked_answer, shaped_answer
from umform.model.terms.term import At, Energies, Found, Into, Term, Tree

Floats = NDArray[np.float64]
Ids = NDArray[np.int32]


@dataclass(frozen=True)
class NodalFound(Found):
    """Result of the evaluation of a nodal term.

    Attributes
    ----------
    forces : ndarray, shape (n, 3)
        Internal forces: the forces on the ground. A node shared by several ranks counts on one.
    history : ndarray, shape (n, k)
        Trial history.
    changed : ndarray of bool, shape (n,)
        Whether the evaluation has changed the history of a node.
    """

    forces: Floats = field(default_factory=lambda: np.empty((0, 3)))
    history: Floats = field(default_factory=lambda: np.empty((0, 0)))
    changed: NDArray[np.bool_] = field(default_factory=lambda: np.empty(0, dtype=bool))

    @property
    def flowing(self) -> NDArray[np.uint8]:
        """1 for each node whose history the evaluation has changed, else 0; empty without a history."""
        return self.changed.astype(np.uint8) if self.history.size else np.zeros(0, dtype=np.uint8)


class NodalTerm(Term):
    """Forces between single nodes and the ground; derive from it and write :meth:`respond`.

    Parameters
    ----------
    name : str
        For messages, files and the history.
    nodes : array_like of int, shape (n,)
        Numbers of the nodes, ``mesh.nodes("z0")`` for instance.
    history : mapping of str to int, or int
        Names and sizes of what each node remembers, zero at first; or how many numbers.

    Attributes
    ----------
    each_node : tuple of str
        Names of attributes of a derived class with one row for each node, which ranks divide.
    history : ndarray, shape (n, k)
        Converged history.
    history_variables : dict of str to int
        Names and sizes of its parts, for :func:`umform.history_variables.named`.

    Raises
    ------
    InvalidValue
        If the nodes are not a row of numbers.
    """

    within_bodies = True
    each_node: tuple[str, ...] = ()
    memory = (*Term.memory, "history", "before")

    def __init__(self, name: str, nodes: ArrayLike, history: Mapping[str, int] | int = 0) -> None:
        given = np.asarray(nodes)
        if given.ndim != 1 or not np.issubdtype(given.dtype, np.integer):
            raise InvalidValue(
                "the nodes of a term are a row of numbers",
                where=f"{type(self).__name__} {name}",
                value=f"{given.dtype} of shape {given.shape}",
                remedy="mesh.nodes(...) gives the numbers of a set, a predicate or a mask",
            )
        self.name, self.nodes = name, given.astype(np.int32)
        self.history_variables = {"history": history} if isinstance(history, int) else dict(history)
        self.history: Floats = np.zeros((len(given), sum(self.history_variables.values())))
        self.before = self.history[:0]

    def respond(self, u: Floats, history: Floats, at: At) -> tuple[Floats, Floats, Floats]:
        """Forces of the nodes on the ground, their derivatives, and the trial history.

        Parameters
        ----------
        u : ndarray, shape (n, 3)
            Displacements.
        history : ndarray, shape (n, k)
            Converged history, which must not be changed.
        at : At
            Time, step of time, values of the controls.

        Returns
        -------
        forces : ndarray, shape (n, 3)
        tangents : ndarray, shape (n, 3, 3)
            ``tangents[a, i, j]`` is the derivative of ``forces[a, i]`` with ``u[a, j]``.
        history : ndarray, shape (n, k)
        """
        raise NotImplementedError

    def energy(self, u: Floats, history: Floats) -> tuple[ArrayLike, ArrayLike]:
        """Stored energy and dissipated work of each node at a converged state, shape (n,); unknown by default."""
        return np.nan, 0.0

    # Term ----------------------------------------------------------------------------------------------------

    def couples(self) -> tuple[_core.Connectivity]:
        """Each node with itself."""
        return (_core.Connectivity(self.nodes[:, None]),)

    def _at_nodes(self, u: Floats) -> Floats:
        return u.reshape(-1, 3)[self.nodes]

    def _asked(self, function: Callable[..., Any], names: Sequence[str], called: str, *arguments: Any) -> Sequence[Any]:
        """What a function of the derived class returns, one array for each name; errors name the term and the call."""
        history = self.history.view()
        history.flags.writeable = False  # it is that of the converged state
        try:
            answer = function(arguments[0], history, *arguments[1:])
        except Exception as error:
            error.add_note(f"in the term {self!r}, called as {called}")
            raise
        if not isinstance(answer, tuple) or len(answer) != len(names):
            raise InvalidValue(
                f"{called.split('(')[0]} of a term must return {len(names)} arrays: {', '.join(names)}",
                where=repr(self),
                value=type(answer).__name__,
                cause="a return that is missing, or a list in place of a tuple",
                remedy=called,
            )
        return answer

    def _responds(self, at: At) -> tuple[Floats, Floats, Floats]:
        n, k = self.history.shape
        names, called = ("forces", "tangents", "history"), "respond(u, history, at) -> forces, tangents, history"
        answer = self._asked(self.respond, names, called, self._at_nodes(at.u), at)
        shapes = ((n, 3), (n, 3, 3), (n, k))
        forces, tangents, history = (checked_answer(self, *one) for one in zip(names, answer, shapes, strict=True))
        return forces, tangents, history

    def evaluate(self, at: At, into: Into) -> NodalFound:
        """Add forces and tangents of all nodes."""
        forces, tangents, history = self._responds(at)
        into.add(self, self.nodes[:, None], forces[:, None], tangents[:, None, :, None, :], at)
        changed = (history != self.history).any(axis=1)
        return NodalFound(float((forces**2).sum()), forces=forces, history=history, changed=changed)

    def commit(self, found: Found) -> None:
        """Accept the trial history as converged."""
        assert isinstance(found, NodalFound)
        self.before, self.history = self.history, found.history

    def go_back(self, before: Floats) -> None:
        """Restore the history that the evaluation of the converged state used as input."""
        self.history = before

    def state(self) -> Tree:
        """Converged history, a row for each node."""
        if self.elsewhere:
            raise not_here(f"the history of {self.name}")
        return {"history": self.history} if self.history.shape[1] else {}

    def restore(self, tree: Tree) -> None:
        """Restore a history."""
        self.history = np.array(tree["history"], dtype=float)

    def energies(self, found: Found, u: Floats) -> Energies:
        """Stored energy and spent work of the nodes."""
        names, called = ("stored", "dissipated"), "energy(u, history) -> stored, dissipated"
        answer = self._asked(self.energy, names, called, self._at_nodes(u))
        n = len(self.nodes)
        elastic, plastic = (
            shaped_answer(self, f"{name} energy", part if np.ndim(part) else np.full(n, part), (n,))
            for name, part in zip(names, answer, strict=True)
        )
        return Energies(float(elastic.sum()), float(plastic.sum()), 0.0)

    def support_forces(self, found: Found, at: At) -> Floats:
        """Forces of the ground on the nodes, as the evaluation found them: a committed history may give others."""
        assert isinstance(found, NodalFound)
        forces = np.zeros((at.u.size // 3, 3))
        np.subtract.at(forces, self.nodes, found.forces)
        return forces.ravel()

    def holds(self, at: At) -> tuple[Ids, Floats]:
        """Rows of the tangents: directions in which the nodes are constrained."""
        tangents = self._responds(at)[1].reshape(-1, 3)
        length = np.linalg.norm(tangents, axis=1)
        stiff = length > 0.0
        return np.repeat(self.nodes, 3)[stiff], tangents[stiff] / length[stiff, None]

    # Ranks ---------------------------------------------------------------------------------------------------

    def strip(self, bare: Self, twins: Twins) -> None:
        """Without nodes and nodal data."""
        for made in ("nodes", "history", "before", *self.each_node):
            bare.__dict__.pop(made, None)

    def piece(self, cut: Cut) -> dict[str, Any]:
        """Nodes that the rank owns, in its numbering, their rows, and their data."""
        nodes, rows = cut.nodes_of(self.nodes)
        each = {name: np.asarray(getattr(self, name))[rows] for name in ("history", *self.each_node)}
        return {"nodes": nodes, "rows": rows, "before": self.before[:0], **each}

    def fill(self, piece: dict[str, Any], mesh: Any) -> None:
        """Set nodes, history and nodal data."""
        vars(self).update(piece)
