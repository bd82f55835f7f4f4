"""The balance of a run: external work against energies, resultants of the external forces.

External work is stored as elastic energy, dissipated by plastic flow and friction, or stored by the penalty of contact.
The work is the trapezoidal rule over the converged states; beyond it there is only what happens at contact points
within an increment, where they touch, leave, or begin to slip. It uses no energy of the sheet, so that the difference
measures the time discretisation. Relative to the largest energy it falls with the square of the increment.
docs/theory, 5.11
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform.model import Evaluation, Model, Tool
from umform.model.contact import ContactFound
from umform.model.contact.found import moment as moment_of
from umform.model.terms.term import At, Energies
from umform.ranks import Ranks

Floats = NDArray[np.float64]
#: Part of the largest energy below which a sheet is not loaded.
_NOTHING = 1e-12


def energies(model: Model, evaluation: Evaluation) -> Energies:
    """Energies of the converged state of a model. eq. (5.30)

    Parameters
    ----------
    model : Model
        A model at its converged state.
    evaluation : Evaluation
        The evaluation there.
    """
    total = [0.0] * 4
    for term in model.system.terms:
        own = term.energies(evaluation.found[term], model.u)
        total = [sum(pair) for pair in zip(total, (own.elastic, own.plastic, own.contact, own.friction), strict=True)]
    return Energies(*(model.system.ranks.sum(part) for part in total))


@dataclass(frozen=True)
class Balance:
    """Balance of a run, one entry for each row of the history; arrays of shape (rows,).

    Attributes
    ----------
    step, time : ndarray
        As in the history.
    external_work : ndarray
        Work of loads, pressures, supports and tools, plus the sum of the energies at the start.
    elastic, plastic, contact, friction : ndarray
        Energies, see :class:`Energies`.
    drift : ndarray
        External work minus the sum of the energies, relative to the largest sum in any row. eq. (5.33)
    force_imbalance : ndarray
        Sum of all external forces on the sheet, relative to the largest sum of their magnitudes so far. eq. (5.34)
    moment_imbalance : ndarray
        Sum of their moments about the middle of the undeformed mesh, relative to the same sum times the largest initial
        distance of a node from it.
    works : mapping of str to ndarray
        Work of each tool on the sheet by its name, of "loads and supports" together, and of "contact beyond the mean",
        the part of it within increments that no mean of forces contains, since the run began. Their sum is the change
        of the external work, except that an opened tool adds the energy of its contact to that.
    """

    step: Floats
    time: Floats
    external_work: Floats
    elastic: Floats
    plastic: Floats
    contact: Floats
    friction: Floats
    drift: Floats
    force_imbalance: Floats
    moment_imbalance: Floats
    works: Mapping[str, Floats]

    @property
    def largest_imbalances(self) -> tuple[float, float]:
        """Largest imbalance of forces and of moments in the increments in which the sheet is loaded.

        The start may be out of balance, and forces on a sheet that nothing touches yet are round-off.
        """
        energy = np.abs(self.elastic + self.plastic + self.contact + self.friction)
        bears = ~(energy <= _NOTHING * energy.max(initial=0.0))  # an unknown energy is NaN
        bears[:1] = False
        force, moment = (one[bears].max(initial=0.0) for one in (self.force_imbalance, self.moment_imbalance))
        return float(force), float(moment)


def drift(external_work: Floats, stored: Floats) -> Floats:
    """External work minus energies, relative to the largest energy of the run. eq. (5.33)

    At first contact or first yield the error of a row is a fixed part of its work, however short the increment is. The
    energies up to that row are therefore no suitable scale.

    Parameters
    ----------
    external_work, stored : ndarray, shape (rows,)
        External work, and the sum of all energies.

    Returns
    -------
    ndarray, shape (rows,)
        Zero where no row has any energy.
    """
    difference, largest = external_work - stored, np.abs(stored).max(initial=0.0)
    return difference / largest if largest != 0.0 else np.zeros_like(difference)


@dataclass(frozen=True)
class _Tool:
    """Pose of a tool, force and moment of the sheet on it, sum of the magnitudes of the contact forces, and the work
    that no mean of forces contains: of friction so far, of points that touched or left in the last increment.
    """

    point: Floats
    rotation: Floats
    force: Floats
    moment: Floats  # about the point
    magnitude: float
    above_mean: float
    of_touch: float

    @classmethod
    def of(cls, tool: Tool, evaluation: Evaluation, ranks: Ranks) -> _Tool:
        rotation, shift = tool.pose(evaluation.controls, evaluation.time)
        point = rotation @ tool.reference_point + shift
        force, moment, magnitude, above, touch = np.zeros(3), np.zeros(3), 0.0, 0.0, 0.0
        for pair in tool.pairs:
            found: ContactFound = evaluation.found[pair]
            of_pair = found.resultant(point)
            force, moment = force + of_pair[0], moment + of_pair[1]
            magnitude += float(found.pressure @ found.area)
            above += found.held.work_above_mean
            touch += pair.work_of_touch
        sums = [ranks.sum(part) for part in (magnitude, above, touch)]
        return cls(point, rotation, ranks.sum(force), ranks.sum(moment), *sums)

    def work_since(self, before: _Tool) -> float:
        """Work of the forces that move the tool against the sheet, from an earlier state. eq. (5.32)"""
        slide, turn, arms = self.point - before.point, np.zeros(3), np.zeros((2, 3))
        if not np.array_equal(self.rotation, before.rotation):
            from scipy.spatial.transform import Rotation  # the import is slow

            turn = Rotation.from_matrix(self.rotation @ before.rotation.T).as_rotvec()
        if angle := math.hypot(*turn):
            # the tool slides along the axis of its motion and turns about it; arms from its point to the axis
            axis = turn / angle
            across = slide - (slide @ axis) * axis
            arms[0] = 0.5 * (across + np.cross(axis, across) / math.tan(0.5 * angle))
            arms[1], slide = arms[0] - across, slide - across
        force, moment = before.force + self.force, before.moment + self.moment
        moment = moment - np.cross(arms[0], before.force) - np.cross(arms[1], self.force)
        return -0.5 * float(force @ slide + moment @ turn)


@dataclass(frozen=True)
class _State:
    """A state for work and resultants.

    Attributes
    ----------
    u : ndarray, shape (3 n,)
        Displacement.
    forces : ndarray, shape (3 n,)
        External nodal forces that do external work.
    all_forces : ndarray, shape (3 n,)
        The same with forces of foundations, whose energy is part of the energies.
    tools : list of _Tool
        Tools.
    """

    u: Floats
    forces: Floats
    all_forces: Floats
    tools: list[_Tool]


@dataclass(frozen=True)
class Worked:
    """Balance of one increment.

    Attributes
    ----------
    difference : float
        Magnitude of the external work less the change of the energies.
    gained : float
        Magnitude of the change of the energies.
    energy : float
        Sum of the energies at the end.
    """

    difference: float
    gained: float
    energy: float


class ExternalWork:
    """External work along the converged states of a run, and the resultants in each state.

    It starts at the sum of the energies of the model, which is zero at rest. If energies are unknown (NaN), it starts
    at zero and counts the work of this run only.

    Attributes
    ----------
    value : float
        External work so far.
    energies : Energies
        Energies of the last state.
    imbalances : list of tuple of float
        Relative resultants of all external forces and moments, one pair for each state. eq. (5.34)
    works : list of ndarray
        Work of loads and supports, of contact beyond the mean, then of each tool, since the first state; one array for
        each state.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        self.value = 0.0
        self.energies = Energies(0.0, 0.0, 0.0)
        self.imbalances: list[tuple[float, float]] = []
        self.works: list[Floats] = []
        self._before: _State | None = None
        self._largest = 0.0  # sum of the magnitudes of the external forces
        ranks, x = model.system.ranks, model.positions
        self._centre = np.array([0.5 * (ranks.max(float(part.max())) - ranks.max(float(-part.min()))) for part in x.T])
        self._length = ranks.max(float(np.linalg.norm(x - self._centre, axis=1).max()))

    def advance(self, evaluation: Evaluation) -> None:
        """Continue to the converged state of the model at which the evaluation was made."""
        model = self.model
        tools = [_Tool.of(tool, evaluation, model.system.ranks) for tool in model.tools]
        state = _State(model.u.copy(), *self._nodal_forces(evaluation), tools)
        self.energies = energies(model, evaluation)
        if self._before is None:
            self.value = 0.0 if np.isnan(self.energies.total) else self.energies.total
            self.works.append(np.zeros(2 + len(tools)))
        else:
            parts = self._works(self._before, state)
            self.value += parts[0] + sum(parts[1:])
            self.works.append(self.works[-1] + parts)
        self._before = state
        self.imbalances.append(self._imbalance(state))

    def since(self, before: ExternalWork) -> Worked:
        """Balance of the increment from an earlier state."""
        gained = self.energies.total - before.energies.total
        return Worked(abs(self.value - before.value - gained), abs(gained), abs(self.energies.total))

    def begin_anew(self, evaluation: Evaluation) -> None:
        """Continue from the same state with loads that replace the contact forces of removed tools."""
        model, before = self.model, self.energies
        tools = [_Tool.of(tool, evaluation, model.system.ranks) for tool in model.tools]
        self._before = _State(model.u.copy(), *self._nodal_forces(evaluation), tools)
        self.energies = energies(model, evaluation)
        self.value += self.energies.contact - before.contact

    def copy(self) -> Self:
        """A copy that continues independently."""
        other = copy(self)
        other.imbalances, other.works = list(self.imbalances), list(self.works)
        return other

    @property
    def largest_moment(self) -> float:
        """Scale of the moments of (5.34)."""
        return self._largest * self._length

    def memory(self) -> dict[str, Any]:
        """All that the work of later states depends on, besides the model itself."""
        return {
            "value": self.value,
            "imbalances": np.array(self.imbalances),
            "works": np.array(self.works),
            "largest": self._largest,
        }

    def recall(self, memory: Mapping[str, Any], evaluation: Evaluation) -> None:
        """Restore the work of a run.

        Parameters
        ----------
        memory : mapping
            Value of `memory`.
        evaluation : Evaluation
            The evaluation of its last state.
        """
        self.advance(evaluation)
        self.imbalances = [(force, moment) for force, moment in memory["imbalances"].tolist()]
        self.works = list(memory["works"])
        self.value, self._largest = memory["value"], memory["largest"]

    def _nodal_forces(self, evaluation: Evaluation) -> tuple[Floats, Floats]:
        """Dead loads, pressures and reactions on the nodes; and the same with the forces of foundations."""
        model = self.model
        forces = evaluation.residual[: model.u.size].copy()  # reactions and hinge forces
        forces[model.system.free] = 0.0
        at = At(model.u, evaluation.time, evaluation.controls)
        for term in model.system.terms:
            own = term.external_forces(at)
            if own is not None:
                forces += own
        others = [(term, evaluation.found[term]) for term in model.system.others]
        held = [own for term, found in others if (own := term.support_forces(found, at)) is not None]
        return forces, sum(held, start=forces)

    def _works(self, before: _State, state: _State) -> list[float]:
        """Work of loads and supports, of contact beyond the mean, of each tool. eqs. (5.31), (5.104), (5.32)"""
        nodes = 0.5 * self.model.system.ranks.dot(before.forces + state.forces, state.u - before.u)
        above = sum(tool.above_mean for tool in state.tools) - sum(tool.above_mean for tool in before.tools)
        above += sum(tool.of_touch for tool in state.tools)
        return [nodes, above, *map(_Tool.work_since, state.tools, before.tools)]

    def _imbalance(self, state: _State) -> tuple[float, float]:
        """Resultants in the current configuration, relative to the largest magnitudes so far. eq. (5.34)"""
        ranks, owned = self.model.system.ranks, self.model.system.whole.owned
        x = self.model.mesh.displaced(state.u)[owned]
        forces = self.model.system.whole.sum_at_nodes(state.all_forces.reshape(-1, 3))[owned]
        force, moment = ranks.sum(forces.sum(axis=0)), ranks.sum(moment_of(x - self._centre, forces))
        magnitude = ranks.sum(float(np.sqrt((forces * forces).sum(axis=1)).sum()))
        for tool in state.tools:
            force -= tool.force
            moment -= tool.moment + moment_of((tool.point - self._centre)[None], tool.force[None])
            magnitude += tool.magnitude
        self._largest = max(self._largest, magnitude)
        if self._largest == 0.0:
            return 0.0, 0.0
        return math.hypot(*force) / self._largest, math.hypot(*moment) / self.largest_moment
