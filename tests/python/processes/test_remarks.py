"""Remarks beside the numbers of a bend: tools, coarse mesh, force for the press, extrapolated flow curve."""

from functools import partial
from types import SimpleNamespace

import pytest

from umform.errors import InvalidValue
from umform.materials import J2, CowperSymonds, Metal, Swift, Table
from umform.processes.air_bending import AirBending
from umform.processes.air_bending.formulas import shop_forces, uniform_strain
from umform.processes.air_bending.remarks import coarse_mesh, extrapolated, force_apart, tools_text, total_force
from umform.processes.air_bending.sheet import studied_mesh
from umform.processes.air_bending.stack import StackedSheet
from umform.processes.draw import UBend
from umform.processes.draw_bead.spec import DrawBead
from umform.processes.hemming.spec import acute
from umform.sheet_metals import get

STEEL = {"E": 210e3, "nu": 0.3}


def test_all_tools_are_named_given_or_not():
    case = AirBending(thickness=3.0, opening=24.0)
    assert tools_text(case) == "tools: V 24, 85 degrees, shoulder 2, punch radius 1.5, 85 degrees; V/t 8"


def test_only_a_mesh_below_the_default_is_coarse():
    assert coarse_mesh(AirBending()) == []
    assert coarse_mesh(AirBending(layers=4, thickness_points=5, elements_per_thickness=6.0)) == []
    (said,) = coarse_mesh(AirBending(layers=1, elements_per_thickness=1.0))
    assert "elements per thickness 1 (default 3), layers 1 (default 2)" in said
    (said,) = coarse_mesh(AirBending(element="BEND8"))
    assert "no bands" in said
    assert coarse_mesh(acute(), acute()) == []


@pytest.mark.parametrize("mesh", [{"element": "BEND8"}, {"layers": 1}])
def test_a_mesh_unlike_those_of_the_studies_has_no_band(mesh):
    assert studied_mesh(AirBending(elements_per_thickness=9.0, layers=4)) is not None
    assert studied_mesh(AirBending(**mesh)) is None
    assert studied_mesh(acute(), like=acute()) is not None


@pytest.mark.parametrize("case", [AirBending, partial(UBend, length=300.0, width=35.0, punch_width=50.0)])
def test_one_contact_point_is_refused_on_faces_of_nine_nodes(case):
    steel = get("DC04").law
    more = {} if case is AirBending else {"thickness": 0.8, "punch_edge": 5.0, "die_edge": 5.0, "holder_force": 2e3}
    with pytest.raises(InvalidValue, match="does not hold a face of nine nodes"):
        case(material=steel, contact_points=1, **more)
    case(material=steel, contact_points=1, element="BEND8", **more)


@pytest.mark.parametrize("case", [AirBending, UBend, DrawBead, partial(StackedSheet, 1.0)])
def test_a_metal_with_a_rate_is_refused(case):
    quick = Metal(**STEEL, hardening=Swift(520.0, 0.004, 0.2), rate=CowperSymonds(40.0, 5.0))
    more = {"thickness": 0.8, "length": 300.0, "width": 35.0, "punch_width": 50.0, "punch_edge": 5.0, "die_edge": 5.0}
    with pytest.raises(InvalidValue, match="have no speed"):
        case(material=quick, **(more | {"holder_force": 2e3} if case is UBend else {}))


def test_a_force_far_from_the_rule_is_explained():
    case = AirBending(material=get("1.4301").law)
    middle = 0.5 * sum(shop_forces(case))

    def said(ratio, now=0.9, case=case):
        return force_apart(case, SimpleNamespace(largest_force=ratio * middle, force=now * ratio * middle))

    assert said(0.9) == said(1.1) == []
    assert "24 % below" in said(0.76)[0]
    assert "friction" in said(0.76)[0] and "friction" not in said(1.2)[0]  # it explains no larger force
    assert "20 % above" in said(1.2)[0]
    assert said(0.5, now=1.0) == []  # the force still rises
    assert said(9.0, case=AirBending(bottoming=True, die_angle=88, punch_angle=88)) == []


@pytest.mark.parametrize("name", ["DC04", "DP600", "AA6016-T4"])
def test_the_uniform_strain_is_that_of_the_library(name):
    metal = get(name)
    assert uniform_strain(metal.law) == pytest.approx(metal.valid_strain, abs=5e-3)


@pytest.mark.parametrize("law", [J2, Metal])
def test_a_flow_curve_is_extrapolated_beyond_its_data(law):
    measured = AirBending(material=law(**STEEL, hardening=Table((0.0, 0.1, 0.4), (200.0, 300.0, 400.0))))
    assert extrapolated(measured, 0.39) == []
    assert "0.41 exceeds the 0.40" in extrapolated(measured, 0.41)[0]
    swift = AirBending(material=law(**STEEL, hardening=Swift(500.0, 1e-6, 0.2)))
    assert extrapolated(swift, 0.19) == []
    assert "exceeds the 0.20" in extrapolated(swift, 0.25)[0]


def test_the_force_on_a_length_is_in_kilonewtons_and_tonnes():
    assert total_force(98.0665, 1000.0) == "largest force on a bend length of 1000 mm: 98.07 kN (10 t)"
