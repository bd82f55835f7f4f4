"""The table of runs, for the terminal and for the page."""

from __future__ import annotations

from collections.abc import Sequence

from umform.processes.bending.case import Bending


def header(runs: Sequence[Bending]) -> list[str]:
    """Names of the columns."""
    forces = [f"F({mark:g})" for mark in runs[0].case.marks]
    return ["run", *forces, "u at F = 0", "J %", "rms %", "iterations", "s"]


def rows(runs: Sequence[Bending]) -> list[list[str]]:
    """One row a run; what a run did not reach is a dash."""
    return [
        [
            run.case.name,
            *(_number(force, 2) for force in run.forces),
            _number(run.zero_force, 3),
            _percent(run.jump),
            _percent(run.roughness),
            str(run.iterations),
            f"{run.seconds:.1f}",
        ]
        for run in runs
    ]


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


def _number(value: float | None, digits: int) -> str:
    return "–" if value is None else f"{value:.{digits}f}"


def _percent(value: float | None) -> str:
    return _number(None if value is None else 100.0 * value, 2)
