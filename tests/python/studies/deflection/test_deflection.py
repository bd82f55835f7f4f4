"""Deflection of a press brake against closed forms and direct runs; crowning removes what it says."""

from dataclasses import replace

import numpy as np
import pytest

import umform as uf
from umform.processes.air_bending import AirBending, air_bending, bending_table
from umform.studies.deflection import PressBrake, angle_along, beam_deflection

BRAKE = PressBrake(span=3100.0, ram_height=1400.0, ram_thickness=60.0, bed_height=1200.0, bed_thickness=80.0)
CASE = AirBending(stroke=3.0, layers=1, elements_per_thickness=1, increment=0.05)


def test_a_beam_under_a_load_on_its_whole_span():
    span, height, thickness, q, G = 3000.0, 900.0, 50.0, 100.0, 210e3 / 2.6
    inertia, A = thickness * height**3 / 12.0, 5.0 / 6.0 * thickness * height
    found = beam_deflection([0.0, 0.5 * span, span], span, height, thickness, q, 0.0, span)
    assert found[1] == pytest.approx(5 * q * span**4 / (384 * 210e3 * inertia) + q * span**2 / (8 * G * A), rel=1e-12)
    assert np.abs(found[[0, 2]]).max() < 1e-12


def test_a_short_load_is_a_force():
    """A force F at the distance a: F b x (S² - b² - x²) / (6 E I S) of bending before it, F b x / (S G A) of shear."""
    span, height, thickness, F, a, x = 3000.0, 40.0, 10.0, 7.0, 1100.0, 600.0
    b, E_I = span - a, 210e3 * thickness * height**3 / 12.0
    shear = F * b * x / span / (210e3 / 2.6 * 5.0 / 6.0 * thickness * height)
    found = beam_deflection([x], span, height, thickness, F / 0.2, a - 0.1, a + 0.1)[0]
    assert found == pytest.approx(F * b * x * (span**2 - b**2 - x**2) / (6 * E_I * span) + shear, rel=1e-7)


def test_mesh_of_a_plate_deflects_as_the_beam():
    """A plate of solid-shells on edge: the beam with shear, without formulas of the beam."""
    span, height, thickness, q = 3000.0, 600.0, 50.0, 100.0
    plate = uf.mesh.grid(np.linspace(0, span / 2, 31), np.linspace(0, height, 13), [0.0, thickness])
    model = uf.Model(plate, "EAS3DEAS", material=uf.SVK(E=210e3, nu=0.3))
    middle = np.flatnonzero(plate.points[:, 0] == 0.0)
    end = np.flatnonzero(plate.points[:, 0] == span / 2)
    model.symmetry(middle, "x")
    model.fix(end, "y")
    model.fix([0], "z")
    model.fix([int(end[0])], "z")
    model.fix([int(middle[-2])], "z")
    load = model.traction("y1", (0.0, -q / thickness, 0.0), "load")
    uf.solve(model, uf.Move(load, 1.0, steps=1), progress=False)
    axis = np.flatnonzero((plate.points[:, 1] == height / 2) & (plate.points[:, 0] == 0.0))
    found = -model.u.reshape(-1, 3)[axis, 1].mean()
    theory = beam_deflection([span / 2], span, height, thickness, q, 0.0, span)[0]
    assert found == pytest.approx(theory, rel=0.02)


def test_the_angle_along_a_bend_is_that_of_direct_runs():
    found = angle_along(CASE, BRAKE, 3000.0)
    y, angles = found.y, found.angles()
    assert np.allclose(angles, angles[::-1])
    at = [0, 25, 50]
    strokes = 3.0 - found.deflection[at]
    rows = bending_table(replace(CASE, stroke=None), [float(s) for s in strokes])
    direct = sorted(row.angle for row in rows)
    assert np.abs(np.sort(angles[at]) - direct).max() < 0.03 * (found.angles().max() - found.angle)
    assert found.error > 0.0 and y[0] == -1500.0


def test_the_best_crowning_makes_middle_and_ends_equal():
    found = angle_along(CASE, BRAKE, 2500.0)
    best = replace(found, brake=replace(BRAKE, crowning=found.best_crowning))
    assert abs(best.error) < 1e-10 < abs(found.error)
    assert np.ptp(best.angles()) < 0.1 * abs(found.error)
    assert "crowning" in best.annex.notes[1]


@pytest.mark.parametrize(
    ("brake", "message"),
    [
        ({"span": 3000.0}, "does not deflect"),
        ({"ram_height": 900.0, "ram_thickness": 50.0}, "distance of the side frames"),
        ({"span": 3000.0, "ram_height": 900.0}, "height and a thickness"),
        ({"span": -3000.0, "ram_height": 900.0, "ram_thickness": 50.0}, "span"),
    ],
)
def test_a_press_brake_that_is_none_is_refused(brake, message):
    with pytest.raises(uf.errors.InvalidValue, match=message):
        PressBrake(**brake)


def test_the_bend_of_another_case_is_refused():
    other = air_bending(replace(CASE, stroke=2.0), progress=False)
    with pytest.raises(uf.errors.InvalidValue, match="outcome of another case"):
        angle_along(CASE, BRAKE, 3000.0, other)


def test_a_bend_longer_than_the_press_brake_is_refused():
    with pytest.raises(uf.errors.InvalidValue, match="between the side frames"):
        angle_along(CASE, BRAKE, 3200.0)
