"""A body: cells of the mesh, their element, their law, and the rolling direction; a model has one or more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.elements import BodyOptions, Element, Rolling, rolling_directions
from umform.elements import element as catalogue_element
from umform.elements import thickness_rule as make_thickness_rule
from umform.errors import InvalidValue, WrongCellType
from umform.materials import Material
from umform.materials.material import check_material
from umform.mesh import Mesh
from umform.model.bodies.failing_point import at_failing_point
from umform.model.bodies.selected_cells import Cells, cell_numbers
from umform.model.bodies.through_thickness import completed, points_through
from umform.model.terms.control import Twins
from umform.model.terms.cut import Cut
from umform.model.terms.elsewhere import not_here
from umform.model.terms.term import At, Energies, Found, Into, Term, Tree
from umform.spec import takes

Floats = NDArray[np.float64]
Numbers = NDArray[np.int64]


@dataclass(frozen=True)
class BodyFound(Found):
    """Result of the evaluation of a body.

    Attributes
    ----------
    flows : ndarray of uint8, shape (points,)
        1 for each point whose history the evaluation has changed, else 0.
    enhanced_change : float
        Largest change of an enhanced parameter that a recovery without a displacement makes; 0 in equilibrium.
    """

    flows: NDArray[np.uint8] | None = None
    enhanced_change: float = 0.0

    @property
    def flowing(self) -> NDArray[np.uint8]:
        """1 for each point whose history the evaluation has changed, else 0."""
        return np.zeros(0, dtype=np.uint8) if self.flows is None else self.flows


class Body(Term):
    """Cells of one element and one law.

    Parameters
    ----------
    element : str or Element
        Name in the catalogue (:data:`umform.elements.CATALOGUE`), or your own element.
    material : Material
        SVK, NeoHooke, NeoHookePower, J2, Metal, or your own law.
    cells : array_like or callable, optional
        Indices of the cells, a mask, a predicate of the coordinates x, y, z of their centres, or the name of a set that
        has all of their nodes; default all cells.
    name : str
        For messages and fields.
    rolling, **options
        As those of :class:`umform.Model`.

    Raises
    ------
    InvalidValue
        If an option is invalid.

    Examples
    --------
    >>> import umform as uf
    >>> strip = uf.mesh.strip(10.0, 1.0, 0.2, (8, 1))
    >>> soft = uf.Body(material=uf.SVK(E=70e3, nu=0.3), cells=lambda x, y, z: x < 5.0, name="soft")
    >>> stiff = uf.Body(material=uf.SVK(E=210e3, nu=0.3), cells=lambda x, y, z: x > 5.0, name="stiff")
    >>> model = uf.Model(strip, bodies=[soft, stiff])
    """

    timed_as = "elements"
    fixed = ("element", "material", "thickness_points", "thickness_rule", "rolling")

    @takes(BodyOptions)
    def __init__(
        self,
        element: str | Element = "ANS3DEAS",
        *,
        material: Material,
        cells: Cells | None = None,
        name: str = "sheet",
        rolling: Rolling | None = None,
        **options: Any,
    ) -> None:
        self.name = name
        wanted = BodyOptions(**options)
        made = catalogue_element(element, **wanted.of_element())
        check_material(material, name)
        self.material = material
        if getattr(material, "directional", False) and rolling is None:
            raise InvalidValue(
                "a law with directions needs the rolling direction of the sheet",
                where=name,
                value=type(material).__name__,
                cause="its yield function differs along and across the rolling direction",
                remedy="rolling=(1, 0, 0), one vector for each cell, or umform.rolling_at(45) to a bend line",
            )
        through = points_through(made, material, wanted.thickness_points, wanted.thickness_rule)
        self.thickness_points, self.thickness_rule = through
        self.element = completed(made, material, *through)
        least = self.element.thickness_order + 1
        if self.thickness_points < least:
            raise InvalidValue(
                f"thickness order {least - 1} needs at least {least} thickness points",
                where="thickness_points",
                value=self.thickness_points,
                cause="fewer points cannot see the highest mode",
                remedy=f"thickness_points={least} or more",
            )
        self.through = make_thickness_rule(*through, self.element.surface_rule)
        self.element.check_modes(*self.through)
        self._selection, self._given_rolling = cells, rolling
        self.elsewhere = False
        self.before = np.empty(0)

    def on(self, mesh: Mesh) -> Self:
        """Attach the body to the cells of a mesh.

        Raises
        ------
        WrongCellType
            If the element needs another cell type.
        EmptySet
            If no cell is selected.
        InvalidValue
            If the body belongs to another model.
        """
        if "cells" in vars(self):
            raise InvalidValue(
                "a body belongs to one model",
                where=f"body {self.name}",
                cause="another model was made with it",
                remedy="a new Body for each model",
            )
        if self.element.cell != mesh.cell:
            raise WrongCellType(
                f"{self.element.name} stands on {self.element.cell} cells, the mesh has {mesh.cell}",
                where="element",
                cause="a mesh that was made for another element",
                remedy=f"make the mesh with cell={self.element.cell!r}, or take an element for {mesh.cell}",
            )
        self.mesh = mesh
        #: Indices of its cells in the mesh.
        self.cells: Numbers = cell_numbers(mesh, self._selection, self.name)
        #: Rolling direction, or one for each cell.
        self.rolling = rolling_directions(self._given_rolling, self._centres())
        self._numbers = self.cells
        return self

    def leave(self) -> None:
        """Leave the mesh of a model that could not be made."""
        for name in ("mesh", "cells", "rolling", "_numbers"):
            vars(self).pop(name, None)

    def _centres(self) -> Floats:
        """Centres of its cells."""
        centres: Floats = self.mesh.points[self.connectivity].mean(axis=1)
        return centres

    @property
    def whole(self) -> bool:
        """Whether it has all cells of the mesh."""
        return len(self.cells) == len(self.mesh.connectivity)

    @property
    def connectivity(self) -> NDArray[np.int32]:
        """Nodes of its cells, shape (cells, nodes)."""
        return self.mesh.connectivity if self.whole else self.mesh.connectivity[self.cells]

    @cached_property
    def block(self) -> _core.ShellBlock:
        """Its elements with their history; large, therefore built on demand.

        Raises
        ------
        ModelError
            If the model was solved on many ranks, which hold its history.
        InvalidValue
            If the rolling direction is normal to the sheet somewhere.
        """
        if self.elsewhere:
            raise not_here("the history of the elements")
        (t, w), technology, law = self.through, self.element.technology(), self.material.law()
        points, cells, X = self.element.surface_rule, self.connectivity, self.mesh.points
        try:
            block = _core.shell_block(technology, points, t, w, law, cells, X, self.rolling)
        except ValueError as error:
            if self.rolling is None:
                raise
            raise InvalidValue(
                str(error),
                where="rolling",
                cause="a direction along the normal of the sheet",
                remedy="a vector in the plane of the sheet, or one for each cell",
            ) from error
        block.set_numbers(self._numbers.astype(np.int32))
        return block

    @property
    def section_points(self) -> int:
        """Different heights of its points in a section of an element."""
        return len(np.unique(self.through[0]))

    @property
    def symmetric(self) -> bool:  # type: ignore[override]
        """Whether the tangent of its law is symmetric."""
        return self.block.symmetric

    @property
    def begun(self) -> bool:
        """Whether its elements have been built, and may have a history."""
        return "block" in vars(self)

    # Term ----------------------------------------------------------------------------------------------------

    def couples(self) -> Sequence[_core.Connectivity]:
        """The nodes of each element."""
        return (self.block.connectivity,)

    def evaluate(self, at: At, into: Into) -> BodyFound:
        """Add the forces and tangents of all elements. eqs. (2.16)-(2.18)"""
        product = None if at.du is None else into.predictor
        scatter, self.block.step = into.scatters[self][0], at.step
        failed, scale, failure = self.block.evaluate(at.u, scatter, into.residual, into.values, at.du, product)
        if failed >= 0:
            failed, failure = int(self.cells[failed]), failure + at_failing_point(self.block, failed, at.u)
        change = self.block.enhanced_change
        return BodyFound(scale, failed=failed, failure=failure, flows=self.block.flowing, enhanced_change=change)

    def recover(self, du: Floats, mixed: bool) -> None:
        """Update the enhanced parameters. eq. (2.19)"""
        self.block.recover(du, mixed)

    def follow(self) -> None:
        """Recover next from the last evaluated forces, with the previous tangent."""
        self.block.follow()

    def shorten(self, part: float) -> None:
        """Scale the last change of the enhanced parameters. eq. (5.12)"""
        self.block.shorten(part)

    def commit(self, found: Found) -> None:
        """Accept the trial history as converged."""
        self.before = self.block.state
        self.block.commit()

    def go_back(self, before: Floats) -> None:
        """Restore the history that the evaluation of the converged state used as input."""
        self.block.restore(before, self.block.alpha)

    def revert(self) -> None:
        """Return to the converged history."""
        self.block.revert()

    def state(self) -> Tree:
        """History of the points and enhanced parameters, a row for each cell."""
        return {"history": self.block.state, "alpha": self.block.alpha}

    def restore(self, tree: Tree) -> None:
        """Restore a history."""
        self.block.restore(tree["history"], tree["alpha"])

    def energies(self, found: Found, u: Floats) -> Energies:
        """Elastic energy and plastic work of the converged state. eq. (5.30)"""
        return Energies(*self.block.energy(u), 0.0)

    # Ranks ---------------------------------------------------------------------------------------------------

    def strip(self, bare: Self, twins: Twins) -> None:
        """Remove cells and history, and their selection."""
        for made in ("block", "mesh", "cells", "rolling", "_numbers", "_selection", "_given_rolling"):
            bare.__dict__.pop(made, None)
        bare.before = np.empty(0)

    def piece(self, cut: Cut) -> dict[str, Any]:
        """Cells of the rank: their indices on the rank, as rows of this body and in the whole model; their history."""
        here, rows = cut.cells_of(self.cells)
        history = {name: values[rows] for name, values in self.state().items()} if self.begun else None
        each = self.rolling is not None and self.rolling.ndim == 2
        rolling = self.rolling[rows] if each and self.rolling is not None else self.rolling
        return {"cells": here, "rows": rows, "numbers": self.cells[rows], "rolling": rolling, "history": history}

    def fill(self, piece: dict[str, Any], mesh: Mesh) -> None:
        """Set cells, rolling directions and history."""
        self.mesh, self.cells, self.rows = mesh, piece["cells"], piece["rows"]
        self._numbers, self.rolling, history = piece["numbers"], piece["rolling"], piece["history"]
        if history is not None:
            self.restore(history)
