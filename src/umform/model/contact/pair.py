"""A contact pair: faces of the sheet against one rigid tool."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.mesh import Mesh
from umform.mesh.numbers import unique
from umform.model.contact.face_basis import in_face_basis, mean_at_nodes
from umform.model.contact.found import ContactFound, ContactPoints
from umform.model.contact.points import PairPoints
from umform.model.terms.control import Control
from umform.model.terms.term import At, Energies, Found, Into, Tree
from umform.model.tools.tool import Pose
from umform.ranks import Ranks

Floats = NDArray[np.float64]


class Contact(PairPoints):
    """Contact of faces with one tool by a penalty and optional multipliers, with or without friction.

    docs/theory, chapter 4. Made by :meth:`umform.Model.contact`.

    Parameters
    ----------
    mesh : Mesh
        The sheet.
    faces : Selector
        Lower or upper faces.
    tool : Tool
        The tool.
    settings : ContactSettings
        Penalty, points, allowed penetration, multipliers; they are attributes of the pair.
    name : str
        For the history.
    """

    within_bodies = True

    # Term ----------------------------------------------------------------------------------------------------

    def couples(self) -> Sequence[_core.Connectivity]:
        """The nodes of each facet."""
        return (self.block.connectivity,)

    def moves_with(self, rates: Mapping[Control, float]) -> bool:
        """Whether the tool has a rate."""
        return self.tool.moved_by(rates)

    def evaluate(self, at: At, into: Into) -> ContactFound:
        """Add the forces and tangents of all facets in contact. eqs. (4.9), (4.10)"""
        pose = self.tool.pose(at.values, at.time)
        self.block.set_pose(*pose)
        way = self._relative_way(at, into, pose)
        product = None if way is None else into.predictor
        last = self._last if at.keep and self.keeps_points else None
        if last is not None:
            self.block.keep(last.status)
        scatter = into.scatters[self][0]
        scale = self.block.evaluate(at.u, scatter, into.residual, into.values, way, product)[1]
        spins, until = self.tool.spins(at.rates, at), None if self.tool.motion is None else at.until
        if into.rates_only and not spins and until is None:
            return ContactFound(scale)
        found = self._found(scale, at.u, pose)
        if last is not None and bool((last.active & ~found.active).any()):
            found = replace(found, kept=True)
        if until is not None:
            turned = self.tool.pose(at.values, until)[0] @ pose[0].T
            self._spread(found.forces @ (turned - np.eye(3)).T, into.predictor)
        for spin, _ in spins:
            self._spread(np.cross(spin, found.forces), into.predictor)
        return found

    def _relative_way(self, at: At, into: Into, pose: Pose) -> Floats | None:
        """Displacement of the nodes relative to the tool, shape (3 n,), for the predictor. eq. (4.37)"""
        if at.du is None:
            return None
        way = at.du.reshape(-1, 3) - self.tool.shift_rate(at.rates)
        for spin, point in self.tool.spins(at.rates, at):
            way = way - np.cross(spin, (into.positions + at.u).reshape(-1, 3) - point)
        if at.until is not None:
            way = way - self._carried((into.positions + at.u).reshape(-1, 3), at, pose)
        return np.ascontiguousarray(way).ravel()

    def _carried(self, x: Floats, at: At, pose: Pose) -> Floats:
        """Displacement of points (n, 3) that move with the tool, from its present to its next pose. eq. (4.37)"""
        if self.tool.motion is None or at.until is None:
            return np.zeros_like(x)
        (rotation, shift), (rotation_then, shift_then) = pose, self.tool.pose(at.values, at.until)
        return (x - shift) @ rotation @ rotation_then.T + shift_then - x

    def commit(self, found: Found) -> None:
        """Accept trial history, multipliers, penalty and results as converged."""
        self._commit()
        assert isinstance(found, ContactFound)
        last = self._last
        if last is not None and (self.augmented or self.penalty != self._standing_penalty):
            self.stiffening_work += found.work_of_stiffening(last)
        self.work_of_touch = 0.0 if last is None or self.tool.open else found.work_of_touch(last)
        self._standing_penalty = self.penalty
        self.stand(found)

    def _commit(self) -> None:
        if self.remembers:
            self.before = self._by_facet(self.block.read)
        self.block.commit()

    def begin(self) -> None:
        """Initialise the history of friction and cells from the last evaluation, if there is none yet."""
        if self.remembers and not self.block.begun:
            self._commit()

    def go_back(self, before: Floats) -> None:
        """Restore the history that the evaluation of the converged state used as input."""
        self.block.restore(np.ascontiguousarray(before).reshape(-1, before.shape[-1]))

    def revert(self) -> None:
        """Return to the converged history."""
        self.block.revert()

    def state(self) -> Tree:
        """History of the points, a grown penalty and the work of changes; a row for each facet, which ranks share."""
        tree: Tree = {"history": self._by_facet(self.block.state)}
        if self.adapts:
            tree["penalty"] = np.full(len(self.facets), self._standing_penalty)
        if self.adapts or self.augmented:
            work = tree["stiffening work"] = np.zeros(len(self.facets))
            work[:1] = self.stiffening_work  # shares of all facets would not add up to the same bits
        return tree

    def _by_facet(self, history: Floats) -> Floats:
        """A history of points with a row for each facet."""
        return history.reshape(len(self.facets), -1, history.shape[1])

    def restore(self, tree: Tree) -> None:
        """Restore a history."""
        history = np.ascontiguousarray(tree["history"], dtype=float)
        self.block.restore(history.reshape(-1, history.shape[-1]))
        if self.adapts and len(tree.get("penalty", ())):
            self._restore_penalty(float(tree["penalty"][0]))
        if len(tree.get("stiffening work", ())):
            self.stiffening_work = float(tree["stiffening work"].sum())
        self._last = None

    def columns(self, found: Found, ranks: Ranks) -> dict[str, float]:
        """Largest penetration and number of held points; slipping points and their slip; work along the path."""
        assert isinstance(found, ContactFound)
        columns = {
            f"{self.name}_penetration": self.deepest(found, ranks),
            f"{self.name}_penetration_energy": ranks.sum(found.energy_of_penetration()),
            f"{self.name}_penalty": self.penalty,
            f"{self.name}_active": int(ranks.sum(float(found.active.sum()))),
        }
        if self.friction is not None:
            elastic = float(np.linalg.norm(found.held.elastic_slip, axis=1).max(initial=0.0))
            columns |= {
                f"{self.name}_slipping": int(ranks.sum(float(found.slipping.sum()))),
                f"{self.name}_elastic_slip": ranks.max(elastic),
                f"{self.name}_friction_work": ranks.sum(found.friction_work),
            }
        if self.augmented:
            columns[f"{self.name}_multipliers_stay"] = float(self.multipliers_stay)
        if self.cells is not None:
            columns[f"{self.name}_contact_work"] = ranks.sum(float(found.held.contact_work))
        return columns

    def column_names(self) -> Iterable[str]:
        """Largest penetration, number of held points, and the columns of friction and cells."""
        of_friction = [] if self.friction is None else ["slipping", "elastic_slip", "friction_work"]
        of_multipliers = ["multipliers_stay"] if self.augmented else []
        of_all = ["penetration", "penetration_energy", "penalty", "active"]
        of_cells = [] if self.cells is None else ["contact_work"]
        return [f"{self.name}_{what}" for what in [*of_all, *of_friction, *of_multipliers, *of_cells]]

    def energies(self, found: Found, u: Floats) -> Energies:
        """Energy of penalty and multipliers, and the work of friction. eqs. (4.32), (4.49), (4.201)"""
        assert isinstance(found, ContactFound)
        return Energies(0.0, 0.0, found.energy() + self.stiffening_work, found.friction_work)

    # The converged state -------------------------------------------------------------------------------------

    def active(self) -> NDArray[np.bool_]:
        """Mask of the active points in the converged state."""
        return self.found.active

    def at_points(self) -> ContactPoints:
        """Gap, pressure and the rest at the contact points of the converged state. eqs. (4.6), (4.33)"""
        return self.found.points()

    def resultant(self, about: Floats | None = None) -> tuple[Floats, Floats]:
        """Resultant of the contact pressure in the converged state, see :meth:`ContactFound.resultant`. eq. (4.17)"""
        return self.found.resultant(about)

    # Multipliers and penalties -------------------------------------------------------------------------------

    def loose(self, found: ContactFound) -> bool:
        """Whether multipliers are active and a gap or an elastic slip exceeds its limit."""
        if not self.augmented or self.allowed is None:
            return False
        if (np.abs(self._in_basis(found.held_gap, found)) > self.allowed).any():
            return True
        slides = self.friction is not None and np.linalg.norm(self._in_basis(found.elastic_slip, found), axis=1)
        return bool(np.any(slides > self.slip))

    def deepest(self, found: ContactFound, ranks: Ranks) -> float:
        """Largest penetration on all ranks."""
        return ranks.max(self._depth(found))

    def _depth(self, found: ContactFound) -> float:
        """Largest penetration; with multipliers the part of it that the face can remove."""
        if not self.augmented or not found.active.any():
            return found.penetration
        return float(-min(self._in_basis(found.held_gap, found).min(), 0.0))

    def augment(self, found: ContactFound, change: Floats) -> None:
        """Augmentation: set the multipliers to the present pressure, and add the change of the residual.

        To first order the held points keep their pressure and close their gaps. Where the tool retreats, new
        multipliers on old gaps would open points under pressure. eqs. (4.34), (4.35)
        """
        self._close(found, found.share * self._in_basis(found.held_gap, found), change)
        self.block.multipliers = np.maximum(self._in_basis(found.pressure, found), 0.0)
        if self.friction is not None:  # sticking points keep their traction and recover their elastic slip
            stiffness = found.tangential_stiffness * found.area * (found.status == 1)
            self._spread(stiffness[:, None] * self._in_basis(found.elastic_slip, found), change)
            self.block.augment(self._in_basis(found.friction, found))

    def _in_basis(self, values: Floats, found: ContactFound) -> Floats:
        """Values at the held points, projected onto the shape functions of the faces."""
        return in_face_basis(values, found.active, found.share * found.area, self.block.shape_values)

    def stiffen(self, found: ContactFound, penalty: float, change: Floats) -> None:
        """Change the penalty, and add to the residual the change that keeps the pressure of the held points.

        Parameters
        ----------
        found : ContactFound
            Equilibrium with the present penalty.
        penalty : float
            The new penalty.
        change : ndarray, shape (3 n,)
            Receives the residual for the first increment with the previous tangent. eq. (4.39)
        """
        rest = 1.0 - self.penalty / penalty
        if self.law is None:
            self._close(found, rest * found.held_gap, change)
        else:  # to first order the same forces, whatever the law
            self._spread((-rest * found.pressure * found.area)[:, None] * found.held_normal, change)
        self.use_penalty(penalty)

    def _close(self, found: ContactFound, way: Floats, change: Floats) -> None:
        """Add the forces that move the held points by a distance (points,) against their gaps."""
        weight = self.penalty * np.where(found.active, way, 0.0) * found.area
        self._spread(weight[:, None] * found.held_normal, change)

    # Output --------------------------------------------------------------------------------------------------

    def at_nodes(
        self, u: Floats, mesh: Mesh, add: Callable[[Floats], Floats] = lambda shares: shares
    ) -> tuple[Floats, Floats]:
        """Pressure and gap at the nodes of the facets; zero and NaN at other nodes; two arrays of shape (nodes,).

        The pressure is the average of that at the contact points, weighted by their areas and the hat functions of the
        nodes, which are not negative and have the sum one. eq. (4.38). The gap is measured at the nodes themselves.
        ``add`` sums values at nodes, shape (nodes, k), over all that share the mesh.
        """
        return self.found_at_nodes(self.found, u, mesh, add)

    def found_at_nodes(
        self, at: ContactFound, u: Floats, mesh: Mesh, add: Callable[[Floats], Floats] = lambda shares: shares
    ) -> tuple[Floats, Floats]:
        """The same of any evaluation at ``u``."""
        count, nodes = len(mesh.points), unique(self.facets)
        shares = np.zeros((count, 2))  # gap, and how many know it
        shares[nodes, 0], shares[nodes, 1] = self.gap(mesh.displaced(u)[nodes], self.pose), 1.0
        pressure = self._mean_at_nodes(at.pressure[:, None], at.area, count, add)[:, 0]
        gap, known = add(shares).T
        return pressure, np.divide(gap, known, out=np.full(count, np.nan), where=known > 0)

    def friction_at_nodes(
        self, at: ContactFound, mesh: Mesh, add: Callable[[Floats], Floats] = lambda shares: shares
    ) -> tuple[Floats, Floats]:
        """Tangential traction (nodes, 3) and distance slid (nodes,), averaged as the pressure is. eq. (4.38)"""
        values = np.column_stack([at.friction, at.slip])
        mean = self._mean_at_nodes(values, at.area, len(mesh.points), add)
        return mean[:, :3], mean[:, 3]

    def _mean_at_nodes(self, values: Floats, areas: Floats, count: int, add: Callable[[Floats], Floats]) -> Floats:
        return mean_at_nodes(values, areas, self.block.shape_values, self.facets, count, add)
