"""Settings of a contact: its penalty from the penetration that is allowed, its number of points."""

from __future__ import annotations

import logging
import math

import numpy as np
import pytest

from umform import materials as mt
from umform.errors import InvalidPenalty, InvalidValue
from umform.materials.user_law import UserLaw
from umform.mesh import graded, grid, strip
from umform.model import Model
from umform.model.contact.encounter import sheet_thickness
from umform.model.contact.settings import contact_length
from umform.surfaces import Cylinder, Extruded, Plane, Profile, Sphere
from umform.surfaces.directions import rotation_matrix

PLASTIC = mt.J2(E=210e3, nu=0.3, hardening=mt.Perfect(200.0))
ELEMENT = {"hex8": "ANS3DEAS", "hex18": "MI9K3DEAS"}


def sheet(cells=(20, 1), cell="hex8", unit=1.0, law=PLASTIC):
    return Model(strip(40.0 * unit, 10.0 * unit, 1.0 * unit, cells, cell=cell), ELEMENT[cell], material=law)


def roller(radius=10.0, unit=1.0):
    return Cylinder((20.0 * unit, 0.0, -(radius + 0.5) * unit), "y", radius * unit)


# Penalty from penetration -----------------------------------------------------------------------------------


def test_the_penalty_carries_the_line_force_of_a_plastic_bend_at_the_penetration_that_is_allowed():
    model = sheet()
    contact = model.contact("lower", roller(), penetration=0.004, points=10)
    line_force = 2.0 / math.sqrt(3.0) * 200.0 * 1.0 / 8.0
    assert contact.penalty == pytest.approx(line_force / (0.004 * 4 / 3 * math.sqrt(2 * 10 * 0.004)), rel=0.01)
    assert contact.allowed == 0.004
    assert contact_length(10.0, line_force, contact.penalty) == pytest.approx(2 * math.sqrt(2 * 10 * 0.004), rel=0.01)
    coarse = sheet().contact("lower", roller(), penetration=0.004, points=1)  # one row takes it all
    assert coarse.penalty == pytest.approx(line_force / (0.004 * 2.0), rel=0.01)


def test_a_200th_of_the_thickness_is_allowed_by_default():
    contact = sheet().contact("lower", roller())
    assert contact.allowed == pytest.approx(1 / 200)
    assert contact.penalty == sheet().contact("lower", roller(), penetration=1 / 200).penalty
    assert (contact.points, contact.augmented) == (2, False)


@pytest.mark.parametrize("layers", [1, 2, 3])
def test_the_thickness_is_that_of_all_layers(layers):
    mesh = grid(graded(4.0, 4), [0.0, 1.0], graded(0.6, layers))
    assert sheet_thickness(mesh) == pytest.approx(0.6)


@pytest.mark.parametrize("law", [PLASTIC, mt.NeoHooke(E=1000.0, nu=0.3), mt.SVK(E=1000.0, nu=0.0)])
def test_the_estimate_knows_no_units(law):
    """A sheet in metres and pascals gets the penalty of the same sheet in millimetres and megapascals."""
    small = mt.J2(E=210e9, nu=0.3, hardening=mt.Perfect(200e6)) if law is PLASTIC else type(law)(E=1000e6, nu=law.nu)
    mm = sheet(law=law).contact("lower", roller(), points="auto")
    m = sheet(law=small, unit=1e-3).contact("lower", roller(unit=1e-3), points="auto")
    assert m.penalty == pytest.approx(1e9 * mm.penalty, rel=1e-6)
    assert m.points == mm.points


def test_a_thin_elastic_sheet_bends_at_the_stress_of_the_radius():
    """E / (1 - nu^2) times h / (2 R + h) at the faces."""
    contact = sheet(law=mt.SVK(E=1000.0, nu=0.3)).contact("lower", roller(radius=20.0), penetration=0.01, points=10)
    line_force = 1000.0 / 0.91 / 41.0 / 8.0
    assert contact.penalty == pytest.approx(line_force / (0.01 * 4 / 3 * math.sqrt(2 * 20 * 0.01)), rel=0.05)


