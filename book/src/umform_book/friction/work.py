"""Work of friction by the number of increments: a block that slides, a strip whose points touch and leave."""

from __future__ import annotations

import numpy as np

from umform import mesh
from umform.analysis.run import Result
from umform.analysis.steps import Move
from umform.materials import SVK
from umform.model import Model
from umform.surfaces import Cylinder
from umform_book.case import Case
from umform_book.friction.block import EIGHT, MU, PRESSED, SLIP, block
from umform_book.page import Page
from umform_book.variants import Variant

LENGTH, THICKNESS, E, RUB = 24.0, 0.5, 2e5, 0.2
STROKE, PENALTY = 10.0, 1000.0
STRIP = Variant("BEND8")
#: Slides of the block, in allowed elastic slips.
TURNS = (100.0, -50.0)
#: Largest drift that a run may have without a warning.
WARNED = 0.01


def drawn(page: Page, increments: int) -> Result:
    """The block, pressed down and moved back and forth."""
    made = block(EIGHT, 2, 2)
    steps = [Move(made.press, -PRESSED, steps=2)]
    steps += [Move(made.push, [0.8 * turn * SLIP, 0.6 * turn * SLIP], steps=increments) for turn in TURNS]
    return page.solve(f"block, {increments} increments per stroke", made.model, steps)


def wiped(page: Page, increments: int) -> Result:
    """A clamped elastic strip is wiped over a roll by another one, and let go."""
    divisions = 24
    strip = mesh.strip(LENGTH, 1.0, THICKNESS, (divisions, 1), cell=STRIP.cell)
    strip = strip.transformed(lambda X: X - np.array([X[:, 0].min(), 0.0, 0.0]))
    model = Model(strip, STRIP.element, material=SVK(E=E, nu=0.3))
    model.fix(np.arange(len(strip.points)), "y")
    model.fix("x0")
    edge = Cylinder((8.0, 0.0, -4.25), "y", 4.0)
    model.contact("lower", edge, friction=RUB, points=4, penalty=PENALTY, name="edge")
    punch = model.tool("punch", Cylinder((16.0, 0.0, 3.25), "y", 3.0))
    model.contact("upper", punch, friction=RUB, points=4, penalty=PENALTY, name="wiper")
    stroke = model.drive(punch, "-z", name="stroke")
    steps = [Move(stroke, STROKE, steps=increments), Move(stroke, 0.0, steps=increments)]
    return page.solve(f"strip, {increments} increments per stroke", model, steps)


def run(page: Page) -> None:
    """Fill the page."""
    rows: list[tuple[str | float | int, ...]] = []
    for increments in page.pick((1, 5, 10, 20), (1, 5)):
        result = drawn(page, increments)
        normal = -float(result["plane_fz"][-1])
        slip = float(result["foot_elastic_slip"][-1])
        exact = MU * normal * (TURNS[0] * SLIP - slip + (TURNS[0] - TURNS[1]) * SLIP - 2.0 * slip)
        work = float(result["friction_work"][-1])
        rows.append((increments, work, exact, work / exact - 1.0))
        page.check(f"block, {increments} increments per stroke: work of friction", work, exact, 1e-6)
    page.table(
        "A block moved back and forth", ("increments per stroke", "work of friction", "exact", "deviation"), rows
    )
    counts = page.pick((10, 20, 40, 80, 160), (10, 20))
    runs = [wiped(page, increments) for increments in counts]
    finest = float(runs[-1]["friction_work"][-1])
    off = [abs(float(one["friction_work"][-1]) / finest - 1.0) for one in runs]
    drifts = [float(np.abs(one.balance().drift).max()) for one in runs]
    table = [
        (count, float(one["friction_work"][-1]), part, drift)
        for count, one, part, drift in zip(counts, runs, off, drifts, strict=True)
    ]
    page.table(
        "A strip wiped over a roll and let go",
        ("increments per stroke", "work of friction", "off the finest", "largest drift"),
        table,
    )
    page.at_most(f"strip, {counts[1]} increments per stroke: drift", drifts[1], 0.5 * WARNED)
    if len(counts) > 2:
        page.at_most("strip: error of the work at 40 increments over that at 10", off[2] / off[0], 1.0 / 8.0)
        page.at_most("strip: drift at 80 increments over that at 20", drifts[3] / drifts[1], 1.0 / 8.0)


CASE = Case(
    name="friction-work",
    title="Work of friction: points that begin to slip, touch and leave",
    problem=f"""
* The block of [friction-block](friction-block.md), drawn to {TURNS[0]:g} elastic slips and back to {TURNS[1]:g}, in
  1 to 20 increments per stroke.
* An elastic strip of {LENGTH:g} x {THICKNESS:g}, E = {E:g}, clamped at one end, is wiped by a roll of radius 3 over a
  roll of radius 4, by a stroke of {STROKE:g}, and let go; mu = {RUB:g}, {STRIP.name}, 24 elements, 4 x 4 contact
  points. Throughout the run points touch, slip, reverse and open.
""",
    reference="""
Block: mu N times the path minus the elastic slip, at the reversal minus twice that slip, for any number of increments.
Strip: the finest run; the error of the work falls with the square of the number of increments. So does the drift, until
single points that open or touch dominate it in the finest runs. Theory gives a factor of 16; the checks require 8.
""",
    run=run,
    cost=15.0,
)
