"""Values, tools and columns for people."""

import numpy as np
import pytest

import umform as uf
from umform.report.words import column_text, text_of
from umform.sheet_metals import get, name_of, sheet_text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (6.26326444370525, "6.26326"),
        (-0.0, "0"),
        (True, "yes"),
        (3, "3"),
        ((0.0, 1.5), "0, 1.5"),
        (np.zeros((4, 2)), "8 values"),
        ({"tolerance": 1e-3, "none": None}, "tolerance 0.001"),
        (uf.Cylinder((25, 0, -20.5), "y", 20), "cylinder: centre 25, 0, -20.5; axis y; radius 20"),
    ],
)
def test_values(value, text):
    assert text_of(value) == text


def test_a_material_is_described_by_its_constants():
    assert text_of(uf.J2(E=2e5, nu=0.3, hardening=uf.Linear(160.0, 500.0))).startswith("J2: E = 200000")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("punch_fz", "punch force in z"),
        ("die_mx", "die moment about x"),
        ("stroke_force", "stroke force"),
        ("time", "time"),
    ],
)
def test_columns(name, text):
    assert column_text(name) == text


@pytest.mark.parametrize("name", ["DC04", "EN AW-5754", "AA6016-T4"])
def test_a_law_of_the_library_has_its_name(name):
    assert name_of(get(name).law) == name and sheet_text(get(name).law, 2.0) == f"{name}, 2 mm"


def test_other_laws_have_none():
    assert name_of(uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(160.0, 500.0))) == ""
    assert name_of(object()) == "" and sheet_text(object(), 1.5) == "1.5 mm sheet"


def test_a_thick_sheet_has_the_name_of_its_metal():
    thick = get("S355", 20.0)
    assert thick.law != get("S355").law and name_of(thick.law) == "S355"
