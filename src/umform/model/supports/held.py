"""The combined supports of a model, and the displacement that they prescribe; contradictions are refused."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import count
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.mesh import Ids, Mesh
from umform.mesh.numbers import common
from umform.model.supports.constraints import Groups, Rows
from umform.model.supports.support import Support
from umform.model.supports.ties import Tie, split_ties
from umform.model.terms.control import Control, OnDofs, Prescribed
from umform.model.terms.controls import Controls
from umform.model.terms.present_state import Now
from umform.model.terms.state import State

Floats = NDArray[np.float64]
_C = TypeVar("_C", bound=Control)

HELD = "fix or symmetry"


class Held:
    """The supports of a model, individually and combined: a sequence of the active ones, without those of controls.

    Parameters
    ----------
    mesh : Mesh
        Points and cells.
    controls : Controls
        Controls of the model, some of which prescribe displacements.
    now : Now
        The present state of the model.
    """

    def __init__(self, mesh: Mesh, controls: Controls, now: Now) -> None:
        self.mesh, self.controls, self.now = mesh, controls, now
        self.ties: list[Tie] = []
        #: Constraints in local axes.
        self.rows: list[Rows] = []
        self.fixed = np.zeros(3 * len(mesh.points), dtype=bool)
        self._holders: list[Support] = []
        self._split: tuple[Ids, Groups] | None = None

    def __iter__(self) -> Iterator[Support]:
        return iter([support for support in self.all if not support.removed])

    def __len__(self) -> int:
        return len(list(iter(self)))

    def __getitem__(self, number: int) -> Support:
        return list(iter(self))[number]

    @property
    def all(self) -> list[Support]:
        """The supports, including removed ones."""
        return [holder for holder in self._holders if holder.control is None]

    @property
    def holders(self) -> list[Support]:
        """All objects that hold nodes: supports and controls, including removed ones."""
        return self._holders

    def take(self, holders: list[Support], fixed: NDArray[np.bool_], ties: list[Tie]) -> None:
        """Take the supports of a share, which the whole model has checked."""
        self._holders, self.fixed, self.ties = holders, fixed, ties

    def hold_again(self) -> None:
        """Apply the supports again after one of them has been removed, restored or moved."""
        self._support(self._holders)

    def wait(self, nodes: Ids, dofs: Ids, name: str) -> Support:
        """A support of degrees of freedom that is inactive until it is restored."""
        support = self._new(HELD, "all", nodes, False, name)
        support.held, support.removed, support.waits = dofs, True, True
        self._holders = [*self._holders, support]
        return support

    def constrained(self) -> NDArray[np.bool_]:
        """Mask of degrees of freedom that are held or prescribed, without tied ones and those in local axes."""
        return _constrained(self.fixed, self.controls.of_kind(Prescribed))

    @property
    def pairs(self) -> Ids:
        """Tied pairs of degrees of freedom, lower and upper, without those that are part of a group of constraints."""
        return self._parts()[0]

    @property
    def groups(self) -> Groups:
        """Constraints in local axes, and the ties that share a degree of freedom with them."""
        return self._parts()[1]

    @property
    def unknown_count(self) -> int:
        """Number of unknowns: degrees of freedom that are not held; a tied pair counts once."""
        groups = self.groups
        return int((~self.constrained()).sum()) - len(self.pairs) - len(groups.dofs) + groups.count

    def displacement(self, values: Mapping[Control, float]) -> Floats:
        """Displacement that supports prescribe for given values of the controls (others zero); zero elsewhere.

        Parameters
        ----------
        values : mapping of Control to float
            Displacements, or their rates.

        Returns
        -------
        ndarray, shape (3 n,)
            Displacement.
        """
        return self._displacement(values, self.controls, self.groups)

    def prescribed(self, goal: State | None = None) -> Floats:
        """Displacement that supports prescribe at a goal, by default at the present values of the controls."""
        values = {c: c.value for c in self.controls} if goal is None else self.controls.values_at(goal)
        return self._displacement(values, self.controls, self.groups, _acting(self._holders))

    def _displacement(
        self,
        values: Mapping[Control, float],
        controls: Iterable[Control],
        groups: Groups,
        holders: Sequence[Support] = (),
    ) -> Floats:
        """Displacement that controls prescribe; with holders, also that of the supports at the nodes."""
        u = np.zeros(self.fixed.size)
        for control in controls:
            control.displace(u, values.get(control, 0.0))
        fixed = self._held_by(holders)
        for holder in holders:
            if holder.base is not None:
                u[holder.held] = holder.base[holder.held]
                for tie in (tie.without_held(fixed) for tie in holder.ties):
                    u[tie.dofs] = 0.0 if tie.offsets is None else tie.offsets[:, None]
        groups.prescribe(values, u, offsets=bool(holders))
        return u

    # Internal ------------------------------------------------------------------------------------------------

    def _parts(self) -> tuple[Ids, Groups]:
        if self._split is None:
            self._split = _split(self.constrained(), self.ties, self.rows)
        return self._split

    def _held_by(self, holders: Sequence[Support]) -> NDArray[np.bool_]:
        """Mask of the degrees of freedom that supports hold along x, y or z."""
        fixed = np.zeros_like(self.fixed)
        for holder in holders:
            fixed[holder.held] = True
        return fixed

    def _new(self, kind: str, directions: str | None, nodes: Ids, base: bool, name: str) -> Support:
        """A support that is not active yet; used names are refused."""
        if directions == "":
            raise InvalidValue(
                "a support holds in one direction at least",
                where="supports",
                value="''",
                cause="an empty word",
                remedy="letters such as xz; without directions it holds in all",
            )
        taken = {support.name for support in self._holders} | {control.name for control in self.controls}
        if name in taken:
            raise InvalidValue(
                "the name of a support is taken",
                where="supports",
                value=name,
                cause="two supports, or a support and a control, with one name",
                remedy="give it another name",
            )
        free = next(text for k in count(1) if (text := f"support{k}") not in taken)
        return Support(name or free, kind, directions or "all", nodes, base=self.now.u.copy() if base else None)

    def _hold(self, support: Support) -> Support:
        """Activate a support."""
        self.refuse_taken(support)
        self._support([*self._holders, support])
        return support

    def refuse_taken(self, support: Support) -> None:
        """Reject an inactive support if another one holds its degrees of freedom."""
        fixed = self.fixed.copy()
        fixed[support.held] = True
        taken = self._taken([tie.without_held(fixed) for tie in self.ties])
        if support.kind == HELD:  # holding a node twice is harmless
            del taken[HELD]
        for dofs in [support.held, *(tie.without_held(fixed).dofs.ravel() for tie in support.ties)]:
            for number, letter in enumerate("xyz"):
                refuse_twice(dofs[dofs % 3 == number], letter, taken, support.kind)

    def _drive(self, control: _C, holder: Support | None) -> _C:
        """Add a control and its prescribed displacement, or neither if one of them is refused."""
        before = self._holders
        self._support(before if holder is None else [*before, holder], [control])
        try:
            return self.controls.add(control)
        except InvalidValue:
            self._support(before)
            raise

    def _support(self, holders: list[Support], controls: Sequence[Control] = ()) -> None:
        """Activate these supports and those of new controls, unless they contradict each other."""
        acting = _acting(holders)
        fixed = self._held_by(acting)
        ties = [tie.without_held(fixed) for holder in acting for tie in holder.ties]
        rows = [part for holder in acting for part in holder.rows]
        every = [*self.controls, *controls]
        split = _split(_constrained(fixed, [c for c in every if isinstance(c, Prescribed)]), ties, rows)
        self._refuse_contradictions(split[1], every, acting)
        self.fixed, self.ties, self.rows, self._split, self._holders = fixed, ties, rows, split, holders
        self.now.restructured()
        for control in every:
            if isinstance(control, OnDofs):  # a control may move more than its degrees of freedom
                control.along = self._displacement({control: 1.0}, every, split[1]) if rows else None

    def _refuse_contradictions(self, groups: Groups, controls: Sequence[Control], holders: list[Support]) -> None:
        """Move each control alone, then none: the constraints must be satisfied each time."""
        if not groups.rows:
            return
        moved = [control for control in controls if isinstance(control, OnDofs)]
        for control in [*moved, None]:
            values: dict[Control, float] = {} if control is None else {control: 1.0}
            at = holders if control is None else []
            missed = groups.missed(values, self._displacement(values, controls, groups, at), offsets=bool(at))
            if missed is not None:
                part, number = missed
                other = "another support" if control is None or control is part.control else control.name
                raise _twice(int(part.dofs[number, 0]) // 3, "of local axes", other, part.by)

    def _taken(self, ties: Sequence[Tie]) -> dict[str, Ids]:
        """Degrees of freedom that are already held or prescribed, and by which support."""
        taken = {HELD: np.flatnonzero(self.fixed).astype(np.int32)}
        taken |= {control.name: control.dofs for control in self.controls.of_kind(Prescribed)}
        for tie in ties:
            by = "hinge" if tie.control is None else tie.control.name
            taken[by] = np.concatenate([taken.get(by, np.empty(0, dtype=np.int32)), tie.dofs.ravel()])
        return taken


def refuse_twice(dofs: Ids, direction: str, taken: Mapping[str, Ids], by: str) -> None:
    """Reject degrees of freedom that another support already holds."""
    for other, theirs in taken.items():
        shared = common(dofs, theirs)
        if len(shared):
            raise _twice(int(shared[0]) // 3, direction, other, by)


def _twice(node: int, direction: str, other: str, by: str) -> InvalidValue:
    return InvalidValue(
        "a displacement is prescribed twice",
        where=f"node {node}, direction {direction}",
        value=f"by {other} and by {by}",
        cause="two supports ask for it",
        remedy="take the node out of one of the sets; a hinge may have a fixed node if its partner is fixed too",
    )


def _acting(holders: Iterable[Support]) -> list[Support]:
    return [holder for holder in holders if not holder.removed]


def _constrained(fixed: NDArray[np.bool_], prescribed: Iterable[Prescribed]) -> NDArray[np.bool_]:
    constrained = fixed.copy()
    for control in prescribed:
        constrained[control.dofs] = True
    return constrained


def _split(constrained: NDArray[np.bool_], ties: Sequence[Tie], rows: Sequence[Rows]) -> tuple[Ids, Groups]:
    pairs, joined = split_ties(ties, rows, constrained)
    return pairs, Groups(constrained, joined)
