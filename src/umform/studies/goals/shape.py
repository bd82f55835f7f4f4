"""Offset fields of tools with which a part has its wanted shape after springback. docs/theory, 5.17"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import Result, solve
from umform.analysis.steps import Free, Release, Step
from umform.errors import InvalidValue, SolveError
from umform.io.tables import write_csv
from umform.mesh import Selector
from umform.model import Model, Tool
from umform.model.contact.encounter import sheet_thickness
from umform.problem.problem import Problem
from umform.problem.unloading import loading_steps
from umform.progress import Show, progress_bar
from umform.report.symmetry import mirrors
from umform.results.forming.tool_distance import pose_in
from umform.results.outcome import Annex, Study
from umform.spec import check_value, each
from umform.spec.types import Count, Positive
from umform.studies.goals.deviation import SmoothFace, deviations
from umform.studies.goals.files import write_deck
from umform.studies.goals.found import DECK, TABLE
from umform.surfaces import OffsetByField, OffsetField, Placed
from umform.surfaces import Tool as Shape

Floats = NDArray[np.float64]
#: A function of the user: offset fields by the names of tools -> model and steps, of which the last release the part.
Build = Callable[..., tuple[Model, Sequence[Step]]]

#: Part of the deviation of the first run that is wanted by default.
_WITHIN = 0.1
#: Nodes farther from a tool, in thicknesses, say nothing about its field.
_REACH = 2.0
#: Weights of first and second differences of the coefficients against the fit: the first one whose field is not too
#: steep. Those of coefficients with less than this part of the most metal count more.
_SMOOTH, _BESIDE, _MORE = (1e-4, 1e-3, 1e-2, 1e-1), 0.05, 100.0
#: Weight of the changes of the coefficients.
_SMALL = 1e-6
#: Changes of the deviations below this part of the largest one are noise, and do not say how tools act.
_KNOWN = 5e-2
#: Halvings of a change whose run fails.
_HALVINGS = 3
#: File of the deviations.
DEVIATIONS = "deviations.csv"


@dataclass(frozen=True)
class ShapeTrial:
    """A run on the way to a shape.

    Attributes
    ----------
    values : dict of str to tuple of float
        Coefficients of the fields by the names of the tools.
    deviation : ndarray, shape (n,)
        Of the nodes of the face.
    part : float
        Part of the wanted change of the shape with which the run succeeded.
    """

    values: dict[str, Sequence[float]]
    deviation: Floats
    part: float = 1.0

    @property
    def largest(self) -> float:
        """Largest deviation."""
        return float(np.abs(self.deviation).max())

    @property
    def rms(self) -> float:
        """Root of the mean of the squares of the deviations."""
        return float(np.sqrt(np.mean(self.deviation**2)))


@dataclass(frozen=True, repr=False)
class CompensatedShape(Study):
    """Offset fields for a wanted shape.

    Attributes
    ----------
    subject : Problem or callable
        The problem with the fields of the best run; a function stays as it is.
    fields : dict of str to OffsetField
        These fields by the names of the tools.
    trials : tuple of ShapeTrial
        All runs.
    points : ndarray, shape (n, 3)
        The nodes of the face in the tools of the first run.
    within : float
        The wanted largest deviation.
    stopped : str
        Why there are no more runs, if one failed.

    Examples
    --------
    >>> import numpy as np
    >>> import umform as uf
    >>> from umform.studies.goals.shape import ShapeTrial
    >>> first = ShapeTrial({"die": np.zeros(4)}, np.array([0.5, -0.2]))
    >>> second = ShapeTrial({"die": np.full(4, -0.3)}, np.array([0.04, 0.02]))
    >>> found = uf.CompensatedShape(None, {}, (first, second), np.zeros((2, 3)), within=0.05)
    >>> found.reached, found.best.largest
    (True, 0.04)
    """

    subject: Any
    fields: dict[str, OffsetField]
    trials: tuple[ShapeTrial, ...]
    points: Floats
    within: float
    stopped: str = ""

    @property
    def best(self) -> ShapeTrial:
        """The run with the least largest deviation."""
        return min(self.trials, key=lambda one: one.largest)

    @property
    def reached(self) -> bool:
        """Whether its largest deviation is within the wanted one."""
        return self.best.largest <= self.within

    @property
    def table(self) -> list[list[str]]:
        """A header, and a row for each run."""
        rows = [
            ["run", "largest deviation", "rms deviation", "of the first run", "largest offset", "part of the change"]
        ]
        for number, one in enumerate(self.trials, start=1):
            offset = max(float(np.abs(values).max()) for values in one.values.values())
            share = f"{100.0 * one.largest / self.trials[0].largest:.1f} %"
            numbers = f"{one.largest:.4g}", f"{one.rms:.4g}", share, f"{offset:.4g}", f"{one.part:g}"
            rows.append([str(number), *numbers])
        return rows

    @property
    def annex(self) -> Annex:
        """The runs, and whether the shape was reached."""
        warnings = [f"the next run failed: {self.stopped}"] if self.stopped else []
        if not self.reached:
            reached = f"the largest deviation is {self.best.largest:.4g}, wanted {self.within:.4g}"
            warnings.append(f"{reached}: more runs or coefficients")
        return Annex("Compensation", self.table, warnings=warnings)

    def write(self, folder: str | Path) -> list[Path]:
        """Write the table of the runs, the deviations of the first and the best one, and the deck with the fields."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        columns: dict[str, Any] = {
            "largest": [one.largest for one in self.trials],
            "rms": [one.rms for one in self.trials],
        }
        for name in self.fields:
            for number, values in enumerate(zip(*(one.values[name] for one in self.trials), strict=True)):
                columns[f"{name}.{number}"] = values
        write_csv(folder / TABLE, columns)
        places = dict(zip("xyz", self.points.T, strict=True))
        ends = {"first": self.trials[0].deviation, "best": self.best.deviation}
        write_csv(folder / DEVIATIONS, places | ends)
        files = [folder / TABLE, folder / DEVIATIONS]
        if isinstance(self.subject, Problem):
            files.append(write_deck(folder / DECK, self.subject, "a wanted shape"))
        return files


