"""The model: mesh, element, material, supports, loads, contact; residual and tangent at a displacement."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from umform import _core
from umform.elements import Element, rolling_directions
from umform.elements import element as catalogue_element
from umform.elements import thickness_rule as make_thickness_rule
from umform.errors import InvalidValue, WrongCellType
from umform.materials import Material
from umform.mesh import Mesh
from umform.model.assembly import Assembly, Evaluation, Snapshot
from umform.model.boundary import Control, Load, Prescribed, Pressure
from umform.model.checks import check_model
from umform.model.contact import ToolMotion
from umform.model.contact.touched import Touched
from umform.model.loads import Loaded
from umform.model.supports import Supported
from umform.model.ties import MidLine
from umform.model.whole import Whole, not_here
from umform.ranks import ONE, Ranks
from umform.solvers import Pattern
from umform.timing import Timing

__all__ = ["Evaluation", "Model", "Snapshot"]

Floats = NDArray[np.float64]


class Model(Supported, Loaded, Touched, Whole):
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
        Points through the thickness, 2 to 15, at least thickness_order + 1. Default: 2 with an elastic law; 5 with a
        plastic one, but 12 with BEND8 and BEND18.
    thickness_rule : {"gauss", "lobatto", "split"}, optional
        Where they lie; default gauss, but split where the default of the points is 12.
    rolling : array_like, shape (3,) or (cells, 3), optional
        Rolling direction of the sheet: e_1 of the local axes is its projection onto the layer, eq. (1.26). By default
        e_1 lies along G_1 and follows the numbering of the mesh, which an isotropic law does not see.
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

    #: Who shares the model.
    ranks: Ranks = ONE

    def __init__(
        self,
        mesh: Mesh,
        element: str | Element = "ANS3DEAS",
        *,
        material: Material,
        thickness_points: int | None = None,
        thickness_rule: str | None = None,
        rolling: ArrayLike | None = None,
        **options: int | bool | None,
    ) -> None:
        super().__init__(mesh)
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
        self.rolling = rolling_directions(rolling, len(mesh.connectivity))
        least = self.element.thickness_order + 1
        self.thickness_points, self.thickness_rule = self._through_thickness(thickness_points, thickness_rule)
        if self.thickness_points < least:
            raise InvalidValue(
                f"thickness order {least - 1} needs at least {least} thickness points",
                value=self.thickness_points,
                cause="fewer points cannot see the highest mode",
                remedy=f"thickness_points={least} or more",
            )
        self._through = make_thickness_rule(self.thickness_points, self.thickness_rule)
        self.element.check_modes(self._through[0])
        self.u: Floats = np.zeros(3 * len(mesh.points))
        self.time = 0.0
        #: Where the time goes; :func:`umform.solve` puts a new one here.
        self.timing = Timing()

    def _through_thickness(self, points: int | None, rule: str | None) -> tuple[int, str]:
        """Points through the thickness and their rule: what is given, else what law and element want."""
        plastic = self.material.thickness_points > 2
        wanted, wanted_rule = self.element.plastic_points if plastic else (2, "gauss")
        if points is not None:
            return points, rule or "gauss"
        return max(wanted, self.material.thickness_points, self.element.thickness_order + 1), rule or wanted_rule

    @cached_property
    def block(self) -> _core.ShellBlock:
        """All elements with their history: large, so made when first asked for.

        Raises
        ------
        ModelError
            If the model was solved on many ranks: they have its history.
        InvalidValue
            If the rolling direction stands on the sheet somewhere.
        """
        if self.elsewhere:
            raise not_here("the history of the elements")
        mesh, (t, w) = self.mesh, self._through
        technology, law = self.element.technology(), self.material.law()
        points, cells = self.element.surface_points, mesh.connectivity
        try:
            return _core.shell_block(technology, points, t, w, law, cells, mesh.points, self.rolling)
        except ValueError as error:
            if self.rolling is None:
                raise
            raise InvalidValue(str(error), remedy="a vector in the plane of the sheet, or one for each cell") from error

    # Evaluation ----------------------------------------------------------------------------------------------

    @property
    def pattern(self) -> Pattern:
        """Sparse pattern of the tangent over the unknowns."""
        return self._assembly().pattern

    @property
    def effort(self) -> float:
        """What an evaluation costs for each equation; 1 for 8-node elements with 20 points.

        Each point adds to all entries of an element's matrix; in a regular mesh of one layer an element of 8 nodes has
        one fibre of its own, one of 18 nodes has four.
        """
        nodes = self.mesh.connectivity.shape[1]
        fibres = 1 if nodes == 8 else 4
        size = nodes / 8
        return float(self.block.points / 20 * size * size / fibres)

    @cached_property
    def extent(self) -> float:
        """Largest extent of the undeformed body along an axis."""
        return self.ranks.max(float(np.ptp(self.mesh.points, axis=0).max()))

    @property
    def free(self) -> NDArray[np.int64]:
        """Degrees of freedom (3 * node + direction) without a reaction: neither held nor prescribed nor tied."""
        return self._assembly().unknowns.free

    def restrict(self, r: Floats) -> Floats:
        """Unknowns' share of a vector at all degrees of freedom, shape (3 n,). eq. (5.18)"""
        return self._assembly().unknowns.restrict(r)

    def coefficients(self, u: Floats) -> Floats:
        """Unknowns in a displacement of all degrees of freedom, shape (3 n,). eq. (5.18)"""
        return self._assembly().unknowns.restrict(u)

    def largest_entry(self, values: Floats) -> float:
        """Size of the largest entry of the tangent."""
        return max(float(values.max(initial=0.0)), -float(values.min(initial=0.0)))  # no copy of the matrix

    def extend(self, x: Floats) -> Floats:
        """Displacement of all degrees of freedom, shape (3 n,), that the unknowns make. eq. (5.17)"""
        return self._assembly().unknowns.extend(x)

    def evaluate(
        self,
        u: Floats,
        du: Floats | None = None,
        rates: Mapping[Control, float] | None = None,
        until: float | None = None,
    ) -> Evaluation:
        """Residual and tangent at ``u``, at the present values of controls and time; changes no converged history.

        Parameters
        ----------
        u : ndarray, shape (3 n,)
            Displacement.
        du : ndarray, shape (3 n,), optional
            Increment of the prescribed degrees of freedom, for the predictor. eq. (5.6)
        rates : mapping of Control to float, optional
            Rates of the controls instead of ``du``: the predictor is the rate of the residual while the unknowns are
            held. eq. (5.21)
        until : float, optional
            With ``rates``, that are then changes: the time at which tools that move by a function of time arrive, whose
            way counts too. eq. (4.37)
        """
        assembly = self._assembly()
        f, values, Kdu = np.zeros(u.size), np.zeros(assembly.entries), np.zeros(u.size)
        rates = rates or {}
        if rates or until is not None:
            du = self.displacement_of_supports(rates)
        product = None if du is None else Kdu
        with self.timing.elements:
            failed, scale, failure = self.block.evaluate(u, assembly.scatter, f, values, du, product)
        round_off = 0.0
        for contact, scatter in zip(self.contacts, assembly.contact_scatter, strict=True):
            with self.timing.contact:
                contact.place(self.time)
                shift = sum(rates.get(c, 0.0) * np.asarray(c.direction) for c in contact.translations)
                relative = None if du is None else (du.reshape(-1, 3) - shift).ravel()
                if relative is not None and until is not None:
                    relative -= contact.carried((self.mesh.points.ravel() + u).reshape(-1, 3), until).ravel()
                scale += contact.block.evaluate(u, scatter, f, values, relative, product)[1]
                round_off += contact.block.round_off_squared
                if until is not None:
                    contact.turn(until, Kdu)
        for control, scatter in zip(self.of_kind(Pressure), assembly.pressure_scatter, strict=True):
            assert control.block is not None
            if rates.get(control, 0.0) != 0.0:
                control.block.pressure = rates[control]
                control.block.evaluate(u, scatter, Kdu, np.zeros_like(values), None, None)
            control.block.pressure = control.value
            with self.timing.contact:
                scale += control.block.evaluate(u, scatter, f, values, du, product)[1]
        for load in self.of_kind(Load):
            if load in rates:
                Kdu -= rates[load] * load.vector
            if load.value != 0.0:
                f -= load.value * load.vector
                scale += load.value**2 * float(load.vector @ load.vector)
        if self.ties:
            with self.timing.ties:
                values = assembly.reduce(values)
        return Evaluation(f, values, Kdu, float(np.sqrt(scale)), failed, float(np.sqrt(round_off)), failure)

    def recover(self, du: Floats, s: float, mixed: bool = False) -> None:
        """Update the enhanced parameters after ``u += s du``. eq. (2.19)

        With ``mixed`` the tangent of the evaluation that follows has the geometric stiffness of the stress that
        ``s du`` foresaw instead of the present one. eq. (5.39)
        """
        with self.timing.recovery:
            self.block.recover(du, s, mixed)

    def undo_recover(self) -> None:
        """Take the last :meth:`recover` back."""
        self.block.undo_recover()

    def active_set(self) -> NDArray[np.bool_]:
        """Which contact points tools hold, over all contacts, of the last evaluation."""
        if not self.contacts:
            return np.zeros(0, dtype=bool)
        return np.concatenate([contact.active() for contact in self.contacts])

    def flowing(self) -> NDArray[np.uint8]:
        """1 for each point of the material whose history the last evaluation has changed, else 0."""
        return self.block.flowing

    def commit(self, u: Floats) -> None:
        """Make ``u`` and the trial history of the last evaluation the converged state."""
        self.block.commit()
        for contact in self.contacts:
            contact.commit()
        self.u = u.copy()

    def revert(self) -> None:
        """Forget everything since the last commit."""
        self.block.revert()
        for contact in self.contacts:
            contact.revert()

    def snapshot(self) -> Snapshot:
        """Copy of the converged state and of the controls."""
        return Snapshot(
            self.u.copy(),
            self.block.state,
            self.block.alpha,
            tuple(c.value for c in self.controls),
            self.time,
            tuple(contact.multipliers for contact in self.contacts),
        )

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot."""
        self.block.restore(snapshot.state, snapshot.alpha)
        for contact, multipliers in zip(self.contacts, snapshot.multipliers, strict=True):
            contact.multipliers = multipliers
            contact.revert()
        self.u = snapshot.u.copy()
        self.time = snapshot.time
        for control, value in zip(self.controls, snapshot.controls, strict=True):
            control.value = value

    def conjugate_force(self, control: Control, residual: Floats) -> float:
        """Force that belongs to a control: sum of reactions, force on a tool along its motion, or the load itself."""
        if isinstance(control, Prescribed | MidLine):
            return self.ranks.sum(float(residual[control.dofs].sum()))
        if isinstance(control, ToolMotion):
            owner = next(contact for contact in self.contacts if control in contact.translations)
            return float(self.ranks.sum(owner.resultant()[0]) @ np.asarray(control.direction))
        return control.value

    def check(self) -> None:
        """Refuse what cannot be solved before time is spent on it, see :func:`umform.model.checks.check_model`."""
        check_model(self)

    # Inside --------------------------------------------------------------------------------------------------

    def _assembly(self) -> Assembly:
        if self._assembled is None:
            with self.timing.analysis:
                self._assembled = Assembly(self)
        return self._assembled
