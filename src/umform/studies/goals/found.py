"""What a search for wanted results has found: its runs, tables, deck, tools and picture."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from umform.errors import InvalidValue
from umform.io.tables import write_csv
from umform.problem import Problem
from umform.problem.named_units import length_of
from umform.processes.rules import number as is_number
from umform.processes.rules import positive
from umform.results.outcome import Annex, Study
from umform.results.quantity import Quantity
from umform.spec.types import FARTHEST
from umform.studies.goals.files import write_deck, write_tools
from umform.studies.goals.shapes import Shapes, Tools, picture

#: What the picture shows.
_CAPTION = (
    "The middle of the sheet in the section at y = 0, in its tools (broken) and out of them: of the first run, and "
    "with the parameters for the wanted results."
)
#: Files: the runs, the deck, the picture of the shapes, the page.
TABLE, DECK, PICTURE, PAGE = "compensation.csv", "compensated.toml", "compensation.png", "compensation.html"


@dataclass(frozen=True)
class Wanted:
    """A wanted result.

    Attributes
    ----------
    value : float
        The value.
    tolerance : float
        Largest deviation.

    Examples
    --------
    >>> import umform as uf
    >>> uf.Wanted(90.0, 0.05).tolerance
    0.05
    """

    value: float
    tolerance: float

    def __post_init__(self) -> None:
        if not (is_number(self.value) and abs(self.value) <= FARTHEST and positive(self.tolerance)) or (
            self.tolerance < 1.0 / FARTHEST
        ):
            raise InvalidValue(
                f"a wanted result has a value up to {FARTHEST:g} and a tolerance of at least {1.0 / FARTHEST:g}",
                where="want",
                value=f"{self.value} +- {self.tolerance}",
                cause="a sign, a tolerance of zero, or a typing error",
                remedy="a tolerance such as 0.05",
            )


@dataclass(frozen=True)
class Trial:
    """A run on the way.

    Attributes
    ----------
    parameters : tuple of float
        Values of the parameters.
    results : tuple of float
        The results.
    derived : bool
        Whether it was run with derivatives.
    shapes : Shapes, optional
        The sheet in its tools and out of them; None without a section.
    """

    parameters: tuple[float, ...]
    results: tuple[float, ...]
    derived: bool
    shapes: Shapes | None = None


@dataclass(frozen=True, repr=False)
class Compensated(Study):
    """Parameters for wanted results.

    Attributes
    ----------
    subject : Problem, case or callable
        The problem or case with the parameters; a function stays as it is.
    parameters : dict of str to Quantity
        The parameters by their paths.
    results : list of Quantity
        The results; ``limit`` is not used, the band is the tolerance.
    wanted : dict of str to Wanted
        What was wanted.
    trials : tuple of Trial
        All runs.
    reached : bool
        Whether all results are within their tolerances.
    best : int
        The run of the parameters, from 0.
    tools : Tools, optional
        Its tools.
    missed : float
        By how much a run missed what the derivatives foretold of it, relative to what changed; 0 if they were right.
    stopped : str
        Why there are no more runs, if the next one failed.

    Examples
    --------
    >>> import umform as uf
    >>> def build(way):
    ...     model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=210e3, nu=0.3))
    ...     model.fix("x0")
    ...     return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), to=-way, steps=2)
    >>> found = uf.compensate(build, {"tip_force": uf.Wanted(-0.2, 1e-6)}, by={"way": 0.5}, progress=False)
    >>> found.table[0]
    ['run', 'way', 'tip_force', 'derivatives']
    """

    subject: Any
    parameters: dict[str, Quantity]
    results: list[Quantity]
    wanted: dict[str, Wanted]
    trials: tuple[Trial, ...]
    reached: bool
    best: int = 0
    tools: Tools | None = None
    missed: float = 0.0
    stopped: str = ""

    @property
    def table(self) -> list[list[str]]:
        """A header, and a row for each run."""
        names = [*self.parameters, *(one.label for one in self.results)]
        rows = [["run", *names, "derivatives"]]
        for number, trial in enumerate(self.trials, start=1):
            values = [f"{value:.6g}" for value in (*trial.parameters, *trial.results)]
            rows.append([str(number), *values, "yes" if trial.derived else ""])
        return rows

    @property
    def goals(self) -> list[list[str]]:
        """A header, and a row for each wanted result: the first run, the last one, what is wanted."""
        first = self.trials[0].results
        rows = [
            [one.label, one.number(before), one.number(one.value), f"{want.value:g} ± {want.tolerance:g}", one.unit]
            for one, before, want in zip(self.results, first, self.wanted.values(), strict=True)
        ]
        return [["result", "first run", "compensated", "wanted", "unit"], *rows]

    @property
    def warnings(self) -> list[str]:
        """Results that were not reached, and derivatives that did not predict the results."""
        found = []
        if not self.reached:
            runs = f"{len(self.trials)} runs" if len(self.trials) > 1 else "a single run"
            found.append(
                f"the wanted results are not reached in {runs}: wider bounds, another start or other parameters"
            )
        if self.stopped:
            found.append(f"the next run failed: {self.stopped}")
        if self.missed:
            found.append(
                "a step changed the results otherwise than their derivatives say, by "
                f"{100.0 * self.missed:.0f} % of the change: they are wavy or strongly curved there. Secants took the "
                "place of the derivatives; a finer mesh, equal increments and tighter tolerances make results smoother"
            )
        return found

    @property
    def _pictured(self) -> tuple[Shapes, Shapes] | None:
        first, last = self.trials[0].shapes, self.trials[self.best].shapes
        return None if first is None or last is None else (first, last)

    @property
    def annex(self) -> Annex:
        """Runs and shapes for the outcome of a process."""
        shapes = self._pictured
        plot = None if shapes is None else (lambda: picture(*shapes))
        return Annex("Compensation", self.table, self._notes, self.warnings, plot, _CAPTION)

    @property
    def annexes(self) -> list[Annex]:
        """Wanted results and runs."""
        return [Annex("Wanted results", self.goals), self.annex]

    @property
    def _notes(self) -> list[str]:
        values = (f"{path} = {one.value:.6g} {one.unit}".rstrip() for path, one in self.parameters.items())
        return [", ".join(values)]

    def write(self, folder: str | Path) -> list[Path]:
        """Write the table of the runs, the deck of a problem with the parameters, its tools, picture and page.

        Returns
        -------
        list of Path
            The files.
        """
        from umform.plotting import save
        from umform.report import parts
        from umform.report.page import annex_parts

        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        columns = np.array([(*trial.parameters, *trial.results) for trial in self.trials]).T
        names = [*self.parameters, *(one.name for one in self.results)]
        write_csv(folder / TABLE, dict(zip(names, columns.tolist(), strict=True)))
        files = [folder / TABLE]
        if isinstance(self.subject, Problem):
            files.append(write_deck(folder / DECK, self.subject, "wanted results"))
        if self.tools is not None:
            unit = length_of(self.subject) if isinstance(self.subject, Problem) else "mm"
            files += write_tools(folder, self.tools, unit)
        if self._pictured is not None:
            save(picture(*self._pictured), folder / PICTURE)
            files.append(folder / PICTURE)
        header, *rows = self.goals
        content = [parts.heading("Wanted results"), parts.table(header, rows), *annex_parts(self.annex)]
        lead = f"{len(self.trials)} runs; {'all' if self.reached else 'not all'} results are reached"
        files.append(parts.write_html(folder / PAGE, "Parameters for wanted results", lead, content))
        return files
