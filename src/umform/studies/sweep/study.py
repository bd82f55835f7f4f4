"""``sweep``: run a deck over values of some of its keys, in processes or in an executor of the user."""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from umform.errors import InvalidValue
from umform.notebook import Display, InNotebook
from umform.pool import check_processes, run_all
from umform.progress import Tick, progress_bar
from umform.spec import check_value, each
from umform.spec.display import value_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from umform.problem import Problem
    from umform.studies.sweep.measures import Function, Measure, Record
    from umform.studies.sweep.plan import Plan

log = logging.getLogger("umform")
#: Varied values, results, and causes of failures.
Row = dict[str, Any]


@dataclass(frozen=True, repr=False)
class Sweep(InNotebook):
    """All jobs of a sweep.

    Attributes
    ----------
    varied, measures : list of str
        Names of the varied columns, and of the results.
    rows : list of dict
        One for each job: varied values, ``outcome``, measures, ``warnings``, ``seconds``, ``reason``, ``folder``, and
        ``quantities``: the measures with unit, error and limit.
    files : list of Path
        Table and plot.

    Examples
    --------
    >>> import umform as uf
    >>> row = {"outcome": "done", "warnings": 0, "seconds": 1.0, "reason": "", "folder": "jobs"}
    >>> rows = [row | {"thickness": t, "punch_force:peak": force} for t, force in ((0.8, 21.0), (1.0, 33.5))]
    >>> found = uf.Sweep(["thickness"], ["punch_force:peak"], rows, [])
    >>> found["punch_force:peak"]
    [21.0, 33.5]
    """

    varied: list[str]
    measures: list[str]
    rows: list[Row]
    files: list[Path]

    def __repr__(self) -> str:
        return f"Sweep({len(self.rows)} jobs over {', '.join(self.varied)}: {', '.join(self.measures)})"

    def _display(self) -> Display:
        columns = self.table()
        rows = zip(*([value_text(one) for one in column] for column in columns.values()), strict=True)
        return Display(f"Sweep of {len(self.rows)} jobs", {"": [list(columns), *map(list, rows)]})

    def __getitem__(self, column: str) -> list[Any]:
        """A column of the table."""
        table = self.table()
        if column not in table:
            raise InvalidValue("the sweep has no such column", value=column, remedy="one of " + ", ".join(table))
        return table[column]

    def table(self) -> dict[str, list[Any]]:
        """Columns by name; ``pandas.DataFrame(sweep.table())`` is a data frame."""
        from umform.studies.sweep.table import columns

        return columns(self.rows, self.varied, self.measures)

    def plot(self, path: str | Path | None = None, measures: Sequence[str] | None = None) -> Figure:
        """Draw measures over the varied keys.

        Parameters
        ----------
        path : str or Path, optional
            Where to save the picture: .png, .svg or .pdf.
        measures : sequence of str, optional
            Columns; default: the first four that are not the same in all jobs.
        """
        from umform.studies.sweep.plot import plot
        from umform.studies.sweep.table import telling

        return plot(self.rows, self.varied, measures or telling(self.rows, self.measures), path)


