"""A soft foil on the sheet of an air bend, and friction of the tools, which holds it."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from umform.errors import InvalidValue
from umform.materials import J2, Voce
from umform.processes.air_bending import AirBending, StackedSheet, air_bending
from umform.processes.air_bending.foil import refuse_squeezed, tip_pressure
from umform.processes.air_bending.formulas import shop_forces
from umform.processes.air_bending.sheet import lines_along, lines_through
from umform.processes.air_bending.spec import dc04_like

COARSE = {"elements_per_thickness": 1, "layers": 1, "increment": 0.02, "thickness": 1.0, "opening": 12.0}
FILM = J2(E=250.0, nu=0.45, hardening=Voce(10.0, 25.0, 1.5))


def test_friction_of_the_shoulders_raises_the_force():
    """The leg at the slope a is pulled in: F = 2 M (cos a + mu sin a) / (l + mu d), d from t/2 to t below."""
    free, rubbed = (air_bending(AirBending(**COARSE, stroke=2.0, friction=mu), progress=False) for mu in (0.0, 0.3))
    slope = math.radians(0.5 * (180.0 - free.measures.loaded_angle))
    lever = (free.case.shoulder - free.case.radii * math.sin(slope)) / math.cos(slope) + free.case.punch_radius
    grown = rubbed.measures.largest_force / free.measures.largest_force
    pulled = 1.0 + 0.3 * math.tan(slope)
    assert pulled / (1.0 + 0.3 / lever) < grown < pulled / (1.0 + 0.15 / lever)
    assert rubbed.force_balance < 1e-6
    assert rubbed.result["friction_work"][-1] > 0.0


def test_friction_on_both_faces_holds_a_foil_below_the_punch():
    case = AirBending(**COARSE, element="BEND8", stroke=0.4, friction=0.3)
    covered, bare = (
        air_bending(replace(case, on_top=sheets), progress=False) for sheets in ([StackedSheet(0.1, FILM, 0.3)], [])
    )
    assert 0.8 < covered.stack[1].loaded.thicknesses.min() < 0.98
    assert covered.measures.largest_force == pytest.approx(bare.measures.largest_force, rel=0.05)
    assert covered.measures.loaded_angle > bare.measures.loaded_angle  # the foil gives way: the sheet follows later


@pytest.mark.parametrize("below", [True, False])
def test_a_foil_that_sticks_follows_the_sheet_on_either_side_without_friction(below):
    sheet = StackedSheet(1.0, dc04_like(), bonded=True)
    case = AirBending(**COARSE, stroke=3.5)
    bare = air_bending(case, progress=False)
    if below:
        covered = air_bending(replace(case, thickness=0.1, material=FILM, on_top=[sheet]), progress=False)
    else:
        covered = air_bending(replace(case, on_top=[StackedSheet(0.1, FILM, bonded=True)]), progress=False)
    assert covered.measures.largest_force == pytest.approx(bare.measures.largest_force, rel=0.05)
    assert covered.measures.springback == pytest.approx(bare.measures.springback, rel=0.05)
    assert covered.measures.angle == pytest.approx(bare.measures.angle, abs=1.0)
    assert covered.penetration < 0.0055  # of the foil, at most that which is allowed for the sheet
    assert covered.force_balance < 1e-6


def test_elements_of_bonded_sheets_follow_the_thinnest():
    case = AirBending(thickness=3.0, opening=24.0, on_top=[StackedSheet(0.1, FILM, bonded=True)])
    assert 0.5 < lines_along(case)[1] <= 0.6
    assert lines_along(replace(case, on_top=()))[1] > 0.8
    assert [len(lines_through(case, number)) for number in range(2)] == [3, 2]
    loose = replace(case, on_top=[StackedSheet(1.0, FILM, 0.1)], friction=0.1)
    assert [len(lines_through(loose, number)) for number in range(2)] == [3, 3]


def test_the_flow_stress_in_plane_strain_decides_and_the_rule_of_the_shop():
    """Between 25 MPa, which is squeezed out without friction, and 41 MPa, which stays."""
    case = AirBending(**COARSE, on_top=[StackedSheet(0.1, FILM)])
    with pytest.raises(InvalidValue) as refused:
        refuse_squeezed(case)
    bears, pressure = 2.0 / math.sqrt(3.0) * (25.0 - 15.0 * math.exp(-1.5)), tip_pressure(case)
    assert f"it bears {bears:.3g} MPa" in refused.value.cause and f"about {pressure:.3g} MPa" in refused.value.cause
    assert pressure == pytest.approx(shop_forces(case)[0] / (0.7 * case.punch_radius))
    refuse_squeezed(replace(case, on_top=[StackedSheet(0.1, replace(FILM, hardening=Voce(20.0, 40.0, 1.5)))]))


def test_a_foil_that_slides_freely_is_refused():
    sheet = StackedSheet(1.0, dc04_like())
    for rubs in ({"friction": 0.2}, {}):
        with pytest.raises(InvalidValue, match="squeezed out") as refused:
            air_bending(AirBending(**COARSE, stroke=1.0, on_top=[StackedSheet(0.1, FILM)], **rubs))
    assert "friction on both of its faces" in str(refused.value)
    with pytest.raises(InvalidValue, match="sheet1 would be squeezed out"):
        air_bending(AirBending(**COARSE | {"thickness": 0.1}, material=FILM, on_top=[sheet], stroke=1.0))
