"""The points of a contact pair: facets of the sheet against the surface of a tool."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, partial
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.history_variables import history_of, named
from umform.mesh import Ids, Mesh, Selector
from umform.mesh.numbers import unique
from umform.model.contact.found import ContactFound
from umform.model.contact.friction import friction_kernel
from umform.model.contact.own_law import AnyContactLaw
from umform.model.contact.penalised import Penalised
from umform.model.contact.settings import ContactSettings
from umform.model.terms.control import Twins
from umform.model.terms.cut import Cut
from umform.model.terms.term import Tree
from umform.model.tools.tool import Pose, Tool

Floats = NDArray[np.float64]


class PairPoints(Penalised[ContactFound]):
    """Facets, their points in the kernel, and their geometry; see :class:`umform.model.contact.Contact`."""

    fixed: ClassVar[tuple[str, ...]] = ("tool", "name")

    _settings: ContactSettings

    def __init__(self, mesh: Mesh, faces: Selector, tool: Tool, settings: ContactSettings, name: str) -> None:
        super().__init__(settings, name)
        self.tool = tool
        #: Work of growing penalties and of multipliers; a sum over the facets here. eqs. (4.201), (4.240)
        self.stiffening_work = 0.0
        #: Work of points that touched or left in the last increment, beyond the mean of both ends. eq. (5.104)
        self.work_of_touch = 0.0
        self._meet(mesh, mesh.face_set(faces))

    def _meet(self, mesh: Mesh, faces: Ids) -> None:
        #: Rows (cell, number of the face), and the nodes of these facets.
        self.faces: Ids = faces
        self.facets: Ids = mesh.facets_of(faces)
        #: Nodes of all cells with such a facet, including the opposite face.
        self.nodes: Ids = unique(mesh.connectivity[faces[:, 0]])
        self._mesh_points = mesh.points

    # Settings ------------------------------------------------------------------------------------------------

    @property
    def points(self) -> int | str:
        """Gauss points (or cells) per direction and facet, or "nodes"; fixed when the pair is made."""
        return self._settings.points

    @points.setter
    def points(self, value: object) -> None:
        self.refuse("points", value)

    @property
    def rule(self) -> tuple[int, int]:
        """Gauss points (or cells) along and across a facet; they differ in plane strain only. (1, 1) at nodes."""
        along = 1 if isinstance(self.points, str) else self.points
        return along, min(along, self._settings.width_points or along)

    @property
    def cells(self) -> int | None:
        """Cells per direction and facet over which the pressure is integrated; None for points."""
        return self._settings.cells

    @property
    def ripple(self) -> float | None:
        """Expected relative ripple of the force with cells; None for points. eq. (4.121)"""
        return self._settings.ripple

    @property
    def allowed(self) -> float | None:
        """Allowed penetration; None if only a penalty was given, infinite if any is allowed."""
        return self._settings.allowed

    @allowed.setter
    def allowed(self, value: float | None) -> None:
        self._settings = replace(self._settings, allowed=value)

    @property
    def has_potential(self) -> bool:
        """Whether its energy follows from the pressures."""
        return self.cells is None

    @property
    def keeps_points(self) -> bool:
        """Whether a first evaluation holds open points: no cells, and the travel of the tool is given. eq. (4.230)"""
        return self.cells is None and not self.tool.unknowns and not self.tool.open

    def use_penalty(self, value: float) -> None:
        """Evaluate with this penalty from now on."""
        super().use_penalty(value)
        if "block" in vars(self):
            self.block.penalty = value

    @cached_property
    def block(self) -> _core.ContactBlock:
        """The contact points, built on demand.

        Raises
        ------
        ModelError
            If the model was solved on many ranks, which hold the points of their facets.
        """
        self._refuse_elsewhere()
        block = self._new_block()
        block.name, block.open = f"contact {self.name}", self.tool.open
        if self.has_friction:
            block.set_pose(*self.pose)
            block.locate(self.tool.now.u)
            block.begin()
        return block

    def _new_block(self) -> _core.ContactBlock:
        where, tool, law = (self.facets, self._mesh_points), self.tool.kernel, self._law()
        if self.cells is not None:
            return _core.contact_cells(*where, self.cells, tool, law)
        if isinstance(self.points, str):
            return _core.contact_block(*where, (1, 1), True, tool, law)
        along, across = self.rule
        lower = len(self.faces) > 0 and self.faces[0, 1] == 0  # whose r runs across: it is seen from below
        return _core.contact_block(*where, (across, along) if lower else (along, across), False, tool, law)

    def _law(self) -> _core.ContactLaw:
        normal = None if self.law is None else self.law.called(f"contact {self.name}, {self.law.name}").kernel()
        if self.friction is None:
            return _core.penalty_law(self.penalty) if normal is None else _core.own_law(self.penalty, normal)
        # Multipliers remove the elastic slip, so the stiffness need not follow the pressure. eq. (4.174)
        slip = np.inf if self.augmented else self.slip
        ratio, friction = self._settings.ratio, friction_kernel(self.friction, f"contact {self.name}")
        if normal is not None:
            return _core.own_coulomb_law(self.penalty, ratio, slip, friction, normal)
        return _core.coulomb_law(self.penalty, ratio, slip, friction)

    @property
    def law(self) -> AnyContactLaw | None:
        """Contact law of the user; None where the pressure follows from the penalty."""
        return self._settings.law

    @property
    def slip(self) -> float:
        """Allowed elastic slip; zero without friction."""
        return self._settings.slip

    @property
    def symmetric(self) -> bool:  # type: ignore[override]
        """Whether the tangents of its law and its rule are symmetric."""
        return not self.has_friction and self.cells is None

    @property
    def remembers(self) -> bool:
        """Whether an evaluation writes history other than multipliers."""
        return self.has_friction or self.cells is not None

    @property
    def multipliers(self) -> Floats:
        """Multipliers of the converged state at the contact points; zero without augmentation."""
        return history_of(self.block)["multiplier"].ravel()

    def forget_multipliers(self) -> None:
        """Remove pressures of points without penetration."""
        state = self.block.state
        named(state, self.block.history_variables)["multiplier"][:] = 0.0
        self.block.restore(state)

    # Geometry ------------------------------------------------------------------------------------------------------

    @property
    def pose(self) -> Pose:
        """Present pose of its tool: rotation and shift."""
        return self.tool.pose_now

    def gap(self, x: Floats, pose: Pose | None = None) -> Floats:
        """Signed distance of positions (n, 3) to the tool, in its present or a given pose; shape (n,)."""
        rotation, shift = self.pose if pose is None else pose
        return self.tool.kernel.gap(np.ascontiguousarray((x - shift) @ rotation))[0]

    @property
    def has_begun(self) -> bool:
        """Whether its points have a history, of this run or of a stage before."""
        return "block" in vars(self) and self.block.begun

    def gap_now(self, u: Floats) -> Floats:
        """Signed distances of the contact points to the tool in its present pose, shape (n,)."""
        return self._measured(u, self.pose)[1]

    def _found(self, scale: float, u: Floats, pose: Pose) -> ContactFound:
        """Copy of the kernel's results at held points; the rest is computed on demand."""
        block = self.block
        held = block.found()
        acts = self.augmented and not self.tool.open  # an open tool has no energy
        multiplier = block.multipliers if acts else self._no_multipliers
        measure = partial(self._measured, u, pose)
        return ContactFound(
            scale,
            held.round_off_squared,
            held=held,
            measure=measure,
            place=partial(self._places, u, pose),
            rotation=pose[0],
            area=self._areas,
            multiplier=multiplier,
            penalty=self.penalty,
            has_friction=self.has_friction,
            has_potential=self.has_potential,
            own=None if self.law is None else self._own_energy,
        )

    def _own_energy(self, gap: Floats) -> Floats:
        """Energy per area of a law of the user at gaps (n,); ``penalty`` over its measure scales it. eq. (4.281)"""
        assert self.law is not None
        return self.law.kernel().energies(gap) * (self.penalty / self.initial_penalty)

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

    def _places(self, u: Floats, pose: Pose, points: NDArray[np.int64]) -> Floats:
        """Positions of some points at a displacement in the frame of a tool with a pose."""
        facets, q = np.divmod(points, self.block.per_facet)
        nodes, N = self.facets[facets], self.block.shape_values[0, q]
        x = (N[:, None] @ (self._mesh_points[nodes] + u.reshape(-1, 3)[nodes]))[:, 0]
        rotation, shift = pose
        in_tool: Floats = (x - shift) @ rotation
        return in_tool

    def locate(self, u: Floats, pose: Pose) -> ContactFound:
        """Results at a displacement, with the tool in a pose; without force and tangent."""
        self.block.set_pose(*pose)
        self.block.locate(u)
        return self._found(0.0, u, pose)

    def _spread(self, forces: Floats, change: Floats) -> None:
        """Add forces (points, 3) at the contact points to their nodes. eq. (4.9)"""
        N = self.block.shape_values
        nodal = np.swapaxes(N, 1, 2) @ forces.reshape(len(self.facets), self.block.per_facet, 3)
        np.add.at(change.reshape(-1, 3), self.facets, nodal)

    # Ranks ---------------------------------------------------------------------------------------------------

    def strip(self, bare: Self, twins: Twins) -> None:
        """Without faces and points, for the twin of its tool."""
        for made in ("block", "_areas", "_no_multipliers", "faces", "facets", "nodes", "_mesh_points", "_last"):
            bare.__dict__.pop(made, None)
        bare.__dict__["tool"] = twins.of(self.tool)
        bare.before = np.empty(0)

    def piece(self, cut: Cut) -> tuple[Ids, NDArray[np.int64], Tree | None]:
        """Faces of the rank, their rows in this contact, and their history if any."""
        faces, rows = cut.faces_of(self.faces)
        history = {name: values[rows] for name, values in self.state().items()} if self.has_begun else None
        return faces, rows, history

    def fill(self, piece: tuple[Ids, NDArray[np.int64], Tree | None], mesh: Any) -> None:
        """Set faces and history."""
        faces, self.rows, history = piece
        self._last = None
        self._meet(mesh, faces)
        if history is not None:
            self.restore(history)