@pytest.mark.parametrize(
    "tool",
    [
        Plane((0.0, 0.0, -0.5)),
        Cylinder((20.0, 0.0, 49.5), "y", 50.0, inside=True),
        Sphere((20.0, 5.0, -5.5), 5.0),
        Extruded(Profile.from_corners([(20.0, -9.0), (20.0, -0.5), (0.0, -0.5)], 0.0, closed=False)),
    ],
    ids=["flat", "hollow", "sphere", "edge"],
)
def test_any_tool_gets_a_penalty_that_the_sheet_can_feel(tool):
    contact = sheet().contact("lower", tool, points="auto")
    assert 1e-3 * 210e3 < contact.penalty <= 10.0 * 210e3 / 0.91 * 1.001
    assert 2 <= contact.points <= 10


def test_a_law_without_a_stress_is_refused():
    nothing = UserLaw(lambda E, state: (0 * E, np.tile(np.eye(6), (len(E), 1, 1)), state), name="nothing")
    model = sheet(law=nothing)
    with pytest.raises(InvalidPenalty, match="no bending stress"):
        model.contact("lower", roller())
    assert model.contact("lower", roller(), penalty=5.0).penalty == 5.0


@pytest.mark.parametrize("penetration", [0.0, -1.0, math.nan, math.inf])
def test_a_penetration_must_be_positive(penetration):
    with pytest.raises(InvalidValue, match="the allowed penetration must be positive"):
        sheet().contact("lower", roller(), penetration=penetration)


def test_penalty_and_penetration_together_are_for_multipliers():
    with pytest.raises(InvalidValue, match="not both"):
        sheet().contact("lower", roller(), penalty=1.0, penetration=0.1)
    both = sheet().contact("lower", roller(), penalty=1.0, penetration=0.1, augmented=True)
    assert (both.penalty, both.allowed) == (1.0, 0.1)
    assert sheet().contact("lower", roller(), penalty=1.0).allowed is None


# Number of points -------------------------------------------------------------------------------------------


def wanted(length, penalty, radius=10.0):
    """Six points within the length that touches in the narrowest die."""
    return 6.0 * length / contact_length(radius, 2.0 / math.sqrt(3.0) * 200.0 / 8.0, penalty)


@pytest.mark.parametrize(("cells", "penalty"), [(20, 300.0), (20, 1000.0), (40, 1000.0), (40, 5000.0), (10, 200.0)])
def test_points_grow_with_the_length_of_a_facet_and_the_cube_root_of_the_penalty(cells, penalty):
    expected = wanted(40.0 / cells, penalty)
    assert 2 < expected < 10
    contact = sheet((cells, 1)).contact("lower", roller(), penalty=penalty, points="auto")
    assert contact.points == math.ceil(expected)
    assert contact.block.points == cells * contact.points**2


def test_only_the_length_across_the_tool_counts():
    """Ten times as wide facets along the cylinder need no more points."""
    across = sheet((20, 1)).contact("lower", roller(), penalty=1000.0, points="auto")
    wide = Model(strip(40.0, 100.0, 1.0, (20, 1)), material=PLASTIC)
    assert wide.contact("lower", roller(), penalty=1000.0, points="auto").points == across.points


def test_the_choice_under_a_sphere_does_not_depend_on_the_axes():
    """A sphere is as sharp in all directions of a face, whichever two of them a decomposition takes."""

    def penalty(turn):
        Q = rotation_matrix(turn * np.array([1.0, 2.0, 3.0]))
        model = Model(sheet().mesh.transformed(lambda X: X @ Q.T), material=PLASTIC)
        return model.contact("upper", Sphere(Q @ [14.0, 3.0, 2.4], 2.0), points=4).penalty

    assert [penalty(turn) for turn in (0.14, 0.36, 0.51)] == pytest.approx([penalty(0.0)] * 3, rel=1e-9)


@pytest.mark.parametrize(("cell", "least"), [("hex8", 2), ("hex18", 3)])
def test_points_are_neither_too_few_nor_too_many(cell, least):
    soft = sheet(cell=cell).contact("lower", roller(), penalty=1e-6, points="auto")
    stiff = sheet(cell=cell).contact("lower", roller(), penalty=1e9, points="auto")
    assert (soft.points, stiff.points) == (least, 10)


def test_the_choice_is_logged(caplog):
    with caplog.at_level(logging.INFO, logger="umform.contact"):
        sheet().contact("lower", roller(), points="auto", name="die")
    assert "contact die: thickness 1, tool radius 10" in caplog.text
