"""The form is that of the Specs: a new parameter of air bending is there without another line."""

import json
import re

import pytest

import umform
from umform.bench.form import BY_MESH, form_fields
from umform.bench.values import Mistakes
from umform.bench.wanted import Wanted
from umform.processes.air_bending import AirBending
from umform.spec import check_value, parameters

NEW = '''    crown: Length = 0.25
    """Crown of the die; the middle is higher by it."""
'''
PROGRAM = """
import json
from typer.testing import CliRunner
from umform.bench.form_check import look
from umform.bench.library import library
from umform.bench.wanted import Wanted
from umform.cli import app
from umform.processes.air_bending import AirBending

shown = CliRunner().invoke(app, ["bend", "--help"], env={"COLUMNS": "200", "TERMINAL_WIDTH": "200"}).stdout
(field,) = [one for one in library()["fields"] if one["name"] == "crown"]
wanted = Wanted.read({"crown": 0.5})
(problem,) = look({"crown": -1.0})["problems"]
crowns = [wanted.case().crown, wanted.values["crown"], AirBending().record()["crown"]]
print(json.dumps([shown, field, crowns, problem]))
"""


def test_a_new_parameter_of_air_bending_is_one_field(package_copy):
    """It is in the help of the command, in the form, in its problems, in the order and in the record."""
    package_copy.put("processes/air_bending/spec.py", "    die_angle:", NEW)
    shown, field, crowns, problem = json.loads(package_copy.run(PROGRAM))
    assert re.search(r"--crown\s+<float>\s+Crown of the die in mm; the middle is higher by it\.", shown)
    assert field["label"] == "the crown of the die" and field["help"] == "Crown of the die; the middle is higher by it."
    assert (field["unit"], field["default"], field["bounds"]) == ("mm", 0.25, {"gt": 0.0})
    assert (field["group"], field["kind"]) == ("Tools", "number")
    assert crowns == [0.5, 0.5, 0.25]
    assert problem["where"] == "crown" and problem["what"] == "the crown of the die must be positive and finite"


def test_the_form_has_the_defaults_and_bounds_of_air_bending():
    names = [name for name, one in form_fields().items() if one.parameter.spec is AirBending and not one.many]
    assert len(names) > 15
    for name in names:
        known = parameters(AirBending)[name]
        assert form_fields()[name].default == (None if name in BY_MESH else known.default)
        with pytest.raises(Mistakes) as refused:
            Wanted.read({name: -1e9})
        with pytest.raises(umform.errors.InvalidValue) as of_spec:
            check_value(AirBending, name, -1e9)
        (said,) = refused.value.errors
        assert (said.where, str(said)) == (name, str(of_spec.value))


def test_an_empty_field_of_the_mesh_is_that_of_the_mesh_and_a_given_one_is_not():
    assert Wanted.read({"mesh": "quick"}).case().layers == 1
    assert Wanted.read({"mesh": "quick", "layers": 3}).case().layers == 3
    assert Wanted.read({"mesh": "quick", "layers": 3}).case().elements_per_thickness == 1.0


def test_lengths_of_a_hem_follow_the_thickness_where_they_are_empty():
    tools = {"opening": 24, "die_angle": 30, "die_radius": 3, "punch_angle": 30, "punch_radius": 1.5}
    wanted = Wanted.read({"work": "hem", "form": "insert", "thickness": 3, "base": 100, **tools})
    hem = wanted.hem(wanted.case())
    assert (hem.gap, hem.flange, hem.base) == (3.0, 36.0, 100.0)


def test_fields_of_other_work_are_neither_checked_nor_kept():
    wanted = Wanted.read({"gap": -1.0, "bends": "x", "travel": "x"})
    assert not {"gap", "bends", "travel"} & wanted.values.keys()
    with pytest.raises(Mistakes):
        Wanted.read({"work": "hem", "gap": -1.0})


def test_sizes_of_a_second_sheet_are_kept_with_its_metal_only():
    assert "second_thickness" not in Wanted.read({"second_thickness": -1.0}).values
    assert Wanted.read({"second_material": "DC04", "second_thickness": 2}).values["second_thickness"] == 2.0
    with pytest.raises(Mistakes):
        Wanted.read({"second_material": "DC04", "second_thickness": -1.0})


def test_all_mistakes_are_said_at_once():
    form = {
        "work": "sequence",
        "thickness": 10**400,
        "bends": [{"position": -1}, {"position": 5, "angle": "x", "y": 1}, 3],
    }
    with pytest.raises(Mistakes) as refused:
        Wanted.read(form)
    places = [error.where for error in refused.value.errors]
    assert places == ["thickness", "bend 1, position", "bend 2, y", "bend 2, angle", "bend 3"]


@pytest.mark.parametrize("form", ["flat", "inner", "insert", "open", "rope"])
def test_each_form_of_a_hem_has_a_title_and_a_case(form):
    """Its gap follows from the form where none is given; two layers close on the coarsest mesh."""
    wanted = Wanted.read({"work": "hem", "mesh": "quick", "form": form, "thickness": 1.0, "opening": 8.0, **ACUTE})
    assert wanted.title == f"DC04 1 mm, {form} hem"
    assert wanted.hem(wanted.case()).sheet.layers == 2


ACUTE = {"die_angle": 30.0, "die_radius": 1.0, "punch_angle": 30.0, "punch_radius": 0.5, "stroke": None}
