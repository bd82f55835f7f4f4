"""A run in stages: each has its mesh, bodies and tools, and begins at the end of the previous one.

One stage is a run of :func:`umform.solve`. Between stages a part may be trimmed, remeshed or moved to other tools.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from umform.analysis.run.execute import resume, solve
from umform.analysis.run.result import Result
from umform.analysis.steps import Step
from umform.errors import InvalidValue
from umform.model import Model, Snapshot
from umform.model.transfer.rigid_motion import RigidMotion
from umform.spec import check_arguments


@dataclass(frozen=True)
class Stage:
    """A part of a run with one mesh and one set of bodies.

    Parameters
    ----------
    name : str
        For results and checkpoints: letters, digits, hyphens and underscores.
    build : callable
        Called with the result of the previous stage, None for the first one; returns the model and its steps.

    Examples
    --------
    >>> import umform as uf
    >>> def press(before):
    ...     model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    ...     model.fix("x0")
    ...     return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-0.1, steps=2)
    >>> first = uf.Stage("press", press)
    """

    name: str
    build: Callable[[Result | None], tuple[Model, Sequence[Step] | Step]]

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not re.fullmatch(r"[\w-]+", self.name):
            raise InvalidValue(
                "the name of a stage has letters, digits, hyphens and underscores",
                where="Stage",
                value=self.name,
                cause="it is the name of its checkpoint, too",
                remedy="a name such as draw or trim-1",
            )


class StagedResult:
    """Results of the stages of a run, in order.

    Attributes
    ----------
    results : dict of str to Result
        Result of each stage by its name.
    """

    def __init__(self) -> None:
        self.results: dict[str, Result] = {}

    def __getitem__(self, name: str) -> Result:
        """Result of a stage."""
        if name not in self.results:
            raise InvalidValue(
                "the run has no such stage",
                where="stage",
                value=name,
                cause="a typing mistake, or a stage that was not reached",
                remedy="one of " + (", ".join(self.results) or "none so far"),
            )
        return self.results[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.results)

    def __len__(self) -> int:
        return len(self.results)

    def table(self) -> dict[str, Any]:
        """Concatenated histories of all stages, with the column ``stage``; NaN where a stage lacks a column."""
        columns = dict.fromkeys(name for result in self.results.values() for name in result.columns())
        rows = {name: len(result) for name, result in self.results.items()}
        table: dict[str, Any] = {"stage": np.repeat(list(rows), list(rows.values()))}
        for column in columns:
            parts = [
                result[column] if column in result.columns() else np.full(len(result), np.nan)
                for result in self.results.values()
            ]
            table[column] = np.concatenate(parts)
        return table


def solve_stages(
    stages: Sequence[Stage], *, checkpoints: str | PathLike[str] | None = None, **options: Any
) -> StagedResult:
    """Run stages one after the other.

    Parameters
    ----------
    stages : sequence of Stage
        The stages, in order.
    checkpoints : str or PathLike, optional
        Folder for the checkpoint of each stage. Stages with an existing checkpoint are resumed from it, to the same
        bits; the same call therefore continues a stopped run.
    **options
        See :func:`umform.solve`; they apply to all stages.

    Returns
    -------
    StagedResult
        Results by stage.

    Raises
    ------
    InvalidValue
        If two stages have the same name.
    NoConvergence, FileProblem
        See :func:`umform.solve` and :func:`umform.resume`. An exception carries the results of the stages so far as its
        attribute ``stages``.

    Examples
    --------
    >>> import umform as uf
    >>> def press(before):
    ...     model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    ...     model.fix("x0")
    ...     return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-0.1, steps=2)
    >>> result = uf.solve_stages([uf.Stage("press", press)])
    """
    check_arguments(solve_stages, stages=stages)
    names = [stage.name for stage in stages]
    if not names or len(set(names)) < len(names):
        raise InvalidValue(
            "stages have different names, and there is one at least",
            where="solve_stages",
            value=", ".join(names),
            cause="a name is given twice, or the list is empty",
            remedy='[Stage("press", press), Stage("open", open)]',
        )
    reached, before = StagedResult(), None
    for number, stage in enumerate(stages, start=1):
        file = None if checkpoints is None else Path(checkpoints) / f"{number}-{stage.name}.h5"
        if file is not None:
            file.parent.mkdir(parents=True, exist_ok=True)
        try:
            before = _result_of(stage, before, file, options)
        except BaseException as error:
            error.stages = reached  # type: ignore[attr-defined]
            raise
        reached.results[stage.name] = before
    return reached


def _result_of(stage: Stage, before: Result | None, file: Path | None, options: dict[str, Any]) -> Result:
    try:
        made: object = stage.build(before)
    except Exception as error:
        error.add_note(f"in the function of stage {stage.name}, called as build(result of the stage before, or None)")
        raise
    if not isinstance(made, tuple) or len(made) != 2:
        raise InvalidValue(
            "the function of a stage returns the model and its steps",
            where=f"stage {stage.name}",
            value=type(made).__name__,
            cause="a return that is missing, or the model alone",
            remedy="return model, [Move(control, to=-1.0, steps=10)]",
        )
    model, steps = made
    if file is not None and file.exists():
        return resume(file, model, steps, **options)
    return solve(model, steps, checkpoint=file, **options)


def continued(model: Model, before: Result, motion: RigidMotion | None = None) -> Model:
    """Start a model of the same mesh and bodies from the final state of a run.

    Parameters
    ----------
    model : Model
        The model of the next stage, with its tools, supports and loads. Supports that are activated later with
        ``here=True`` hold the nodes in their positions at that time.
    before : Result
        Result of the stage before.
    motion : RigidMotion, optional
        Rigid motion of the part before the stage, into other tools for instance. eq. (5.91)
        Give its contacts a penalty then: the default is estimated from the undeformed sheet, which lies elsewhere.

    Returns
    -------
    Model
        The model.

    Raises
    ------
    InvalidValue
        If the meshes or the bodies differ.
    """
    old = before.model
    same = np.array_equal(old.mesh.connectivity, model.mesh.connectivity) and np.array_equal(
        old.mesh.points, model.mesh.points
    )
    bodies = [(body.name, body.element, body.material, body.cells.tolist()) for body in model.bodies]
    if not same or bodies != [(b.name, b.element, b.material, b.cells.tolist()) for b in old.bodies]:
        raise InvalidValue(
            "a stage continues with the mesh and the bodies of the stage before",
            where="continued()",
            cause="another mesh, element or law",
            remedy="build the model from the mesh and the bodies of the stage before; values on another mesh are not "
            "interpolated",
        )
    state = old.system.snapshot()
    terms = {body.key: state.terms[body.key] for body in old.bodies}
    u = state.u if motion is None else motion.displacement(old.mesh.points, state.u)
    model.system.restore(Snapshot(u, terms=terms))
    return model
