"""Shapes of the sheet on the way to wanted results: in the tools and out of them, in a section; the picture of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray

from umform.analysis.run import Result
from umform.analysis.steps import Free, Release, Step
from umform.errors import InvalidValue
from umform.results.forming import section
from umform.surfaces.tool import Tool
from umform.surfaces.triangles import Box3

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from umform.processes.bend_sequence.part import Part

Floats = NDArray[np.float64]

#: Margin around the sheet of what is written of a tool, relative to the largest side of the sheet.
_MARGIN = 0.25


@dataclass(frozen=True)
class Shapes:
    """The middle of the sheet in the section at y = 0, and the tools.

    Attributes
    ----------
    formed : ndarray, shape (n, 2), optional
        At the end of forming: x, z; None for a part of several operations, which is in no tools as a whole.
    sprung : ndarray, shape (n, 2)
        At the end of the run, out of the tools.
    """

    formed: Floats | None
    sprung: Floats

    @classmethod
    def of(cls, steps: Sequence[Step], result: Result) -> Self | None:
        """Those of a run with a frame at the end of each step; None if the plane does not cut the sheet."""
        opens = next((number for number, step in enumerate(steps) if isinstance(step, Release | Free)), len(steps))
        row = np.flatnonzero(result["step"] <= opens)[-1]
        formed = next((frame for frame in reversed(result.frames) if frame.number <= row), None)
        if formed is None or not result.frames:
            return None
        try:
            lines = [
                section(result.model.mesh, frame.points["displacement"]).middle[:, [0, 2]]
                for frame in (formed, result.frames[-1])
            ]
        except InvalidValue:
            return None
        return cls(*lines)

    @classmethod
    def of_part(cls, part: Part) -> Self:
        """That of a part of several bends: its first leg on x."""
        return cls(None, part.strip.middle)


@dataclass(frozen=True)
class Tools:
    """The tools of a run, where they stand at first.

    Attributes
    ----------
    tools : dict of str to Tool
        By their names.
    box : tuple of two points
        Around the sheet before and after the run.
    """

    tools: dict[str, Tool]
    box: Box3

    @classmethod
    def of(cls, result: Result) -> Self:
        """Those of a model after its run."""
        model = result.model
        points = np.concatenate([model.mesh.points, model.positions])
        low, high = points.min(axis=0), points.max(axis=0)
        low, high = (ends + sign * _MARGIN * float((high - low).max()) for ends, sign in ((low, -1.0), (high, 1.0)))
        found = {tool.name: tool.surface for tool in model.tools if isinstance(tool.surface, Tool)}
        return cls(found, (tuple(low.tolist()), tuple(high.tolist())))


def picture(first: Shapes, last: Shapes) -> Figure:
    """Both runs, each in its tools and out of them."""
    from umform.plotting import COLOURS, Plot, house_style

    lines = (
        ("formed, first run", first.formed, COLOURS[0], "--"),
        ("sprung, first run", first.sprung, COLOURS[0], "-"),
        ("formed in the compensated tools", last.formed, COLOURS[1], "--"),
        ("out of the compensated tools", last.sprung, COLOURS[1], "-"),
    )
    with house_style():
        figure = Plot(figsize=(7.5, 4.5), layout="constrained")
        axes = figure.add_subplot()
        for label, line, colour, style in lines:
            if line is None:
                continue
            axes.plot(*line.T, style, color=colour, label=label)
        axes.set(xlabel="x", ylabel="z", aspect="equal", title="Middle of the sheet")
        axes.legend()
    return figure
