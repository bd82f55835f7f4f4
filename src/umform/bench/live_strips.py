"""Live data of a strip with several bends or a hem: operation, outline, curve."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from umform.processes.bend_sequence import BendSequence
from umform.processes.bend_sequence.sides import Strip
from umform.processes.hemming import Hemming
from umform.processes.hemming.problem import FORCE, STROKE, edge_of, way_column

if TYPE_CHECKING:
    from umform.analysis.steps.run_state import Run
    from umform.model import Model
    from umform.results.history import History

#: Largest number of points of a curve, and of one face of an outline.
_MOST = 300
#: Share of loading in an operation; largest progress before the files are written.
_LOADING, _BEFORE_FILES = 0.7, 0.95


class StripProgress:
    """Curve, outline and progress of a strip.

    Parameters
    ----------
    case : BendSequence or Hemming
        Its bends, and the hem that is flattened after them.
    """

    def __init__(self, case: BendSequence | Hemming) -> None:
        self.hem = case if isinstance(case, Hemming) else None
        self.sequence = case.first if isinstance(case, Hemming) else case
        self.count = len(self.sequence.bends) + (self.hem is not None)
        self._model: Model | None = None
        self._number = -1

    def __call__(self, run: Run) -> dict[str, Any]:
        """Live data of the present state."""
        if run.model is not self._model:  # a new operation
            self._model, self._number = run.model, self._number + 1
        number = min(self._number, self.count - 1)
        bends = self.sequence.bends
        flattened = self.hem if number >= len(bends) else None
        if flattened is None:
            strip = Strip.of(run.model.mesh, run.model.u).at(bends[number].position, over=bends[number].over)
        else:
            strip = Strip.of(run.model.mesh, run.model.u, edge_of(flattened))
        stroke = run.result[STROKE if flattened is None else way_column(flattened)]
        force = self.force(run.result)
        thin = max(1, -(-len(stroke) // _MOST))
        back = len(stroke) > 1 and bool(stroke[-1] < stroke[-2])
        return {
            "phase": "springback" if back else "flattening" if flattened else "loading",
            "operation": number + 1,
            "operations": self.count,
            "flattening": flattened is not None,
            "fraction": min(_BEFORE_FILES, (number + self._part(number, float(stroke[-1]), back)) / self.count),
            "stroke": round(float(stroke[-1]), 4),
            "force": round(float(force[-1]), 3),
            "curve": {"x": stroke[::thin].round(4).tolist(), "y": force[::thin].round(3).tolist()},
            "outline": _outline(strip),
        }

    def force(self, result: History) -> NDArray[np.float64]:
        """Force per length of bend: the strip is as wide as it is thick."""
        return result[FORCE] / self.sequence.sheet.thickness

    def _part(self, number: int, stroke: float, back: bool) -> float:
        """Approximate progress of an operation."""
        if back or number >= len(self.sequence.bends):
            return _LOADING
        bend = self.sequence.bends[number]
        case = self.sequence.case(bend)
        goal = bend.stroke if bend.angle is None else case.rigid_stroke(90.0 - 0.5 * bend.angle)
        return _LOADING * min(1.0, stroke / goal) if goal else 0.0


def _outline(strip: Strip) -> list[list[float]]:
    """Outline of the strip where it stands, lower face first."""
    thin = max(1, -(-len(strip.current) // _MOST))
    lower, upper = (strip.current[::thin, level] for level in (0, -1))
    outline: list[list[float]] = np.concatenate([lower, upper[::-1]]).round(4).tolist()
    return outline
