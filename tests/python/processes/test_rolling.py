"""Bends of cards with directions: springback over the rolling angle, symmetry, deck, refusals."""

from __future__ import annotations

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from umform.cli import app
from umform.errors import InvalidValue
from umform.problem import Problem
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.air_bending.formulas import shop_forces
from umform.processes.air_bending.problem import problem_of
from umform.processes.bend_sequence import Bend, BendSequence, bend_sequence
from umform.processes.draw_bead.case import build
from umform.processes.draw_bead.spec import DrawBead
from umform.sheet_metals import get, uniaxial

ROOT = Path(__file__).parents[3]
ALUMINIUM = get("AA6016-T4").law
COARSE = AirBending(
    thickness=1.0,
    opening=12.0,
    stroke=2.5,
    elements_per_thickness=1.0,
    layers=1,
    increment=0.0125,
    material=ALUMINIUM,
    rolling=90.0,
)


@pytest.fixture(scope="module")
def bends():
    return {angle: air_bending(replace(COARSE, rolling=angle), progress=False) for angle in (0.0, 45.0, 90.0)}


def test_force_and_springback_follow_the_yield_stress(bends):
    """At 45 degrees the sheet is softest: the lowest force, and the least springback."""
    force = {angle: bend.measures.largest_force for angle, bend in bends.items()}
    springback = {angle: bend.measures.springback for angle, bend in bends.items()}
    assert force[45.0] < min(force[0.0], force[90.0])
    assert springback[45.0] < min(springback[0.0], springback[90.0])
    softest = uniaxial(ALUMINIUM.yield_function, 45)[0] / uniaxial(ALUMINIUM.yield_function, 0)[0]
    assert force[45.0] / force[90.0] == pytest.approx(softest, abs=0.05)


def test_plus_and_minus_are_mirror_images(bends):
    other = air_bending(replace(COARSE, rolling=-45.0), progress=False)
    for name in ("angle", "radius", "smallest_radius", "k_factor", "outer_strain", "thinning"):
        assert other[name].value == pytest.approx(bends[45.0][name].value, rel=1e-6), name


def test_so_are_those_of_a_part():
    """Its strip is turned over for the second bend."""
    bends = (Bend(20.0, 150.0), Bend(45.0, 150.0, direction="down"))
    parts = []
    for rolling in (45.0, -45.0):
        sheet = replace(COARSE, stroke=None, rolling=rolling)
        parts.append(bend_sequence(BendSequence(length=65.0, bends=bends, sheet=sheet), progress=False))
    one, other = (part.profile for part in parts)
    assert other == pytest.approx(one, abs=1e-6)


def test_the_deck_gives_the_same_bits(bends):
    text = problem_of(bends[45.0].case).toml()
    assert "rolling = { angle = 45.0 }" in text
    again = Problem.read(text).build().solve(progress=False)
    assert np.array_equal(again["stroke_force"], bends[45.0].result["stroke_force"])


def test_the_rule_of_the_shop_takes_the_bar_across_the_bend():
    along, at45 = (shop_forces(replace(COARSE, rolling=angle))[0] for angle in (90.0, 45.0))
    assert at45 < 0.95 * along


def test_what_is_refused():
    with pytest.raises(InvalidValue, match="which is not given"):
        replace(COARSE, rolling=None)
    with pytest.raises(InvalidValue, match="along or across"):
        replace(COARSE, width=20.0, rolling=45.0)
    with pytest.raises(InvalidValue, match="-180 to 180"):
        replace(COARSE, rolling=270.0)
    assert replace(COARSE, width=20.0, rolling=0.0).rolling == 0.0
    with pytest.raises(InvalidValue, match="which is not given"):
        DrawBead(thickness=1.0, material=ALUMINIUM)


def test_a_bead_takes_the_direction_too():
    model, _ = build(DrawBead(thickness=1.0, material=ALUMINIUM, rolling=90.0))
    assert model.bodies.only.rolling == pytest.approx([-1.0, 0.0, 0.0])


def test_the_example_writes_its_table():
    example = runpy.run_path(str(ROOT / "examples" / "rolling_angle.py"))
    found = {"AA6016-T4": example["bends"]("AA6016-T4", (45,))}
    row = next(line for line in (ROOT / "docs" / "materials.md").read_text().splitlines() if "T4, springback |" in line)
    assert found["AA6016-T4"][45].springback == pytest.approx(float(row.split("|")[5]), rel=0.02)
    assert f"{found['AA6016-T4'][45].springback:.2f}" in example["table"](found)
    assert len(example["draw"](found).axes) == 1


def test_the_command(tmp_path):
    given = ["bend", "--stroke", "1", "--material", "AA6016-T4", "--print-deck"]
    assert "--rolling" in CliRunner().invoke(app, given).stderr
    done = CliRunner().invoke(app, [*given, "--rolling", "45"])
    assert done.exit_code == 0
    assert "rolling = { angle = 45.0 }" in done.stdout
