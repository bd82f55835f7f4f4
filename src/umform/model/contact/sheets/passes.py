"""The half passes of a contact of sheets: their points, penalty and search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.history_variables import columns
from umform.mesh import Ids, Mesh
from umform.mesh.part import sheets_of
from umform.model.contact.face_basis import in_face_basis
from umform.model.contact.friction import friction_kernel
from umform.model.contact.penalised import Penalised
from umform.model.contact.sheets.faces import ARC, cut_edges, depth_of, near_in_the_sheet
from umform.model.contact.sheets.found import SheetsFound, SideFound
from umform.model.contact.sheets.settings import SheetContactSettings, longest_side
from umform.model.terms.term import Term
from umform.ranks import Ranks

Floats = NDArray[np.float64]
Numbers = NDArray[np.integer]

#: Way of the nodes that a search covers, in longest sides of a facet: a larger one couples more nodes, which costs more
#: than searches.
_WAY = 0.25
#: Turn of the facets that a search covers, in radians.
TURN = 0.45


@dataclass(frozen=True)
class Search:
    """Start of a search.

    Attributes
    ----------
    at : ndarray, shape (3 n,)
        Displacement.
    feet : ndarray, shape (points,)
        Facets of the converged feet, which stay.
    """

    at: Floats
    feet: Floats


class SheetPasses(Penalised[SheetsFound]):
    """Facets, their points in the kernels, and the penalty; see :class:`umform.model.contact.sheets.SheetContact`."""

    by_pattern = True
    symmetric = False
    smooth = False
    #: No tool: what loops over all contacts asks for.
    tool = None
    fixed: ClassVar[tuple[str, ...]] = ("name", "sides")
    memory = (
        *Term.memory,
        *("passes", "before", "_at", "_feet", "_couplings", "_declared", "_kept", "_last"),
        *("_penalty", "_standing_penalty", "_nowhere", "_areas", "history_variables", "opposite", "multipliers_stay"),
    )

    _settings: SheetContactSettings

    def __init__(self, mesh: Mesh, sides: Sequence[Ids], settings: SheetContactSettings, name: str) -> None:
        super().__init__(settings, name)
        self.sides = tuple(sides)
        self.facets = tuple(mesh.facets_of(side) for side in sides)
        self._mesh = mesh
        self._size = max(longest_side(mesh, facets) for facets in self.facets)
        self._at: Floats = np.zeros(3 * len(mesh.points))
        self._way = _WAY * self._size
        self._feet = np.empty(0)
        self._couplings: list[_core.Connectivity] | None = None
        #: What the pattern of the matrix was made from, where a restored search has found something else.
        self._declared: list[_core.Connectivity] | None = None
        #: The search of the converged state.
        self._kept: Search | None = None

    @property
    def settings(self) -> SheetContactSettings:
        """Penalty, points, depth."""
        return self._settings

    @property
    def thickness(self) -> float:
        """Thickness of the thinner sheet."""
        return self.settings.thickness

    @cached_property
    def passes(self) -> list[_core.SheetPass]:
        """The half passes: each side against the other one, or a side against itself."""
        near = [
            near_in_the_sheet(self._mesh, self.sides[one], self.sides[other], ARC * self.thickness)
            for one, other in self._pairs
        ]
        return self._made(near, self.settings.deepest)

    @cached_property
    def _edges(self) -> list[tuple[Ids, Ids]]:
        """Cut edges of each side. A solid body has none: its sides are no rims."""
        return [cut_edges(self._mesh, side[:0] if depth_of(self._mesh, side).solid else side) for side in self.sides]

    @property
    def _pairs(self) -> tuple[tuple[int, int], ...]:
        return ((0, len(self.sides) - 1), (1, 0))[: len(self.sides)]

    def _made(self, near: list[list[list[int]]], deepest: float) -> list[_core.SheetPass]:
        settings, friction, made = self.settings, None, []
        if settings.friction is not None:
            friction = friction_kernel(settings.friction)
        highest = settings.deepest
        if settings.over_cells:
            highest = max(highest, self._size / settings.points)
        points, cells = ((1, 1), settings.points) if settings.over_cells else ((settings.points,) * 2, 0)
        for (one, other), of_sheet in zip(self._pairs, near, strict=True):
            edges, at = self._edges[other]
            made.append(
                _core.sheet_pass(
                    self.facets[one], self.facets[other], edges, at.tolist(), self._mesh.points, points, cells,
                    self.penalty, deepest, highest, of_sheet, friction, settings.stiffness,
                )
            )  # fmt: skip
            made[-1].name, made[-1].augmented = f"contact {self.name}", self.augmented
        return made

    def looked(self, u: Floats, deep: float) -> list[dict[str, Any]]:
        """Results of passes with a deeper search, in thicknesses, at a displacement."""
        found = []
        for one in self._made([self._everything_near(pair) for pair in self._pairs], deep * self.thickness):
            one.search(u, 0.0, TURN)
            one.evaluate(u, self._nowhere, np.zeros_like(u), None, None, None)
            found.append(one.found())
        return found

    def through(self, u: tuple[Floats, Floats]) -> tuple[Floats, float] | None:
        """The deepest place where one side goes through the other from a displacement to the next, and how deep.

        Parameters
        ----------
        u : tuple of ndarray, shapes (3 n,)
            Two displacements.
        """
        moved = self.points_at(u[0]), self.points_at(u[1])
        return self.crossed(moved, moved, self.settings.deepest)

    def points_at(self, u: Floats) -> Floats:
        """Positions of all nodes at a displacement; shape (3 n,)."""
        return np.asarray(self._mesh.points.ravel() + u)

    def opposite_at(self, u: Floats) -> Floats:
        """The same, but each node of the faces has the position of the node on the other side of its cell."""
        x, cells = self.points_at(u).reshape(-1, 3), self._mesh.connectivity
        half, opposite = cells.shape[1] // 2, x.copy()
        for cell, face in np.concatenate(self.sides):
            sides = cells[cell, :half], cells[cell, half:]
            opposite[sides[face]] = x[sides[1 - face]]
        return opposite.ravel()

    def nodes_of_sheets(self, side: int) -> Numbers | None:
        """Nodes of the sheets of a side; None if the other one has faces of the same."""
        sheet = sheets_of(self._mesh)
        mine, other = (sheet[self.sides[one][:, 0]] for one in (side, 1 - side))
        if np.intersect1d(mine, other).size:
            return None
        return np.unique(self._mesh.connectivity[np.isin(sheet, mine)])

    def crossed(
        self, x: tuple[Floats, Floats], y: tuple[Floats, Floats], deepest: float
    ) -> tuple[Floats, float] | None:
        """The same for a face with the positions x, shapes (3 n,), of the nodes and one with the positions y."""
        found = [
            _core.sheet_crossings(self.facets[one], x, self.facets[other], y, deepest) for one, other in self._pairs
        ]
        places, depths = (np.concatenate(parts) for parts in zip(*found, strict=True))
        return (places[depths.argmax()], float(depths.max())) if len(depths) else None

    def _everything_near(self, pair: tuple[int, int]) -> list[list[int]]:
        """All faces of one sheet as near: its two faces are its thickness apart."""
        sheet = sheets_of(self._mesh)
        mine, other = (sheet[self.sides[side][:, 0]] for side in pair)
        rows = {int(one): np.flatnonzero(other == one).tolist() for one in np.unique(mine)}
        return [rows[int(one)] for one in mine]

    # History of the points ---------------------------------------------------------------------------------------

    @property
    def faces(self) -> Ids:
        """Rows (cell, face) of one side after the other, in the order of the history."""
        return np.concatenate(self.sides)

    @cached_property
    def history_variables(self) -> dict[str, int]:
        """Parts of the history of a point."""
        return self.passes[0].history_variables

    def _column(self, name: str) -> int:
        """Column of the history with a number; "facet" counts from 1, with 0 for a point that has met none."""
        return int(columns(self.history_variables)[name].start)

    @cached_property
    def opposite(self) -> NDArray[np.int64]:
        """For each face the row of the first face of the other side."""
        starts = np.cumsum([0, *map(len, self.sides)])
        return np.concatenate([np.full(len(self.sides[one]), starts[other]) for one, other in self._pairs])

    # Settings ----------------------------------------------------------------------------------------------------

    @property
    def allowed(self) -> float:
        """Allowed penetration."""
        return self.settings.allowed

    @property
    def points(self) -> int:
        """Gauss points, or cells, per direction and facet."""
        return self.settings.points

    @property
    def cells(self) -> int | None:
        """Cells per direction and facet; None at points."""
        return self.settings.points if self.settings.over_cells else None

    @property
    def rule(self) -> tuple[int, int]:
        """Gauss points, or cells, along and across a facet."""
        return self.points, self.points

    # Penalty -----------------------------------------------------------------------------------------------------

    def use_penalty(self, value: float) -> None:
        """Evaluate with this penalty from now on."""
        super().use_penalty(value)
        for one in self.passes:
            one.penalty = value

    def deepest(self, found: SheetsFound, ranks: Ranks) -> float:
        """Largest penetration; with multipliers the part of it that the faces can remove."""
        if not self.augmented:
            return ranks.max(found.penetration)
        return ranks.max(float(-min(gap.min(initial=0.0) for gap in self._gaps(found))))

    def loose(self, found: SheetsFound) -> bool:
        """Whether multipliers are active and a gap exceeds its limit."""
        return self.augmented and any((np.abs(gap) > self.allowed).any() for gap in self._gaps(found))

    def augment(self, found: SheetsFound, change: Floats) -> None:
        """Augmentation: set the multipliers to the present pressure, and add the change of the residual. eq. (4.34)"""
        change -= self.forces(found.u)
        for one, side in zip(self.passes, found.sides, strict=True):
            one.multipliers = np.maximum(self._in_basis(one, side, np.where(side.active, side.pressure, 0.0)), 0.0)
        change += self.forces(found.u)

    def _gaps(self, found: SheetsFound) -> list[Floats]:
        """Gaps of the held points of each side, projected onto the shape functions of its faces."""
        return [
            self._in_basis(one, side, np.where(side.active, side.gap, 0.0))
            for one, side in zip(self.passes, found.sides, strict=True)
        ]

    @staticmethod
    def _in_basis(one: _core.SheetPass, side: SideFound, values: Floats) -> Floats:
        return in_face_basis(values, side.active, side.area, one.shape_values)

    def stiffen(self, found: SheetsFound, penalty: float, change: Floats) -> None:
        """Change the penalty, and add to the residual the change that keeps the pressure of the held points.

        Parameters
        ----------
        found : SheetsFound
            Equilibrium with the present penalty.
        penalty : float
            The new penalty.
        change : ndarray, shape (3 n,)
            Receives the residual for the first increment with the previous tangent. eq. (4.39)
        """
        change += (1.0 - self.penalty / penalty) * self.forces(found.u)
        self.use_penalty(penalty)

    def forces(self, u: Floats) -> Floats:
        """Internal forces of the contact at a displacement, shape (3 n,); the history does not change."""
        f = np.zeros_like(u)
        for one in self.passes:
            one.evaluate(u, self._nowhere, f, None, None, None)
        return f

    @cached_property
    def _nowhere(self) -> _core.Pattern:
        """An empty pattern: forces are requested where no model has unknowns."""
        return _core.Pattern(np.full(3 * len(self._mesh.points), -1, dtype=np.int32), [], False)

    @cached_property
    def _areas(self) -> list[Floats]:
        return [one.areas for one in self.passes]
