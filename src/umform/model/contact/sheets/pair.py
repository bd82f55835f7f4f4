"""A contact of two sheets, or of a sheet with itself: two half passes. docs/theory, 4.21"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform import _core
from umform.mesh.numbers import unique
from umform.model.contact.face_basis import mean_at_nodes
from umform.model.contact.sheets.found import SheetsFound, SideFound
from umform.model.contact.sheets.passes import TURN, Search, SheetPasses
from umform.model.terms.term import At, Energies, Found, Into, Tree
from umform.ranks import Ranks

Floats = NDArray[np.float64]


class SheetContact(SheetPasses):
    """Contact between faces of sheets, or of one sheet with itself, by a penalty, with or without friction.

    Each side integrates half of the pressure at its own contact points, with forces on both. Made by
    :meth:`umform.Model.sheet_contact` and :meth:`umform.Model.self_contact`.

    Parameters
    ----------
    mesh : Mesh
        The sheets.
    sides : sequence of ndarray of int, shape (k, 2)
        Faces of each side, rows (cell, face): two, or one of a sheet that touches itself.
    settings : SheetContactSettings
        Penalty, points, depth.
    name : str
        For the history.
    """

    # Search ------------------------------------------------------------------------------------------------------

    def covers(self, u: Floats) -> bool:
        """Whether the couplings have all facets that may touch at a displacement; searches again where they do not."""
        if self._couplings is None:
            self._at = u.copy()
            return True
        moved, turned = np.max([one.moved_since_search(u) for one in self.passes], axis=0).tolist()
        before, self._declared = self._declared, None
        if moved > self._way or turned > TURN:
            before = before or self._couplings
            self._at = u.copy()
            self._search()
        return before is None or _same(before, self.couples())

    def couples(self) -> Sequence[_core.Connectivity]:
        """The nodes of each facet with those of the facets that it may touch."""
        if self._couplings is None:
            self._search()
        assert self._couplings is not None
        return self._couplings

    def _search(self) -> None:
        """Find what may touch; the feet of the converged state stay among it."""
        for one in self.passes:
            one.search(self._at, self._way, TURN)
        self._feet = self._history()[:, self._column("facet")].copy()
        self._couplings = [one.couplings() for one in self.passes]

    def _history(self) -> Floats:
        return np.concatenate([one.state for one in self.passes])

    # Term --------------------------------------------------------------------------------------------------------

    def evaluate(self, at: At, into: Into) -> SheetsFound:
        """Add the forces on both sides and their tangents. eqs. (4.305), (4.306)"""
        product = None if at.du is None else into.predictor
        scale = 0.0
        sides: list[SideFound] = []
        for one in self.passes:
            scale += one.evaluate(at.u, into.pattern, into.residual, into.values, at.du, product)
            of_side: dict[str, Any] = one.found()
            sides.append(SideFound(area=self._areas[len(sides)], **of_side))
        round_off = sum(side.round_off_squared for side in sides)
        return SheetsFound(scale, round_off, sides=tuple(sides), u=at.u)

    def commit(self, found: Found) -> None:
        """Accept the trial history as converged."""
        assert isinstance(found, SheetsFound)
        self._commit()
        self._standing_penalty = self.penalty
        self.stand(found)

    def _commit(self) -> None:
        self.before = self._history()
        if self.augmented:  # what the evaluation has read
            multipliers = np.concatenate([one.multipliers for one in self.passes])
            self.before[:, self._column("multiplier")] = multipliers
        for one in self.passes:
            one.commit()
        self._kept = self._searched

    def begin(self) -> None:
        """Initialise the history from the last evaluation, if there is none yet: where points lie at the start."""
        if not self._history().any():
            self._commit()

    def revert(self) -> None:
        """Return to the converged history, and to the search from which its run would go on."""
        for one in self.passes:
            one.revert()
        if self._kept is not None and self._at is not self._kept.at:
            self._search_again(self._kept, self._history())

    def state(self) -> Tree:
        """History of the points, where and with which feet the last search looked, and the penalty."""
        history = self._history()
        feet = history[:, self._column("facet")].copy() if self._couplings is None else self._feet
        standing = np.array([self._standing_penalty])
        return {"history": history, "searched": self._at.copy(), "feet": feet, "penalty": standing}

    def go_on_with(self, history: Floats) -> None:
        """Continue from a history whose feet the last search need not have found."""
        self.restore({**self.state(), "history": history, "feet": history[:, self._column("facet")].copy()})

    def restore(self, tree: Tree) -> None:
        """Restore a history, and the search that its run has made, whose couplings order the equations."""
        searched, feet = (np.array(tree[key], dtype=float) for key in ("searched", "feet"))
        self._search_again(Search(searched, feet), tree["history"])
        self._kept = self._searched
        self._restore_penalty(float(tree["penalty"][0]))
        self._last = None

    @property
    def _searched(self) -> Search:
        """The last search."""
        return Search(self._at, self._feet)

    def _search_again(self, search: Search, history: Floats) -> None:
        """Make an earlier search again, for a history."""
        then = np.array(history, dtype=float)
        then[:, self._column("facet")] = search.feet
        self.go_back(then)
        self._at = search.at
        self._declared = self._declared or self._couplings
        self._search()
        self.go_back(history)

    def go_back(self, before: Floats) -> None:
        """Restore the history that the evaluation of the converged state used as input."""
        first = 0
        for one in self.passes:
            one.restore(np.ascontiguousarray(before[first : first + one.points], dtype=float))
            first += one.points

    def columns(self, found: Found, ranks: Ranks) -> dict[str, float]:
        """Largest penetration, its energy, penalty, held points, force on the first side, multipliers, friction."""
        assert isinstance(found, SheetsFound)
        values = [self.deepest(found, ranks), found.sum("contact_energy"), self.penalty, float(found.active.sum())]
        values += found.force.tolist() if len(self.sides) > 1 else []
        values += [float(self.multipliers_stay)] if self.augmented else []
        if self.settings.friction is not None:
            values += [float((found.status == 2).sum()), found.sum("friction_work")]
        return dict(zip(self.column_names(), values, strict=True))

    def column_names(self) -> Iterable[str]:
        """Largest penetration, held points, force, and the columns of multipliers and friction."""
        names = [
            "penetration",
            "penetration_energy",
            "penalty",
            "active",
            *(("fx", "fy", "fz") if len(self.sides) > 1 else ()),
            *(("multipliers_stay",) if self.augmented else ()),
        ]
        names += [] if self.settings.friction is None else ["slipping", "friction_work"]
        return [f"{self.name}_{what}" for what in names]

    def found_at_nodes(self, at: SheetsFound, count: int) -> tuple[Floats, Floats]:
        """Pressure and gap at the nodes, averaged from the points (4.38): zero, and NaN, where none is near."""
        near = np.concatenate([np.isfinite(side.gap) for side in at.sides])
        points = at.points()
        pressure, gap, part = self._mean_at_nodes(
            np.column_stack([points.pressure, np.where(near, points.gap, 0.0), near]), count
        ).T
        return pressure, np.divide(gap, part, out=np.full(count, np.nan), where=part > 0.0)

    def friction_at_nodes(self, at: SheetsFound, count: int) -> tuple[Floats, Floats]:
        """Tangential traction (nodes, 3) and distance slid (nodes,), averaged as the pressure is. eq. (4.38)"""
        values = np.concatenate([np.column_stack([side.friction, side.slip]) for side in at.sides])
        mean = self._mean_at_nodes(values, count)
        return mean[:, :3], mean[:, 3]

    def _mean_at_nodes(self, values: Floats, count: int) -> Floats:
        """Of the values at the points of all sides; of both at nodes that they share."""
        total, sides, first = np.zeros((count, values.shape[1])), np.zeros((count, 1)), 0
        for one, area, facets in zip(self.passes, self._areas, self.facets, strict=True):
            own = values[first : first + one.points]
            total += mean_at_nodes(own, area, one.shape_values, facets, count, lambda shares: shares)
            sides[unique(facets)] += 1.0
            first += one.points
        return total / np.maximum(sides, 1.0)

    def energies(self, found: Found, u: Floats) -> Energies:
        """Energy of penalty and elastic slip, and the work of friction."""
        assert isinstance(found, SheetsFound)
        return Energies(0.0, 0.0, found.sum("contact_energy") + found.sum("stored"), found.sum("friction_work"))


def _same(one: Sequence[_core.Connectivity], other: Sequence[_core.Connectivity]) -> bool:
    """Whether two searches have found the same couplings."""
    return all(np.array_equal(a.ids, b.ids) for a, b in zip(one, other, strict=True))
