"""The table of runs, for the terminal and for the page."""

from __future__ import annotations

from collections.abc import Sequence

from umform.processes.bending.case import Bending
from umform.results.quantity import Quantity, in_rows


def table(runs: Sequence[Bending]) -> list[list[str]]:
    """A header and a row for each run; what a run did not reach is a dash."""
    header, *rows = in_rows([[*run.quantities, *_effort(run)] for run in runs])
    return [["run", *header], *([run.case.name, *row] for run, row in zip(runs, rows, strict=True))]


def legend(runs: Sequence[Bending]) -> list[str]:
    """What the words of the table mean: one line for the columns, one for each word in the names of the runs."""
    lines = ["J: largest jump of the force within 0.1 mm; rms: distance of the force from a smooth curve."]
    orders = sorted({run.case.thickness_order for run in runs} - {1})
    lines += [f"order {n}: strain in the thickness direction of degree {n} over it, not linear." for n in orders]
    if any(run.case.tie_E33 for run in runs):
        lines.append(
            "tied: this strain is interpolated from the nodes, so that an element does not thin where it bends."
        )
    return lines


def _effort(run: Bending) -> list[Quantity]:
    return [Quantity("iterations", decimals=0, value=run.iterations), Quantity("time", "s", 1, value=run.seconds)]
