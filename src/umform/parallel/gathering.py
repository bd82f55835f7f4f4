"""Frames and states of a run over the whole model from what the ranks have, and back."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from umform.model.contact import ContactPoints
from umform.parallel.places import Places

if TYPE_CHECKING:
    from umform.model.frame import Frame
    from umform.parallel.share import Share

Floats = NDArray[np.float64]


class Gathering:
    """Where the nodes, cells and facets of a share are in the whole model.

    Parameters
    ----------
    share : Share
        The share of this rank.
    """

    def __init__(self, share: Share) -> None:
        ranks = share.ranks
        self.share, self.ranks = share, ranks
        self.known_nodes = Places(share.nodes, ranks)
        self.own_nodes = Places(share.nodes[share.owned], ranks)
        self.cells = Places(share.cells, ranks)
        self.facets = [Places(here, ranks) for here in share.facets_here]

    # Whole arrays --------------------------------------------------------------------------------------------

    def displacement(self, u: Floats) -> Floats | None:
        """A displacement (3 nodes here,) of all nodes, shape (3 n,)."""
        whole = self.own_nodes.collect(u.reshape(-1, 3)[self.share.owned])
        return None if whole is None else whole.ravel()

    def points(self, number: int, values: Floats) -> Floats | None:
        """Values at the contact points (points here, ...) of a contact, at all of its points."""
        contact = self.share.contacts[number]
        per_facet = len(contact.block.shape_values)
        whole = self.facets[number].collect(values.reshape(len(contact.facets), per_facet, *values.shape[1:]))
        return None if whole is None else whole.reshape(-1, *values.shape[1:])

    def frame(self, frame: Frame) -> Frame | None:
        """The frame over the whole model, on the first rank."""
        owned = self.share.owned
        points: dict[str, Any] = {name: self.own_nodes.collect(values[owned]) for name, values in frame.points.items()}
        cells: dict[str, Any] = {name: self.cells.collect(values) for name, values in frame.cells.items()}
        contacts: dict[str, dict[str, Any]] = {
            name: {key: self.points(number, values) for key, values in vars(at).items()}
            for number, (name, at) in enumerate(frame.contacts.items())
        }
        if self.ranks.rank > 0:
            return None
        at_points: dict[str, Any] = {name: ContactPoints(**values) for name, values in contacts.items()}
        return replace(frame, points=points, cells=cells, contacts=at_points)

    # The state of a run --------------------------------------------------------------------------------------

    def state(self, tree: dict[str, Any]) -> dict[str, Any]:
        """The tree of a checkpoint over the whole model, on the first rank."""
        model, work = tree["model"], tree["result"]["work"]
        residual = self.share.sum_at_nodes(work["residual"].reshape(-1, 3)).ravel()
        multipliers = [self.points(number, values) for number, values in enumerate(model["multipliers"])]
        return {
            **tree,
            "model": {
                **model,
                "u": self.displacement(model["u"]),
                "state": self.cells.collect(model["state"]),
                "alpha": self.cells.collect(model["alpha"]),
                "multipliers": multipliers,
            },
            "history": self.cells.collect(tree["history"]),
            "last_du": None if tree["last_du"] is None else self.displacement(tree["last_du"]),
            "result": {**tree["result"], "work": {**work, "residual": self.displacement(residual)}},
        }

    def own_state(self, read: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """What this rank has of the tree of a checkpoint, which the first rank reads.

        Raises
        ------
        FileProblem
            On all ranks, if the first one cannot read it.
        """
        tree = self.ranks.on_first(read)
        outline = self.ranks.comm.bcast(None if tree is None else _outline(tree))
        whole = tree or {"model": {}, "result": {"work": {}}}
        model, work = whole["model"], whole["result"]["work"]

        def at_nodes(values: Floats | None) -> Floats:
            return self.known_nodes.hand_out(None if values is None else values.reshape(-1, 3)).ravel()

        multipliers = [self._multipliers(k, model.get("multipliers")) for k in range(len(self.facets))]
        reactions = at_nodes(work.get("residual")).reshape(-1, 3)
        residual = np.zeros_like(reactions)  # the sum counts for the owner
        residual[self.share.owned] = reactions[self.share.owned]
        arrays = {name: self.cells.hand_out(model.get(name)) for name in ("state", "alpha")}
        outline["model"] |= {"u": at_nodes(model.get("u")), **arrays, "multipliers": multipliers}
        outline["history"] = self.cells.hand_out(whole.get("history"))
        outline["last_du"] = at_nodes(whole.get("last_du")) if outline["last_du"] else None
        outline["result"]["work"]["residual"] = residual.ravel()
        outline["result"]["frames"] = None if tree is None else tree["result"]["frames"]
        return outline  # type: ignore[no-any-return]

    def _multipliers(self, number: int, whole: list[Floats] | None) -> Floats:
        places = self.facets[number]
        return places.hand_out(None if whole is None else whole[number].reshape(places.count, -1)).ravel()


def _outline(tree: dict[str, Any]) -> dict[str, Any]:
    """The tree without what each rank has a part of."""
    model = {key: tree["model"][key] for key in ("controls", "time")}
    work = {key: value for key, value in tree["result"]["work"].items() if key != "residual"}
    result = {key: value for key, value in tree["result"].items() if key not in ("work", "frames")}
    small = {key: tree[key] for key in ("fingerprint", "note", "number", "factors", "loop")}
    return {**small, "model": model, "last_du": tree["last_du"] is not None, "result": {**result, "work": work}}
