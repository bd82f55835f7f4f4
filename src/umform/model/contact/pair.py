"""A contact pair: faces of the sheet against one rigid tool."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.errors import ModelError
from umform.mesh import FACE_NODES, Ids, Mesh, Selector
from umform.model.contact.found import ContactFound, ContactPoints
from umform.model.contact.settings import ContactSettings
from umform.model.control import Control, Twins
from umform.model.cut import Cut
from umform.model.elsewhere import not_here
from umform.model.term import At, Energies, Found, Into, Term, Tree
from umform.model.tool import Pose, Tool
from umform.ranks import Ranks

Floats = NDArray[np.float64]


class Contact(Term):
    """Frictionless contact of faces with one tool, held by a penalty and, where wanted, multipliers.

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
        Penalty, points, penetration that is allowed, multipliers or not; they are attributes of the pair.
    name : str
        For the history.
    """

    timed_as = "contact"
    within_bodies = True

    def __init__(self, mesh: Mesh, faces: Selector, tool: Tool, settings: ContactSettings, name: str) -> None:
        self.name = name
        self.tool = tool
        self._settings, self._penalty = settings, settings.penalty
        self._meet(mesh, mesh.face_set(faces))
        self.elsewhere = False
        self._last: ContactFound | None = None

    def _meet(self, mesh: Mesh, faces: Ids) -> None:
        #: Rows (cell, number of the face), and the nodes of these facets.
        self.faces: Ids = faces
        self.facets: Ids = mesh.facets_of(faces)
        #: Nodes of all cells that bear a facet, those of the far face too.
        self.nodes: Ids = np.unique(mesh.connectivity[faces[:, 0]])
        self._mesh_points = mesh.points

    # Settings ------------------------------------------------------------------------------------------------

    @property
    def points(self) -> int | str:
        """Gauss points per direction and facet, or "nodes"; fixed when the pair is made."""
        return self._settings.points

    @property
    def allowed(self) -> float | None:
        """Penetration that is allowed; None where only a penalty was given."""
        return self._settings.allowed

    @allowed.setter
    def allowed(self, value: float | None) -> None:
        self._settings = replace(self._settings, allowed=value)

    @property
    def augmented(self) -> bool:
        """Whether multipliers take the penetration away that is not allowed."""
        return self._settings.augmented

    @property
    def penalty(self) -> float:
        """Pressure per penetration."""
        return self._penalty

    @penalty.setter
    def penalty(self, value: float) -> None:
        self._penalty = value
        if "block" in vars(self):
            self.block.penalty = value

    @cached_property
    def block(self) -> _core.ContactBlock:
        """The contact points: made when first asked for.

        Raises
        ------
        ModelError
            If the model was solved on many ranks: each had the points of its own facets.
        """
        if self.elsewhere:
            raise self._not_here()
        at_nodes = isinstance(self.points, str)
        per_side = 1 if isinstance(self.points, str) else self.points
        law = _core.penalty_law(self.penalty)
        block = _core.contact_block(self.facets, self._mesh_points, per_side, at_nodes, self.tool.kernel, law)
        block.name = f"contact {self.name}"
        return block

    @property
    def symmetric(self) -> bool:  # type: ignore[override]
        """Whether the tangent of its law is."""
        return self.block.symmetric

    @property
    def multipliers(self) -> Floats:
        """Multipliers of the converged state at the contact points; zero without augmentation."""
        return self.block.state[:, 0]

    def _not_here(self) -> ModelError:
        return not_here(f"the state of contact {self.name}")

    # Term ----------------------------------------------------------------------------------------------------

    def couples(self) -> Sequence[_core.Connectivity]:
        """The nodes of each facet."""
        return (self.block.connectivity,)

    def moves_with(self, rates: Mapping[Control, float]) -> bool:
        """Whether its tool does."""
        return self.tool.moved_by(rates)

    def evaluate(self, at: At, into: Into) -> ContactFound:
        """Add the forces and tangents of all facets that the tool holds. eqs. (4.9), (4.10)"""
        pose = self.tool.pose(at.values, at.time)
        self.block.set_pose(*pose)
        way = self._relative_way(at, into, pose)
        product = None if way is None else into.predictor
        scatter = into.scatters[self][0]
        scale = self.block.evaluate(at.u, scatter, into.residual, into.values, way, product)[1]
        found = self._found(scale, at.u, pose)
        if at.until is not None and self.tool.motion is not None:
            turned = self.tool.pose(at.values, at.until)[0] @ pose[0].T
            self._spread(
                -(found.pressure * found.area)[:, None] * found.normal @ (turned - np.eye(3)).T, into.predictor
            )
        for spin, _ in self.tool.spins(at.rates, at):
            self._spread(np.cross(spin, found.forces), into.predictor)
        return found

    def _relative_way(self, at: At, into: Into, pose: Pose) -> Floats | None:
        """Way of the nodes less that of the tool at their places, shape (3 n,), for the predictor. eq. (4.37)"""
        if at.du is None:
            return None
        way = at.du.reshape(-1, 3) - self.tool.shift_rate(at.rates)
        for spin, point in self.tool.spins(at.rates, at):
            way = way - np.cross(spin, (into.positions + at.u).reshape(-1, 3) - point)
        if at.until is not None:
            way = way - self._carried((into.positions + at.u).reshape(-1, 3), at, pose)
        return np.ascontiguousarray(way).ravel()

    def _carried(self, x: Floats, at: At, pose: Pose) -> Floats:
        """Way of places (n, 3) of the tool by its motion, from where it stands to where it will be. eq. (4.37)"""
        if self.tool.motion is None or at.until is None:
            return np.zeros_like(x)
        (rotation, shift), (rotation_then, shift_then) = pose, self.tool.pose(at.values, at.until)
        return (x - shift) @ rotation @ rotation_then.T + shift_then - x

    def _found(self, scale: float, u: Floats, pose: Pose) -> ContactFound:
        """What the kernel knows now of the points that are held, copied; the rest is measured when it is asked for."""
        block = self.block
        held = block.found()
        multiplier = block.multipliers if self.augmented else self._no_multipliers
        measure = partial(self._measured, u, pose)
        return ContactFound(
            scale,
            held.round_off_squared,
            held=held,
            measure=measure,
            area=self._areas,
            multiplier=multiplier,
            penalty=self.penalty,
        )

    @cached_property
    def _areas(self) -> Floats:
        return self.block.areas

    @cached_property
    def _no_multipliers(self) -> Floats:
        return np.zeros(self._areas.size)

    def _measured(self, u: Floats, pose: Pose) -> tuple[Floats, Floats, Floats]:
        """Positions, gaps and normals of all points at a displacement, with the tool in a pose."""
        self.block.set_pose(*pose)
        self.block.locate(u)
        return self.block.positions, self.block.gaps, self.block.normals

    def locate(self, u: Floats, pose: Pose) -> ContactFound:
        """What would be found at a displacement, with the tool in a pose; no force and no tangent."""
        self.block.set_pose(*pose)
        self.block.locate(u)
        return self._found(0.0, u, pose)

    def stand(self, found: ContactFound) -> None:
        """Keep what was found at the converged state."""
        self._last = found

    def commit(self, found: Found) -> None:
        """Make the trial history, multipliers too, and what was found those of the converged state."""
        self.block.commit()
        assert isinstance(found, ContactFound)
        self.stand(found)

    def revert(self) -> None:
        """Go back to the converged history."""
        self.block.revert()

    def state(self) -> Tree:
        """History of the points, a row for each facet."""
        state = self.block.state
        return {"history": state.reshape(len(self.facets), -1, state.shape[1])}

    def restore(self, tree: Tree) -> None:
        """Put a history back."""
        history = np.ascontiguousarray(tree["history"], dtype=float)
        self.block.restore(history.reshape(-1, history.shape[-1]))
        self._last = None

    def columns(self, found: Found, ranks: Ranks) -> dict[str, float]:
        """Largest penetration and number of points that are held."""
        assert isinstance(found, ContactFound)
        return {
            f"{self.name}_penetration": ranks.max(found.penetration),
            f"{self.name}_active": int(ranks.sum(float(found.active.sum()))),
        }

    def column_names(self) -> Iterable[str]:
        """Largest penetration and number of points that are held."""
        return [f"{self.name}_penetration", f"{self.name}_active"]

    def energies(self, found: Found, u: Floats) -> Energies:
        """What penalty and multipliers hold. eq. (4.32)"""
        assert isinstance(found, ContactFound)
        return Energies(0.0, 0.0, found.energy())

    # The converged state -------------------------------------------------------------------------------------

    @property
    def found(self) -> ContactFound:
        """What was found at the converged state.

        Raises
        ------
        ModelError
            If the model has not been solved yet; ask ``model.evaluate(u).found[contact]`` then. If it was solved on
            many ranks: each had the points of its own facets.
        """
        if self.elsewhere:
            raise self._not_here()
        if self._last is None:
            raise ModelError(
                f"nothing is known of contact {self.name} yet",
                cause="the model has not been solved since it was made or put back",
                remedy="model.evaluate(model.u).found[contact]",
            )
        return self._last

    def active(self) -> NDArray[np.bool_]:
        """Which points are held by the tool in the converged state."""
        return self.found.active

    def at_points(self) -> ContactPoints:
        """Gap, pressure and the rest at the contact points of the converged state. eqs. (4.6), (4.33)"""
        return self.found.points()

    def resultant(self, about: Floats | None = None) -> tuple[Floats, Floats]:
        """Resultant of the contact pressure in the converged state, see :meth:`ContactFound.resultant`. eq. (4.17)"""
        return self.found.resultant(about)

    # Multipliers and penalties -------------------------------------------------------------------------------

    def loose(self, found: ContactFound) -> bool:
        """Whether multipliers are wanted and a point that the tool holds is further from it than allowed."""
        if not self.augmented or self.allowed is None:
            return False
        return bool((np.abs(found.held.gap) > self.allowed).any())

    def augment(self, found: ContactFound, change: Floats) -> None:
        """Let the multipliers carry the pressure that was found, and add what that changes in the residual.

        The points that are held now stay so to first order, and close their gaps: where the tool goes back, new
        multipliers on old gaps would let go of points that bear a pressure. eqs. (4.34), (4.35)
        """
        self._close(found, found.held_gap, change)
        self.block.multipliers = found.pressure

    def stiffen(self, found: ContactFound, penalty: float, change: Floats) -> None:
        """Take another penalty, and add to the residual what lets the points that are held keep their pressure.

        Parameters
        ----------
        found : ContactFound
            Equilibrium with the present penalty.
        penalty : float
            The new penalty.
        change : ndarray, shape (3 n,)
            Gets what the first increment with the tangent of before has to answer. eq. (4.39)
        """
        self._close(found, (1.0 - self.penalty / penalty) * found.held_gap, change)
        self.penalty = penalty

    def _close(self, found: ContactFound, way: Floats, change: Floats) -> None:
        """Add the forces by which the points that are held now go a way (points,) against their gaps."""
        weight = self.penalty * np.where(found.active, way, 0.0) * found.area
        self._spread(weight[:, None] * found.held_normal, change)

    def _spread(self, forces: Floats, change: Floats) -> None:
        """Add forces (points, 3) at the contact points to their nodes. eq. (4.9)"""
        N = self.block.shape_values
        nodal = np.einsum("qa,eqk->eak", N, forces.reshape(len(self.facets), len(N), 3))
        np.add.at(change.reshape(-1, 3), self.facets, nodal)

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
        hats = hat_functions(self.block.shape_values)
        places = len(self.facets), len(hats)
        weight = hats * at.area.reshape(*places, 1)  # [facet][point][node]
        share = np.einsum("eqa,eq->ea", weight, at.pressure.reshape(places))
        count = len(mesh.points)
        shares = np.zeros((count, 4))  # pressure times area, area; gap, and how many know it
        np.add.at(shares[:, 0], self.facets.ravel(), share.ravel())
        np.add.at(shares[:, 1], self.facets.ravel(), weight.sum(axis=1).ravel())
        nodes = np.unique(self.facets)
        shares[nodes, 2], shares[nodes, 3] = self.gap((mesh.points + u.reshape(-1, 3))[nodes], self.pose), 1.0
        total, area, gap, known = add(shares).T
        pressure = np.divide(total, area, out=np.zeros(count), where=area > 0)
        return pressure, np.divide(gap, known, out=np.full(count, np.nan), where=known > 0)

    @property
    def pose(self) -> Pose:
        """Where its tool stands now: rotation and shift."""
        return self.tool.pose_now

    def gap(self, x: Floats, pose: Pose | None = None) -> Floats:
        """Signed distance of positions (n, 3) to the tool, where it stands now or in a pose; shape (n,)."""
        rotation, shift = self.pose if pose is None else pose
        return self.tool.kernel.gap(np.ascontiguousarray((x - shift) @ rotation))[0]

    # Ranks ---------------------------------------------------------------------------------------------------

    def strip(self, bare: Self, twins: Twins) -> None:
        """Without faces and points, of the twin of its tool."""
        for made in ("block", "_areas", "_no_multipliers", "faces", "facets", "nodes", "_mesh_points", "_last"):
            bare.__dict__.pop(made, None)
        bare.tool = twins.of(self.tool)

    def piece(self, cut: Cut) -> tuple[Ids, NDArray[np.int64], Tree | None]:
        """Faces of the rank, which rows of this contact they are, and their history if there is any yet."""
        faces, rows = cut.faces_of(self.faces)
        history = {name: values[rows] for name, values in self.state().items()} if "block" in vars(self) else None
        return faces, rows, history

    def fill(self, piece: tuple[Ids, NDArray[np.int64], Tree | None], mesh: Any) -> None:
        """Take faces and history."""
        faces, self.rows, history = piece
        self._last = None
        self._meet(mesh, faces)
        if history is not None:
            self.restore(history)


def hat_functions(N: Floats) -> Floats:
    """Piecewise bilinear functions between the nodes of a face at the places where its shape functions are N.

    Parameters
    ----------
    N : ndarray, shape (points, nodes)
        Shape functions of a face of 4 or 9 nodes.

    Returns
    -------
    ndarray, shape (points, nodes)
        N itself on 4-node faces; on 9-node faces the hats (1 - |r - r_a|)(1 - |s - s_a|) of their four quarters.
    """
    if N.shape[1] == 4:
        return N
    distance = np.abs((N @ FACE_NODES)[:, None, :] - FACE_NODES)
    hats: Floats = np.maximum(1.0 - distance, 0.0).prod(axis=-1)
    return hats