def compensate_shape(
    subject: Problem | Build,
    faces: Selector,
    by: str | Sequence[str] | Mapping[str, OffsetField],
    *,
    wanted: Shape | None = None,
    within: Positive | None = None,
    most: Count = 4,
    factor: Positive = 1.0,
    options: NewtonOptions | None = None,
    solver: str | None = None,
    progress: Show = None,
) -> CompensatedShape:
    """Find offset fields of tools with which a part has its wanted shape after springback.

    The wanted shape is that in the tools of the first run, or that of a surface. Each run moves the surfaces of the
    tools by the deviation of the released part, to the other side; from the third run on by what all runs before say
    of its effect.

    Parameters
    ----------
    subject : Problem or callable
        A problem whose last steps release the part; or a function that is called with the fields by the names of the
        tools, and returns a model with such tools and its steps.
    faces : str, callable or array_like
        Lower or upper faces of the sheet that are compared.
    by : str, sequence of str, or mapping of str to OffsetField
        Tools with an offset field that follows; with the fields to begin with for a function. Give all tools that shape
        these faces.
    wanted : Tool, optional
        Wanted surface of these faces, in the position of the part in the tools.
    within : float, optional
        Wanted largest deviation; by default a tenth of that of the first run.
    most : int
        Largest number of runs.
    factor : float
        Part of a deviation that the second run takes off.
    options, solver
        Those of the run, for a function.
    progress : bool or callable, optional
        Show a progress bar.

    Returns
    -------
    CompensatedShape
        The fields of the best run, and all runs.

    Raises
    ------
    InvalidValue
        A tool has no field or shapes no part of the faces, the part is not released, or a number is none.
    NoConvergence
        The first run does not converge.

    Examples
    --------
    >>> import umform as uf
    >>> from umform.problem import load  # doctest: +SKIP
    >>> found = uf.compensate_shape(load("panel.toml"), "upper", ["die", "punch"])  # doctest: +SKIP
    >>> found.write("panel")  # doctest: +SKIP
    """
    for name, value in (("wanted", wanted), ("within", within), ("most", most), ("factor", factor)):
        check_value(compensate_shape, name, value)
    source = _Source.of(subject, each(by), options, solver)
    with progress_bar(progress) as tick:
        first = source.run({})
        search = _Search(first, faces, wanted)
        d = search.deviation(first)
        trials = [ShapeTrial({name: one.field.values for name, one in search.tools.items()}, d)]
        goal = _WITHIN * trials[0].largest if within is None else within
        offsets, stopped = [np.zeros_like(d)], ""
        while trials[-1].largest > goal and len(trials) < most and not stopped:
            tick("runs", min(1.0, goal / trials[-1].largest), f"{len(trials)} runs")
            change = _next(offsets, [one.deviation for one in trials], factor) - offsets[-1]
            for halving in range(_HALVINGS + 1):
                part = 0.5**halving
                try:
                    fields = search.fields(offsets[-1] + part * change)
                    d = search.deviation(source.run(fields))
                except (SolveError, InvalidValue) as error:
                    stopped = " ".join(str(error).split())
                    continue
                offsets.append(offsets[-1] + part * change)
                trials.append(ShapeTrial({name: one.values for name, one in fields.items()}, d, part))
                stopped = ""
                break
    best = min(trials, key=lambda one: one.largest)
    found = {name: replace(one.field, values=best.values[name]) for name, one in search.tools.items()}
    return CompensatedShape(source.with_(found).subject, found, tuple(trials), search.places, goal, stopped)


