"""Gather frames and states of a run over the whole model from the ranks, and distribute them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from umform.model.contact import Contact, ContactPoints
from umform.model.equations.frame import Frame
from umform.model.terms.term import Term, Tree
from umform.parallel.mpi_ranks import MpiRanks
from umform.parallel.places import Places

Floats = NDArray[np.float64]


#: Placeholder for nodal values in the outline of a tree.
_NODAL = "at nodes"


def _nodal(value: Any) -> bool:
    """Whether an entry of the state of a support has values at nodes."""
    return isinstance(value, np.ndarray)


class Part(Protocol):
    """Position of a share in the whole model."""

    ranks: MpiRanks
    u: Floats
    nodes: NDArray[np.int64]
    cells: NDArray[np.int64]
    owned: NDArray[np.int64]

    @property
    def contacts(self) -> Sequence[Contact]:
        """Its contacts."""

    @property
    def terms(self) -> list[Term]:
        """All terms of the residual."""


class Gathering:
    """Where the nodes, cells and facets of a share are in the whole model.

    Parameters
    ----------
    share : Part
        The share of this rank.
    """

    def __init__(self, share: Part) -> None:
        ranks = share.ranks
        self.share, self.ranks = share, ranks
        self.known_nodes = Places(share.nodes, ranks)
        self.own_nodes = Places(share.nodes[share.owned], ranks)
        self.cells = Places(share.cells, ranks)
        #: Local rows of the state of each term, by its key.
        self.rows = {term.key: Places(term.rows, ranks) for term in share.terms if term.rows is not None}
        #: Entries of the states of terms with nodal values.
        self.nodal = {term.key: term.nodal for term in share.terms if term.nodal}

    # Whole arrays --------------------------------------------------------------------------------------------

    def displacement(self, u: Floats) -> Floats | None:
        """A displacement (3 nodes here,) of all nodes, shape (3 n,)."""
        whole = self.own_nodes.collect(u.reshape(-1, 3)[self.share.owned])
        return None if whole is None else whole.ravel()

    def points(self, contact: Contact, values: Floats) -> Floats | None:
        """Values at the contact points (points here, ...) of a contact, at all of its points."""
        per_facet = contact.block.per_facet
        rows = values.reshape(len(contact.facets), per_facet, *values.shape[1:])
        whole = self.rows[contact.key].collect(rows)
        return None if whole is None else whole.reshape(-1, *values.shape[1:])

    def frame(self, frame: Frame) -> Frame | None:
        """The frame over the whole model, on the first rank."""
        owned, by_name = self.share.owned, {contact.name: contact for contact in self.share.contacts}
        points: dict[str, Any] = {name: self.own_nodes.collect(values[owned]) for name, values in frame.points.items()}
        cells: dict[str, Any] = {name: self.cells.collect(values) for name, values in frame.cells.items()}
        contacts: dict[str, dict[str, Any]] = {
            name: {key: self.points(by_name[name], values) for key, values in at.known().items()}
            for name, at in frame.contacts.items()
        }
        if self.ranks.rank > 0:
            return None
        at_points: dict[str, Any] = {name: ContactPoints(**values) for name, values in contacts.items()}
        return replace(frame, points=points, cells=cells, contacts=at_points)

    # The state of a run --------------------------------------------------------------------------------------

    def state(self, tree: dict[str, Any]) -> dict[str, Any]:
        """The tree of a checkpoint over the whole model, on the first rank."""
        model = tree["model"]
        return {
            **tree,
            "model": {
                **model,
                "u": self.displacement(model["u"]),
                "terms": {key: self._collected(key, state) for key, state in model["terms"].items()},
                "supports": self.supports(model["supports"]),
            },
            "before": {key: self.rows[key].collect(values) for key, values in tree["before"].items()},
            "trail": self._collected_trail(tree["trail"]),
        }

    def supports(self, states: Tree) -> Tree:
        """States of supports over the whole model, on the first rank."""
        return {
            name: {key: self.displacement(values) if _nodal(values) else values for key, values in state.items()}
            for name, state in states.items()
        }

    def _collected(self, key: str, state: Tree) -> Tree:
        """State of a term over the whole model; one without rows is the same on all ranks, but for what nodes have."""
        if key not in self.rows:
            return {name: self.displacement(v) if name in self.nodal.get(key, ()) else v for name, v in state.items()}
        return {name: self.rows[key].collect(values) for name, values in state.items()}

    def _collected_trail(self, trail: Tree | None) -> Tree | None:
        """Trail over the whole model, on the first rank."""
        if trail is None:
            return None
        dofs = self.share.u.size
        whole = [self.displacement(row[:dofs]) for row in trail["terms"]]
        if self.ranks.rank > 0:
            return None
        return {**trail, "terms": np.concatenate([np.array(whole), trail["terms"][:, dofs:]], axis=1)}

    def own_state(self, read: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """What this rank has of the tree of a checkpoint, which the first rank reads.

        Raises
        ------
        FileProblem
            On all ranks, if the first one cannot read it.
        """
        tree = self.ranks.on_first(read)
        outline: dict[str, Any] = self.ranks.comm.bcast(None if tree is None else self._outline(tree))
        model = outline["model"]
        whole: Any = tree or {
            "model": {"u": None, "terms": {}, "supports": {}},
            "before": {},
            "trail": None,
            "result": {},
        }
        model["u"] = self._at_nodes(whole["model"]["u"])
        for key, names in model["rows"].items():
            state = whole["model"]["terms"].get(key, {})
            model["terms"][key] = {name: self.rows[key].hand_out(state.get(name)) for name in names}
        del model["rows"]
        for key, names in self.nodal.items():
            for name in sorted(set(names) & set(model["terms"].get(key, ()))):
                model["terms"][key][name] = self._at_own_nodes(whole["model"]["terms"].get(key, {}).get(name))
        for name, state in model["supports"].items():
            given = whole["model"]["supports"].get(name, {})
            for entry, hand_out in (("base", self._at_nodes), ("vector", self._at_own_nodes)):
                if state[entry] is not None:
                    state[entry] = hand_out(given.get(entry))
        outline["before"] = {key: self.rows[key].hand_out(whole["before"].get(key)) for key in outline["before"]}
        if outline["trail"] is not None:
            scalars = outline["trail"]["terms"]
            rows = [None] * len(scalars) if whole["trail"] is None else whole["trail"]["terms"]
            here = [self._at_nodes(None if row is None else row[: whole["model"]["u"].size]) for row in rows]
            outline["trail"]["terms"] = np.concatenate([np.array(here), scalars], axis=1)
        outline["result"]["frames"] = None if tree is None else tree["result"]["frames"]
        return outline

    def _at_nodes(self, values: Floats | None) -> Floats:
        return self.known_nodes.hand_out(None if values is None else values.reshape(-1, 3)).ravel()

    def _at_own_nodes(self, values: Floats | None) -> Floats:
        """Values that count for the owner of a node, zero at the others."""
        here = self._at_nodes(values).reshape(-1, 3)
        own = np.zeros_like(here)
        own[self.share.owned] = here[self.share.owned]
        return own.ravel()

    def _outline(self, tree: dict[str, Any]) -> dict[str, Any]:
        """The tree without what each rank has a part of, and the names of what it has."""
        model = {key: tree["model"][key] for key in ("controls", "unknowns", "time", "began")}
        terms = tree["model"]["terms"]
        model["terms"] = {
            key: {name: None if name in self.nodal.get(key, ()) else value for name, value in state.items()}
            for key, state in terms.items()
            if key not in self.rows
        }
        model["supports"] = {
            name: {key: _NODAL if _nodal(value) else value for key, value in state.items()}
            for name, state in tree["model"]["supports"].items()
        }
        model["rows"] = {key: list(state) for key, state in terms.items() if key in self.rows}
        result = {key: value for key, value in tree["result"].items() if key != "frames"}
        small = {key: tree[key] for key in ("fingerprint", "note", "number", "factors", "loop", "statistics")}
        trail = tree["trail"]
        if trail is not None:  # of its rows only what no node has
            trail = {**trail, "terms": trail["terms"][:, tree["model"]["u"].size :]}
        return {**small, "model": model, "before": list(tree["before"]), "trail": trail, "result": result}
