"""A contact pair: faces of the sheet against one rigid tool, its motion, resultants, pressure and gap."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.mesh import FACE_NODES, Ids, Mesh, Selector
from umform.model.boundary import Control, vector3
from umform.model.contact.settings import ContactSettings
from umform.model.whole import not_here
from umform.surfaces import Surface
from umform.surfaces.directions import rotation_matrix

Floats = NDArray[np.float64]

#: time -> translation (3,), or (translation (3,), rotation vector (3,)) about the tool's reference point.
Motion = Callable[[float], Floats | tuple[Floats, Floats]]


@dataclass(eq=False, repr=False)
class ToolMotion(Control):
    """Translation of a tool along a direction; its force is that of the sheet on the tool along it."""

    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class ContactPoints:
    """What is known at the contact points of a pair.

    Attributes
    ----------
    x : ndarray, shape (n, 3)
        Current positions.
    gap : ndarray, shape (n,)
        Signed distance, negative in penetration.
    pressure : ndarray, shape (n,)
        Contact pressure on the reference area, zero without contact.
    normal : ndarray, shape (n, 3)
        Unit normal out of the tool.
    area : ndarray, shape (n,)
        Reference area that belongs to the point.
    """

    x: Floats
    gap: Floats
    pressure: Floats
    normal: Floats
    area: Floats


class Contact:
    """Frictionless contact of faces with one tool, held by a penalty and, where wanted, multipliers.

    docs/theory, chapter 4. Made by :meth:`umform.Model.contact`.

    Parameters
    ----------
    mesh : Mesh
        The sheet.
    faces : Selector
        Lower or upper faces.
    tool : Surface
        The tool.
    settings : ContactSettings
        Penalty, points, penetration that is allowed, multipliers or not; they are attributes of the pair.
    name : str
        For the history.
    """

    def __init__(self, mesh: Mesh, faces: Selector, tool: Surface, settings: ContactSettings, name: str) -> None:
        self.name = name
        self.tool = tool
        self.penalty, self.points = settings.penalty, settings.points
        self.allowed, self.augmented = settings.allowed, settings.augmented
        self._meet(mesh, mesh.face_set(faces))
        self.pose: tuple[Floats, Floats] = (np.eye(3), np.zeros(3))
        self.translations: list[ToolMotion] = []
        self.motion: Motion | None = None
        self.reference_point = np.zeros(3)
        self.elsewhere = False

    def _meet(self, mesh: Mesh, faces: Ids) -> None:
        #: Rows (cell, number of the face), and the nodes of these facets.
        self.faces: Ids = faces
        self.facets: Ids = mesh.facets_of(faces)
        #: Nodes of all cells that bear a facet, those of the far face too.
        self.nodes: Ids = np.unique(mesh.connectivity[faces[:, 0]])
        self._kernel, self._mesh_points = self.tool.kernel(), mesh.points

    @cached_property
    def block(self) -> _core.ContactBlock:
        """The contact points: made when first asked for.

        Raises
        ------
        ModelError
            If the model was solved on many ranks: each had the points of its own facets.
        """
        if self.elsewhere:
            raise not_here(f"the state of contact {self.name}")
        at_nodes = isinstance(self.points, str)
        per_side = 1 if isinstance(self.points, str) else self.points
        law = _core.penalty_law(self.penalty)
        block = _core.contact_block(self.facets, self._mesh_points, per_side, at_nodes, self._kernel, law)
        block.name = f"contact {self.name}"
        block.set_pose(*self.pose)
        return block

    @property
    def multipliers(self) -> Floats:
        """Multipliers of the converged state at the contact points; zero without augmentation."""
        return self.block.state[:, 0]

    @multipliers.setter
    def multipliers(self, values: Floats) -> None:
        self.block.restore(np.ascontiguousarray(values, dtype=float))

    def bare(self) -> Self:
        """The same contact without its faces, which :meth:`part` gives it anew."""
        bare = copy.copy(self)
        for made in ("block", "faces", "facets", "nodes", "_mesh_points", "_kernel"):
            bare.__dict__.pop(made, None)
        return bare

    def part(self, mesh: Mesh, faces: Ids) -> Self:
        """The same contact on some faces of a part of the mesh, rows (cell, face) there, which may be none."""
        part = self.bare()
        part._meet(mesh, faces)
        return part

    def place(self, time: float) -> None:
        """Put the tool where its motions have it at ``time``. eq. (4.18)"""
        self.put(self._pose_at(time))

    def put(self, pose: tuple[Floats, Floats]) -> None:
        """Put the tool into a pose: rotation and shift."""
        self.pose = pose
        if "block" in vars(self):
            self.block.set_pose(*pose)

    def _pose_at(self, time: float) -> tuple[Floats, Floats]:
        """Rotation and shift of the tool at ``time``, at the present values of the controls."""
        shift, rotation = np.zeros(3), np.eye(3)
        for control in self.translations:
            shift += control.value * np.asarray(control.direction)
        if self.motion is not None:
            answer = self.motion(time)
            translation, turn = answer if isinstance(answer, tuple) and len(answer) == 2 else (answer, np.zeros(3))
            where = f"motion of contact {self.name} at time {time:g}"
            shift += vector3(translation, where)
            rotation = rotation_matrix(vector3(turn, where))
        centre = self.reference_point
        return np.ascontiguousarray(rotation), centre + shift - rotation @ centre

    @property
    def penalty(self) -> float:
        """Pressure per penetration."""
        return self._penalty

    @penalty.setter
    def penalty(self, value: float) -> None:
        self._penalty = value
        if "block" in vars(self):
            self.block.penalty = value

    def active(self) -> NDArray[np.bool_]:
        """Which points are held by the tool, of the last evaluation."""
        return self.block.active.astype(bool)

    def loose(self) -> bool:
        """Whether multipliers are wanted and a point that the tool holds is further from it than allowed."""
        if not self.augmented or self.allowed is None:
            return False
        return bool((np.abs(self.block.gaps[self.active()]) > self.allowed).any())

    def augment(self, change: Floats) -> None:
        """Let the multipliers carry the pressure of the last evaluation, and add what that changes in the residual.

        The points that are held now stay so to first order, and close their gaps: where the tool goes back, new
        multipliers on old gaps would let go of points that bear a pressure. eqs. (4.34), (4.35)
        """
        at = self.at_points()
        self._close(at.gap, change)
        self.block.multipliers = at.pressure

    def stiffen(self, penalty: float, change: Floats) -> None:
        """Take another penalty, and add to the residual what lets the points that are held keep their pressure.

        Parameters
        ----------
        penalty : float
            The new penalty.
        change : ndarray, shape (3 n,)
            Gets what the first increment with the tangent of before has to answer. eq. (4.39)
        """
        self._close((1.0 - self.penalty / penalty) * self.block.gaps, change)
        self.penalty = penalty

    def _close(self, way: Floats, change: Floats) -> None:
        """Add the forces by which the points that are held now go a way (points,) against their gaps."""
        at = self.at_points()
        weight = self.penalty * np.where(self.active(), way, 0.0) * at.area
        self._spread(weight[:, None] * at.normal, change)

    def _spread(self, forces: Floats, change: Floats) -> None:
        """Add forces (points, 3) at the contact points to their nodes. eq. (4.9)"""
        N = self.block.shape_values
        nodal = np.einsum("qa,eqk->eak", N, forces.reshape(len(self.facets), len(N), 3))
        np.add.at(change.reshape(-1, 3), self.facets, nodal)

    def carried(self, x: Floats, time: float) -> Floats:
        """Way of places (n, 3) of the tool, from where it stands to where it will be at ``time``. eq. (4.37)"""
        if self.motion is None:
            return np.zeros_like(x)
        (rotation, shift), (rotation_then, shift_then) = self.pose, self._pose_at(time)
        return (x - shift) @ rotation @ rotation_then.T + shift_then - x

    def turn(self, time: float, change: Floats) -> None:
        """Add what the forces of the last evaluation change by as they turn with the tool until ``time``. eq. (4.37)"""
        if self.motion is not None:
            at, turned = self.at_points(), self._pose_at(time)[0] @ self.pose[0].T
            self._spread(-(at.pressure * at.area)[:, None] * at.normal @ (turned - np.eye(3)).T, change)

    def commit(self) -> None:
        """Make the multipliers those of the converged state."""
        self.block.commit()

    def revert(self) -> None:
        """Go back to the multipliers of the converged state."""
        self.block.revert()

    def at_points(self) -> ContactPoints:
        """Gap, pressure and the rest at the contact points, of the last evaluation. eqs. (4.6), (4.33)"""
        return ContactPoints(
            x=self.block.positions,
            gap=self.block.gaps,
            pressure=self.block.pressures,
            normal=self.block.normals,
            area=self.block.areas,
        )

    def resultant(self, about: Floats | None = None) -> tuple[Floats, Floats]:
        """Resultant of the contact pressure. eq. (4.17)

        Parameters
        ----------
        about : array_like, shape (3,), optional
            Point that the moment is about; default the origin.

        Returns
        -------
        force, moment : ndarray, shape (3,)
            Of the sheet on the tool, at the last evaluation.
        """
        at = self.at_points()
        forces = -(at.pressure * at.area)[:, None] * at.normal
        arm = at.x - (np.zeros(3) if about is None else np.asarray(about, dtype=float))
        return forces.sum(axis=0), np.cross(arm, forces).sum(axis=0)

    def at_nodes(
        self, u: Floats, mesh: Mesh, add: Callable[[Floats], Floats] = lambda shares: shares
    ) -> tuple[Floats, Floats]:
        """Pressure and gap at the nodes of the facets; zero and NaN at other nodes; two arrays of shape (nodes,).

        The pressure is the average of that at the contact points, weighted by their areas and the hat functions of the
        nodes, which are not negative and have the sum one. eq. (4.38). The gap is measured at the nodes themselves.
        ``add`` sums values at nodes, shape (nodes, k), over all that share the mesh.
        """
        at = self.at_points()
        hats = hat_functions(self.block.shape_values)
        places = len(self.facets), len(hats)
        weight = hats * at.area.reshape(*places, 1)  # [facet][point][node]
        share = np.einsum("eqa,eq->ea", weight, at.pressure.reshape(places))
        count = len(mesh.points)
        shares = np.zeros((count, 4))  # pressure times area, area; gap, and how many know it
        np.add.at(shares[:, 0], self.facets.ravel(), share.ravel())
        np.add.at(shares[:, 1], self.facets.ravel(), weight.sum(axis=1).ravel())
        nodes = np.unique(self.facets)
        shares[nodes, 2], shares[nodes, 3] = self.gap((mesh.points + u.reshape(-1, 3))[nodes]), 1.0
        total, area, gap, known = add(shares).T
        pressure = np.divide(total, area, out=np.zeros(count), where=area > 0)
        return pressure, np.divide(gap, known, out=np.full(count, np.nan), where=known > 0)

    def gap(self, x: Floats) -> Floats:
        """Signed distance of positions (n, 3) to the tool where it stands now; shape (n,)."""
        rotation, shift = self.pose
        return self._kernel.gap(np.ascontiguousarray((x - shift) @ rotation))[0]


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
