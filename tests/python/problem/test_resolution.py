"""Elements, thickness, contact points and increments against what the tools ask for."""

import math

import numpy as np
import pytest

from umform.elements import element as element_of
from umform.elements.locking import locking_moment
from umform.problem.findings import Level
from umform.problem.resolution import against_locking

OK = [Level.OK]


def levels(findings):
    return [finding.level for finding in findings]


def test_element_size_on_the_smallest_radius(texts, found):
    text = texts("air-bending")
    fine, coarse = (found(text, "contact punch", mesh__cells=[n, 1])[1] for n in (40, 10))
    assert fine.level is Level.OK
    assert f"{math.degrees(0.35 / 3):.3g} degrees" in fine.text
    assert coarse.level is Level.WARNING
    assert "0.52 or less" in coarse.remedy
    curved = found(text, "contact punch", mesh__cells=[15, 1], element__name="BEND18")[1]
    assert curved.level is Level.OK
    coarse = found(text, "contact punch", mesh__cells=[10, 1], element__name="BEND18")[1]
    assert "1 or less" in coarse.remedy
    edge = found(text.replace("tip_radius = 3.0", "tip_radius = 0.0"), "contact punch")
    assert any("sharp edge" in finding.text and finding.level is Level.WARNING for finding in edge)


def test_element_size_is_measured_across_the_tool(texts, found):
    across = found(texts("free-bending"), "contact cylinder", mesh__cells=[24, 100])[1]
    assert "an element is 2.5 long" in across.text


def test_thickness_order_and_points(texts, found):
    text = texts("air-bending")
    assert levels(found(text, "element")) == OK
    (locks,) = found(text, "element", element__name="ANS3DEAS", element__thickness_order=1)
    assert locks.level is Level.WARNING
    assert "33.3 %" in locks.text
    few = found(text, "element", element__thickness_points=5)
    assert levels(few) == [Level.OK, Level.WARNING]


@pytest.mark.parametrize(
    ("element", "remedy"),
    [
        ({"name": "ANS3DEAS", "thickness_order": 1}, "leave thickness_order out, or give 4 or more"),
        ({"name": "DISP3D"}, "name = 'BEND8'"),
        ({"name": "DISP9K3D"}, "name = 'BEND18'"),
    ],
)
def test_an_element_that_locks_is_told_what_it_lacks(element, remedy, texts, found):
    locks = found(texts("air-bending"), "element", element=element)[0]
    assert locks.remedy == remedy


@pytest.mark.parametrize("name", ["BEND8", "BEND18", "ANS3DEAS"])
def test_where_no_order_follows_layers_are_advised_that_help(name, texts, found):
    text = texts("air-bending").replace("tip_radius = 3.0", "tip_radius = 0.5")
    locks = found(text, "element", element__name=name)[0]
    assert locks.level is Level.WARNING
    assert locks.remedy.startswith("2 layers of BEND18")
    assert found(text, "element", element__name="BEND18", mesh__layers=2)[0].level is Level.OK
    assert found(text, "element", element__name="EAS3DEAS", mesh__layers=16)[0].level is Level.OK


def test_one_layer_in_a_sharp_bend_is_told_of_its_springback(texts, found):
    text = texts("air-bending")
    sharp, layered = (found(text, "element", mesh__layers=layers)[0] for layers in (1, 4))
    (blunt,) = found(text.replace("shoulder_radius = 2.0", "shoulder_radius = 3.1"), "element")
    assert "springback of so sharp a bend" in sharp.text
    assert "springback" not in layered.text + blunt.text


def test_layers_share_the_thickness_points(texts, found):
    text = texts("air-bending")
    many = found(text, "element", element__thickness_points=5, mesh__layers=2)
    assert levels(many) == OK
    few = found(text, "element", element__thickness_points=3, mesh__layers=2, element__name="ANS3DEAS")
    assert few[-1].text.startswith("6 thickness points")
    assert few[-1].remedy == "take 4 in each layer"


def test_a_hardening_table_that_ends_before_the_bend(texts, found):
    text = texts("air-bending")
    curve = {"curve": "Table", "eqps": [0.0, 0.2], "stress": [200.0, 300.0]}
    (short,) = found(text, "material", material={"law": "J2", "E": 210e3, "nu": 0.3, "hardening": curve})
    assert short.level is Level.WARNING
    assert "ends at a plastic strain of 0.2" in short.text
    curve["eqps"] = [0.0, 0.5]
    assert found(text, "material", material={"law": "J2", "E": 210e3, "nu": 0.3, "hardening": curve}) == []