def _next(offsets: Sequence[Floats], found: Sequence[Floats], factor: float) -> Floats:
    """Next offset of the shape: that of the least deviation in the linear hull of the runs, less its deviation.

    eqs. (5.175), (5.176): with one run displacement adjustment, with more Broyden's (second) method for all of them.
    """
    z, d = offsets[-1], found[-1]
    if len(offsets) > 1:
        moves = np.stack([z - one for one in offsets[:-1]], axis=1)
        effects = np.stack([d - one for one in found[:-1]], axis=1)
        share = np.linalg.lstsq(effects, d, rcond=_KNOWN)[0]
        z, d = z - moves @ share, d - effects @ share
    return z - factor * d


@dataclass(frozen=True)
class _Run:
    """A run, and its state in the tools."""

    result: Result
    formed: Floats
    row: int
    tools: dict[str, Tool]

    @property
    def places(self) -> Floats:
        """Places of the nodes in the tools, shape (n, 3)."""
        return self.result.model.mesh.points + self.formed

    @property
    def released(self) -> Floats:
        """Places of the nodes at the end."""
        return self.result.model.positions


@dataclass(frozen=True)
class _Source:
    """A problem or a function whose tools have fields."""

    subject: Problem | Build
    start: Mapping[str, OffsetField]
    names: tuple[str, ...]
    settings: Mapping[str, Any]

    @classmethod
    def of(cls, subject: Any, by: Any, options: NewtonOptions | None, solver: str | None) -> _Source:
        fields = dict(by) if isinstance(by, Mapping) else {}
        if not by or not (fields or isinstance(subject, Problem)):
            raise InvalidValue(
                "a shape needs tools with offset fields",
                where="by",
                value=list(by),
                cause="none is named, or a function gets names without fields",
                remedy='["die", "punch"] of a problem; {"die": OffsetField(...)} of a function',
            )
        source = cls(subject, fields, tuple(by), {"options": options, "solver": solver or "auto"})
        return source.with_(fields) if isinstance(subject, Problem) else source

    def with_(self, fields: Mapping[str, OffsetField]) -> _Source:
        """The problem with other fields."""
        if not isinstance(self.subject, Problem):
            return self
        tools = self.subject.contents.tools
        if unknown := [name for name in self.names if name not in tools]:
            raise InvalidValue(
                "the deck has no tool of this name",
                where="by",
                value=", ".join(unknown),
                cause="another name, or that of a contact",
                remedy=f"one of {', '.join(tools)}" if tools else "a deck with tools",
            )
        tables = {
            f"tools.{name}.offset_field": {
                "along": [one if isinstance(one, str) else list(one) for one in field.along],
                "span": [list(one) for one in field.span],
                "coefficients": list(field.coefficients),
                "values": list(field.values),
            }
            for name, field in fields.items()
        }
        return replace(self, subject=self.subject.with_(tables)) if tables else self

    def run(self, fields: Mapping[str, OffsetField]) -> _Run:
        """Form and release the part."""
        if isinstance(self.subject, Problem):
            problem = self.with_(fields).subject
            assert isinstance(problem, Problem)
            built, loading = problem.build(), loading_steps(problem.contents)
            result = solve(
                built.model, built.steps, solver=built.solver, options=built.options, frames=1, progress=False
            )
            touching = {one.tool: built.contacts[name].tool for name, one in problem.contents.contacts.items()}
            return _formed(result, loading, {name: touching[name] for name in self.names if name in touching})
        model, steps = self.subject(**{**self.start, **fields})
        loading = len(steps)
        while loading and isinstance(steps[loading - 1], Free | Release):
            loading -= 1
        result = solve(model, steps, frames=1, progress=False, **self.settings)
        return _formed(result, loading, {one.name: one for one in model.tools if one.name in self.names})


def _formed(result: Result, loading: int, tools: dict[str, Tool]) -> _Run:
    last = [frame for frame in result.frames if result.rows[frame.number]["step"] <= loading]
    if not last or result.rows[-1]["step"] <= loading:
        raise InvalidValue(
            "the part is not released: it has no springback",
            where="shape",
            cause="the last step is none of the kind release or free",
            remedy="such a step at the end",
        )
    return _Run(result, last[-1].points["displacement"], last[-1].number, tools)


