"""Stages of a run with its shadows: each continues from its own result of the previous stage. docs/theory, 5.17"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

from umform.analysis.run.result import Result
from umform.analysis.run.stages import Stage
from umform.analysis.shadows.group import Built, Shadowed, resume_with_shadows, solve_with_shadows
from umform.analysis.shadows.shadow import Kept
from umform.analysis.steps import Step
from umform.errors import NoConvergence


def solve_stages_with_shadows(
    stages: Sequence[Stage],
    shadows: Mapping[Any, Sequence[Stage]],
    *,
    reference: Sequence[Stage] | None = None,
    checkpoints: str | PathLike[str] | None = None,
    **options: Any,
) -> dict[str, Shadowed]:
    """Run stages one after the other, each with its shadows.

    Parameters
    ----------
    stages : sequence of Stage
        The stages, in order.
    shadows : mapping of object to sequence of Stage
        The stages with one parameter changed a little.
    reference : sequence of Stage, optional
        Those of the reference; default: built by the same functions, which then return a new model in each call.
    checkpoints : str or PathLike, optional
        Folder for the checkpoint of each stage; the same call continues a stopped run.
    **options
        See :func:`solve_with_shadows`.

    Returns
    -------
    dict of str to Shadowed
        By the name of the stage. A shadow that was lost is none of the later stages, and marked there.

    Raises
    ------
    InvalidValue
        If a stage of a shadow has other elements or steps: a cut that moves must keep the elements.
    NoConvergence
        If a stage fails, or if a later one would go on from a reference that was lost.
    """
    found: dict[str, Shadowed] = {}
    lost: dict[Any, Kept] = {}
    before: Shadowed | None = None
    for number, stage in enumerate(stages):
        lead = _built(stage, None if before is None else before.run)
        level = _built((reference or stages)[number], None if before is None else before.reference)
        others = {
            key: _built(own[number], None if before is None else before.shadows[key])
            for key, own in shadows.items()
            if key not in lost
        }
        before = _how(checkpoints, number, stage.name)(lead, level, others, **options)
        found[stage.name] = replace(before, kept={**before.kept, **lost})
        last = number == len(stages) - 1
        if before.missing and not last:
            raise NoConvergence(
                "the derivatives end in this stage",
                where=f"stage {stage.name}",
                value=before.missing,
                cause="the run has no solution to round-off there",
                remedy="smaller increments; or solve_stages without shadows",
            )
        lost |= {
            key: Kept(lost=f"stage {stage.name}: {kept.lost}", from_row=0)
            for key, kept in before.kept.items()
            if kept.lost
        }
    return found


def of_all(stages: Mapping[str, Shadowed]) -> Shadowed:
    """The last stage, with what each shadow has kept in all of them."""
    *_, last = stages.values()
    kept = {}
    for key, one in last.kept.items():
        each = [stage.kept[key] for stage in stages.values()]
        kept[key] = replace(
            one,
            residual=max(other.residual for other in each),
            switched=[count for other in each for count in other.switched],
            own=sum(other.own for other in each),
        )
    return replace(last, kept=kept)


def _built(stage: Stage, before: Result | None) -> Built:
    model, steps = stage.build(before)
    return model, [steps] if isinstance(steps, Step) else list(steps)


def _how(folder: str | PathLike[str] | None, number: int, name: str) -> Callable[..., Shadowed]:
    """What runs a stage, or goes on with it from its checkpoint."""
    if folder is None:
        return solve_with_shadows
    file = Path(folder) / f"{number + 1}-{name}.h5"
    file.parent.mkdir(parents=True, exist_ok=True)
    return partial(resume_with_shadows, file) if file.exists() else partial(solve_with_shadows, checkpoint=file)
