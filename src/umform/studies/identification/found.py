"""What was identified: numbers with their standard deviations, residuals, the problem with them; as table and files."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from umform.io.staging import staging
from umform.io.tables import write_csv, write_json
from umform.results.outcome import Annex, Study
from umform.results.quantity import UNKNOWN
from umform.sheet_metals import Fit
from umform.studies.calibration.words import vague
from umform.studies.derivatives import Derivatives
from umform.studies.derivatives.subjects import OfCase, OfFunction, OfProblem, Subject
from umform.studies.identification.data import Measured, MeasuredCurve, numbers_of
from umform.studies.identification.sought import Sought

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
#: Files: numbers, residuals, all of it, the deck with the numbers, pictures.
TABLE, RESIDUALS, RECORD, DECK, PICTURE = (
    "identified.csv",
    "residuals.csv",
    "identified.json",
    "deck.toml",
    "identified",
)
FILES = (TABLE, RESIDUALS, RECORD, DECK, f"{PICTURE}.png", f"{PICTURE}.svg")
#: Misfit in standard deviations beyond which the run is another one than what was measured.
_FAR = 2.0
#: What was known before is most of what is known if the standard deviation stays at more than this part.
_LITTLE = 0.8


@dataclass(frozen=True, repr=False)
class Identified(Study):
    """Numbers of a problem from measurements.

    Attributes
    ----------
    fit : Fit
        Values, standard deviations, correlations and misfit, in standard deviations of the measurements.
    sought : mapping of str to Sought
        Bounds and what was known before.
    start : mapping of str to float
        First values.
    data : tuple of MeasuredCurve or MeasuredNumber
        Measurements.
    before, after : ndarray, shape (m,)
        Numbers of the run at the first values, and at the end.
    last : tuple of Derivatives
        The last run of each measurement.
    runs, refused : int
        Runs, each with its shadows; sets of values that were refused or did not converge.
    unfinished : str
        Why the search has stopped before its end; empty if it has not.
    given : bool
        Whether standard deviations of the measurements were given.
    unknown_errors : bool
        Whether there are none, and so few measurements that the misfit does not tell them.

    Examples
    --------
    >>> import umform as uf
    >>> def build(yield_stress):
    ...     metal = uf.J2(E=200e3, nu=0.3, hardening=uf.Linear(yield_stress, 1000.0))
    ...     model = uf.Model(uf.mesh.strip(1.0, 1.0, 1.0, (1, 1)), material=metal)
    ...     model.hinge("x0", "xyz")
    ...     return model, uf.Move(model.prescribe("x1", "x", name="pull"), to=0.01, steps=10)
    >>> found = uf.identify(build, {"yield_stress": (100.0, 400.0)}, [uf.MeasuredNumber("pull_force", 250.0, 2.0)])
    >>> 100.0 < found.values["yield_stress"] < 250.0 and not found.unfinished
    True
    """

    fit: Fit[Subject]
    sought: Mapping[str, Sought]
    start: Mapping[str, float]
    data: tuple[Measured, ...]
    before: Floats
    after: Floats
    last: tuple[Derivatives, ...]
    runs: int
    refused: int
    unfinished: str
    given: bool
    unknown_errors: bool

    @property
    def values(self) -> Mapping[str, float]:
        """Numbers found, by path."""
        return self.fit.constants

    @property
    def deviations(self) -> Mapping[str, float]:
        """Standard deviations; infinite for a number at a bound."""
        return self.fit.deviations

    @property
    def correlation(self) -> Floats:
        """Correlations, in the order of the values."""
        return self.fit.correlation

    @property
    def subject(self) -> Any:
        """The problem or case with the values; the values of a function."""
        made = self.fit.law
        if isinstance(made, OfProblem):
            return made.problem
        return made.case if isinstance(made, OfCase) else dict(self.values)

    @property
    def table(self) -> list[list[str]]:
        """A header and a row for each number."""
        rows = [["number", "before", "found", "standard error", "unit", "determined"]]
        units = {one.path: one.unit for one in self.last[0].parameters}
        for path, value in self.values.items():
            error = self.deviations[path]
            sure = UNKNOWN if self.unknown_errors else "no" if path in self.fit.undetermined else "yes"
            text = UNKNOWN if math.isinf(error) else f"{error:.2g}"
            rows.append([path, f"{self.start[path]:.6g}", f"{value:.6g}", text, units[path], sure])
        return rows

    @property
    def annex(self) -> Annex:
        """The numbers and the remarks."""
        return Annex("Numbers from measurements", self.table, list(self.remarks))

    @property
    def remarks(self) -> Iterator[str]:
        """Sentences: runs, misfit, what is not determined."""
        runs = f"{self.runs} runs, each with {len(self.values)} shadows"
        yield f"{runs}; {self.refused} sets of values without a run" if self.refused else runs
        unit = "standard deviations" if self.given else "per cent of the largest number of each measurement"
        yield f"misfit {self.fit.misfit:.3g} {unit}, before {self._misfit(self.before):.3g}"
        if self.given and self.fit.misfit > _FAR:
            yield (
                "the run is far from the measurements: a law, a friction or a tool is another one, or the standard "
                "deviations are too small; the standard errors are then too small"
            )
        if self.unfinished:
            yield f"the search has stopped before its end: {self.unfinished}"
        if self.unknown_errors:
            yield (
                "as many numbers as measurements, which have no standard deviations: the standard errors are unknown; "
                "give the measurements deviations, or measure more"
            )
        else:
            yield from vague("measurements", self.fit)
        for path, one in self.sought.items():
            if one.deviation is not None and self.deviations[path] > _LITTLE * one.deviation:
                yield (
                    f"{path} is hardly measured: standard deviation {self.deviations[path]:.2g}, known before "
                    f"{one.deviation:.2g}"
                )

    def _misfit(self, found: Floats) -> float:
        return float(np.sqrt(np.mean(((found - self._measured[0]) / self._measured[1]) ** 2)))

    @property
    def _measured(self) -> tuple[Floats, Floats]:
        return numbers_of(self.data)

    def __str__(self) -> str:
        widths = [max(len(row[n]) for row in self.table) for n in range(len(self.table[0]))]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in self.table]
        return "\n".join([*(line.rstrip() for line in lines), *self.remarks])

    @property
    def residuals(self) -> dict[str, list[Any]]:
        """Columns: each measured number beside those of the first and of the last run."""
        measured, deviations = self._measured
        names = [one.name for one in self.data for _ in one.numbers[0]]
        x = [x for one in self.data for x in (one.abscissae if isinstance(one, MeasuredCurve) else [None])]
        return {
            "measurement": names,
            "x": x,
            "measured": measured.tolist(),
            "deviation": deviations.tolist(),
            "before": self.before.tolist(),
            "found": self.after.tolist(),
        }

    def record(self) -> dict[str, Any]:
        """All of it as JSON data."""
        numbers = {
            path: {
                "value": value,
                "standard_error": None if math.isinf(self.deviations[path]) else self.deviations[path],
                "before": self.start[path],
                "determined": None if self.unknown_errors else path not in self.fit.undetermined,
            }
            for path, value in self.values.items()
        }
        return {
            "numbers": numbers,
            "correlation": self.correlation,
            "misfit": self.fit.misfit,
            "runs": self.runs,
            "remarks": list(self.remarks),
        }

    def toml(self) -> str:
        """The deck with the values, without the comments of the first one; empty for a function."""
        from umform.processes.problems import problem_of

        made = self.fit.law
        if isinstance(made, OfFunction):
            return ""
        if not isinstance(made, OfProblem):
            return problem_of(self.subject).toml()
        source = made.problem.source
        if source.made:
            return made.problem.toml()
        remark = f"{source.name} with numbers from measurements; files that it names are looked for beside it."
        numbers = (
            f"{path} = {value:.7g}, standard error {self.deviations[path]:.2g}" for path, value in self.values.items()
        )
        return made.problem.toml(remarks=[remark, *numbers])

    def write(self, folder: str | Path) -> list[Path]:
        """Write numbers, residuals, a record, the deck and a picture; the files appear together."""
        with staging(folder, FILES) as stage:
            here = stage.waiting
            record = self.record()
            numbers = record["numbers"]
            columns = ("value", "standard_error", "before", "determined")
            write_csv(
                here / TABLE,
                {"number": list(numbers)} | {name: [one[name] for one in numbers.values()] for name in columns},
            )
            write_csv(here / RESIDUALS, self.residuals)
            write_json(here / RECORD, record)
            if deck := self.toml():
                (here / DECK).write_text(deck, encoding="utf-8")
            for ending in ("png", "svg"):
                self.plot(here / f"{PICTURE}.{ending}")
            return stage.commit(FILES)

    def plot(self, path: str | Path | None = None) -> Figure:
        """Measured curves over those of the last run, and single numbers in standard deviations."""
        from umform.studies.identification.picture import picture

        return picture(self.data, self.residuals, self.last, path)
