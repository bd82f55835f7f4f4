"""Standard deviations and shares of an air bend and of a U-bend, beside 200 random runs."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import NDArray

import umform as uf
from umform.analysis.run import Result
from umform.processes.air_bending import AirBending
from umform.results.quantity import Quantity
from umform.studies.derivatives.derive import subject_of
from umform.studies.derivatives.responses import responses
from umform_book.balance import balance_row
from umform_book.case import Case
from umform_book.page import Page

Floats = NDArray[np.float64]
#: Random runs, those of the short case, and the seed.
RUNS, FEW, SEED = 200, 5, 1
#: Limits: of the standard deviation, and of shares in per cent.
WITHIN, POINTS = 0.1, 5.0
#: Root mean square of what the derivatives do not explain, over sigma, that would raise the deviation by its limit.
REST = math.sqrt((1.0 + WITHIN) ** 2 - 1.0)

#: Length of the strip of the U-bend, of its clamped part, and the gap beside the punch, mm.
LENGTH, CLAMPED, GAP = 24.0, 3.0, 1.2


@dataclass(frozen=True)
class Study:
    """What is varied, and what is compared.

    Attributes
    ----------
    subject : object
        Of :func:`umform.scatter`.
    sources : dict of str to str or float
        What scatters.
    of : tuple of str or callable
        Results.
    values : dict of str to float, optional
        Values of the parameters of a function.
    """

    subject: Any
    sources: Mapping[str, str | float]
    of: tuple[str | Callable[[Result], Quantity], ...]
    values: Mapping[str, float] | None = None

    def results(self, changes: Mapping[str, float]) -> list[float]:
        """Results of a run with other values."""
        thing = subject_of(self.subject, self.values, None, None).with_(changes)
        built = thing.build()
        result = uf.solve(built.model, built.steps, options=built.options, frames=1, progress=False)
        found = responses(self.of, thing.quantities(built, result), result)
        return [float(one.quantity.value or np.nan) for one in found]


def channel(thickness: float, strength: float, exponent: float, friction: float, edge: float) -> Any:
    """Model and steps of half of a U-bend: a die wipes the wall over the edge of a punch, which holds the bottom."""
    x = np.linspace(-CLAMPED, LENGTH - CLAMPED, 37)
    metal = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(strength, 0.0071, exponent))
    model = uf.Model(uf.mesh.grid(x, [0.0, 1.0], [0.0, thickness]), "BEND8", material=metal, plane_strain=True)
    model.fix("x0")
    model.fix(lambda x, y, z: x > -math.inf, "y")
    shoulder = uf.Box((edge + GAP + 25.0, 0.0, thickness + 50.0), (50.0, 100.0, 100.0), 4.0)
    rule = {"friction": friction, "points": 3}
    punch = model.contact("lower", uf.WipingDie(edge, origin=(edge, 0.0, 0.0)), name="punch", **rule)
    die = model.contact("upper", shoulder, name="die", **rule)
    down = model.drive(die, "-z", "stroke")
    return model, [uf.Move(down, to=17.0, steps=40), uf.Free([die, punch], steps=4)]


def angle(result: Result) -> Quantity:
    """Angle of the wall, from its last third."""
    X = result.model.mesh.points
    end, begin = (
        (X + result.model.u.reshape(-1, 3))[np.abs(X[:, 0] - at) < 1e-6].mean(axis=0)
        for at in (LENGTH - CLAMPED, LENGTH * 2.0 / 3.0 - CLAMPED)
    )
    way = end - begin
    return Quantity("angle of the wall", "degrees", 2, value=math.degrees(math.atan2(-way[2], way[0])))


def largest_force(result: Result) -> Quantity:
    """Largest force of the die."""
    return Quantity("largest force of the die", "N/mm", 2, value=float(result["stroke_force"].max()))


BRAKE = Study(
    AirBending(stroke=6.1, increment=0.0125),
    {
        "thickness": "1%",
        "material.hardening.strength": "4%",
        "material.hardening.exponent": "4%",
        "die_radius": 0.05,
        "opening": 0.05,
    },
    ("angle", "springback", "largest_force"),
)
CHANNEL = Study(
    channel,
    {"thickness": "1%", "strength": "4%", "exponent": "4%", "friction": "20%", "edge": "2%"},
    (angle, largest_force),
    {"thickness": 1.0, "strength": 1000.0, "exponent": 0.15, "friction": 0.1, "edge": 5.0},
)


def latin(runs: int, columns: int) -> Floats:
    """Standard normal numbers of a Latin hypercube: each column has one number in each of as many equal parts."""
    random = np.random.default_rng(SEED)
    cells = np.stack([random.permutation(runs) for _ in range(columns)], axis=1)
    ppf = np.vectorize(NormalDist().inv_cdf)
    numbers: Floats = ppf((cells + random.random(cells.shape)) / runs)
    return numbers


def _shares(x: Floats, y: Floats) -> Floats:
    """Shares of independent standard normal columns in the variance of results, by least squares, in per cent."""
    slopes = np.linalg.lstsq(np.column_stack([np.ones(len(x)), x]), y, rcond=None)[0][1:]
    shares: Floats = 100.0 * slopes**2 / (slopes**2).sum(axis=0)
    return shares


def _timed(call: Any) -> tuple[Any, float]:
    start = time.process_time()
    return call(), time.process_time() - start


def run(page: Page, study: Study) -> None:
    """Fill the page."""
    study.results({})  # the first run loads what the others have
    _, one = _timed(lambda: study.results({}))
    found, cost = _timed(
        lambda: uf.scatter(study.subject, study.sources, study.of, values=study.values, progress=False)
    )
    names = [spread.name for spread in found]
    page.balances.append(balance_row(page.case.name, "the run", found.derivatives.run))
    values = {source.path: float(source.parameter.value) for source in found.sources}
    sizes = np.array([source.deviation for source in found.sources])
    x = latin(FEW if page.short else RUNS, len(sizes))
    rows = []
    for number in page.each(range(len(x)), lambda number: f"random run {number + 1}"):
        changes: Mapping[str, float] = dict(
            zip(values, np.array(list(values.values())) + sizes * x[number], strict=True)
        )
        rows.append(study.results(changes))
    y = np.array(rows)
    deviations = np.array([found[name].deviation.value for name in names])
    means = np.array([found[name].mean.value for name in names])
    slopes = np.array([[found.derivatives[name, path].value for path in values] for name in names])
    rest = np.sqrt(np.mean(((y - means - x @ (slopes * sizes).T) / deviations) ** 2, axis=0))
    for name, part in zip(names, rest, strict=True):
        page.at_most(f"{name}: what the derivatives leave of the runs, root mean square over sigma", part, REST)
    if page.short:
        return
    page.text(
        f"Cost: {cost / one:.0f} runs, by processor time, for {len(sizes)} parameters and with the second run; the "
        f"comparison takes {RUNS}."
    )
    _compare(page, found, names, x, y)


def _compare(page: Page, found: uf.Scattered, names: Sequence[str], x: Floats, y: Floats) -> None:
    """Standard deviations and shares beside those of random runs."""
    rows = []
    for name, sample, mean in zip(names, y.std(axis=0, ddof=1), y.mean(axis=0), strict=True):
        spread = found[name]
        page.check(f"{name}: standard deviation", spread.deviation.value or np.nan, sample, WITHIN)
        rows.append((name, spread.response.unit, spread.mean.value, mean, spread.deviation.value, sample))
    columns = ("result", "unit", "mean", f"mean of {RUNS} runs", "sigma", f"sigma of {RUNS} runs")
    page.table("Mean and standard deviation", columns, rows)
    shares = []
    for name, sampled in zip(names, _shares(x, y).T, strict=True):
        ours = [one.value or np.nan for one in found[name].shares.values()]
        page.at_most(f"{name}: largest difference of a share, points", float(np.abs(ours - sampled).max()), POINTS)
        for source, one, other in zip(found.sources, ours, sampled, strict=True):
            shares.append((name, source.path, one, float(other)))
    page.table("Shares of the variance, %", ("result", "parameter", "share", f"share in {RUNS} runs"), shares)
    page.figure("shares", found.plot(), "Shares of the parameters in the variance of the results")
    for second in found.second_runs:
        changes = {name: second.change(name) for name in names if found[name].largest == second.path}
        told = ", ".join(f"{name} {pair[0]:+.3g} and {pair[1]:+.3g}" for name, pair in changes.items() if pair)
        page.text(f"Predicted and found change by {second.title}: {told}.")
    for warning in found.warnings:
        page.text(f"Warning: {warning}.")


_REFERENCE = f"""
Runs with random values: normal distributions, a Latin hypercube with a fixed seed. Their standard deviation has an
error of 2 to 3 % by the sample; shares are those of a linear fit. Limits: {100 * WITHIN:g} % of the standard deviation,
{POINTS:g} points of a share; what the derivatives leave of the runs may raise the standard deviation by no more than
that, so its root mean square is at most {REST:.2f} sigma.
"""


def _scatter_text(study: Study) -> str:
    return ", ".join(f"{path} {size}{'' if isinstance(size, str) else ' mm'}" for path, size in study.sources.items())


BEND = Case(
    name="scatter-air-bend",
    title=f"Scatter of an air bend beside {RUNS} random runs",
    problem=f"""
Air bending with the defaults of `umform bend`, stroke 6.1 mm, increments of 1/80 of the opening. Standard deviations:
{_scatter_text(BRAKE)}. The number of elements follows from the thickness: it is 36 or 38.
""",
    reference=_REFERENCE,
    run=partial(run, study=BRAKE),
    cost=150.0,
)
U_BEND = Case(
    name="scatter-u-bend",
    title=f"Scatter of a U-bend beside {RUNS} random runs",
    problem=f"""
Half of a U-bend in plane strain: the die, with an edge of 4 mm, wipes the wall over the edge of the punch, of 5 mm,
which holds the bottom; then both leave. Sheet of 1 mm, Swift 1000 (0.0071 + e)^0.15, friction 0.1, 36 elements BEND8,
40 increments; a gap of {GAP:g} mm. A function builds it. Standard deviations: {_scatter_text(CHANNEL)}.
""",
    reference=_REFERENCE,
    run=partial(run, study=CHANNEL),
    cost=160.0,
)
