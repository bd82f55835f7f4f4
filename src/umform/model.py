"""The model: mesh, element, material, supports, loads, contact; residual and tangent at a displacement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core, boundary
from umform.boundary import DIRECTIONS, Control, Load, Prescribed, Pressure
from umform.contact import Contact, Motion, ToolMotion
from umform.elements import Element
from umform.elements import element as catalogue_element
from umform.elements import thickness_rule as make_thickness_rule
from umform.errors import InvalidValue, WrongCellType
from umform.materials import Material
from umform.mesh import Ids, Mesh, Selector
from umform.model_checks import check_model
from umform.solvers import Pattern
from umform.surfaces import Direction, Surface, unit_vector

Floats = NDArray[np.float64]
#: Columns of every history.
_COLUMNS = ("step", "time", "iterations")
_C = TypeVar("_C", bound=Control)


@dataclass(frozen=True)
class Evaluation:
    """Residual and tangent at a displacement.

    Attributes
    ----------
    residual : ndarray, shape (3 n,)
        Internal and contact forces minus loads at all degrees of freedom; reactions at the prescribed ones.
    values : ndarray
        Entries of the tangent over the free degrees of freedom, in the order of :attr:`Model.pattern`.
    predictor : ndarray, shape (3 n,)
        Tangent times the increment of the prescribed degrees of freedom (zero without one).
    force_scale : float
        Root of the sum of squares of all element forces, the scale of a residual. eq. (5.8)
    failed : int
        First cell whose strain left the domain of its law, or -1.
    """

    residual: Floats
    values: Floats
    predictor: Floats
    force_scale: float
    failed: int


@dataclass(frozen=True)
class Snapshot:
    """A converged state that a model can be put back to."""

    u: Floats
    state: Floats
    alpha: Floats
    controls: tuple[float, ...]
    time: float


class Model:
    """Solid-shells with supports, loads and rigid tools.

    Parameters
    ----------
    mesh : Mesh
        Points and cells.
    element : str or Element
        Name in the catalogue (:data:`umform.elements.CATALOGUE`) or an element of your own.
    material : Material
        SVK, NeoHooke, NeoHookePower or J2.
    thickness_points : int, optional
        Points through the thickness, 2 to 15; default 2 (elastic) or 5 (plastic), at least thickness_order + 1.
    thickness_rule : {"gauss", "lobatto", "split"}
        Where they lie.
    **options
        Options of the element: thickness_modes, thickness_order, order_modes, membrane_modes, tie_E33,
        compatible_E12.

    Raises
    ------
    WrongCellType
        If the element does not stand on the cells of the mesh.
    InvalidValue
        If an option does not fit.
    """

    def __init__(
        self,
        mesh: Mesh,
        element: str | Element = "ANS3DEAS",
        *,
        material: Material,
        thickness_points: int | None = None,
        thickness_rule: str = "gauss",
        **options: int | bool | None,
    ) -> None:
        self.mesh = mesh
        self.element = catalogue_element(element, **options)  # type: ignore[arg-type]
        if self.element.cell != mesh.cell:
            raise WrongCellType(
                f"{self.element.name} stands on {self.element.cell} cells, the mesh has {mesh.cell}",
                remedy=f"make the mesh with cell={self.element.cell!r}, or take an element for {mesh.cell}",
            )
        if not isinstance(material, Material) or isinstance(material, type):
            raise InvalidValue(
                "material must be a material law",
                value=type(material).__name__,
                remedy="SVK, NeoHooke, NeoHookePower or J2",
            )
        self.material = material
        least = self.element.thickness_order + 1
        self.thickness_points = (
            thickness_points if thickness_points is not None else max(material.thickness_points, least)
        )
        self.thickness_rule = thickness_rule
        if self.thickness_points < least:
            raise InvalidValue(
                f"thickness order {least - 1} needs at least {least} thickness points",
                value=self.thickness_points,
                cause="fewer points cannot see the highest mode",
                remedy=f"thickness_points={least} or more",
            )
        t, w = make_thickness_rule(self.thickness_points, thickness_rule)
        self.element.check_modes(t)
        self.block = _core.shell_block(
            self.element.technology(), self.element.surface_points, t, w, material.law(), mesh.connectivity, mesh.points
        )
        size = 3 * len(mesh.points)
        self.u: Floats = np.zeros(size)
        self.time = 0.0
        self.controls: list[Control] = []
        self.contacts: list[Contact] = []
        self._fixed = np.zeros(size, dtype=bool)
        self._assembled: _Assembly | None = None

    # Supports ------------------------------------------------------------------------------------------------

    def fix(self, nodes: Selector, directions: str = "xyz") -> None:
        """Hold nodes in one or more of the directions x, y, z.

        Parameters
        ----------
        nodes : str, callable or array_like
            Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.
        directions : str
            Letters of the directions, "xz" for instance.

        Raises
        ------
        InvalidValue
            If a direction is unknown, or a displacement is prescribed already.
        """
        ids = self.mesh.nodes(nodes)
        for direction in directions:
            dofs = 3 * ids + self._direction(direction)
            self._refuse_twice(dofs, direction, {c.name: c.dofs for c in self._of(Prescribed)}, "fix or symmetry")
            self._fixed[dofs] = True
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
            If a displacement is prescribed already.
        """
        dofs = (3 * self.mesh.nodes(nodes) + self._direction(direction)).astype(np.int32)
        taken = {c.name: c.dofs for c in self._of(Prescribed)}
        taken["fix or symmetry"] = np.flatnonzero(self._fixed).astype(np.int32)
        self._refuse_twice(dofs, direction, taken, name or "this one")
        return self._add(Prescribed(name or self._name("displacement"), dofs=dofs))

    @staticmethod
    def _refuse_twice(dofs: Ids, direction: str, taken: Mapping[str, Ids], by: str) -> None:
        for other, theirs in taken.items():
            shared = np.intersect1d(dofs, theirs)
            if len(shared):
                raise InvalidValue(
                    "a displacement is prescribed twice",
                    where=f"node {shared[0] // 3}, direction {direction}",
                    value=f"by {other} and by {by}",
                    remedy="take the node out of one of the sets",
                )

    # Loads ---------------------------------------------------------------------------------------------------

    def force(self, nodes: Selector, force: ArrayLike, name: str = "") -> Load:
        """The same dead force on each node of a set.

        Parameters
        ----------
        nodes : str, callable or array_like
            Name of a set, predicate of x, y, z, node ids or a mask, see :meth:`umform.Mesh.nodes`.
        force : array_like, shape (3,)
            Force on each node for the value 1 of the control.
        name : str, optional
            Column of the history.

        Returns
        -------
        Load
            The control whose value steps move.
        """
        return self._load(boundary.nodal_forces(self.mesh, nodes, force), name or self._name("force"))

    def traction(self, faces: Selector, traction: ArrayLike, name: str = "") -> Load:
        """Dead traction on faces of the cells, lateral ones too.

        Parameters
        ----------
        faces : str, callable or array_like
            Name of a set, predicate of x, y, z, or rows (cell, face), see :meth:`umform.Mesh.face_set`.
        traction : array_like, shape (3,)
            Force per reference area for the value 1 of the control.
        name : str, optional
            Column of the history.

        Returns
        -------
        Load
            The control whose value steps move.
        """
        return self._load(boundary.traction_forces(self.mesh, faces, traction), name or self._name("traction"))

    def line_load(self, faces: Selector, side: str, load: ArrayLike, name: str = "") -> Load:
        """Dead load on the lower or upper edge of lateral faces.

        Parameters
        ----------
        faces : str, callable or array_like
            Name of a set, predicate of x, y, z, or rows (cell, face), see :meth:`umform.Mesh.face_set`.
        side : {"lower", "upper"}
            Which edge of the faces.
        load : array_like, shape (3,)
            Force per reference length for the value 1 of the control.
        name : str, optional
            Column of the history.

        Returns
        -------
        Load
            The control whose value steps move.
        """
        return self._load(boundary.edge_forces(self.mesh, faces, side, load), name or self._name("line_load"))

    def body_force(self, force: ArrayLike, name: str = "") -> Load:
        """Dead force in the volume.

        Parameters
        ----------
        force : array_like, shape (3,)
            Force per reference volume for the value 1 of the control.
        name : str, optional
            Column of the history.

        Returns
        -------
        Load
            The control whose value steps move.
        """
        return self._load(boundary.body_forces(self.mesh, force), name or self._name("body_force"))

    def pressure(self, faces: Selector, name: str = "") -> Pressure:
        """Follower pressure on lower or upper faces, against their outward normal; the tangent becomes unsymmetric.

        Parameters
        ----------
        faces : str, callable or array_like
            Name of a set, predicate of x, y, z, or rows (cell, face), see :meth:`umform.Mesh.face_set`.
        name : str, optional
            Column of the history.

        Returns
        -------
        Pressure
            The control whose value (force per current area) steps move.
        """
        block = _core.pressure_block(self.mesh.facets(faces), self.mesh.points)
        return self._add(Pressure(name or self._name("pressure"), block=block))

    # Contact -------------------------------------------------------------------------------------------------

    def contact(
        self, faces: Selector, tool: Surface, *, penalty: float, points: int | str = 2, name: str = ""
    ) -> Contact:
        """Let faces touch a rigid tool.

        Parameters
        ----------
        faces : Selector
            Lower or upper faces.
        tool : Surface
            Plane, Cylinder, Sphere or UserSurface.
        penalty : float
            Pressure per penetration.
        points : int or "nodes"
            Gauss points per direction and facet, 1 to 10, or the nodes with their tributary areas. Take at least 2 on
            4-node and 3 on 9-node facets.
        name : str, optional
            For the history: the columns ``<name>_fx`` ... are the force on the tool.
        """
        contact = Contact(self.mesh, faces, tool, penalty, points, name or f"tool{len(self.contacts) + 1}")
        if any(other.name == contact.name for other in self.contacts):
            raise InvalidValue("two contacts have the same name", value=contact.name)
        self.contacts.append(contact)
        self._assembled = None
        return contact

    def drive(self, contact: Contact, direction: Direction, name: str = "") -> ToolMotion:
        """Let steps move a tool along a direction.

        Parameters
        ----------
        contact : Contact
            The pair whose tool moves.
        direction : str or array_like, shape (3,)
            "z", "-x", ... or a vector.
        name : str, optional
            Column of the history.

        Returns
        -------
        ToolMotion
            The control whose value (a length) steps move; its force is that of the sheet on the tool along it.
        """
        control = ToolMotion(name or self._name(contact.name), direction=unit_vector(direction, "drive"))
        contact.translations.append(control)
        return self._add(control)

    def set_motion(self, contact: Contact, motion: Motion, about: ArrayLike = (0.0, 0.0, 0.0)) -> None:
        """Give a tool a motion in time, in addition to what steps do to it.

        Parameters
        ----------
        contact : Contact
            The pair whose tool moves.
        motion : callable
            time -> translation (3,), or (translation (3,), rotation vector (3,)).
        about : array_like, shape (3,)
            Point of the tool that the rotation is about.
        """
        contact.motion = motion
        contact.reference_point = boundary.vector3(about, "about")

    # Evaluation ----------------------------------------------------------------------------------------------

    @property
    def pattern(self) -> Pattern:
        """Sparse pattern of the tangent over the free degrees of freedom."""
        return self._assembly().pattern

    @property
    def free(self) -> NDArray[np.int64]:
        """Degrees of freedom (3 * node + direction) that are not prescribed."""
        return self._assembly().free

    def prescribed_displacement(self) -> Floats:
        """Displacements of the prescribed degrees of freedom at the present values of the controls; zero elsewhere."""
        u = np.zeros_like(self.u)
        for control in self._of(Prescribed):
            u[control.dofs] = control.value
        return u

    def evaluate(self, u: Floats, du: Floats | None = None) -> Evaluation:
        """Residual and tangent at ``u``, at the present values of controls and time; changes no converged history.

        Parameters
        ----------
        u : ndarray, shape (3 n,)
            Displacement.
        du : ndarray, shape (3 n,), optional
            Increment of the prescribed degrees of freedom, for the predictor.
        """
        assembly = self._assembly()
        f, values = np.zeros(u.size), np.zeros(assembly.pattern.indices.size)
        Kdu = np.zeros(u.size)
        target = (f, values, du, None if du is None else Kdu)
        failed, scale = self.block.evaluate(u, assembly.scatter, *target)
        for contact, scatter in zip(self.contacts, assembly.contact_scatter, strict=True):
            contact.place(self.time)
            scale += contact.block.evaluate(u, scatter, *target)[1]
        for control, scatter in zip(self._of(Pressure), assembly.pressure_scatter, strict=True):
            assert control.block is not None
            control.block.pressure = control.value
            scale += control.block.evaluate(u, scatter, *target)[1]
        for load in self._of(Load):
            if load.value != 0.0:
                f -= load.value * load.vector
                scale += load.value**2 * float(load.vector @ load.vector)
        return Evaluation(f, values, Kdu, float(np.sqrt(scale)), failed)

    def recover(self, du: Floats, s: float) -> None:
        """Update the enhanced parameters after ``u += s du``. eq. (2.19)"""
        self.block.recover(du, s)

    def undo_recover(self) -> None:
        """Take the last :meth:`recover` back."""
        self.block.undo_recover()

    def active_set(self) -> NDArray[np.bool_]:
        """Which contact points penetrate, over all contacts, of the last evaluation."""
        if not self.contacts:
            return np.zeros(0, dtype=bool)
        return np.concatenate([contact.active() for contact in self.contacts])

    def commit(self, u: Floats) -> None:
        """Make ``u`` and the trial history of the last evaluation the converged state."""
        self.block.commit()
        self.u = u.copy()

    def revert(self) -> None:
        """Forget everything since the last commit."""
        self.block.revert()

    def snapshot(self) -> Snapshot:
        """Copy of the converged state and of the controls."""
        return Snapshot(
            self.u.copy(), self.block.state, self.block.alpha, tuple(c.value for c in self.controls), self.time
        )

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot."""
        self.block.restore(snapshot.state, snapshot.alpha)
        self.u = snapshot.u.copy()
        self.time = snapshot.time
        for control, value in zip(self.controls, snapshot.controls, strict=True):
            control.value = value

    def conjugate_force(self, control: Control, residual: Floats) -> float:
        """Force that belongs to a control: sum of reactions, force on a tool along its motion, or the load itself."""
        if isinstance(control, Prescribed):
            return float(residual[control.dofs].sum())
        if isinstance(control, ToolMotion):
            owner = next(contact for contact in self.contacts if control in contact.translations)
            return float(owner.resultant()[0] @ np.asarray(control.direction))
        return control.value

    def check(self) -> None:
        """Refuse what cannot be solved before time is spent on it, see :func:`umform.model_checks.check_model`."""
        check_model(self)

    # Inside --------------------------------------------------------------------------------------------------

    def _assembly(self) -> _Assembly:
        if self._assembled is None:
            self._assembled = _Assembly(self)
        return self._assembled

    def constrained(self) -> NDArray[np.bool_]:
        """Which degrees of freedom are held or prescribed."""
        constrained = self._fixed.copy()
        for control in self._of(Prescribed):
            constrained[control.dofs] = True
        return constrained

    def _of(self, kind: type[_C]) -> list[_C]:
        return [control for control in self.controls if isinstance(control, kind)]

    def _add(self, control: _C) -> _C:
        if any(other.name == control.name for other in self.controls) or control.name in _COLUMNS:
            raise InvalidValue("the name of a control is taken", value=control.name, remedy="give it another name")
        self.controls.append(control)
        self._assembled = None
        return control

    def _load(self, vector: Floats, name: str) -> Load:
        return self._add(Load(name, vector=vector))

    def _name(self, base: str) -> str:
        taken = {control.name for control in self.controls}
        return base if base not in taken else next(f"{base}{k}" for k in range(2, 10**6) if f"{base}{k}" not in taken)

    @staticmethod
    def _direction(name: str) -> int:
        if name not in DIRECTIONS:
            raise InvalidValue("a direction is x, y or z", value=name)
        return DIRECTIONS[name]


class _Assembly:
    """Pattern and scatter maps, made once for a set of supports, contacts and pressures."""

    def __init__(self, model: Model) -> None:
        constrained = model.constrained()
        self.free = np.flatnonzero(~constrained)
        if len(self.free) == 0:
            raise InvalidValue("all degrees of freedom are prescribed", remedy="leave some nodes free")
        equation = np.full(constrained.size, -1, dtype=np.int32)
        equation[self.free] = np.arange(len(self.free))
        pressures = [c.block for c in model._of(Pressure) if c.block is not None]
        pattern = _core.Pattern(equation, [model.block.connectivity], symmetric=not pressures)
        self.scatter = pattern.scatter(model.block.connectivity)
        self.contact_scatter = [pattern.scatter(contact.block.connectivity) for contact in model.contacts]
        self.pressure_scatter = [pattern.scatter(block.connectivity) for block in pressures]
        self.pattern = Pattern(len(self.free), pattern.indptr.astype(np.int32), pattern.indices, pattern.symmetric)
