"""Derivatives of the results of a run with respect to its parameters. docs/theory, 5.17"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import is_dataclass
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import Result
from umform.analysis.shadows import Shadowed, resume_with_shadows, solve_stages_with_shadows, solve_with_shadows
from umform.analysis.shadows.structure import relative_motion
from umform.errors import InvalidPath, InvalidValue, UmformError
from umform.problem.errors import slip
from umform.problem.problem import Problem
from umform.processes.problems import has_operations
from umform.progress import Show
from umform.results.quantity import Quantity
from umform.spec import Scalar, check_value, each
from umform.spec.types import Count
from umform.studies.derivatives.found import Derivatives
from umform.studies.derivatives.responses import responses
from umform.studies.derivatives.subjects import (
    Built,
    OfCase,
    OfChain,
    OfFunction,
    OfProblem,
    Subject,
    refuse_other_structure,
    refuse_same_model,
)

#: Change of a parameter relative to its value; in thicknesses the farthest that tools and sheet may be off by it, such
#: as by a coordinate far from the origin; and the least part of the change then.
STEP, _FARTHEST, _LEAST = 3e-5, 1e-4, 1e-3
#: Numbers of a thing of which a message lists all; more are those of a problem, which `umform paths` lists.
_FEW = 40
#: Tables of a problem whose numbers are no parameters of the part: their effect is an error of the solution.
_OF_THE_SOLUTION = ("solution.", "output.")


def derivatives(
    subject: Any,
    by: str | Sequence[str] | Mapping[str, float],
    of: str | Sequence[str | Callable[[Result], float | Quantity]] | None = None,
    *,
    hold: Mapping[str, str] | None = None,
    options: NewtonOptions | None = None,
    solver: str | None = None,
    frames: Count = 1,
    progress: Show = None,
    checkpoint: str | PathLike[str] | None = None,
) -> Derivatives:
    """Run a problem, and find the derivatives of its results with respect to some parameters.

    Beside the run, shadows repeat its increments with one parameter changed a little, with the factors of its tangents;
    a reference solves the same increments to round-off. No law, tool or step needs code for it. The path of the run is
    frozen: increments, and the points of a pace, are those of the run. The end of a release is an equation.

    Parameters
    ----------
    subject : Problem, case of a process, or callable
        A problem; a case such as `AirBending` or `BendSequence` with strokes; or a function that is called with the
        parameters and returns a model and its steps.
    by : str, sequence of str, or mapping of str to float
        Paths, see `Problem.paths`; parameters with their values for a function.
    of : sequence of str or callable, optional
        Quantities, columns of the history such as ``punch_force:max`` (or last, min, peak, sum), and functions of a
        result. Default: all quantities, or the last and the largest force of each control.
    hold : mapping of str to str, optional
        Responses that stay constant, each by a parameter that follows: ``{"angle": "stroke"}`` gives the derivatives at
        the stroke that keeps the angle.
    options, solver
        Those of the run, for a function.
    frames : int
        Approximate number of states kept in each step; at least as many as the quantities follow from.
    progress : bool or callable, optional
        Show a progress bar.
    checkpoint : str or PathLike, optional
        File for the state of the run and of its shadows, or a folder for the files of several operations; the same call
        continues from it, to the same bits.

    Returns
    -------
    Derivatives
        Of quantities, of columns of the history, and of the displacement.

    Raises
    ------
    InvalidValue
        A parameter does not exist, or cannot be varied; ``where`` is its path.
    NoConvergence
        The run does not converge.
    FileProblem
        The checkpoint is that of another run, or cannot be written.

    Examples
    --------
    >>> import umform as uf
    >>> def build(E):
    ...     model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=E, nu=0.3))
    ...     model.fix("x0")
    ...     return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-0.1, steps=2)
    >>> found = uf.derivatives(build, by={"E": 210e3}, of=["tip_force"])
    >>> round(found["tip_force", "E"].relative, 6)
    1.0
    """
    for name, value in {"by": by, "of": each(of), "hold": hold, "frames": frames}.items():
        check_value(derivatives, name, value)
    thing = subject_of(subject, by, options, solver)
    known = {one.path: one for one in thing.parameters()}
    held = held_by(hold or {}, known)
    names = list(dict.fromkeys([*names_of(thing, by), *held.values()]))
    if not names:
        raise InvalidValue(
            "there is no parameter for derivatives",
            where="by",
            cause="an empty list",
            remedy='by=["thickness"], for instance',
        )
    parameters = list({one.path: one for one in (known_parameter(name, known) for name in names)}.values())
    if parameters and {one.path for one in parameters} <= set(held.values()):
        refuse_followers(parameters, held, "by")
    of = None if of is None else list(dict.fromkeys(each(of)))
    lead = thing.build()
    shadows, sizes = {}, {}
    for one in parameters:
        shadows[one.path], sizes[one.path] = _shadow(thing, one, lead)
    again = thing.build()
    refuse_same_model([lead, again, *(built for _, built in shadows.values())])
    thing.refuse_unknown(lead, of or ())
    functions = {getattr(one, "__name__", "number") for one in of or () if not isinstance(one, str)}
    thing.refuse_unknown(lead, [name for name in held if name not in functions], "hold")
    others = {path: built for path, (_, built) in shadows.items()}
    found = _run(lead, again, others, checkpoint, frames=max(frames, lead.frames), progress=progress)
    runs = [one.run for one in found.values()]
    quantities = thing.quantities(lead, *runs)
    wanted = responses(of, quantities, runs[-1])
    more = [name for name in held if name not in {one.name for one in wanted}]
    wanted += responses(more, quantities, runs[-1], "hold")

    def measured(other: Subject, built: Built, results: Sequence[Result]) -> list[float | None]:
        numbers = {one.name: one.value for one in other.quantities(built, *results)}
        return [one.value(numbers, results[-1]) for one in wanted]

    *_, last = found.values()
    rows = {
        path: measured(other, built, [one.shadows[path] for one in found.values()])
        for path, (other, built) in shadows.items()
        if not last.kept[path].lost
    }
    base = measured(thing, lead, [one.reference for one in found.values()]) if rows else []
    whole = Derivatives.of(parameters, sizes, wanted, base, rows, found, thing.main(*runs))
    return whole.holding(held) if held else whole


def _run(
    lead: Built,
    reference: Built,
    shadows: Mapping[str, Built],
    checkpoint: str | PathLike[str] | None,
    **show: Any,
) -> dict[str, Shadowed]:
    """Run all operations with their shadows, or go on with them."""
    show |= {"solver": lead.solver, "options": lead.options}
    if lead.after:
        others = {path: built.stages for path, built in shadows.items()}
        return solve_stages_with_shadows(
            lead.stages, others, reference=reference.stages, checkpoints=checkpoint, **show
        )
    how: Callable[..., Shadowed] = solve_with_shadows
    if checkpoint is not None:
        goes_on = Path(checkpoint).exists()
        how = partial(resume_with_shadows, checkpoint) if goes_on else partial(how, checkpoint=checkpoint)
    pairs = {path: (built.model, built.steps) for path, built in shadows.items()}
    return {lead.name: how((lead.model, lead.steps), (reference.model, reference.steps), pairs, **show)}


def subject_of(subject: Any, by: Any, options: NewtonOptions | None = None, solver: str | None = None) -> Subject:
    """What derivatives are taken of, from what a user gives; one that is made already stays as it is.

    Raises
    ------
    InvalidValue
        A function without the values of its parameters, or something else.
    """
    if isinstance(subject, OfProblem | OfCase | OfFunction):
        return subject
    if isinstance(subject, Problem):
        return OfProblem(subject)
    if callable(subject) and not hasattr(subject, "__dataclass_fields__"):
        if not isinstance(by, Mapping):
            raise InvalidValue(
                "a function needs the values of its parameters",
                where="by",
                value=by,
                cause="names alone",
                remedy='by={"radius": 2.0}',
            )
        return OfFunction(subject, dict(by), options, solver or "auto")
    if not is_dataclass(subject) or isinstance(subject, type):
        raise InvalidValue(
            "parameters are those of a problem, of a case of a process, or of a function",
            where="subject",
            value=type(subject).__name__,
            cause="a model, which forgets the numbers that it was made with",
            remedy="a function that takes the numbers and returns model and steps",
        )
    return OfChain(subject) if has_operations(subject) else OfCase(subject)


def names_of(
    thing: Subject, by: str | Sequence[str] | Mapping[str, float], where: str = "by", remedy: str = ""
) -> list[str]:
    """Names of parameters; only a function takes their values beside them.

    Raises
    ------
    InvalidValue
        Values for a case or a problem, which has its own.
    """
    if isinstance(by, Mapping) and not isinstance(thing, OfFunction):
        raise InvalidValue(
            "values beside names are those of a function",
            where=where,
            value=by,
            cause="a case or a problem has values of its own",
            remedy=remedy or f"{where}={list(by)}; compensate takes bounds={{path: (low, high)}} beside it",
        )
    return list(each(by))


def paths_of(name: str, known: Mapping[str, Scalar]) -> list[str]:
    """The paths that a name may mean: itself, or those of which it is the last parts."""
    parts = name.split(".")
    return [name] if name in known else [one for one in known if one.split(".")[-len(parts) :] == parts]


def known_parameter(path: str, known: Mapping[str, Scalar], where: str = "by") -> Scalar:
    """The number of a path, or of the last parts of one, if that is unique.

    Raises
    ------
    InvalidPath
        There is none, there are several, or it is no parameter of the part; ``where`` is the argument with the path.
    """
    found = paths_of(path, known)
    if len(found) != 1:
        all_of_them = f"one of {', '.join(known)}" if len(known) <= _FEW else "one of the paths that umform paths lists"
        raise InvalidPath(
            "a path is ambiguous" if found else "there is no number of this path",
            where=where,
            value=path,
            cause=slip(path, [*known, *(one.split(".")[-1] for one in known)]) if not found else ", ".join(found),
            remedy=f"write more of it, as {found[0]}" if found else all_of_them,
        )
    one = known[found[0]]
    why, remedy = "", "umform sweep varies it"
    if found[0].startswith(_OF_THE_SOLUTION):
        why = "its effect is an error of the solution, not a change of the part"
    elif isinstance(one.value, bool) or not isinstance(one.value, int | float | np.number):
        why, remedy = "it is no number", "leave it to the function, or to the deck"
    elif isinstance(one.value, int | np.integer):
        why, remedy = "it is a whole number", f"{one.value}.0 in a deck, if it is no count; else {remedy}"
    if why:
        raise InvalidPath("this number has no derivative", where=found[0], value=one.value, cause=why, remedy=remedy)
    return one


def held_by(hold: Mapping[str, str], known: Mapping[str, Scalar]) -> dict[str, str]:
    """Paths of the parameters that follow, by the results that they keep constant.

    Raises
    ------
    InvalidPath
        As of `known_parameter`.
    InvalidValue
        One parameter follows two results.
    """
    held = {name: known_parameter(path, known, "hold").path for name, path in hold.items()}
    paths = list(held.values())
    if twice := sorted({path for path in paths if paths.count(path) > 1}):
        raise InvalidValue(
            "a parameter keeps one result constant",
            where="hold",
            value=", ".join(f"{name} by {path}" for name, path in held.items() if path in twice),
            cause="two results with one parameter",
            remedy="a parameter of its own for each result",
        )
    return held


def known_parameters(
    subject: Any, by: Sequence[str], where: str = "by", hold: Mapping[str, str] | None = None
) -> list[Scalar]:
    """The numbers of some paths of a subject, each once.

    Raises
    ------
    InvalidPath
        As of `known_parameter`, or one of them follows a result that is held.
    """
    known = {one.path: one for one in subject_of(subject, by, None, None).parameters()}
    found = list({one.path: one for one in (known_parameter(name, known, where) for name in by)}.values())
    refuse_followers(found, hold or {}, where)
    return found


def refuse_followers(parameters: Sequence[Scalar], hold: Mapping[str, str], where: str) -> None:
    """Refuse derivatives by a parameter that is adjusted to keep a result.

    Raises
    ------
    InvalidPath
    """
    kept = {path: name for name, path in hold.items()}
    for one in parameters:
        if one.path in kept:
            raise InvalidPath(
                "a parameter that follows has no derivative",
                where=where,
                value=one.path,
                cause=f"it is adjusted to keep {kept[one.path]}",
                remedy="another parameter, or a value of its own for this one in place of the result",
            )


def _shadow(thing: Subject, one: Scalar, lead: Built) -> tuple[tuple[Subject, Built], float]:
    """The thing with a slightly larger value, or a smaller one if that is refused; and the change.

    Raises
    ------
    InvalidValue
        Both are refused.
    """
    size = STEP * (abs(one.value) or 1.0)
    refusal: UmformError | None = None
    for change in (size, -size):
        try:
            made = _varied(thing, one, change, lead)
            off = relative_motion(lead.model, made[1].model)
            if off > _FARTHEST:
                change *= max(_FARTHEST / off, _LEAST)
                made = _varied(thing, one, change, lead)
        except UmformError as error:
            refusal = refusal or error
        else:
            return made, change
    raise InvalidValue(
        "this number cannot be varied",
        where=one.path,
        value=one.value,
        cause=str(refusal).splitlines()[0] if refusal else "",
        remedy=getattr(refusal, "remedy", "") or "another parameter",
    )


def _varied(thing: Subject, one: Scalar, change: float, lead: Built) -> tuple[Subject, Built]:
    """The thing with another value, and its model, which has the structure of the first one."""
    other = thing.with_({one.path: one.value + change})
    built = other.build()
    refuse_other_structure(one.path, lead, built)
    return other, built