class _Search:
    """What the first run says of shape and tools."""

    def __init__(self, run: _Run, faces: Selector, wanted: Shape | None) -> None:
        mesh = run.result.model.mesh
        self.planes = mirrors(run.result.model)
        self.face = SmoothFace.of(mesh, faces, run.places, self.planes)
        self.wanted = wanted
        self.tools = {
            name: _FittedTool(name, tool, run, self.face, _REACH * sheet_thickness(mesh))
            for name, tool in run.tools.items()
        }

    @property
    def places(self) -> Floats:
        """Places of the nodes of the face in the tools of the first run."""
        return self.face.points

    def gap(self, x: Floats) -> tuple[Floats, Floats]:
        """Distance from the wanted shape along the outward normal of the face, and that normal."""
        if self.wanted is None:
            return self.face.gap(x)
        g, n, _ = self.wanted.gap(x)
        sign = np.sign(np.einsum("ni,ni->n", n, self.face.normals))
        return sign * g, sign[:, None] * n

    def deviation(self, run: _Run) -> Floats:
        """Deviation of a released part at the nodes of the face."""
        return deviations(run.released[self.face.nodes], self.face.points, self.gap, self.planes)

    def fields(self, offset: Floats) -> dict[str, OffsetField]:
        """Fields that move the surfaces of all tools by an offset of the face along its normal."""
        return {name: tool.fitted(offset) for name, tool in self.tools.items()}


class _FittedTool:
    """A tool whose field follows an offset of the face."""

    def __init__(self, name: str, tool: Tool, run: _Run, face: SmoothFace, reach: float) -> None:
        surface, Q, c = tool.surface, np.eye(3), np.zeros(3)
        while isinstance(surface, Placed):
            Q, c = Q @ np.array(surface.matrix), Q @ np.array(surface.shift) + c
            surface = surface.tool
        if not isinstance(surface, OffsetByField):
            low, high = (face.points.min(axis=0), face.points.max(axis=0))
            raise InvalidValue(
                "a tool has no offset field",
                where=f"tools.{name}",
                cause="its table has none, or the function does not use the field that it gets",
                remedy=f'offset_field = {{ along = ["x", "y"], span = [[{low[0]:.4g}, {high[0]:.4g}], '
                f"[{low[1]:.4g}, {high[1]:.4g}]], coefficients = [7, 5] }}, for a section along x alone",
            )
        rotation, shift = pose_in(tool, run.result.rows[run.row])
        x = np.ascontiguousarray((face.points - shift) @ rotation)
        g, n, _ = tool.kernel.gap(x)
        self.field, self.base, self.name = surface.field, surface.tool.kernel(), name
        self.near = np.abs(g) <= reach
        if not self.near.any():
            raise InvalidValue(
                "a tool shapes no part of the faces",
                where=f"tools.{name}",
                value=f"{np.abs(g).min():.4g} from them at the end of forming",
                cause="another tool, or faces that it does not reach",
                remedy="tools that hold the sheet in its shape then",
            )
        feet = (x - g[:, None] * n)[self.near]
        self.feet, self.normals = (feet - c) @ Q, (face.normals[self.near] @ rotation) @ Q

    def fitted(self, offset: Floats) -> OffsetField:
        """The field whose surface meets the feet moved by an offset, and is smooth elsewhere. eq. (5.177)"""
        moved = np.ascontiguousarray(self.feet + offset[self.near, None] * self.normals)
        w = self.base.gap(moved)[0]
        basis, rough = self.field.basis(moved), self.field.differences()
        support = np.where(rough != 0.0, basis.sum(axis=0) / basis.sum(axis=0).max(), np.inf).min(axis=1)
        rough = rough * np.where(support < _BESIDE, np.sqrt(_MORE), 1.0)[:, None] * np.sqrt(len(moved) / len(rough))
        start, zeros = np.array(self.field.values), np.zeros(len(rough) + basis.shape[1])
        small = np.sqrt(_SMALL * len(moved)) * np.eye(len(start))
        change = np.concatenate([w - basis @ start, zeros])
        for weight in _SMOOTH:
            rows = np.concatenate([basis, np.sqrt(weight) * rough, small])
            try:
                return replace(self.field, values=tuple(start + np.linalg.lstsq(rows, change, rcond=None)[0]))
            except InvalidValue as error:
                steep = error
        raise steep