@pytest.mark.parametrize("stiffness", [1e30, 1e200, float("inf")])
def test_a_stiffness_of_another_unit_has_a_remedy_at_once(stiffness):
    remedy = against_locking(element_of("BEND18"), 0.025, stiffness, 1)
    assert remedy.startswith("a larger radius, or a yield stress in the unit of E")


def test_contact_points(texts, found):
    text = texts("free-bending")
    for points in ("nodes", 1):
        stairs = found(text, "contact cylinder", contacts__cylinder__points=points)
        assert any("stairs" in finding.text and finding.level is Level.WARNING for finding in stairs)
    assert not any("stairs" in finding.text for finding in found(text, "contact cylinder"))
    large = found(text, "contact cylinder", element__name="MI9K3DEAS", mesh__cells=[12, 1])
    assert any("points = 3 or more" in finding.remedy for finding in large)


def test_contact_cells(texts, found):
    text = texts("free-bending")
    for cells, few in ((2, True), (3, False)):
        keys = {"contacts__cylinder__cells": cells, "contacts__cylinder__points": None}
        findings = found(text, "contact cylinder", **keys)
        assert any("stiffer" in finding.text and "cells = 3" in finding.remedy for finding in findings) == few


def test_ways_of_steps(strip, texts, found):
    text = texts("free-bending")
    assert levels(found(text, "step 1")) == OK
    (fast,) = found(text, "step 1", steps__0__increments=20)
    assert fast.level is Level.WARNING
    assert fast.remedy == "increments = 30 or more"
    (far,) = found(text, "step 1", steps__0__to__punch=-15000.0)
    assert "farther than the sheet is long" in far.text
    assert found(text, "step 2") == []  # a release ends where it ends
    back = 'kind = "move"\nto = { punch = 5.0 }\nincrements = 1\n'
    assert found(text + "\n[[steps]]\n" + back, "step 3") == []
    assert levels(found(strip, "step 1", steps__0__increments=1)) == OK  # nothing is touched


def test_rotations_of_tools_are_radians(texts, found):
    turn = '[controls.fold]\nkind = "turn"\ncontact = "cylinder"\naxis = "y"\n'
    step = '[[steps]]\nkind = "move"\nto = { fold = 0.5 }\nincrements = 9\n'
    text = f"{texts('free-bending')}\n{turn}\n{step}"
    (half,) = found(text, "step 3")
    assert (half.level, half.text) == (Level.OK, "fold turns by 0.5 radians, 28.65 degrees")
    (far,) = found(text, "step 3", steps__2__to__fold=-45.0)
    assert far.level is Level.WARNING and far.remedy == "0.7854 turns by 45 degrees"


def test_locking_moment_is_that_of_the_theory():
    """The false moment (2.28), differentiated from its energy, over the plastic moment of plane strain."""
    kappa_over_y, h = 600.0, 2.0
    for layers in (2, 3):  # n false moments of (h / n)² each, at the strain of a layer
        of_a_layer = locking_moment(2, 0.2 / layers, kappa_over_y) / layers
        assert locking_moment(2, 0.2, kappa_over_y, layers) == pytest.approx(of_a_layer)

    def energy(k, order):
        z = np.linspace(-h / 2, h / 2, 4001)
        m, x, t = order + 1, k * h / 2, 2 * z / h
        beta = {2: 1.0, 3: 4 / 5, 4: 4 / 7}[m]
        legendre = np.polynomial.legendre.Legendre.basis(m)(t)
        return np.trapezoid(0.5 * kappa_over_y * (beta * x**m * legendre) ** 2, z)

    k = 0.2
    plastic = 2 / math.sqrt(3) * h**2 / 4
    for order in (1, 2, 3):
        moment = (energy(k * 1.0001, order) - energy(k * 0.9999, order)) / (2e-4 * k)
        assert locking_moment(order, k * h / 2, kappa_over_y) == pytest.approx(moment / plastic, rel=1e-4)


def test_a_strip_one_element_wide_is_bent_along_its_length(texts, found):
    text = texts("hat-rail")
    coarse = found(text, "contact punch", mesh__cells=[15, 1])[1]
    assert "an element is 6 long" in coarse.text and coarse.level is Level.WARNING
    assert "an element is 1 long" in found(text, "contact punch")[1].text


def test_a_box_bends_elements_across_its_edges(texts, found):
    text = texts("hat-rail").replace("width = 1.0", "width = 6.0")
    long = found(text, "contact punch", mesh__cells=[15, 6])[1]  # elements of 6 x 1
    assert "an element is 6 long" in long.text and long.level is Level.WARNING
    assert "an element is 1 long" in found(text, "contact punch", mesh__cells=[90, 2])[1].text  # 1 x 3
