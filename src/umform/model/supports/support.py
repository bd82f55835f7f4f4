"""A support of a model, which can be removed and restored. docs/theory, 5.10"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.mesh import Ids
from umform.model.supports.axes import Axes, directions_at, unit_normals
from umform.model.supports.constraints import Rows
from umform.model.supports.ties import MidLine, Tie
from umform.model.terms.control import Control, Twins
from umform.model.terms.cut import Cut
from umform.model.terms.dead_load import Load
from umform.model.terms.forces import DIRECTIONS

Floats = NDArray[np.float64]


def _no_dofs() -> Ids:
    return np.empty(0, dtype=np.int32)


def _no_pairs() -> Ids:
    return np.empty((0, 2), dtype=np.int32)


@dataclass(eq=False)
class Support:
    """Something that holds nodes, directors or the mid-line of the sheet.

    Attributes
    ----------
    name : str
        Name in messages, and of the history column while the support is released.
    kind : str
        "fix or symmetry", "hinge", "director", or the name of the control that prescribes a mid-line.
    directions : str
        Letters of the directions, or "normals".
    nodes : ndarray of int32
        Its nodes.
    held : ndarray of int32
        Degrees of freedom that it holds along x, y or z.
    ties : list of Tie
        Pairs of lower and upper degrees of freedom whose mean it holds.
    rows : list of Rows
        Constraints in local axes.
    base : ndarray, shape (3 n,), optional
        Displacement of the model when the support was activated, if it holds the nodes in that position.
    control : Control, optional
        Control that prescribes the displacement; None for a support.
    load : Load, optional
        The forces that replace it after removal.
    removed : bool
        Whether it is inactive.
    waits : bool
        Whether it is activated later, with the positions of its nodes at that time.
    """

    name: str
    kind: str
    directions: str
    nodes: Ids
    held: Ids = field(default_factory=_no_dofs)
    ties: Sequence[Tie] = ()
    rows: Sequence[Rows] = ()
    base: Floats | None = None
    control: Control | None = None
    load: Load | None = None
    removed: bool = False
    waits: bool = False

    def hold_at(self, base: Floats | None) -> None:
        """Hold the nodes at a displacement of the model, or in their undeformed positions."""
        self.base = base
        self.ties = [replace(tie, offsets=None if base is None else base[tie.dofs].mean(axis=1)) for tie in self.ties]
        self.rows = [replace(part, offsets=_offsets(part.dofs, part.weights, base)) for part in self.rows]

    # Ranks ---------------------------------------------------------------------------------------------------

    def strip(self, bare: Any, twins: Twins) -> None:
        """Without nodes, with the twins of its controls."""
        bare.nodes, bare.held, bare.base = _no_dofs(), _no_dofs(), None
        bare.ties = [Tie(_no_pairs(), _twin(tie.control, twins)) for tie in self.ties]
        bare.control, bare.load = _twin(self.control, twins), _twin(self.load, twins)

    def piece(self, cut: Cut) -> dict[str, Any]:
        """Nodes, degrees of freedom and pairs of the rank, and their held displacement."""
        nodes, held = cut.node[self.nodes], cut.dofs(self.held)
        known = [(cut.node[tie.dofs // 3] >= 0).all(axis=1) for tie in self.ties]
        ties = [
            (cut.dofs(tie.dofs[here]), None if tie.offsets is None else tie.offsets[here])
            for tie, here in zip(self.ties, known, strict=True)
        ]
        base = None if self.base is None else self.base.reshape(-1, 3)[cut.nodes].ravel()
        return {"nodes": nodes[nodes >= 0], "held": held[held >= 0], "ties": ties, "base": base}

    def fill(self, piece: dict[str, Any], mesh: Any) -> None:
        """Set them."""
        self.nodes, self.held, self.base = piece["nodes"], piece["held"], piece["base"]
        own = zip(piece["ties"], self.ties, strict=True)
        self.ties = [Tie(dofs, tie.control, offsets) for (dofs, offsets), tie in own]

    def __repr__(self) -> str:
        return f"Support({self.name!r}, {self.kind} {self.directions}, {len(self.nodes)} nodes)"

    def __str__(self) -> str:
        return self.name


def _twin(thing: Any, twins: Twins) -> Any:
    return None if thing is None else twins.of(thing)


def direction_number(name: str) -> int:
    """0, 1 or 2 for x, y or z."""
    if not isinstance(name, str) or name not in DIRECTIONS:
        raise InvalidValue(
            "a direction is x, y or z",
            where="supports",
            value=name,
            cause="another letter, or a vector",
            remedy="letters such as xz; other directions need axes= or normals=",
        )
    return DIRECTIONS[name]


def numbers_of(letters: Sequence[str] | None) -> tuple[str, list[int]]:
    """Letters and numbers of directions along x, y and z; by default all three."""
    each = "xyz" if letters is None else letters
    numbers = [direction_number(letter) for letter in (each if isinstance(each, Sequence) else [each])]
    return "".join(each), numbers


def directions_of(
    axes: Axes, letters: str | None, normals: ArrayLike | None, points: Floats
) -> tuple[str, list[Floats]]:
    """Letters and unit vectors (n, 3) of the directions in which a support holds."""
    if normals is not None:
        return "normals", [unit_normals(normals, len(points))]
    if not hasattr(axes, "letters"):
        raise InvalidValue(
            "axes of a support are local axes",
            where="supports, axes",
            value=axes,
            cause="the letter of an axis, or a vector",
            remedy="cylindrical(origin, axis) or turned(x, y)",
        )
    found = directions_at(axes, axes.letters if letters is None else letters, points)
    return "".join(letter for letter, _ in found), [vectors for _, vectors in found]


def direction_of(axes: Axes, letter: str, points: Floats) -> Floats:
    """Unit vectors (n, 3) of the one direction in which a control prescribes a displacement."""
    _, vectors = directions_of(axes, letter, None, points)
    if len(vectors) != 1:
        raise InvalidValue(
            "a displacement is prescribed in one direction",
            where="supports",
            value=letter or "''",
            cause="several letters, or none",
            remedy=f"one of {', '.join(axes.letters)}; a control for each direction",
        )
    return vectors[0]


def tie_of(pairs: Ids, direction: int, control: MidLine | None, base: Floats | None) -> Tie:
    """The mean of the displacements of each pair in one direction."""
    dofs = (3 * pairs + direction).astype(np.int32)
    return Tie(dofs, control, None if base is None else base[dofs].mean(axis=1))


def rows_of_nodes(nodes: Ids, vectors: Floats, by: str, control: Control | None, base: Floats | None) -> Rows:
    """The displacement of each node along its unit vector."""
    return _rows((3 * nodes[:, None] + np.arange(3)).astype(np.int32), vectors, by, control, base)


def rows_of_pairs(
    pairs: Ids, vectors: Floats, by: str, control: Control | None, base: Floats | None, *, turn: bool = False
) -> Rows:
    """Mean of the displacements of lower and upper node along a unit vector; with ``turn`` half their difference."""
    dofs = (3 * pairs[:, :, None] + np.arange(3)).reshape(-1, 6).astype(np.int32)
    weights = 0.5 * np.concatenate([-vectors if turn else vectors, vectors], axis=1)
    return _rows(dofs, weights, by, control, base)


def _rows(dofs: Ids, weights: Floats, by: str, control: Control | None, base: Floats | None) -> Rows:
    return Rows(dofs, weights, control, by, _offsets(dofs, weights, base))


def _offsets(dofs: Ids, weights: Floats, base: Floats | None) -> Floats | None:
    return None if base is None else (weights * base[dofs]).sum(axis=1)
