"""The scatter of all results: tables, warnings, files."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from umform.errors import InvalidValue
from umform.io.tables import write_csv, write_json
from umform.report.versions import versions
from umform.results.outcome import Annex, Study
from umform.results.quantity import UNKNOWN, Bad, Quantity, list_columns
from umform.studies.derivatives import Derivatives
from umform.studies.scatter.second_run import ALLOWED, STEPS, SecondRun
from umform.studies.scatter.source import Source
from umform.studies.scatter.spread import Spread

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
#: Files: all numbers, the same with the sources, the picture.
TABLE, RECORD, PICTURE = FILES = ("scatter.csv", "scatter.json", "scatter.png")
#: Headings of the tables of results and of shares.
RESULTS, SHARES = "Scatter of the results", "Shares of the variance in %"
#: Capability above which a process is usually called capable.
CAPABLE = 1.33
#: Share of the largest result of its unit below which a result is round-off.
_ROUND_OFF = 1e-9
#: Difference of two runs relative to the result that is the wave of a mesh which follows the source.
_WAVE = 2e-3


@dataclass(frozen=True, repr=False)
class Scattered(Study):
    """Scatter of the results of a run.

    Attributes
    ----------
    spreads : tuple of Spread
        Mean, standard deviation and shares of each result.
    sources : tuple of Source
        The parameters that scatter.
    covariance : ndarray
        Their covariance.
    derivatives : Derivatives
        What it follows from.
    second_runs : tuple of SecondRun
        Runs that show whether the first order holds.
    failures : tuple of str
        Why others could not be made.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.processes.air_bending import AirBending
    >>> found = uf.scatter(AirBending(stroke=6.0), {"thickness": "1%"}, hold={"angle": "stroke"})  # doctest: +SKIP
    >>> found["stroke"].deviation.full_text, found["springback"].largest  # doctest: +SKIP
    >>> found.write("results")  # doctest: +SKIP
    """

    spreads: tuple[Spread, ...]
    sources: tuple[Source, ...]
    covariance: Floats
    derivatives: Derivatives
    second_runs: tuple[SecondRun, ...]
    failures: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> Spread:
        """The spread of a result."""
        found = {one.name: one for one in self.spreads}
        if name not in found:
            raise InvalidValue("there is no result of this name", value=name, remedy="one of " + ", ".join(found))
        return found[name]

    def __iter__(self) -> Iterator[Spread]:
        return iter(self.spreads)

    @property
    def quantities(self) -> list[Quantity]:
        """All numbers, such as ``angle.mean``, ``angle.deviation``, ``angle.share.thickness`` and ``angle.cpk``."""
        return [quantity for one in self for quantity in one.quantities]

    @property
    def tables(self) -> dict[str, list[list[str]]]:
        """Tables for people by their headings: a header, then rows of cells."""
        found = {"Parameters that scatter": self._table_of_sources, RESULTS: self._table_of_results}
        if len(self.sources) > 1:
            found[SHARES] = self._table_of_shares
        return found | {f"{one.place}: changes": self._table_of_run(one) for one in self.second_runs}

    @property
    def _table_of_sources(self) -> list[list[str]]:
        rows = [["parameter", "value", "standard deviation", "unit"]]
        for one in self.sources:
            parameter = one.parameter
            rows.append([one.path, f"{parameter.value:.6g}", f"{one.deviation:.3g}", parameter.unit])
        return rows

    @property
    def _table_of_results(self) -> list[list[str]]:
        limited = any(one.limits for one in self)
        rows = [["quantity", "mean", "standard deviation", *["limits", "Cp", "Cpk", "beyond, %"] * limited, "unit"]]
        for one in self:
            sigma = one.deviation.value
            capability = [quantity.text for quantity in one.capability] or [""] * 3
            if limited and one.limits:
                capability[1] = Bad(capability[1]) if not _capable(one) else capability[1]
            limits = [one.limits.text if one.limits else "", *capability] if limited else []
            rows.append(
                [
                    one.response.label,
                    _with_error(one.mean, sigma),
                    _with_error(one.deviation, sigma),
                    *limits,
                    one.response.unit,
                ]
            )
        return rows

    @property
    def _table_of_shares(self) -> list[list[str]]:
        names = _short([one.path for one in self.sources])
        rows = [["quantity", *names]]
        rows += [[one.response.label, *(share.text for share in one.shares.values())] for one in self if one.largest]
        return rows

    def _table_of_run(self, run: SecondRun) -> list[list[str]]:
        rows = [["quantity", "predicted", "found", "difference, %", "unit"]]
        for one in self._of_run(run):
            predicted, found = (
                one.deviation.number(value, "+") for value in (run.predicted[one.name], run.found[one.name])
            )
            difference = run.difference(one.name)
            text = UNKNOWN if difference is None else f"{100.0 * difference:.1f}"
            rows.append(
                [
                    one.response.label,
                    predicted,
                    found,
                    Bad(text) if _is_bent(one, run) else text,
                    one.response.unit,
                ]
            )
        return rows

    def _of_run(self, run: SecondRun) -> list[Spread]:
        """Results whose largest source is that of a run, but for round-off."""
        return [one for one in self if one.largest == run.path and not self._is_round_off(one)]

    def _is_round_off(self, spread: Spread) -> bool:
        """Whether a result is tiny beside another one of its unit, such as the bow of a leg that is straight."""
        sizes = [abs(one.response.value or 0.0) for one in self if one.response.unit == spread.response.unit]
        own = abs(spread.response.value or 0.0) + abs(spread.deviation.value or 0.0)
        return own < _ROUND_OFF * max(sizes)

    @property
    def warnings(self) -> list[str]:
        """Warnings about the numbers."""
        own = [*self.derivatives.warnings, *self.failures, *self.derivatives.run.warnings]
        for run in self.second_runs:
            bent = [one.response.label for one in self._of_run(run) if _is_bent(one, run)]
            if bent:
                own.append(
                    f"{run.title} changes {', '.join(bent)} by more than {100.0 * ALLOWED:g} % less or more than the "
                    f"derivative predicts: standard deviation and shares are rough there"
                    f"{f' ({run.note})' if run.note else ''}; umform sweep over {run.path} shows the curve"
                )
        return own

    @property
    def annexes(self) -> list[Annex]:
        """Tables and picture for the outcome of a process; the warnings are at the end."""
        found = {title: Annex(title, table) for title, table in self.tables.items()}
        if SHARES in found:
            caption = "Shares of the parameters in the variance of the results."
            found[SHARES] = replace(found[SHARES], picture=self.plot, caption=caption)
        *others, last = found.values()
        return [*others, replace(last, warnings=self.warnings)]

    def record(self) -> dict[str, Any]:
        """All of it as JSON data."""
        return {
            "sources": [
                {
                    "path": one.path,
                    "value": one.parameter.value,
                    "deviation": one.deviation,
                    "unit": one.parameter.unit,
                }
                for one in self.sources
            ],
            "covariance": self.covariance,
            "held": dict(self.derivatives.held),
            "quantities": [one.record() for one in self.quantities],
            "second_runs": [
                {"path": one.path, "step": one.step, "predicted": one.predicted, "found": one.found}
                for one in self.second_runs
            ],
            "warnings": self.warnings,
            "versions": versions(),
        }

    def write(self, folder: str | Path) -> list[Path]:
        """Write the numbers as CSV and JSON, and the picture if there are shares to show.

        Returns
        -------
        list of Path
            The files.
        """
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        write_json(folder / RECORD, self.record())
        write_csv(folder / TABLE, list_columns(self.quantities))
        written = [folder / TABLE, folder / RECORD]
        if SHARES in self.tables:
            self.plot(folder / PICTURE)
            written.append(folder / PICTURE)
        return written

    def plot(self, path: str | Path | None = None) -> Figure:
        """Bars of the shares of the sources in the variance of each result."""
        from umform.studies.scatter.picture import bars

        return bars([one for one in self if one.largest], path)


def _is_bent(spread: Spread, run: SecondRun) -> bool:
    """Whether a result does not change as its derivative: by more than a wave and two units of the last digit."""
    change = run.change(spread.name)
    if change is None or (run.difference(spread.name) or 0.0) <= ALLOWED:
        return False
    result = spread.response
    digit = 0.0 if result.decimals is None else 10.0**-result.decimals  # of two rounded numbers
    return abs(change[1] - change[0]) > max(2.0 * digit, _WAVE * abs(result.value or 0.0))


def _with_error(quantity: Quantity, deviation: float | None) -> str:
    """A number with its error, if that shows and is more than a twentieth of the standard deviation.

    The error is that of the first order: whether the number is that of its mesh only is said beside the number itself.
    """
    quantity = replace(quantity, of_mesh=False)
    shown = (
        quantity.band is not None
        and quantity.band.error > 0.05 * (deviation or 0.0)
        and quantity.number(quantity.band.error) != quantity.number(0.0)
    )
    return f"{quantity.text} {quantity.error_text}" if shown else replace(quantity, band=None).text


def _capable(one: Spread) -> bool:
    cpk = one.capability[1].value
    return cpk is None or cpk >= CAPABLE


def _short(paths: list[str]) -> list[str]:
    """The last parts of paths, where they are unique."""
    ends = [path.rpartition(".")[2] for path in paths]
    return [
        end if ends.count(end) == 1 and not end.isdecimal() else path for end, path in zip(ends, paths, strict=True)
    ]


__all__ = ["CAPABLE", "FILES", "STEPS", "Scattered"]
