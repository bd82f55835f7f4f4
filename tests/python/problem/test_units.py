"""Units: what is unusual is a warning, what no metal sheet comes near to an error."""

from dataclasses import replace

import numpy as np
import pytest

import umform as uf
from umform.materials import J2, Perfect, Voce
from umform.problem import DeckError, Problem
from umform.problem.findings import Level, accept, error, ok, warning
from umform.problem.named_units import named_units
from umform.problem.plausible import of_model
from umform.problem.units import extent
from umform.processes.air_bending import AirBending, StackedSheet
from umform.processes.air_bending.problem import build
from umform.surfaces import UDie, write_tool

OK, WARNING, ERROR = [Level.OK], [Level.WARNING], [Level.ERROR]


def levels(findings):
    return [finding.level for finding in findings]


def plastic(E, hardening):
    return {"law": "J2", "E": E, "nu": 0.3, "hardening": hardening}


def test_moduli_and_lengths(strip, found):
    assert levels(found(strip, "units")) == OK
    (pascal,) = found(strip, "units", material__E=210e9)
    assert pascal.level is Level.WARNING
    assert "Pa with mm" in pascal.text
    (giga,) = found(strip, "units", material__E=210.0)
    assert giga.level is Level.WARNING
    assert "GPa with mm" in giga.text
    small = {"mesh__length": 0.01, "mesh__width": 0.002, "mesh__thickness": 0.001}
    (metres,) = found(strip, "units", **small)
    assert "MPa with m?" in metres.text
    assert levels(found(strip, "units", material__E=210e9, **small)) == OK


@pytest.mark.parametrize(
    ("E", "yield_stress", "level"),
    [
        (210e3, 160.0, None),
        (210e9, 160e6, None),
        (210e3, 2.0, Level.ERROR),
        (210.0, 160.0, Level.ERROR),  # E in GPa
        (210e3, 0.2, Level.ERROR),  # yield stress in GPa
        (210e3, 10.0, Level.WARNING),
        (2.1e3, 160.0, Level.WARNING),
    ],
)
def test_yield_stress_against_the_modulus(E, yield_stress, level, strip, found):
    material = plastic(E, {"curve": "Perfect", "yield_stress": yield_stress})
    told = [finding for finding in found(strip, "units", material=material) if "first yield" in finding.text]
    assert levels(told) == ([] if level is None else [level])


@pytest.mark.parametrize(("end", "level"), [(0.2, None), (3.0, Level.WARNING), (20.0, Level.ERROR)])
def test_a_curve_in_per_cent(end, level, strip, found):
    curve = {"curve": "Table", "eqps": [0.0, 0.5 * end, end], "stress": [200.0, 300.0, 350.0]}
    told = [
        finding for finding in found(strip, "material", material=plastic(210e3, curve)) if "per cent" in finding.text
    ]
    assert levels(told) == ([] if level is None else [level])


@pytest.mark.parametrize(("width", "level"), [(2.0, Level.OK), (0.05, Level.WARNING), (0.002, Level.ERROR)])
def test_a_side_against_the_thickness(width, level, strip, found):
    (told,) = found(strip, "sheet", mesh__width=width)
    assert told.level is level


def test_a_metal_of_the_library_has_its_units(strip, found):
    thin = {"mesh__length": 0.06, "mesh__width": 0.01, "mesh__thickness": 0.001}
    told = found(strip, "units", material={"library": "DC04"}, **thin)[0]
    assert told.level is Level.ERROR
    assert "lengths are in mm" in told.text
    assert found(strip, "units", material={"library": "DC04"})[0].level is Level.OK


def test_the_modulus_of_a_bend_is_in_MPa():
    for E, yield_stress in ((210.0, 0.2), (210e9, 160e6)):
        model, _ = build(AirBending(stroke=6.0, material=J2(E=E, nu=0.3, hardening=Perfect(yield_stress))))
        assert Level.ERROR in levels(of_model(model, millimetres=True))
    model, _ = build(AirBending(stroke=6.0))
    assert set(levels(of_model(model, millimetres=True))) == {Level.OK}


