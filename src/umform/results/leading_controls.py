"""The controls of a run by their work: the first one has the curve to look at."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from umform.model.terms.control import Control
    from umform.results.history import History


def leading_controls(result: History) -> list[Control]:
    """Controls that displace something in the run, the one with the largest work first.

    A load is its own force: its curve is a straight line, and it is not among them.
    """
    known = set(result.columns())  # without controls that were added after the run
    works = {control: work(result, control.name) for control in result.model.controls if control.name in known}
    return sorted((control for control, value in works.items() if value > 0.0), key=lambda c: -works[c])


def work(result: History, name: str) -> float:
    """Integral of the absolute force of a control over its travel, by trapezia; -1 for a load or one that rests."""
    value, force = result[name], result[f"{name}_force"]
    if np.array_equal(value, force) or not np.ptp(value):
        return -1.0
    middle = 0.5 * np.abs(force[1:] + force[:-1])
    return float(middle @ np.abs(np.diff(value))) + np.finfo(float).tiny
