"""Diagnosis of a failed increment: a load near its maximum, which a step that prescribes it cannot pass."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from umform.analysis.steps.run_state import Run
from umform.model.terms.control import Control
from umform.model.terms.dead_load import Load
from umform.model.terms.pressure import Pressure

#: Growth of the flexibility over the last increments that only the neighbourhood of a maximum explains: there it grows
#: like one over the root of the distance, and the last cuts come a thousand times nearer.
_GIVES_WAY = 3.0


def limit_load(run: Run, controls: Sequence[Control]) -> tuple[str, str] | None:
    """Cause and remedy if a step is at a maximum of its loads; None otherwise."""
    loads = [control for control in controls if isinstance(control, Load | Pressure)]
    if not loads:
        return None
    growth = _growth(run, loads[0])
    if not growth >= _GIVES_WAY:
        return None
    values = ", ".join(f"{load.name} = {load.value:.4g}" for load in loads)
    names = ", ".join(f"{load.name} = ..." for load in loads)
    cause = (
        f"near {values} the sheet gives way {growth:.0f} times as far under the same load as an increment before: a "
        "maximum of the load, beyond which a larger one has no equilibrium"
    )
    multiplied = " and augmented=False" if run.model.system.multiplied else ""
    remedy = (
        f'follow the path in place of the load: the step Arc, kind = "arc" with to = {{ {names} }}{multiplied}, lets '
        "the load fall behind its maximum; or prescribe a displacement"
    )
    return cause, remedy


def _growth(run: Run, load: Control) -> float:
    """Flexibility in the last increment over that in the last one of usual size: work over load and its increment."""
    rows = [row for row in run.result.rows if row["step"] in (run.number, 0)]
    if len(rows) < 4:
        return 0.0
    p, work = (np.array([row[name] for row in rows]) for name in (load.name, "external_work"))
    step, mean = np.diff(p), 0.5 * (p[1:] + p[:-1])
    with np.errstate(all="ignore"):
        flexibility = np.diff(work) / (mean * step)
    usual = np.flatnonzero(np.abs(step) >= 0.5 * np.abs(step).max())
    last, before = flexibility[-1], flexibility[usual[-1]]
    return float(last / before) if before > 0.0 and np.isfinite(last) else 0.0
