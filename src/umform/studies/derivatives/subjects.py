"""What derivatives are taken of: a problem, a case of a process, or a function of the user that builds a model."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Protocol, Self

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import Result, solve
from umform.analysis.run.stages import Stage
from umform.analysis.shadows.structure import other_structure
from umform.analysis.steps import Step
from umform.errors import InvalidValue
from umform.model import Model
from umform.problem.measured import Taken, may_report, names_begin
from umform.problem.prepared import Prepared
from umform.problem.problem import Problem
from umform.processes.problems import Operation, frames_of, operations_of, outcome_of, problem_of, quantities_named
from umform.progress import Show
from umform.results.quantity import Quantity
from umform.spec import Scalar, changed, scalars
from umform.studies.sweep.foreseen import refuse_unknown
from umform.studies.sweep.measures import Function


@dataclass(frozen=True)
class Built:
    """A model that can be run, what it was made from, and the operations after it.

    Attributes
    ----------
    model : Model
        The model.
    steps : sequence of Step
        Its steps.
    solver : str
        Sparse solver.
    options : NewtonOptions, optional
        Options of Newton's method.
    prepared : Prepared, optional
        The problem that it belongs to.
    after : sequence of Stage
        Operations after it, with the same solver and options.
    alike : sequence of tuple of Model and steps
        Those of them that are known without a run, in another state.
    name : str
        Name of the first operation.
    frames : int
        States of each step that its numbers follow from.
    """

    model: Model
    steps: Sequence[Step]
    solver: str = "auto"
    options: NewtonOptions | None = None
    prepared: Prepared | None = None
    after: Sequence[Stage] = ()
    alike: Sequence[tuple[Model, Sequence[Step]]] = ()
    name: str = "run"
    frames: int = 1

    @classmethod
    def of(cls, prepared: Prepared, frames: int = 1) -> Self:
        """That of a problem."""
        return cls(prepared.model, prepared.steps, prepared.solver, prepared.options, prepared, frames=frames)

    @property
    def stages(self) -> list[Stage]:
        """All operations; the first one is this model."""
        return [Stage(self.name, lambda before: (self.model, self.steps)), *self.after]

    def solve(self, progress: Show = None) -> list[Result]:
        """Run all operations, with the frames that the numbers follow from."""
        found: list[Result] = []
        for stage in self.stages:
            model, steps = stage.build(found[-1] if found else None)
            settings = {"solver": self.solver, "options": self.options}
            found.append(solve(model, steps, **settings, frames=self.frames, progress=progress))  # type: ignore[arg-type]
        return found


class Subject(Protocol):
    """A thing with parameters that can be built, and whose results are numbers."""

    @property
    def given(self) -> Any:
        """The thing itself: a problem, a case, a function."""

    @property
    def settings(self) -> dict[str, Any]:
        """Options and solver of a run that the thing itself does not have."""

    def parameters(self) -> list[Scalar]:
        """All numbers that can be varied."""

    def with_(self, changes: Mapping[str, float]) -> Subject:
        """The same with other values."""

    def build(self) -> Built:
        """The model and its steps."""

    def refuse_unknown(self, built: Built, wanted: Sequence[str | Function], where: str = "of") -> None:
        """Refuse names of results that its run cannot have, as far as they are known before."""

    def quantities(self, built: Built, *results: Result) -> list[Quantity]:
        """Its numbers after a run of each operation."""

    def main(self, *results: Result) -> Sequence[str]:
        """Names of the numbers that it is for."""


@dataclass(frozen=True)
class OfProblem:
    """A problem, whose measures are its numbers."""

    problem: Problem
    settings: dict[str, Any] = field(default_factory=dict)

    @property
    def given(self) -> Problem:
        """The problem."""
        return self.problem

    def parameters(self) -> list[Scalar]:
        """Numbers of the problem."""
        return self.problem.paths()

    def with_(self, changes: Mapping[str, float]) -> OfProblem:
        """The problem with other values."""
        return OfProblem(self.problem.with_(changes))

    def build(self) -> Built:
        """Its model."""
        return Built.of(self.problem.build())

    def refuse_unknown(self, built: Built, wanted: Sequence[str | Function], where: str = "of") -> None:
        """Refuse what is neither of its measures nor of its history."""
        contents = self.problem.contents
        others = [one for one in wanted if not (isinstance(one, str) and may_report(contents, one))]
        refuse_unknown(others, names_begin(contents), built.model, built.steps, where)

    def quantities(self, built: Built, *results: Result) -> list[Quantity]:
        """Its measures."""
        assert built.prepared is not None
        return Taken.of(self.problem, built.prepared, results[-1], complete=True).quantities

    def main(self, *results: Result) -> Sequence[str]:
        """Empty: no quantity is the main one."""
        del results
        return ()


@dataclass(frozen=True)
class OfCase:
    """A case of a process, such as `AirBending` with a stroke."""

    case: Any
    settings: dict[str, Any] = field(default_factory=dict)

    @property
    def given(self) -> Any:
        """The case."""
        return self.case

    def parameters(self) -> list[Scalar]:
        """Numbers of the case."""
        return list(scalars(self.case))

    def with_(self, changes: Mapping[str, float]) -> OfCase:
        """The case with other values."""
        return OfCase(changed(self.case, changes))

    def build(self) -> Built:
        """The model of its problem."""
        return Built.of(problem_of(self.case).build(), frames_of(self.case))

    def refuse_unknown(self, built: Built, wanted: Sequence[str | Function], where: str = "of") -> None:
        """Refuse what is neither of the quantities of its process nor of the history of its last operation."""
        names = quantities_named(self.case)
        if names is not None:
            model, steps = [(built.model, built.steps), *built.alike][-1]
            refuse_unknown(wanted, names, model, steps, where)

    def quantities(self, built: Built, *results: Result) -> list[Quantity]:
        """Quantities that the process reports."""
        del built
        return outcome_of(self.case, *results).quantities

    def main(self, *results: Result) -> Sequence[str]:
        """Names of the main quantities of the process."""
        return outcome_of(self.case, *results).main


@dataclass(frozen=True)
class OfChain(OfCase):
    """A case of a process of several operations, such as `BendSequence` with strokes."""

    def with_(self, changes: Mapping[str, float]) -> OfChain:
        """The case with other values."""
        return OfChain(changed(self.case, changes))

    def build(self) -> Built:
        """The model of its first operation."""
        first, *after = operations_of(self.case)
        made = Built.of(first.problem(None).build())
        alike = [_built(one, None) for one in after if one.alone]
        stages = [Stage(one.name, partial(_built, one)) for one in after]
        return replace(made, after=stages, alike=alike, name=first.name)


def _built(operation: Operation, before: Result | None) -> tuple[Model, Sequence[Step]]:
    made = operation.problem(before).build()
    return made.model, made.steps


@dataclass(frozen=True)
class OfFunction:
    """A function of the user that builds a model and its steps from named numbers."""

    function: Callable[..., tuple[Model, Sequence[Step] | Step]]
    values: Mapping[str, float] = field(default_factory=dict)
    options: NewtonOptions | None = None
    solver: str = "auto"

    @property
    def given(self) -> Callable[..., tuple[Model, Sequence[Step] | Step]]:
        """The function."""
        return self.function

    @property
    def settings(self) -> dict[str, Any]:
        """Options and solver."""
        return {"options": self.options, "solver": self.solver}

    def parameters(self) -> list[Scalar]:
        """The numbers."""
        return [Scalar(name, value) for name, value in self.values.items()]

    def with_(self, changes: Mapping[str, float]) -> OfFunction:
        """Other values."""
        return OfFunction(self.function, {**self.values, **changes}, self.options, self.solver)

    def build(self) -> Built:
        """The model and the steps that the function returns."""
        name = getattr(self.function, "__name__", "the function")
        try:
            made = self.function(**self.values)
        except Exception as error:
            values = ", ".join(f"{one}={value!r}" for one, value in self.values.items())
            error.add_note(f"in the function of the parameters, called as {name}({values})")
            raise
        if not isinstance(made, tuple) or len(made) != 2 or not isinstance(made[0], Model):
            raise InvalidValue(
                "a function of parameters returns a model and its steps",
                where=name,
                value=type(made).__name__,
                remedy="return model, [Move(...), Release(...)]",
            )
        model, steps = made
        return Built(model, [steps] if isinstance(steps, Step) else list(steps), self.solver, self.options)

    def refuse_unknown(self, built: Built, wanted: Sequence[str | Function], where: str = "of") -> None:
        """Refuse what is not of its history."""
        refuse_unknown(wanted, (), built.model, built.steps, where)

    def quantities(self, built: Built, *results: Result) -> list[Quantity]:
        """Empty: a function names the columns that it wants."""
        del built, results
        return []

    def main(self, *results: Result) -> Sequence[str]:
        """Empty: no quantity is the main one."""
        del results
        return []


def refuse_other_structure(path: str, one: Built, other: Built) -> None:
    """Refuse a parameter that changes the topology of the mesh, controls, contacts, or the kinds of steps.

    Raises
    ------
    InvalidValue
        They differ.
    """
    pairs = zip([(one.model, one.steps), *one.alike], [(other.model, other.steps), *other.alike], strict=False)
    cause = next(filter(None, (other_structure(*each, *another) for each, another in pairs)), "")
    if cause:
        raise InvalidValue(
            "elements and steps change with a slightly different value",
            where=path,
            value=cause,
            cause="their number follows from it",
            remedy="give the numbers of elements and steps, or a value a little off",
        )


def refuse_same_model(builds: Sequence[Built]) -> None:
    """Refuse models that are built once for several runs: each run has its own state.

    Raises
    ------
    InvalidValue
        Two of them are one object.
    """
    if len({id(one.model) for one in builds}) < len(builds):
        raise InvalidValue(
            "a function returns the same model twice",
            where="the function of the parameters",
            value=builds[0].model,
            cause="it keeps the model, or was given it",
            remedy="build a new mesh, model and steps in each call",
        )
