"""What comes out of a run: history, iterations, frames with fields."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.model import Evaluation, Model, Term
from umform.model.equations.frame import Frame
from umform.notebook import Display, InNotebook
from umform.results import fields
from umform.results.balance import Balance, ExternalWork, Worked, drift
from umform.results.records import Iteration
from umform.results.volume import VolumeChange, volume_change
from umform.timing import Timing

log = logging.getLogger("umform")

Floats = NDArray[np.float64]

#: Approximate number of states that each step of a run keeps with their fields.
FRAMES = 60


@dataclass(frozen=True)
class Mark:
    """The history up to a state: its parts, which are shared and not copied, and the external work."""

    rows: list[dict[str, float]]
    frames: list[Frame]
    iterations: list[list[Iteration]]
    events: list[str]
    warnings: list[str]
    work: ExternalWork


class History(InNotebook):
    """History of all converged increments, frames of some of them.

    The history has one row for each increment: ``step``, ``time``, each control and its ``<name>_force``, for each
    contact the force ``<name>_fx``, ``_fy``, ``_fz`` and moment about the origin ``_mx``, ``_my``, ``_mz`` of the sheet
    on the tool, the largest penetration ``<name>_penetration`` and the number of ``<name>_active`` points, the
    ``external_work`` and the ``elastic_energy``, ``plastic_work``, ``contact_energy`` and ``friction_work`` that it
    went into, and the number of ``iterations``. ``events`` says what happened (lift-off), ``warnings`` what to look at,
    ``timing`` where the time went, since the run began or was resumed.

    All energies of a model at rest are zero. A run that starts from a deformed or loaded state starts its external work
    at the sum of the energies that it finds. Energies that a law does not know (one of the user, without an energy) are
    NaN, and the external work then starts at zero.
    """

    def __init__(self, model: Model, timing: Timing | None = None) -> None:
        self.model = model
        self.timing = timing or Timing()
        self.rows: list[dict[str, float]] = []
        self.frames: list[Frame] = []
        self.iterations: list[list[Iteration]] = []
        self.events: list[str] = []
        self.warnings: list[str] = []
        self.solver = ""
        self.seconds = 0.0
        self._work = ExternalWork(model)
        self._ahead: tuple[Evaluation, ExternalWork] | None = None  # the work with a state that is not kept yet
        self._writes = model.system.ranks.rank == 0  # one rank writes for all

    def __repr__(self) -> str:
        columns = len(self.rows[0]) if self.rows else 0
        return f"{type(self).__name__}({len(self.rows)} rows, {columns} columns, {len(self.frames)} frames)"

    def _display(self) -> Display:
        names = [name for one in self.model.controls for name in (one.name, f"{one.name}_force")]
        last = {int(row["step"]): row for row in self.rows}
        shown = [name for name in ("step", "time", *names) if last and name in self.rows[0]]
        rows = [shown, *([f"{row[name]:.6g}" for name in shown] for row in last.values())]
        found = self.summary()
        numbers = "{increments} increments, {iterations} iterations, {seconds:.3g} seconds".format(**found)
        title = f"{type(self).__name__}: {numbers}, {len(self.frames)} frames"
        return Display(title, {"End of each step": rows} if last else {}, self.warnings, self.events)

    def add(self, evaluation: Evaluation, iterations: list[Iteration], *, step: int = 0, frame: bool = True) -> None:
        """Add the converged state of the model, which the evaluation was made at, to the history."""
        with self.timing.output:
            self._add(evaluation, iterations, step, frame)

    def _add(self, evaluation: Evaluation, iterations: list[Iteration], step: int, frame: bool) -> None:
        model, row = self.model, self.row(evaluation, step, len(iterations))
        self.rows.append(row)
        self.iterations.append(iterations)
        log.info(
            "step %d  time %.4f  %s  iterations %d",
            step,
            model.system.time,
            "  ".join(f"{c.name} {c.value:.6g} force {row[c.name + '_force']:.6g}" for c in model.controls),
            len(iterations),
        )
        if frame:
            self.add_frame(evaluation)

    def row(self, evaluation: Evaluation, step: int = 0, iterations: int = 0) -> dict[str, float]:
        """The columns of the next converged state of the model, which the evaluation was made at."""
        model = self.model
        row: dict[str, float] = {"step": step, "time": model.system.time}
        for control in model.controls:
            row[control.name] = control.value
            row[f"{control.name}_force"] = control.force(evaluation, model.system.ranks)
        row |= self._term_columns(evaluation)
        row |= self._energy_columns(evaluation)
        return row | {"iterations": iterations}

    def add_frame(self, evaluation: Evaluation) -> None:
        """Keep the state of the last row as a frame."""
        whole = self.model.system.whole.frame(self._frame(evaluation))
        if whole is not None:
            self.frames.append(whole)

    def complete(self) -> None:
        """Columns of the loads that a later step has added to the model: they are zero so far."""
        columns = [column for control in self.model.controls for column in (control.name, f"{control.name}_force")]
        if self.rows and not all(column in self.rows[0] for column in columns):
            self.rows = [{name: row.get(name, 0.0) for name in ("step", "time", *columns)} | row for row in self.rows]

    def _term_columns(self, evaluation: Evaluation) -> dict[str, float]:
        """Columns of tools and of the pairs that touch them, then of all other terms."""
        model, row = self.model, dict[str, float]()
        pairs = [pair for tool in model.tools for pair in tool.pairs]
        for tool in model.tools:
            row |= tool.resultant_columns(evaluation.found, model.system.ranks)
            for pair in tool.pairs:
                row |= pair.columns(evaluation.found[pair], model.system.ranks)
        for term in model.system.terms:
            if term not in pairs:
                own = term.columns(evaluation.found[term], model.system.ranks)
                if term in model.system.others:  # tools write theirs above
                    _check_names(term, own)
                row |= own
        return row

    def _energy_columns(self, evaluation: Evaluation) -> dict[str, float]:
        if self._ahead is not None and self._ahead[0] is evaluation:
            self._work = self._ahead[1]
        else:
            self._work.advance(evaluation)
        self._ahead = None
        energies = self._work.energies
        return {
            "external_work": self._work.value,
            "elastic_energy": energies.elastic,
            "plastic_work": energies.plastic,
            "contact_energy": energies.contact,
            "friction_work": energies.friction,
        }

    def worked(self, evaluation: Evaluation) -> Worked:
        """Balance of the increment to a converged state of the model that is not in the history yet."""
        with self.timing.output:
            ahead = self._work.copy()
            ahead.advance(evaluation)
        self._ahead = evaluation, ahead
        return ahead.since(self._work)

    def balance(self) -> Balance:
        """Balance of energies, forces and moments of each row of the history.

        Returns
        -------
        Balance
            Energies; the drift of the external work from their sum over the largest energy of the run, which falls with
            the square of the increments; and the relative resultants of all external forces, which are as small as
            Newton's method has left them.
        """
        names = ("elastic_energy", "plastic_work", "contact_energy", "friction_work")
        elastic, plastic, contact, friction = (self[name] for name in names)
        forces, moments = np.array(self._work.imbalances).T
        workers = ("loads and supports", "contact beyond the mean", *(tool.name for tool in self.model.tools))
        return Balance(
            step=self["step"],
            time=self["time"],
            external_work=self["external_work"],
            elastic=elastic,
            plastic=plastic,
            contact=contact,
            friction=friction,
            drift=drift(self["external_work"], elastic + plastic + contact + friction),
            force_imbalance=forces,
            moment_imbalance=moments,
            works=dict(zip(workers, np.array(self._work.works).T, strict=True)),
        )

    @property
    def largest_moment(self) -> float:
        """Largest sum of the magnitudes of external forces, times the largest distance of a node from the origin."""
        return self._work.largest_moment

    def volume_change(self) -> VolumeChange:
        """Change of the volume of the sheet at the present state of the model, and its elastic part."""
        return volume_change(self.model)

    def work_memory(self) -> dict[str, Any]:
        """All that the external work of later states follows from, beside the model and its last evaluation."""
        return self._work.memory()

    def recall_work(self, memory: dict[str, Any], evaluation: Evaluation) -> None:
        """Go on with the external work of a run that was kept, from the evaluation of its last state."""
        self._work.recall(memory, evaluation)

    def __getstate__(self) -> dict[str, Any]:
        """For another process: the model goes as its problem, the external work as its numbers."""
        own = {name: value for name, value in vars(self).items() if name not in ("_work", "_ahead")}
        return own | {"work": self.work_memory()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        work = state.pop("work")
        vars(self).update(state)
        self._work, self._ahead = ExternalWork(self.model), None
        self.recall_work(work, self.model.system.evaluate(self.model.state, tangent=False))

    def begin_anew(self, evaluation: Evaluation) -> None:
        """Go on from the last state with loads in the place of tools that have been opened."""
        self._work.begin_anew(evaluation)

    def of_steps(self, first: int, last: int) -> Self:
        """The part of the history within some steps, from the end of the step before; pictures within it are shared."""
        steps = [int(row["step"]) for row in self.rows]
        start = max((n for n, step in enumerate(steps) if step < first), default=0)
        end = max(n for n, step in enumerate(steps) if step <= last) + 1
        part = copy(self)
        part.rows, part.iterations = self.rows[start:end], self.iterations[start:end]
        inside = (frame for frame in self.frames if start <= frame.number < end)
        part.frames = [replace(frame, number=frame.number - start) for frame in inside]
        return part

    def mark(self) -> Mark:
        """The present end of the history, to go back to."""
        return Mark(
            list(self.rows),
            list(self.frames),
            list(self.iterations),
            list(self.events),
            list(self.warnings),
            self._work.copy(),
        )

    def go_back(self, mark: Mark) -> None:
        """Take the history of a mark in place of what there is."""
        self.rows, self.frames, self.iterations = list(mark.rows), list(mark.frames), list(mark.iterations)
        self.events, self.warnings, self._work = list(mark.events), list(mark.warnings), mark.work.copy()

    def note(self, message: str) -> None:
        """Keep an event, lift-off for instance, and log it."""
        self.events.append(message)
        log.info(message)

    def warn(self, message: str) -> None:
        """Keep a warning and log it."""
        self.warnings.append(message)
        log.warning(message)

    @cached_property
    def _undeformed_thickness(self) -> Floats:
        return fields.undeformed_thickness(self.model)

    def _frame(self, evaluation: Evaluation) -> Frame:
        model, residual = self.model, evaluation.residual[: self.model.u.size]
        reaction = model.system.whole.sum_at_nodes(residual.reshape(-1, 3)).copy()
        reaction.ravel()[model.system.free] = 0.0
        points = {
            "displacement": model.u.reshape(-1, 3).copy(),
            "reaction": reaction,
            "thickness_change": fields.thickness_change(model, self._undeformed_thickness),
        }
        if model.system.penalised:
            points["contact_pressure"], points["contact_gap"] = fields.contact_at_nodes(model, evaluation)
        if any(pair.has_friction for pair in model.system.touching):
            points["friction_traction"], points["slip"] = fields.friction_at_nodes(model, evaluation)
        contacts = {contact.name: evaluation.found[contact].points() for contact in model.system.penalised}
        return Frame(len(self.rows) - 1, model.system.time, points, fields.cell_fields(model), contacts)

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, column: str) -> Floats:
        """A column of the history."""
        if not self.rows or column not in self.rows[0]:
            raise InvalidValue(
                "the history has no such column",
                where="the history",
                value=column,
                cause="another name, or that of a measure" if self.rows else "a run without a row",
                remedy="one of " + ", ".join(self.columns()) if self.rows else "a run with a step",
            )
        return np.array([row[column] for row in self.rows])

    def columns(self) -> list[str]:
        """Names of the columns of the history."""
        return list(self.rows[0]) if self.rows else []

    def table(self) -> dict[str, Floats]:
        """History as columns; ``pandas.DataFrame(result.table())`` is a data frame."""
        return {name: self[name] for name in self.columns()}

    def summary(self) -> dict[str, Any]:
        """Numbers that describe the run."""
        return {
            "increments": len(self.rows) - 1,
            "iterations": int(sum(row["iterations"] for row in self.rows)),
            "solver": self.solver,
            "seconds": self.seconds,
            "events": list(self.events),
            "warnings": list(self.warnings),
        }


def _check_names(term: Term, columns: Mapping[str, float]) -> None:
    """Refuse columns that a term has not named: one of another thing of the model would be lost."""
    names = list(term.column_names())
    if set(columns) != set(names):
        raise InvalidValue(
            "a term must write the columns that it names",
            where=repr(term),
            value=f"columns {', '.join(columns) or 'none'}; names {', '.join(names) or 'none'}",
            cause="columns() and column_names() of its class differ",
            remedy="the same names in both, in every increment",
        )
