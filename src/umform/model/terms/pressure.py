"""A follower pressure: its direction and area follow the deformation of the sheet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.mesh import Ids, Mesh
from umform.model.terms.control import Control, Twins
from umform.model.terms.cut import Cut
from umform.model.terms.term import At, Found, Into, Term

Floats = NDArray[np.float64]


@dataclass(eq=False, repr=False)
class Pressure(Control, Term):
    """A follower pressure ``value`` against the outward normal of faces, rows (cell, face)."""

    block: _core.PressureBlock | None = None
    faces: Ids = field(default_factory=lambda: np.empty((0, 2), dtype=np.int32))

    timed_as = "contact"
    symmetric = False
    within_bodies = True

    @classmethod
    def on(cls, name: str, mesh: Mesh, faces: Ids) -> Pressure:
        """A pressure on faces of a mesh."""
        return cls(name, block=_core.pressure_block(mesh.facets_of(faces), mesh.points), faces=faces)

    def couples(self) -> Sequence[_core.Connectivity]:
        """The nodes of each face."""
        assert self.block is not None
        return (self.block.connectivity,)

    def moves_with(self, rates: Mapping[Control, float]) -> bool:
        """Whether the pressure has a rate."""
        return rates.get(self, 0.0) != 0.0

    def evaluate(self, at: At, into: Into) -> Found:
        """Add its forces and its tangent; with a rate, its forces per unit pressure go to the predictor. eq. (5.3)"""
        assert self.block is not None
        rate, scatter = at.rates.get(self, 0.0), into.scatters[self][0]
        if rate != 0.0:
            self.block.pressure = rate
            self.block.evaluate(at.u, scatter, into.predictor, None, None, None)
        self.block.pressure = at.values[self]
        product = None if at.du is None else into.predictor
        return Found(self.block.evaluate(at.u, scatter, into.residual, into.values, at.du, product)[1])

    def external_forces(self, at: At) -> Floats:
        """Its forces on the nodes."""
        assert self.block is not None
        inward = np.zeros(at.u.size)
        self.block.pressure = at.values[self]
        self.block.evaluate(at.u, self._nowhere, inward, None, None, None)
        return -inward

    @cached_property
    def _nowhere(self) -> _core.Scatter:
        """An empty scatter map: forces are requested where no model has unknowns."""
        assert self.block is not None
        nothing = _core.Pattern(np.full(self.block.dofs, -1, dtype=np.int32), [self.block.connectivity], False)
        return nothing.scatter(self.block.connectivity)

    def strip(self, bare: Any, twins: Twins) -> None:
        """Without its faces."""
        bare.block, bare.faces = None, np.empty((0, 2), dtype=np.int32)
        bare.__dict__.pop("_nowhere", None)

    def piece(self, cut: Cut) -> Ids:
        """The faces of the rank."""
        return cut.faces_of(self.faces)[0]

    def fill(self, piece: Any, mesh: Mesh) -> None:
        """Set the faces."""
        self.faces, self.block = piece, _core.pressure_block(mesh.facets_of(piece), mesh.points)
