"""Air bends of several sheets at once."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import umform as uf
from umform.cli import app
from umform.cli.stack import stacked
from umform.errors import InvalidValue
from umform.materials import J2, Voce
from umform.processes.air_bending import AirBending, StackedSheet, air_bending
from umform.processes.air_bending.budget import error_budget
from umform.processes.air_bending.files import record
from umform.processes.air_bending.formulas import _bending, shop_forces
from umform.processes.air_bending.outcome import names_of, outcome_of
from umform.processes.air_bending.problem import problem_of
from umform.processes.air_bending.search import find_stroke, transformed_stiffness
from umform.processes.air_bending.section import Section
from umform.processes.air_bending.spec import dc04_like
from umform.processes.air_bending.stacked import gaps_of
from umform.processes.bend_sequence import Bend, BendSequence

COARSE = {"elements_per_thickness": 1, "layers": 1, "increment": 0.02}


def stack(friction=0.0, second=1.0, **given):
    above = StackedSheet(second, dc04_like(), friction)
    return AirBending(**COARSE | {"thickness": 1.0, "opening": 16.0, "stroke": 2.0, "on_top": [above]} | given)


@pytest.fixture(scope="module")
def free():
    return air_bending(stack(), progress=False)


def test_two_sheets_need_twice_the_force_of_one(free):
    one = air_bending(replace(free.case, on_top=()), progress=False)
    assert free.measures.largest_force == pytest.approx(2.0 * one.measures.largest_force, rel=0.04)
    assert free.measures.springback == pytest.approx(one.measures.springback, rel=0.02)
    assert free.case.largest_stroke < one.case.largest_stroke
    assert free.measures.below_die == 0.0


def test_an_oblique_metal_on_top_shears_along_the_bend():
    """In plane strain by supports only: the element of plane strain has no shear."""
    metal = uf.sheet_metals.get("AA6016-T4").law
    oblique = [
        replace(stack(rolling=angle), on_top=(StackedSheet(1.0, metal, 0.1),), stroke=1.0) for angle in (45.0, -45.0)
    ]
    one, other = (air_bending(case, progress=False) for case in oblique)
    assert one.case.shears and one.case.plane_strain is None and not stack(rolling=45.0).shears
    for name in ("force", "sheet1_radius", "sheet2_radius", "sheet2_angle", "outer_strain", "sheet1_gap"):
        # Round-off decides how many iterations come before the penalty of the sheets grows: .07 % of it differ.
        assert one[name].value == pytest.approx(other[name].value, rel=1e-4)


def test_friction_between_two_sheets_adds_the_moment_of_its_forces(free):
    """With M = 2 M1 + mu N t at the punch, N the force of a shoulder and l its lever: F = 2 F1 / (1 - mu t / l)."""
    rubbed = air_bending(stack(0.5), progress=False)
    lever = free.case.shoulder - 0.5 * free.case.punch_radius
    grown = rubbed.measures.largest_force / free.measures.largest_force
    assert 1.0 + 0.5 * 0.5 / lever < grown < 1.0 / (1.0 - 0.5 / lever)


def test_each_sheet_has_its_numbers(free):
    assert [one.released.thickness for one in free.stack] == pytest.approx([1.0, 1.0])
    assert free.stack[0].released.angle == free.measures.angle
    assert free["sheet2_springback"].value == pytest.approx(free["sheet1_springback"].value, abs=0.2)
    assert free.stack[1].gap is None
    assert 0.0 < free["sheet1_gap"].value < 0.1
    assert free["sheet2_radius"].value < free["sheet1_radius"].value
    assert free["angle"].band is None
    between = free.result["between1_fz"][np.flatnonzero(free.step == 1)[-1]]
    assert between == pytest.approx(free.result["punch_fz"][np.flatnonzero(free.step == 1)[-1]] * -1.0, rel=1e-4)
    rows = record(free)["sheets"]
    assert json.dumps(rows)
    assert [row["thickness"] for row in rows] == [1.0, 1.0]
    assert len(free.tables["Sheets"]) == 3


def test_the_error_budget_of_a_stack_has_the_numbers_of_each_sheet(free, monkeypatch):
    deeper = replace(free.case, penetration=0.05)
    monkeypatch.setattr("umform.processes.air_bending.budget.refinements", lambda case: {"depth": deeper})
    found = replace(free, budget=error_budget(free, processes=1, progress=False))
    other = air_bending(deeper, progress=False)
    for name in ("angle", "sheet1_gap", "sheet2_angle", "sheet2_radius"):
        change = abs(other[name].value - free[name].value)
        assert found[name].band.error == pytest.approx(change, abs=1e-9)
        assert change > 0.0


def test_the_problem_of_a_stack_is_a_deck(free):
    text = problem_of(free.case).toml()
    prepared = uf.problem.Problem.read(text).build()
    assert [body.name for body in prepared.model.bodies] == ["sheet1", "sheet2"]
    again = outcome_of(free.case, prepared.solve(progress=False))
    assert again.measures.angle == free.measures.angle
    assert set(names_of(free.case)) - again.values.keys() == {"sheet2_gap", "sheet2_gap_in_the_middle"}  # none above


def test_the_distance_of_two_sections():
    x = np.linspace(0.0, 10.0, 11)

    def flat(low, thickness, length=10.0):
        z = np.array([low, low + thickness])
        X = np.stack(np.broadcast_arrays(x[:, None] * length / 10.0, z[None]), axis=-1)
        return Section(X, X.copy(), 1)

    assert gaps_of(flat(0.0, 1.0), flat(1.25, 0.5)) == pytest.approx((0.25, 0.25))
    tilted = flat(1.0, 0.5, 14.0)
    tilted.current[..., 1] += 0.1 * tilted.current[..., 0]
    assert gaps_of(flat(0.0, 1.0), tilted) == pytest.approx((0.1 * 9.8, 0.0))


def test_bonded_sheets_of_one_metal_are_one_sheet():
    """With the same lines of nodes, and half of the thickness behind each face for the penalty."""
    case = stack(on_top=[StackedSheet(1.0, dc04_like(), bonded=True)])
    clad = air_bending(case, progress=False)
    one = air_bending(replace(case, on_top=(), thickness=2.0, layers=2), progress=False)
    assert clad.result.model.mesh.points.shape == one.result.model.mesh.points.shape
    assert clad.measures.angle == pytest.approx(one.measures.angle, abs=1e-3)
    assert clad.measures.largest_force == pytest.approx(one.measures.largest_force, rel=1e-4)
    assert clad.measures.k_factor == pytest.approx(one.measures.k_factor, rel=1e-4)
    assert shop_forces(case) == pytest.approx(shop_forces(one.case))
    assert clad.stack[0].gap is None and clad.stack[0].released.thickness == pytest.approx(1.0)
    assert not problem_of(case).contents.sheet_contacts
    assert record(clad)["sheets"][1]["bonded"] is True


def test_a_bond_is_a_word_in_place_of_a_coefficient():
    loose, rough, clad = stacked(["DC04,0.8", "DC04,0.8,0.1", "DC04, 0.8, bonded"])
    assert [(one.friction, one.bonded) for one in (loose, rough, clad)] == [(0.0, False), (0.1, False), (0.0, True)]
    with pytest.raises(InvalidValue, match="perhaps a coefficient") as refused:
        stacked(["DC04,bonded"])
    assert "0.1,bonded" in refused.value.remedy


def test_the_shop_takes_the_plastic_moment_of_bonded_sheets():
    """Layers of 1 and 3 in plastic bending: the neutral fibre is 1/3 within the stiff one."""
    assert _bending([(300.0, 1.5)]) == pytest.approx(300.0 * 1.5**2)
    moment = 1.0 * 1.0 * (0.5 + 1.0 / 3.0) + 3.0 * 0.5 * ((1.0 / 3.0) ** 2 + (2.0 / 3.0) ** 2)
    assert _bending([(1.0, 1.0), (3.0, 1.0)]) == pytest.approx(4.0 * moment)


def test_a_stack_is_refused_where_one_sheet_is_meant():
    with pytest.raises(InvalidValue, match="not pressed onto the flanks"):
        stack(bottoming=True, stroke=None, punch_angle=88.0, die_angle=88.0)
    with pytest.raises(InvalidValue, match="this has one sheet"):
        BendSequence(length=60.0, bends=[Bend(30.0, angle=90.0)], sheet=replace(stack(), stroke=None))
    with pytest.raises(InvalidValue, match="friction"):
        StackedSheet(1.0, dc04_like(), 20.0)
    with pytest.raises(InvalidValue, match="a bonded sheet does not slide"):
        StackedSheet(1.0, dc04_like(), 0.1, bonded=True)
    with pytest.raises(InvalidValue, match="does not fit the thickness"):
        stack(second=20.0)


def test_derivatives_of_a_stack_are_those_of_differences():
    def angles(radius):
        bend = air_bending(stack(0.1, die_radius=radius), progress=False)
        return [one.value for one in bend.quantities if one.name in ("sheet1_angle", "sheet2_angle")]

    found = uf.derivatives(stack(0.1), ["die_radius"], progress=False)
    rates = [one.value for one in found if one.response.name in ("sheet1_angle", "sheet2_angle")]
    step = 1e-3
    expected = [(up - down) / (2.0 * step) for up, down in zip(angles(2.0 + step), angles(2.0 - step), strict=True)]
    np.testing.assert_allclose(rates, expected, rtol=1e-3)


def test_the_stroke_of_an_angle_takes_the_stiffness_of_bonded_sheets():
    """A soft foil below: the estimated springback that ends a part of the search is that of the sheet."""
    assert transformed_stiffness([3.0], [2.0]) == pytest.approx(3.0 * 2.0**3 / 12.0)
    assert transformed_stiffness([3.0, 3.0], [0.5, 1.5]) == pytest.approx(3.0 * 2.0**3 / 12.0)
    foil = J2(E=250.0, nu=0.45, hardening=Voce(10.0, 25.0, 1.5))
    above = StackedSheet(1.0, dc04_like(), bonded=True)
    case = AirBending(**COARSE | {"thickness": 0.1, "material": foil, "opening": 12.0, "on_top": [above]})
    found = find_stroke(case, 120.0, tolerance=0.1, progress=False)
    assert found.measures.angle == pytest.approx(120.0, abs=0.1)


def test_a_study_of_the_command_takes_numbers_of_further_sheets(tmp_path):
    coarse = ["--layers", "1", "--elements-per-thickness", "1", "--increment", "0.05"]
    words = ["--thickness", "1", "--stroke", "0.5", "--on-top", "DC04,0.5,bonded", "--derive", "on_top.0.thickness"]
    done = CliRunner().invoke(app, ["bend", *words, *coarse, "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert "on_top.0.thickness" in (tmp_path / "derivatives.csv").read_text()
