"""Remove supports and open tools gradually: their forces become loads, which decrease to zero."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from umform.analysis.newton.newton import Newton
from umform.analysis.steps.move import Move
from umform.analysis.steps.moving import Marching
from umform.analysis.steps.run_state import Run, Take
from umform.errors import InvalidValue
from umform.model import Model, Tool
from umform.model.changes.opening import fading_tool, open_tool
from umform.model.changes.removal import fading, put_back, put_supports, remove, states_of_supports
from umform.model.contact import Contact
from umform.model.supports.support import Support
from umform.model.terms.control import Control
from umform.model.terms.term import Tree
from umform.spec import check_fields, names_its_words
from umform.spec.types import Cuts, Duration, Growth, Increments


@names_its_words
@dataclass(frozen=True)
class Free:
    """Remove supports and open tools; their forces become dead loads that decrease to zero over the step.

    The history has the columns ``<name>`` and ``<name>_force`` of a support, ``<name>_left`` and ``<name>_left_force``
    of a tool, from the beginning of the run: the remaining part of the forces, zero before the step.

    An opened tool keeps its position, and the sheet springs back as if the tool did not exist. With all tools in one
    step, on a support from :meth:`umform.Model.hold_rigid`, the part ends free of external forces. Decreasing forces do
    not stabilise: a wall that is ironed between two tools buckles under them. Open these tools in two steps, so that
    the part lies on one of them while the forces of the other decrease.

    Examples
    --------
    >>> import umform as uf
    >>> model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    >>> clamp, rest = model.fix("x0"), model.fix("x1_lower", "z")
    >>> load = model.force("x1_upper", (0.0, 0.0, -0.1), "load")
    >>> result = uf.solve(model, [uf.Move(load, to=1.0, steps=1), uf.Free(rest, steps=2)])
    """

    support: Support | Tool | Contact | Sequence[Support | Tool | Contact]
    """What ``fix``, ``symmetry``, ``hinge``, ``hold_director``, ``tool`` or ``contact`` of the model returned, one or
    several; with a contact its tool opens."""
    steps: Increments = 10
    """Number of equal increments."""
    cuts: Cuts = Move.cuts
    """How often an increment may be halved before the run fails."""
    grow: Growth = 1.0
    """Largest increment relative to the nominal one."""
    on: Support | None = None
    """What ``hold_rigid`` of the model returned: it holds its nodes in their positions at the beginning of the step."""
    time: Duration = Move.time
    """Duration of the step: for rate-dependent metals, and for motions of tools in time."""

    def __post_init__(self) -> None:
        for thing in self.things:
            if not isinstance(thing, Support | Tool):
                raise InvalidValue(
                    "a step Free takes a support, a tool or several of them",
                    where="Free",
                    value=thing,
                    cause="a control, or the name of a set",
                    remedy="what fix(), symmetry(), hinge(), hold_director(), tool() or contact() returned; Release "
                    "for a control",
                )
        if self.on is not None and not (isinstance(self.on, Support) and self.on.waits):
            raise InvalidValue(
                "a step Free puts a support in place that waits",
                where="Free, on",
                value=self.on,
                cause="a support that acts already, or something else",
                remedy="what hold_rigid() of the model returned",
            )
        check_fields(self)

    @property
    def things(self) -> list[Support | Tool]:
        """Supports and tools, in the given order, each once: several contacts may have one tool."""
        given = list(self.support) if isinstance(self.support, Sequence) else [self.support]
        own = [thing.tool if isinstance(thing, Contact) else thing for thing in given]
        return [thing for number, thing in enumerate(own) if thing not in own[:number]]

    def prepare(self, model: Model) -> None:
        """Make the loads that replace the removed objects, so that the history has their columns."""
        for thing in self.things:
            if isinstance(thing, Tool):
                fading_tool(model.system, thing)
            else:
                fading(model.system, thing)

    def moved(self) -> list[Control]:
        """The loads that replace supports and tools."""
        return [thing.load for thing in self.things if thing.load is not None]

    def move(self) -> Move:
        """The step as a move of the loads."""
        loads = self.moved()
        return Move(loads, [0.0] * len(loads), self.steps, self.cuts, self.grow, time=self.time)


class Freeing(Marching):
    """Moves the replacing loads; supports and tools are removed when the first increment converges."""

    @classmethod
    def begin(cls, run: Run, step: Free) -> Self:  # type: ignore[override]
        """The loop at the beginning of the step."""
        return cls([1.0] * len(step.things), run.model.system.time, 1.0 / step.steps)

    @classmethod
    def recall(cls, run: Run, step: Free, memory: dict[str, object]) -> Self:  # type: ignore[override]
        """The restored loop."""
        return super().recall(run, step.move(), memory)

    def _newton(self, run: Run) -> Newton:
        return run.newton.but(springs_back=True)

    def follow(self, run: Run, step: Free, lead: Run, take: Take) -> None:  # type: ignore[override]
        """Repeat the last accepted increment of the loop of a leading run."""
        if self.fraction == 0.0:
            _let_go(run, step)
        super().follow(run, step.move(), lead, take)

    def advance(self, run: Run, step: Free) -> None:  # type: ignore[override]
        """Try one increment; until one has converged, supports and tools are active between attempts."""
        before = _Before(run, step) if self.fraction == 0.0 else None
        try:
            if before is not None:
                _let_go(run, step)
            super().advance(run, step.move())
        finally:
            if before is not None and self.fraction == 0.0:
                before.restore(run)


def _let_go(run: Run, step: Free) -> None:
    """Remove all; loads of factor 1 hold the sheet in equilibrium."""
    model = run.model
    for support in (thing for thing in step.things if isinstance(thing, Support)):
        remove(model.system, support)
    if step.on is not None:  # it may hold nodes of the removed supports
        put_back(model.system, step.on)
    for tool in (thing for thing in step.things if isinstance(thing, Tool)):
        open_tool(model.system, tool)
    if any(isinstance(thing, Tool) for thing in step.things):
        run.evaluation = model.system.evaluate(model.system.x, tangent=False)
        run.result.begin_anew(run.evaluation)


class _Before:
    """State of supports and tools before the step."""

    def __init__(self, run: Run, step: Free) -> None:
        self._tools = [thing for thing in step.things if isinstance(thing, Tool)]
        self._supports = states_of_supports(run.model.system)
        self._states: list[Tree] = [tool.state() for tool in self._tools]
        self._forces = {press.force: press.force.value for tool in self._tools for press in tool.presses}
        self._loads, self._evaluation, self._mark = step.moved(), run.evaluation, run.result.mark()

    def restore(self, run: Run) -> None:
        """Restore supports and tools."""
        put_supports(run.model.system, self._supports)
        for tool, state in zip(self._tools, self._states, strict=True):
            tool.restore(state)
        for force, value in self._forces.items():
            force.value = value
        for load in self._loads:
            load.value = 0.0
        run.evaluation, warnings = self._evaluation, list(run.result.warnings)
        run.result.go_back(self._mark)
        run.result.warnings = warnings
        run.model.system.stand(run.evaluation)
