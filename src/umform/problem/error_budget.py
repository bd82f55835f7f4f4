"""Error budget of a deck: changes of its numbers by coarser runs, and the bands that follow."""

from __future__ import annotations

import math

from umform.analysis.run import Result
from umform.errors import UmformError
from umform.pool import run_all
from umform.problem.coarser import MESH, Changes, coarser
from umform.problem.forming import forming_numbers
from umform.problem.measured import Taken
from umform.problem.prepared import Prepared
from umform.problem.problem import Problem
from umform.progress import progress_bar
from umform.results.budget import Budget
from umform.results.quantity import Quantity, values

#: Factor on the changes by coarser variants, with which nine of ten finer answers lie in their bands (docs/bands.md).
SAFETY = 1.5
#: What is missing without a coarser mesh.
_NO_MESH = (
    "; the mesh has no coarser one (it is from a file, of the operation before, or of bonded sheets whose nodes would "
    "not meet) and is not in it"
)
#: Behind the name of a control: its force.
_FORCE = "_force"
#: Significant digits of a column, and the part of its largest value that is round-off.
_DIGITS, _ROUND_OFF = 6, 1e-6


def error_budget(
    deck: Problem,
    problem: Prepared,
    result: Result,
    taken: Taken,
    *,
    processes: int | None = None,
    progress: bool | None = None,
) -> Taken:
    """Run coarser variants of a deck, one source of error at a time.

    Elements twice as long, increments twice as large, two thickness points less, one contact point less, half the
    penalty, looser tolerances where they are loose already. A number that converges at least with the first power of
    these changes by its error or more; a factor is for those that agree by chance. All but the mesh are varied on the
    coarser mesh, where there is one. The runs go in parallel processes, which are spawned.

    Parameters
    ----------
    deck : Problem
        The deck.
    problem : Prepared
        What it built.
    result : Result
        Its run, which gets the warnings of variants that failed.
    taken : Taken
        Its measures.
    processes : int, optional
        Number of processes; default: that of the processors.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.

    Returns
    -------
    Taken
        The measures, controls and their forces at the end of each step, and the largest values of forming if the deck
        asks for them, with their bands.
    """
    variants, away = coarser(deck, problem), deck.at(deck.source.folder.resolve())
    with progress_bar(progress) as tick:
        found_by = run_all(
            _run,
            [(away, change) for change in variants.values()],
            [1.0] * len(variants),
            on_failure=lambda task, error: str(error),
            processes=processes,
            tick=lambda done: tick("budget", done),
        )
    answers = dict(zip(variants, found_by, strict=True))
    ends = [*ends_of_steps(result), *forming_numbers(deck, result)]
    own = values([*taken.quantities, *ends])
    base = answers.get(MESH, own)
    changes = {
        name: {key: _change(answer, own if name == MESH else base, key) for key in own}
        for name, answer in answers.items()
    }
    ends = [one for one in ends if any(change[one.name] for change in changes.values())]  # others are prescribed
    failures = {name: answer for name, answer in answers.items() if isinstance(answer, str)}
    for name, why in failures.items():
        result.warn(f"error budget, {name}: {why}")
    runs = f"coarser runs beside it: {', '.join(variants) or 'none'}{'' if MESH in variants else _NO_MESH}"
    return taken.with_budget(Budget(changes, failures, runs, SAFETY), ends, of_mesh=MESH not in variants)


def _change(answer: dict[str, float | None] | str, base: dict[str, float | None] | str, key: str) -> float:
    """Change of a number from a coarser run; NaN if one of both is unknown."""
    both = [None if isinstance(one, str) else one.get(key) for one in (base, answer)]
    return math.nan if both[0] is None or both[1] is None else both[1] - both[0]


def _run(task: tuple[Problem, Changes]) -> dict[str, float | None] | str:
    """Numbers of a variant, or why it failed."""
    deck, change = task
    try:
        variant = deck.with_(change)
        problem = variant.build()
        result = problem.solve(progress=False)
    except UmformError as error:
        return str(error)
    return values(numbers_of(variant, problem, result))


def numbers_of(deck: Problem, problem: Prepared, result: Result) -> list[Quantity]:
    """All numbers that a budget compares: measures, ends of steps, largest values of forming."""
    measures = Taken.of(deck, problem, result, complete=True).quantities
    return [*measures, *ends_of_steps(result), *forming_numbers(deck, result)]


def ends_of_steps(result: Result) -> list[Quantity]:
    """Controls and their forces at the end of each step; without round-off, and without loads, whose force they are."""
    ends = {int(row["step"]): row for row in result.rows if row["step"]}
    found = []
    for name in (name for control in result.model.controls for name in (control.name, f"{control.name}_force")):
        column = [row[name] for row in result.rows]
        if column == [row.get(name.removesuffix(_FORCE)) for row in result.rows] and name.endswith(_FORCE):
            continue
        least = _ROUND_OFF * max(map(abs, column))
        found += [
            Quantity(f"{name}, end of step {step}", name=f"{name}.step {step}", value=float(row[name]), digits=_DIGITS)
            for step, row in ends.items()
            if abs(row[name]) > least
        ]
    return found
