"""The pictures of a run: force over displacement, and the final shape."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from umform.analysis.run import Result
from umform.analysis.steps import Release
from umform.model.terms.control import Control
from umform.model.terms.dead_load import Load
from umform.model.terms.pressure import Pressure
from umform.plotting import Plot, history_picture, house_style, shape_picture
from umform.problem.prepared import Prepared
from umform.report.symmetry import mirrors, whole
from umform.results.leading_controls import leading_controls
from umform.results.shape import Shape


def curve(problem: Prepared, result: Result) -> Figure:
    """Force over displacement of the control with the largest work; a load over the largest displacement."""
    moved = leading_controls(result)
    control = moved[0] if moved else main_control(problem)
    if isinstance(control, Load | Pressure):
        return _load_curve(control, result)
    return history_picture(result, control.name, [f"{control.name}_force"])


def shape(result: Result) -> Figure:
    """The whole part in its final state, with the mirror images of the modelled part."""
    return shape_picture(whole(Shape.of(result), mirrors(result.model)))


def main_control(problem: Prepared) -> Control:
    """The control that the first step moves."""
    step = problem.steps[0]
    return step.control if isinstance(step, Release) else step.moved()[0]


def _load_curve(control: Control, result: Result) -> Figure:
    """A load over the displacement of the node with the largest final displacement, frame by frame."""
    displacements = np.array([frame.points["displacement"] for frame in result.frames])
    farthest = int(np.argmax(np.linalg.norm(displacements[-1], axis=1)))
    values = result[control.name][[frame.number for frame in result.frames]]
    with house_style():
        figure = Plot(figsize=(5.6, 3.6), layout="constrained")
        axes = figure.add_subplot()
        axes.plot(np.linalg.norm(displacements[:, farthest], axis=1), values, marker=".", markersize=3)
        axes.set(xlabel=f"displacement of node {farthest}", ylabel=control.name)
    return figure
