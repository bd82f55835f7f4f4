"""Friction of punch and die in a one-step estimate: pressure of a cylinder, the two sides, a bottom."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from formed_parts import cylinder

import umform as uf
from umform.flat_pattern.one_step.law import PathLaw
from umform.flat_pattern.one_step.part import sheet_of
from umform.flat_pattern.one_step.strain import Formed, areas, flat_sides
from umform.flat_pattern.one_step.tool_friction import ToolFriction
from umform_book.drawing.revolved import cup, disc

STEEL = uf.J2(210e3, 0.3, hardening=uf.Swift(520.0, 0.004, 0.2))
RADIUS, STRETCH, MU = 20.0, 1.1, 0.15


def bent_strip():
    """A part of a cylinder that was stretched along its arc."""
    points, triangles = cylinder(radius=RADIUS, cells=(60, 10))
    sheet = sheet_of(points, triangles, 1.0)
    arc = RADIUS * np.arctan2(sheet.points[:, 0], sheet.points[:, 2])
    X = np.stack([arc / STRETCH, sheet.points[:, 1] * np.sqrt(STRETCH)], axis=1)
    law = PathLaw.of(STEEL)
    stress = float(law.energy(np.array([np.log(STRETCH)]))[1][0])
    return sheet, Formed.of(sheet.points, sheet.triangles), X, law, stress


def test_the_pressure_of_a_stretched_strip_is_its_stress_over_the_radius():
    sheet, formed, X, law, stress = bent_strip()
    D = flat_sides(X, sheet.triangles)
    inner = abs(np.arctan2(*sheet.points[sheet.triangles].mean(axis=1)[:, [0, 2]].T)) < 0.9
    pressure = ToolFriction.of(sheet, formed, MU).pressure(D, law)[inner]
    assert pressure == pytest.approx(stress / RADIUS * (areas(D) / formed.area)[inner], rel=2e-3)


def test_ironing_is_no_pressure_of_the_curved_sheet():
    sheet, formed, X, law, _ = bent_strip()
    D, tools = flat_sides(X, sheet.triangles), ToolFriction.of(sheet, formed, MU)
    assert np.array_equal(tools.pressure(D, law), tools.pressure(D, replace(law, thickest=-0.5)))


def test_friction_is_the_coefficient_times_the_pressure_away_from_the_middle():
    """The strip lies above its edge, so the tool below it is the punch, which holds it back inwards."""
    sheet, formed, X, law, _ = bent_strip()
    tools = ToolFriction.of(sheet, formed, MU)
    found = tools.at(X, law)
    vectors = np.einsum("mik,mkl,ml->mi", formed.sides, formed.inverse, found.force)
    size = MU * tools.pressure(flat_sides(X, sheet.triangles), law) * formed.area
    off_centre = tools.outward.any(axis=1)
    assert np.count_nonzero(~off_centre) <= 2  # the slope of the function is zero in the middle
    assert np.linalg.norm(vectors[off_centre], axis=1) == pytest.approx(abs(size[off_centre]), rel=1e-9)
    centres = sheet.points[sheet.triangles].mean(axis=1) - np.array([0.0, 15.0, 0.0])
    near = (abs(centres[:, 1]) < 2.0) & (abs(centres[:, 0]) > 8.0) & (size > 0.0)
    assert near.sum() > 20
    assert (vectors[near, 0] * centres[near, 0]).max() < 0.0


def test_the_corners_of_a_triangle_share_the_force_on_it():
    """Each has a third; together they have the material force F^T f of the force f."""
    sheet, formed, X, law, _ = bent_strip()
    found = ToolFriction.of(sheet, formed, MU).at(X, law)
    D = flat_sides(X, sheet.triangles)
    r, K = np.zeros((len(D), 6)), np.zeros((len(D), 6, 6))
    found.add(X, D, sheet, formed, r, K)
    corners = r.reshape(-1, 3, 2)
    force = np.einsum("mik,mkl,ml->mi", formed.sides, formed.inverse, found.force)
    exact = np.einsum("mik,mkj,mi->mj", formed.sides, np.linalg.inv(D), force)
    assert abs(exact).max() > 1.0
    assert np.allclose(corners.sum(axis=1), exact, rtol=1e-12, atol=1e-12 * abs(exact).max())
    assert np.allclose(corners, corners[:, :1])


def test_a_part_and_its_mirror_image_have_the_same_blank():
    points, triangles = cup(10, 25.0)
    case = uf.Blank(STEEL, 1.0, friction=MU)
    one, other = (uf.blank((points * [1.0, 1.0, sign], triangles), case)["diameter"].value for sign in (1.0, -1.0))
    assert one == pytest.approx(other, rel=1e-6)


def test_friction_of_the_punch_keeps_the_bottom_from_being_stretched():
    flat, triangles = disc(16)
    r = 60.0 * np.hypot(*flat.T)
    dish = np.c_[60.0 * flat, 6.0 + 6.0 * np.cos(np.pi * np.clip((r - 8.0) / 24.0, 0.0, 1.0))]
    bottom = []
    for friction in (0.0, 0.2):
        found = uf.blank((dish, triangles), uf.Blank(STEEL, 1.0, friction=friction, bead=100.0))
        middle = np.hypot(*found.sheet.points[found.sheet.triangles].mean(axis=1)[:, :2].T)
        bottom.append(float(found.fields["thinning"][middle < 6.0].mean()))
    assert bottom[0] > 1.05 * bottom[1] > 0.0
