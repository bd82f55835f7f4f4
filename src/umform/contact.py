"""Contact pairs: faces of the sheet against one rigid tool, its motion, resultants, pressure and gap."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from umform import _core
from umform.boundary import Control, vector3
from umform.errors import InvalidPenalty, InvalidValue
from umform.mesh import Ids, Mesh, Selector
from umform.surfaces import Surface

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
    """Frictionless penalty contact of faces with one tool (docs/theory, chapter 4).

    Made by :meth:`umform.Model.contact`.
    """

    def __init__(
        self, mesh: Mesh, faces: Selector, tool: Surface, penalty: float, points: int | str, name: str
    ) -> None:
        if not (np.isfinite(penalty) and penalty > 0):
            raise InvalidPenalty(
                "the penalty must be positive",
                where=f"contact {name}",
                value=penalty,
                cause="a sign or a missing value",
                remedy="choose it from the penetration that you allow: penalty = expected pressure / penetration",
            )
        at_nodes = isinstance(points, str) and points == "nodes"
        if not at_nodes and (isinstance(points, str) or points not in range(1, 11)):
            raise InvalidValue(
                "contact points per direction must be 1 to 10, or 'nodes'", where=f"contact {name}", value=points
            )
        if not isinstance(tool, Surface):
            raise InvalidValue(
                "a tool must be a surface",
                where=f"contact {name}",
                value=type(tool).__name__,
                remedy="a tool of umform.surfaces, VDie or Cylinder for instance, or UserSurface(function)",
            )
        self.name = name
        self.tool = tool
        self.penalty = float(penalty)
        self.points: int | str = "nodes" if at_nodes else int(points)
        self.facets: Ids = mesh.facets(faces)
        #: Nodes of all cells that bear a facet, those of the far face too.
        self.nodes: Ids = np.unique(mesh.connectivity[mesh.face_set(faces)[:, 0]])
        self._kernel = tool.kernel()
        self.block = _core.contact_block(
            self.facets, mesh.points, 1 if at_nodes else int(points), at_nodes, self._kernel
        )
        self.block.penalty = self.penalty
        self.pose: tuple[Floats, Floats] = (np.eye(3), np.zeros(3))
        self.translations: list[ToolMotion] = []
        self.motion: Motion | None = None
        self.reference_point = np.zeros(3)

    def place(self, time: float) -> None:
        """Put the tool where its motions have it at ``time``. eq. (4.18)"""
        shift, rotation = np.zeros(3), np.eye(3)
        for control in self.translations:
            shift += control.value * np.asarray(control.direction)
        if self.motion is not None:
            answer = self.motion(time)
            translation, turn = answer if isinstance(answer, tuple) and len(answer) == 2 else (answer, np.zeros(3))
            where = f"motion of contact {self.name} at time {time:g}"
            shift += vector3(translation, where)
            rotation = Rotation.from_rotvec(vector3(turn, where)).as_matrix()
        centre = self.reference_point
        self.pose = np.ascontiguousarray(rotation), centre + shift - rotation @ centre
        self.block.set_pose(*self.pose)

    def active(self) -> NDArray[np.bool_]:
        """Which points penetrate, of the last evaluation."""
        return self.block.gaps <= 0.0

    def at_points(self) -> ContactPoints:
        """Gap, pressure and the rest at the contact points, of the last evaluation."""
        gap = self.block.gaps
        return ContactPoints(
            x=self.block.positions,
            gap=gap,
            pressure=self.penalty * np.maximum(-gap, 0.0),
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

    def at_nodes(self, u: Floats, mesh: Mesh) -> tuple[Floats, Floats]:
        """Pressure and gap at the nodes of the facets; zero and NaN at other nodes; two arrays of shape (nodes,).

        The pressure is the average of that at the contact points, weighted by N_a and their areas; the gap is measured
        at the nodes themselves.
        """
        at = self.at_points()
        N = self.block.shape_values
        weight = N[None, :, :] * at.area.reshape(len(self.facets), -1, 1)  # [facet][point][node]
        share = np.einsum("eqa,eq->ea", weight, at.pressure.reshape(len(self.facets), -1))
        count = len(mesh.points)
        total, area = np.zeros(count), np.zeros(count)
        np.add.at(total, self.facets.ravel(), share.ravel())
        np.add.at(area, self.facets.ravel(), weight.sum(axis=1).ravel())
        pressure = np.divide(total, area, out=np.zeros(count), where=area > 0)
        gap = np.full(count, np.nan)
        nodes = np.unique(self.facets)
        gap[nodes] = self.gap((mesh.points + u.reshape(-1, 3))[nodes])
        return pressure, gap

    def gap(self, x: Floats) -> Floats:
        """Signed distance of positions (n, 3) to the tool where it stands now; shape (n,)."""
        rotation, shift = self.pose
        return self._kernel.gap(np.ascontiguousarray((x - shift) @ rotation))[0]