@pytest.mark.parametrize(
    ("keys", "unit", "about", "remedy"),
    [
        ('shape = "Extruded"\nprofile = "die.dxf"', "m", "tools.it.profile", 'unit = "m"'),
        ('shape = "Extruded"\nprofile = { file = "die.dxf", unit = "m" }', "m", None, ""),
        ('shape = "Extruded"\nprofile = { file = "die.dxf", unit = "m" }', "mm", "tools.it.profile", 'unit = "mm"'),
        ('shape = "Extruded"\nprofile = "die.dxf"', "furlong", None, ""),
        ('shape = "Extruded"\nprofile = "die.dxf"', "inch", "tools.it.profile", 'unit = "in"'),
        ('shape = "Drawing"\nfile = "die.step"', "m", "tool it", "scale = 0.001"),
        ('shape = "Drawing"\nfile = "die.step"\nscale = 0.001', "m", None, ""),
        ('shape = "Drawing"\nfile = "die.stl"', "m", None, ""),
    ],
)
def test_drawings_in_another_unit_than_that_of_the_deck(keys, unit, about, remedy, strip, tmp_path):
    pytest.importorskip("ezdxf")
    write_tool(UDie(20, 18, 2, 2), tmp_path / "die.dxf")
    deck = Problem.read(f'{strip}[tools.it]\n{keys}\n[units]\nlength = "{unit}"\n', folder=tmp_path)
    found = list(named_units(deck))
    assert [(one.about, one.level) for one in found] == ([] if about is None else [(about, Level.WARNING)])
    assert all(remedy in one.remedy for one in found)


@pytest.mark.parametrize(
    ("units", "warned"),
    [
        ('length = "m"', True),
        ('length = "mm"', False),
        ('length = "inches"', True),
        ('length = "mm"\nforce = "kN"', True),
        ('force = "lbf"', True),
        ('length = "m"\nforce = "MN"', False),  # MN over square metres is MPa
        ('length = "mm"\nforce = "N"', False),
        ('length = "furlong"\nforce = "N"', False),
    ],
)
def test_a_metal_of_the_library_in_other_units(units, warned, strip):
    text = strip.replace('law = "SVK"\nE = 210e3\nnu = 0.3', 'library = "DC04"')
    deck = Problem.read(f"{text}[units]\n{units}\n")
    assert [(one.about, one.level) for one in named_units(deck)] == [("units", Level.WARNING)] * warned


def test_a_stiff_penalty(texts, found):
    stiff = found(texts("free-bending"), "contact cylinder", contacts__cylinder__penalty=1e9)
    assert Level.WARNING in levels(stiff)
    for wild in (1e300, 1e-300):
        assert Level.ERROR in levels(found(texts("free-bending"), "contact cylinder", contacts__cylinder__penalty=wild))


def test_errors_are_refused_together_unless_forced():
    findings = [ok("a", "fine"), warning("b", "odd", "look"), error("c", "off", "mend"), error("d", "wild", "tame")]
    with pytest.raises(DeckError) as caught:
        accept(findings, force=False)
    assert [(told.where, told.what) for told in caught.value.errors] == [("c", "off"), ("d", "wild")]
    assert all("--force" in told.remedy for told in caught.value.errors)
    with pytest.raises(DeckError) as caught:  # where nothing overrules
        accept(findings)
    assert not any("--force" in told.remedy for told in caught.value.errors)
    assert [line.split(":")[0] for line in accept(findings, force=True)] == ["b", "c", "d"]
    assert len(accept(findings[:2])) == 1


@pytest.mark.parametrize(
    ("E", "strain", "level"), [(250.0, 0.04, []), (250.0, 0.18, WARNING), (20e3, 0.04, []), (22e3, 0.04, WARNING)]
)
def test_only_a_foil_that_is_far_softer_than_the_sheet_yields_late(E, strain, level):
    """Polyethylene yields at 10 MPa of 250, a strain of .04."""
    law = J2(E=E, nu=0.4, hardening=Voce(strain * E, 2.0 * strain * E, 1.5))
    case = AirBending(thickness=1.0, opening=12.0, stroke=1.0, friction=0.3, elements_per_thickness=1, layers=1)
    model, _ = build(replace(case, on_top=[StackedSheet(0.1, law, 0.3)]))
    assert levels(finding for finding in of_model(model) if "first yield" in finding.text) == level


def test_the_width_of_plane_strain_is_free_wherever_the_strip_lies():
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    for Q, across in ((np.eye(3), "y"), (turn, "x")):
        model = uf.Model(uf.mesh.strip(20.0, 0.005, 1.0, (10, 1)), material=uf.SVK(E=210e3, nu=0.3))
        model.u = (model.mesh.points @ (Q.T - np.eye(3))).ravel()
        model.fix(range(len(model.mesh.points)), across, here=True)
        assert levels([extent(model)]) == OK
