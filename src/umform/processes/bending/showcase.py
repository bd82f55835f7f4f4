"""The whole example: its runs, in parallel, and their files."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from umform.errors import InvalidValue, UmformError
from umform.io.staging import staging
from umform.io.tables import write_csv, write_json
from umform.pool import check_processes, run_all
from umform.processes.bending.case import Bending, cell_of, check, failed, failure_text, free_bending
from umform.processes.bending.problem import problem_of
from umform.processes.bending.spec import RECONSTRUCTION, ContactRule, FreeBending
from umform.progress import progress_bar
from umform.report.versions import versions

_MESHES = {"hex8": ((24, 1), (48, 2)), "hex18": ((12, 1), (24, 2))}
_ELEMENTS = ("ANS3DEAS", "MI9K3DEAS")
#: Contact points per direction that a facet needs at least.
_LEAST_POINTS = {"hex8": 2, "hex18": 3}
#: What meets sharp bends: cubic thickness strain, tied at the nodes.
_SHARP = {"thickness_order": 3, "tie_E33": True, "thickness_points": 8}
#: States of a run that go to the file of fields; states that others keep, to have a shape should they end early.
_FRAMES_WRITTEN, _FRAMES_KEPT = 60, 10


_DATA = ("free_bending.csv", "free_bending.json", "free_bending.vtkhdf", "free_bending.toml")
_PAGE = ("free_bending.png", "free_bending.svg", "report.html")
FILES = (*_DATA, *_PAGE)

log = logging.getLogger("umform.processes")


@dataclass(frozen=True)
class Selection:
    """Meshes, elements and contact rules to run; empty: those of the example."""

    meshes: tuple[tuple[int, int], ...] = ()
    elements: tuple[str, ...] = ()
    contacts: tuple[ContactRule, ...] = ()

    def pairs(self) -> list[tuple[str, tuple[int, int]]]:
        """Elements with their meshes."""
        if self.meshes and not self.elements:
            return [
                (element, mesh)
                for mesh in self.meshes
                for element in [e for e in _ELEMENTS if mesh in _MESHES[cell_of(e)]] or _ELEMENTS
            ]
        return [
            (element, mesh)
            for element in self.elements or _ELEMENTS
            for mesh in self.meshes or _MESHES[cell_of(element)]
        ]

    def runs(self, base: FreeBending, *, sharp: bool = True) -> list[FreeBending]:
        """The cases, in the order of tables and figures.

        Parameters
        ----------
        base : FreeBending
            All the parameters that are not selected.
        sharp : bool
            On the fine meshes of the example, one more run with the thickness strain that sharp bends need.
        """
        cases = []
        for element, mesh in self.pairs():
            cell = cell_of(element)
            least = _LEAST_POINTS[cell]
            contacts = self.contacts or ("nodes", least, 5)
            on_mesh = replace(base, element=element, mesh=mesh)
            cases += [replace(on_mesh, contact=contact) for contact in contacts]
            if sharp and element in _ELEMENTS and mesh == _MESHES[cell][1] and least in contacts:
                cases.append(replace(on_mesh, contact=least, **_SHARP))  # type: ignore[arg-type]
        return cases


@dataclass(frozen=True)
class Demo:
    """All runs, in order, and the files written."""

    runs: list[Bending]
    files: list[Path]


def demo(
    out: str | Path = "results/free-bending",
    runs: Sequence[FreeBending] | None = None,
    *,
    processes: int | None = None,
    progress: bool | None = None,
) -> Demo:
    """Bend the strip of the example with all its meshes, elements and contact rules, and show the results.

    The runs go in parallel processes, which are spawned: a script that calls this needs
    ``if __name__ == "__main__":``.

    Parameters
    ----------
    out : str or Path
        Folder for free_bending.csv, .json, .png, .svg, .vtkhdf, .toml (the deck of the run in .vtkhdf) and
        report.html; made if it is missing. The files get
    runs : sequence of FreeBending, optional
        Other cases than the 14 of the example.
    processes : int, optional
        Number of processes; default: that of the processors.
    progress : bool, optional
        Show a progress bar; default: only on a terminal.

    Returns
    -------
    Demo
        The runs, in the order of the cases, and the files. A run that failed, whatever the reason, says so in
        ``failure``.

    Raises
    ------
    UmformError
        Before the first run: a case that cannot be built, a folder that cannot be written.
    """
    from umform.processes.bending.page import write_page  # matplotlib takes time to load; the workers do without

    cases = list(runs) if runs is not None else Selection().runs(FreeBending())
    if not cases:
        raise InvalidValue(
            "there is no case to run",
            where="runs",
            value=runs,
            cause="an empty list",
            remedy="leave it out: all cases run",
        )
    check_processes(processes)
    for case in cases:
        check(case)
    pictured = cases.index(_most_telling(cases))
    alone = len(cases) == 1
    with staging(out, FILES) as stage:
        fields = stage.waiting / "free_bending.vtkhdf"
        with progress_bar(False if alone else progress) as bar:
            name = f"{len(cases)} runs"
            bar(name, 0.0)
            finished = run_all(
                partial(_run, progress=progress if alone else False),
                [(case, fields if n == pictured else None) for n, case in enumerate(cases)],
                [_cost(case) for case in cases],
                on_failure=_given_up,
                processes=processes,
                tick=partial(bar, name),
            )
        _write_tables(stage.waiting, finished)
        (stage.waiting / "free_bending.toml").write_text(problem_of(cases[pictured]).toml(), encoding="utf-8")
        files = stage.commit(_DATA)  # a picture that fails does not take the numbers along
        write_page(stage.waiting, finished, finished[pictured])
        return Demo(finished, [*files, *stage.commit(_PAGE)])


def _run(task: tuple[FreeBending, Path | None], progress: bool | None) -> Bending:
    """One case, as far as it goes; with its fields in a file if there is a path for them, and what its page moves."""
    case, fields = task
    try:
        run = free_bending(case, frames=_FRAMES_WRITTEN if fields else _FRAMES_KEPT, progress=progress)
    except Exception as error:
        run = _given_up(task, error)
    if fields and run.result:
        from umform.report.live import Live  # matplotlib takes time to load; the other runs do without

        try:
            run.result.write(fields)
            run = replace(run, live=Live.of(run.result))
        except Exception as error:
            run = replace(run, failure="\n".join(filter(None, (run.failure, failure_text(error)))))
    return run.detached()


def _given_up(task: tuple[FreeBending, Path | None], error: Exception) -> Bending:
    """The results of a run that an exception ended."""
    case, _ = task
    if not isinstance(error, UmformError):
        log.info("%s: %s", case.name, error, exc_info=error)
    return failed(case, error)


def _cost(case: FreeBending) -> float:
    """About how long a case takes, in any unit."""
    heavy = {"hex8": 1.0, "hex18": 9.0}[cell_of(case.element)]
    return case.mesh[0] * case.mesh[1] * case.steps * heavy * case.thickness_points


def _most_telling(cases: Sequence[FreeBending]) -> FreeBending:
    """The case whose fields are kept: the one nearest to the continuum, that is of order 3, else the last."""
    return max(reversed(cases), key=lambda case: (case.thickness_order, case.tie_E33, case.element == _ELEMENTS[0]))


def _write_tables(folder: Path, runs: Sequence[Bending]) -> list[Path]:
    """The curves as CSV; settings and measures as JSON."""
    curves, record = folder / "free_bending.csv", folder / "free_bending.json"
    write_csv(
        curves,
        {
            "run": [run.case.name for run in runs for _ in run.u],
            "step": np.concatenate([run.step for run in runs]),
            "u": np.concatenate([run.u for run in runs]),
            "F": np.concatenate([run.F for run in runs]),
        },
    )
    content: dict[str, Any] = {
        "note": RECONSTRUCTION,
        "settings": runs[0].case.problem(),
        "versions": versions(),
        "runs": [run.record() for run in runs],
    }
    write_json(record, content)
    return [curves, record]
