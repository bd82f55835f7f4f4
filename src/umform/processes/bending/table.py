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


def _number(value: float | None, digits: int) -> str:
    return "–" if value is None else f"{value:.{digits}f}"


def _percent(value: float | None) -> str:
    return _number(None if value is None else 100.0 * value, 2)
