"""Supports of a model: held or prescribed nodes, directors and mid-lines, along x, y, z or local axes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform.errors import InvalidValue
from umform.mesh import Selector
from umform.mesh.numbers import unique
from umform.model.supports.axes import GLOBAL, Axes
from umform.model.supports.held import HELD, Held, refuse_twice
from umform.model.supports.support import (
    Support,
    direction_number,
    direction_of,
    directions_of,
    numbers_of,
    rows_of_nodes,
    rows_of_pairs,
    tie_of,
)
from umform.model.supports.ties import MidLine, node_pairs
from umform.model.terms.control import Prescribed

Floats = NDArray[np.float64]


class Supports(Held):
    """Supports of the nodes of a mesh."""

    def fix(
        self,
        nodes: Selector,
        directions: str | None = None,
        *,
        axes: Axes | None = None,
        normals: ArrayLike | None = None,
        here: bool = False,
        name: str = "",
    ) -> Support:
        """Hold nodes in one or more directions; nodes of a hinge may also be held, which makes the hinge redundant.

        Parameters
        ----------
        nodes : str, callable or array_like
            Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.
        directions : str, optional
            Letters of the directions: x, y, z, or those of the axes, such as r, t, a; by default all three.
        axes : Axes, optional
            Local axes instead of x, y, z: :func:`umform.cylindrical` or :func:`umform.turned`.
        normals : array_like, shape (3,) or (n, 3), optional
            Hold the displacement along these vectors instead, one for all nodes or one for each in the order of their
            numbers.
        here : bool
            Hold the nodes in their present instead of their undeformed positions, along the axes there.
        name : str, optional
            Name of the support.

        Returns
        -------
        Support
            Handle for :meth:`umform.Model.remove`.

        Raises
        ------
        InvalidValue
            If a direction is unknown, a displacement is prescribed or tied already, or the name is taken.
        """
        if normals is not None and (axes is not None or directions is not None):
            raise InvalidValue(
                "normals are directions of their own",
                where="fix",
                value=directions or type(axes).__name__,
                cause="directions or axes beside them",
                remedy="leave one of them out",
            )
        ids = self.mesh.nodes(nodes)
        support = self._new(HELD, directions, ids, here, name)
        if axes is None and normals is None:
            support.directions, numbers = numbers_of(directions)
            dofs = [3 * ids + number for number in numbers]
            support.held = np.concatenate([support.held, *dofs]).astype(np.int32)
        else:
            support.directions, vectors = directions_of(axes or GLOBAL, directions, normals, self._places(here)[ids])
            support.rows = [rows_of_nodes(ids, vector, support.name, None, support.base) for vector in vectors]
        return self._hold(support)

    def symmetry(self, nodes: Selector, normal: str) -> Support:
        """Symmetry plane: nodes stay in the plane with the normal x, y or z.

        Parameters
        ----------
        nodes : str, callable or array_like
            Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.
        normal : str
            Normal of the plane: x, y or z.
        """
        direction_number(normal)  # refuses what is none
        return self.fix(nodes, normal)

    def _places(self, here: bool) -> Floats:
        """Undeformed or present positions of all nodes."""
        return self.mesh.points + self.now.u.reshape(-1, 3) if here else self.mesh.points

    def hinge(
        self,
        nodes: Selector,
        directions: str | None = None,
        *,
        axes: Axes | None = None,
        here: bool = False,
        name: str = "",
    ) -> Support:
        """Hold the mid-line of the sheet at an edge; the section may rotate about it.

        The mean of the displacements of the lower and the upper node of each pair is zero. eq. (5.16) If both are
        already held, by a plane of symmetry for instance, the hinge is redundant.

        Parameters
        ----------
        nodes : str, callable or array_like
            Lower and upper nodes, "x0" for instance; through a stack of cells the outermost two nodes make the pair.
        directions : str, optional
            As for :meth:`fix`; "xz" lets the mid-line move along y.
        axes, here, name
            As for :meth:`fix`.

        Returns
        -------
        Support
            Handle for :meth:`umform.Model.remove`.

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
        >>> hinge = model.hinge("x0", "xz")
        """
        pairs = node_pairs(self.mesh, nodes)
        support = self._new("hinge", directions, unique(pairs), here, name)
        if axes is None:
            support.directions, numbers = numbers_of(directions)
            support.ties = [tie_of(pairs, number, None, support.base) for number in numbers]
        else:
            middle = self._places(here)[pairs].mean(axis=1)
            support.directions, vectors = directions_of(axes, directions, None, middle)
            support.rows = [rows_of_pairs(pairs, vector, "hinge", None, support.base) for vector in vectors]
        return self._hold(support)

    def hold_director(
        self,
        nodes: Selector,
        directions: str | None = None,
        *,
        axes: Axes | None = None,
        here: bool = False,
        name: str = "",
    ) -> Support:
        """Hold the director of the sheet at an edge: the nodes of each pair move by the same displacement.

        The difference of their displacements in the directions is zero, their mean is free. Held along one direction,
        the director stays in the plane normal to it, in which it may tilt and stretch. eq. (5.44)

        Parameters
        ----------
        nodes : str, callable or array_like
            Lower and upper nodes, "x0" for instance; through a stack of cells the outermost two nodes make the pair.
        directions, axes, here, name
            As for :meth:`fix`.

        Returns
        -------
        Support
            Handle for :meth:`umform.Model.remove`.

        Raises
        ------
        InvalidValue
            If a node has no partner in the set, or the support contradicts another one.

        Examples
        --------
        A rigid diaphragm at the end of a cylinder about y. It holds the mid-line in its plane and the section against
        a rotation about the axis.

        >>> from umform import SVK, Model, cylindrical
        >>> from umform.mesh import strip
        >>> model = Model(strip(10.0, 1.0, 0.1, (8, 1)), material=SVK(E=210e3, nu=0.3))
        >>> ends = model.hinge("y1", "xz"), model.hold_director("y1", "t", axes=cylindrical((0, 0, -50), "y"))
        """
        pairs = node_pairs(self.mesh, nodes)
        support = self._new("director", directions, unique(pairs), here, name)
        middle = self._places(here)[pairs].mean(axis=1)
        support.directions, vectors = directions_of(axes or GLOBAL, directions, None, middle)
        support.rows = [rows_of_pairs(pairs, v, support.name, None, support.base, turn=True) for v in vectors]
        return self._hold(support)

    def prescribe(self, nodes: Selector, direction: str, name: str = "", *, axes: Axes | None = None) -> Prescribed:
        """Prescribe the displacement of nodes in a direction.

        Parameters
        ----------
        nodes : str, callable or array_like
            Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.
        direction : str
            Direction.
        name : str, optional
            Column of the history.
        axes : Axes, optional
            Local axes instead of x, y, z; the direction is then one of their letters.

        Returns
        -------
        Prescribed
            The control of the displacement; its force is the sum of the reactions on the sheet.

        Raises
        ------
        InvalidValue
            If a displacement is held, prescribed or tied already, or the name is taken.
        """
        ids = self.mesh.nodes(nodes)
        control = Prescribed(name or self.controls.free_name("displacement"))
        if axes is not None:
            vectors = direction_of(axes, direction, self.mesh.points[ids])
            rows = [rows_of_nodes(ids, vectors, control.name, control, None)]
            return self._drive(control, Support(control.name, control.name, direction, ids, rows=rows, control=control))
        control.dofs = (3 * ids + direction_number(direction)).astype(np.int32)
        refuse_twice(control.dofs, direction, self._taken(self.ties), name or "this one")
        return self._drive(control, None)

    def prescribe_midline(
        self, nodes: Selector, direction: str, name: str = "", *, axes: Axes | None = None
    ) -> MidLine:
        """Prescribe the displacement of the mid-line of the sheet at an edge; the section may rotate about it.

        Parameters
        ----------
        nodes : str, callable or array_like
            Lower and upper nodes, "x1" for instance; through a stack of cells the outermost two nodes make the pair.
        direction : str
            Direction.
        name : str, optional
            Column of the history.
        axes : Axes, optional
            Local axes instead of x, y, z; the direction is then one of their letters.

        Returns
        -------
        MidLine
            The control of the mean of the displacements of the lower and the upper node of each pair. Its force is the
            sum of the reactions on the sheet.

        Raises
        ------
        InvalidValue
            If a node has no partner in the set, is held, prescribed or tied already, or the name is taken.

        Examples
        --------
        >>> from umform import SVK, Model, Move, solve
        >>> from umform.mesh import strip
        >>> model = Model(strip(10.0, 1.0, 0.1, (8, 1)), material=SVK(E=210e3, nu=0.3))
        >>> clamp = model.fix("x0")
        >>> lift = model.prescribe_midline("x1", "z", "lift")
        >>> result = solve(model, Move(lift, 0.5, steps=2))
        """
        control, pairs = MidLine(name or self.controls.free_name("midline")), node_pairs(self.mesh, nodes)
        holder = Support(control.name, control.name, direction, unique(pairs), control=control)
        if axes is not None:
            vectors = direction_of(axes, direction, self.mesh.points[pairs].mean(axis=1))
            holder.rows = [rows_of_pairs(pairs, vectors, control.name, control, None)]
            return self._drive(control, holder)
        tie = tie_of(pairs, direction_number(direction), control, None)
        refuse_twice(tie.dofs.ravel(), direction, self._taken(self.ties), control.name)
        control.dofs, holder.ties = tie.dofs.ravel(), [tie]
        return self._drive(control, holder)