def sweep(
    deck: str | Path | Problem,
    vary: Mapping[str, Any] | None = None,
    *,
    jobs: Sequence[Mapping[str, Any]] | str | PathLike[str] | None = None,
    changes: Mapping[str, Any] | None = None,
    measures: str | Sequence[str | Function] = (),
    out: str | Path | None = None,
    processes: int | None = None,
    executor: Executor | None = None,
    files: bool = False,
    retry: bool = False,
    force: bool = False,
    overwrite: bool = False,
    progress: bool | None = None,
    on_job: Callable[[Row], None] = lambda row: None,
) -> Sweep:
    """Run a deck over values of some of its keys.

    Each job has its own folder. A finished job is not run again, a killed one continues from its checkpoint: call the
    function again after an interruption, with more values, or with other measures. Processes are spawned, so a script
    needs ``if __name__ == "__main__":``.

    Parameters
    ----------
    deck : str, Path or Problem
        The deck.
    vary : mapping of str to sequence or str
        Values by key; all combinations are run. Keys are named as in ``--set``, or by their last parts if these are
        unambiguous. A text is a list with commas or a range with both ends: ``"0.8:1.2:0.1"``. The values of
        ``material`` are names of the library.
    jobs : sequence of mapping, str or path-like, optional
        Combined values, one mapping for each job, or a CSV file of them with the keys in its first line; ``vary``
        multiplies them.
    changes : mapping of str to object, optional
        Other values of keys for all jobs, as ``--set`` gives them.
    measures : str, or sequence of str or callable, optional
        ``"punch_force:max"`` (last, min, max, peak, sum of a column of the history), a quantity such as
        ``"hat.theta1.released"`` (measure of the deck, number, state) or ``"penetration of die"``, ``"springback"``, or
        functions of a module that make a number, or a :class:`umform.results.quantity.Quantity`, from a
        :class:`umform.Result`. Default: the peak of each force,
        springback, all quantities, and the last value of each column.
    out : str or Path, optional
        Folder; default: results/ and the name of the deck, with "-sweep".
    processes : int, optional
        Jobs at a time; default: as many as processors.
    executor : concurrent.futures.Executor, optional
        Runs the jobs instead of these processes; its workers must have access to the folders of deck and results.
    files : bool
        Whether each job writes the files that the deck asks for: fields, report, pictures. Else history and numbers
        only.
    retry : bool
        Run jobs again that were refused or did not converge.
    force : bool
        Run in spite of numbers that are certainly wrong; refused jobs run again.
    overwrite : bool
        Whether the table may replace that of another study: one whose finished jobs are none of these. Otherwise the
        default folder gets a number then, and a given one is refused.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.
    on_job : callable
        Called with the row of each job when it ends.

    Returns
    -------
    Sweep
        Rows in the order of the jobs, the last key varying fastest. A job that failed is a row with its reason.

    Raises
    ------
    InvalidValue
        An unknown or ambiguous key or measure.
    DeckError
        No job has a valid deck.
    FileProblem
        The given folder has the table of another study.

    Examples
    --------
    >>> import umform as uf
    >>> found = uf.sweep("deck.toml", {"thickness": [0.8, 1.0], "material": "DC04,1.4301"})  # doctest: +SKIP
    """
    from umform.io.staging import staging
    from umform.problem import Problem, load
    from umform.studies.sweep.foreseen import refuse_measures
    from umform.studies.sweep.jobs_file import read_jobs
    from umform.studies.sweep.measures import Measure
    from umform.studies.sweep.plan import make_plan
    from umform.studies.sweep.table import FILES, JOBS, folder_of, write

    check_processes(processes)
    _check_executor(executor, processes)
    measures = each(measures)
    for name, value in {"deck": deck, "vary": vary}.items():
        check_value(sweep, name, value)
    base = deck if isinstance(deck, Problem) else load(deck)
    wanted = [Measure.of(measure) for measure in measures]
    functions = tuple(measure for measure in measures if not isinstance(measure, str))
    options = {"files": files, "functions": functions, "force": force}
    listed = read_jobs(jobs) if isinstance(jobs, str | PathLike) else jobs
    plan = make_plan(base, vary or {}, listed, changes or {}, Path(), **options)
    wanted = plan.beside(wanted)
    for first in list(plan.jobs.values())[:1]:
        refuse_measures(first.deck, [one for one in measures if isinstance(one, str)])
    default = Path("results") / f"{Path(base.source.name).stem}-sweep"
    folder = folder_of(out, default, plan.folders, overwrite=overwrite)
    if out is None and folder != default:
        log.warning("%s holds another sweep; this one writes to %s", default, folder)
    plan = plan.at(folder.resolve() / JOBS)
    if staying := _tools_stay(plan):
        log.warning(staying)
    with staging(folder if out is None else out, FILES) as stage:
        records = plan.known(retry=retry, force=force)
        try:
            with progress_bar(progress) as tick:
                _run(plan, records, wanted, processes, executor, tick, on_job)
        except KeyboardInterrupt as stop:
            rows, names = plan.table(records, wanted)
            write(stage, rows, plan.varied, names)
            stop.add_note(
                f"  kept:   {len(records)} of {len(plan)} jobs in {folder}; run the same sweep again to continue"
            )
            raise
        rows, names = plan.table(records, wanted)
        return Sweep(plan.varied, names, rows, write(stage, rows, plan.varied, names))


def _tools_stay(plan: Plan) -> str:
    """A warning if tools do not follow the thickness that is varied; or nothing."""
    from umform.problem.tools_that_stay import tools_stay

    name = next((name for name in plan.varied if name.split(".")[-1] == "thickness"), "")
    decks = {plan.values[number].get(name): job.deck for number, job in plan.jobs.items()}
    ordered = sorted(value for value in decks if isinstance(value, int | float))
    if not name or not ordered:
        return ""
    text = tools_stay(decks[ordered[0]], decks[ordered[-1]])
    return text and f"{text}: vary the places too, as columns of --jobs"


def _run(
    plan: Plan,
    records: dict[int, Record],
    wanted: Sequence[Measure],
    processes: int | None,
    executor: Executor | None,
    tick: Tick,
    on_job: Callable[[Row], None],
) -> None:
    """Run the jobs that have no record, and add their records."""
    from umform.studies.sweep.jobs import record_of, run_numbered

    def show() -> None:
        counts = Counter(record["outcome"] for record in records.values())
        said = ", ".join(f"{count} {outcome}" for outcome, count in counts.items())
        tick(f"{len(plan)} jobs", len(records) / len(plan), said)

    def take(answer: tuple[int, Record]) -> None:
        first, record = answer
        for number in plan.alike(first):
            records[number] = record
            on_job(plan.row(number, record, wanted))
        log.info("job %d of %d: %s", len(records), len(plan), record["outcome"])
        show()

    for number, record in records.items():
        plan.row(number, record, wanted)  # refuses an unknown measure
    show()
    todo = [(n, job) for n, job in plan.jobs.items() if n not in records and n == plan.alike(n)[0]]
    run_all(
        run_numbered,
        todo,
        [1.0] * len(todo),
        on_failure=lambda task, error: (task[0], record_of("failed", error)),
        processes=processes,
        executor=executor,
        each=take,
    )


def _check_executor(executor: Executor | None, processes: int | None) -> None:
    if executor is not None and processes is not None:
        raise InvalidValue(
            "an executor has its own number of jobs at a time",
            where="processes",
            value=processes,
            cause="a number of processes beside an executor",
            remedy="omit it, and make the executor with that many workers",
        )
