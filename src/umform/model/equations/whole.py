"""Access to whole-model data: trivial for a model on one process, gathered or distributed on ranks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.model.equations.frame import Frame

Floats = NDArray[np.float64]


class Whole:
    """A model on one process.

    Parameters
    ----------
    described : Model, optional
        The complete model, if available.
    """

    #: Nodes that count on this rank where each must count once.
    owned: slice | NDArray[np.int64] = slice(None)

    def __init__(self, described: Any = None) -> None:
        self.described = described
        #: Whether the ranks of a run hold the history of its elements and contacts.
        self.elsewhere = False

    def node_number(self, node: int) -> int:
        """Number of a node in the mesh of the model."""
        return int(node)

    def sum_at_nodes(self, shares: Floats) -> Floats:
        """Sum of nodal values, shape (n, k), over the elements of all ranks."""
        return shares

    def frame(self, frame: Frame) -> Frame | None:
        """A frame over all nodes, cells and contact points, on the first rank."""
        return frame

    def state(self, tree: dict[str, Any]) -> dict[str, Any]:
        """The state of a run for checkpoints, over all nodes, cells and contact points, on the first rank."""
        return tree

    def own_state(self, read: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """The local part of the state of a run; the first rank reads the file."""
        return read()
