"""Supports of a model: nodes that are held or prescribed, and mid-lines that are hinged or prescribed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.mesh import Ids, Mesh, Selector
from umform.model.control import Control, Prescribed
from umform.model.controls import Controlled, columns_of
from umform.model.forces import DIRECTIONS
from umform.model.ties import MidLine, Tie, node_pairs

Floats = NDArray[np.float64]

_HELD = "fix or symmetry"


class Supported(Controlled):
    """Supports of the nodes of a mesh.

    Parameters
    ----------
    mesh : Mesh
        Points and cells.
    """

    def __init__(self, mesh: Mesh) -> None:
        super().__init__()
        self.mesh = mesh
        self.ties: list[Tie] = []
        self._fixed = np.zeros(3 * len(mesh.points), dtype=bool)

    def fix(self, nodes: Selector, directions: str = "xyz") -> None:
        """Hold nodes in one or more of the directions x, y, z; both nodes of a hinge may be held, it then has no say.

        Parameters
        ----------
        nodes : str, callable or array_like
            Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.
        directions : str
            Letters of the directions, "xz" for instance.

        Raises
        ------
        InvalidValue
            If a direction is unknown, or a displacement is prescribed or tied already.
        """
        ids = self.mesh.nodes(nodes)
        for direction in directions:
            dofs = 3 * ids + _direction_number(direction)
            held = self._fixed.copy()
            held[dofs] = True
            ties = [_without_held(tie, held) for tie in self.ties]
            taken = self._taken(ties)
            del taken[_HELD]  # to hold a node twice does no harm
            _refuse_twice(dofs, direction, taken, _HELD)
            self._fixed, self.ties = held, ties
        self._assembled = None

    def symmetry(self, nodes: Selector, normal: str) -> None:
        """Symmetry plane: nodes stay in the plane with the normal x, y or z.

        Parameters
        ----------
        nodes : str, callable or array_like
            Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.
        normal : {"x", "y", "z"}
            Normal of the plane.
        """
        self.fix(nodes, normal)

    def prescribe(self, nodes: Selector, direction: str, name: str = "") -> Prescribed:
        """Prescribe the displacement of nodes in a direction.

        Parameters
        ----------
        nodes : str, callable or array_like
            Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.
        direction : {"x", "y", "z"}
            Direction.
        name : str, optional
            Column of the history.

        Returns
        -------
        Prescribed
            The control whose value (a length) steps move; its force is the sum of the reactions on the sheet.

        Raises
        ------
        InvalidValue
            If a displacement is held, prescribed or tied already.
        """
        dofs = (3 * self.mesh.nodes(nodes) + _direction_number(direction)).astype(np.int32)
        _refuse_twice(dofs, direction, self._taken(self.ties), name or "this one")
        return self._add(Prescribed(name or self._name("displacement"), dofs=dofs))

    def hinge(self, nodes: Selector, directions: str = "xyz") -> None:
        """Hold the mid-line of the sheet at an edge, about which its section may rotate.

        The mean of the displacements of the lower and the upper node of each pair is zero. eq. (5.16) Where both are
        held already, by a plane of symmetry for one, that is so without a hinge.

        Parameters
        ----------
        nodes : str, callable or array_like
            Lower and upper nodes, "x0" for instance; through a stack of cells the outermost two nodes make the pair.
        directions : str
            Letters of the directions in which the mid-line is held; "xz" lets it move along y.

        Raises
        ------
        InvalidValue
            If a node has no partner in the set, is prescribed or tied already in a direction, or is held without its
            partner.

        Examples
        --------
        >>> from umform import SVK, Model
        >>> from umform.mesh import strip
        >>> model = Model(strip(10.0, 1.0, 0.1, (8, 1)), material=SVK(E=210e3, nu=0.3))
        >>> model.hinge("x0", "xz")
        """
        for direction in directions:
            self._tie(nodes, direction, None, "hinge")

    def prescribe_midline(self, nodes: Selector, direction: str, name: str = "") -> MidLine:
        """Prescribe the displacement of the mid-line of the sheet at an edge, about which its section may rotate.

        Parameters
        ----------
        nodes : str, callable or array_like
            Lower and upper nodes, "x1" for instance; through a stack of cells the outermost two nodes make the pair.
        direction : {"x", "y", "z"}
            Direction.
        name : str, optional
            Column of the history.

        Returns
        -------
        MidLine
            The control whose value (a length) steps move: the mean of the displacements of the lower and the upper node
            of each pair. Its force is the sum of the reactions on the sheet.

        Raises
        ------
        InvalidValue
            If a node has no partner in the set, or is held, prescribed or tied already.

        Examples
        --------
        >>> from umform import SVK, Model, Move, solve
        >>> from umform.mesh import strip
        >>> model = Model(strip(10.0, 1.0, 0.1, (8, 1)), material=SVK(E=210e3, nu=0.3))
        >>> model.fix("x0")
        >>> lift = model.prescribe_midline("x1", "z", "lift")
        >>> result = solve(model, Move(lift, 0.5, steps=2))
        """
        control = MidLine(name or self._name("midline"))
        self._refuse_taken(columns_of(control), control.name)
        control.dofs = self._tie(nodes, direction, control, control.name)
        return self._add(control)

    def _tie(self, nodes: Selector, direction: str, control: MidLine | None, by: str) -> Ids:
        dofs = (3 * node_pairs(self.mesh, nodes) + _direction_number(direction)).astype(np.int32)
        tie = _without_held(Tie(dofs, control), self._fixed)
        _refuse_twice(tie.dofs.ravel(), direction, self._taken(self.ties), by)
        self.ties.append(tie)
        self._assembled = None
        return tie.dofs.ravel()

    def constrained(self) -> NDArray[np.bool_]:
        """Which degrees of freedom are held or prescribed; tied ones are not."""
        constrained = self._fixed.copy()
        for control in self.of_kind(Prescribed):
            constrained[control.dofs] = True
        return constrained

    @property
    def unknown_count(self) -> int:
        """Number of unknowns: degrees of freedom that are neither held nor prescribed; two that are tied make one."""
        return int((~self.constrained()).sum()) - sum(len(tie.dofs) for tie in self.ties)

    def displacement_of_supports(self, values: Mapping[Control, float]) -> Floats:
        """Displacement that supports prescribe if their controls have these values (others zero); zero elsewhere.

        Parameters
        ----------
        values : mapping of Control to float
            Displacements, or their rates.

        Returns
        -------
        ndarray, shape (3 n,)
        """
        u = np.zeros(self._fixed.size)
        for control in self.controls:
            control.displace(u, values.get(control, 0.0))
        return u

    def prescribed_displacement(self) -> Floats:
        """Displacement that supports prescribe at the present values of the controls; zero elsewhere."""
        return self.displacement_of_supports({control: control.value for control in self.controls})

    def _taken(self, ties: Sequence[Tie]) -> dict[str, Ids]:
        """Degrees of freedom that are spoken for, and by whom."""
        taken = {_HELD: np.flatnonzero(self._fixed).astype(np.int32)}
        taken |= {control.name: control.dofs for control in self.of_kind(Prescribed)}
        for tie in ties:
            by = "hinge" if tie.control is None else tie.control.name
            taken[by] = np.concatenate([taken.get(by, np.empty(0, dtype=np.int32)), tie.dofs.ravel()])
        return taken


def _without_held(tie: Tie, held: NDArray[np.bool_]) -> Tie:
    """A hinge without the pairs whose nodes are both held: their mean is zero as it is."""
    return tie if tie.control is not None else Tie(tie.dofs[~held[tie.dofs].all(axis=1)], None)


def _direction_number(name: str) -> int:
    if name not in DIRECTIONS:
        raise InvalidValue(
            "a direction is x, y or z",
            where="supports",
            value=name,
            cause="another letter, or a vector",
            remedy="fix takes letters such as xz; all others take one of x, y, z",
        )
    return DIRECTIONS[name]


def _refuse_twice(dofs: Ids, direction: str, taken: Mapping[str, Ids], by: str) -> None:
    for other, theirs in taken.items():
        shared = np.intersect1d(dofs, theirs)
        if len(shared):
            raise InvalidValue(
                "a displacement is prescribed twice",
                where=f"node {shared[0] // 3}, direction {direction}",
                value=f"by {other} and by {by}",
                cause="two supports ask for it",
                remedy="take the node out of one of the sets; a hinge bears a node that is held if its partner is too",
            )
