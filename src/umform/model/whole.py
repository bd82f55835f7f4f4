"""What a model in one piece gives back as it is, and a share of one gathers from all ranks or hands out to them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.model.frame import Frame

Floats = NDArray[np.float64]


class Whole:
    """A model in one piece."""

    #: Whether the ranks of a run have the history of its elements and contacts.
    elsewhere = False

    #: Nodes that count here where each is to be counted once.
    owned: slice | NDArray[np.int64] = slice(None)

    @property
    def described(self) -> Any:
        """The model as it was described, if it is there: this one."""
        return self

    def node_number(self, node: int) -> int:
        """Number of a node in the mesh of the model."""
        return int(node)

    def sum_at_nodes(self, shares: Floats) -> Floats:
        """Values at the nodes, shape (n, k), from the shares that the elements of each rank give."""
        return shares

    def whole_frame(self, frame: Frame) -> Frame | None:
        """A frame over all nodes, cells and contact points, on the first rank."""
        return frame

    def whole_state(self, tree: dict[str, Any]) -> dict[str, Any]:
        """The state of a run, as checkpoints have it, over all nodes, cells and contact points, on the first rank."""
        return tree

    def own_state(self, read: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """The state of a run at the nodes, cells and contact points that are here; the first rank reads it."""
        return read()
