"""A form is looked at before anything is run."""

import math

import pytest

from umform.bench import forces
from umform.bench.form import MESHES
from umform.bench.library import library, tools
from umform.bench.look import look
from umform.bench.wanted import Wanted
from umform.processes.air_bending import AirBending
from umform.processes.air_bending.formulas import tensile_strength


def kinds(found):
    return {(row["where"], row["kind"]) for row in found["problems"]}


def test_usual_form_is_drawn_and_has_no_problem():
    found = look({})
    assert found["problems"] == [] and found["warnings"] == []
    drawing, case = found["drawing"], AirBending()
    assert drawing["largest_stroke"] == case.largest_stroke
    lowest = min(z for _, z in drawing["die"])
    slope = math.radians(90.0 - 0.5 * case.die_angle)
    assert lowest == pytest.approx(-0.5 * case.opening * math.tan(slope))
    assert min(z for _, z in drawing["punch"]) == pytest.approx(case.thickness, abs=0.01 * case.opening)


def test_expected_force_is_the_rule_of_the_shop():
    expected = look({"length": 2000.0})["expected"]
    rm = expected["tensile_strength"]
    assert rm == pytest.approx(310.0, rel=5e-3)  # that of DC04 in metals.toml
    assert expected["force"] == pytest.approx([1.33 * rm * 4 / 16, 1.42 * rm * 4 / 16])
    assert expected["press"]["force"] == pytest.approx(2.0 * expected["force"][1])
    assert expected["press"]["operation"] == "bend"


HEM = {"opening": 16.0, "die_angle": 30.0, "punch_angle": 30.0, "punch_radius": 1.0, "flange": 24.0, "base": 60.0}


def test_the_press_is_chosen_by_the_operation_with_the_largest_force():
    """A hem of DC04, 2 mm over an insert of 2 mm, needs 606 N/mm (default mesh); its first bend 98."""
    press = look({"work": "hem", **HEM, "gap": 2.0})["expected"]["press"]
    assert press["operation"] == "flatten" and 606.0 < press["force"] < 1.5 * 606.0
    wanted = Wanted.read({"work": "hem", **HEM, "gap": 2.0})
    needed = forces.largest(forces.computed_forces(wanted, wanted.case(), {"bend": 98.0, "flatten": 606.0})).over(500.0)
    assert (needed["operation"], needed["basis"], needed["force"]) == ("flatten", "computed", 303.0)
    tools = {"die_angle": 88.0, "punch_angle": 88.0, "angle": None}
    given = look({"work": "bottom", "force_per_metre": 800.0, "length": 2000.0, **tools})["expected"]["press"]
    assert (given["operation"], given["basis"], given["force"]) == ("bottom", "given", 1600.0)
    assert look({"work": "bottom", "travel": 0.0, **tools})["expected"]["press"]["beyond"]  # it resists as it must


def test_a_part_that_will_collide_is_said_before_the_run():
    assert look({"work": "sequence", "angle": None})["warnings"] == []  # the default part
    bends = [{"position": place, "angle": 90.0} for place in (25.0, 55.0)]
    (row,) = look({"work": "sequence", "angle": None, "bends": bends})["warnings"]
    assert (row["where"], row["kind"], row["level"]) == ("bend 2", "collides_punch", "bad")


@pytest.mark.parametrize("angle", [50.0, 70.0, 84.0, 85.0])
def test_angle_out_of_reach_is_refused_with_tools_that_do(angle):
    found = look({"angle": angle})
    assert kinds(found) == {("angle", "refused")}
    again = look({"angle": angle, **found["change"]})
    assert again["problems"] == [] and again["warnings"] == []
    assert max(found["change"]["die_angle"], found["change"]["punch_angle"]) < angle


@pytest.mark.parametrize("work", ["sequence", "hem", "bottom"])
def test_other_work_is_looked_at_too(work):
    tools = {"opening": 16.0, "die_angle": 30.0, "die_radius": 2.0, "punch_angle": 30.0, "punch_radius": 1.0}
    form = {"flange": 24.0, "base": 60.0, "gap": 2.0, "travel": 0.0, "punch_angle": 88.0, "die_angle": 88.0}
    found = look({"work": work, **form, **(tools if work == "hem" else {"angle": None})})
    assert found["problems"] == [] and found["drawing"]["closed"]["punch"] == (work != "bottom")


def test_angle_close_to_that_of_the_tools_is_a_warning():
    found = look({"angle": 87.0})
    assert found["problems"] == [] and [row["kind"] for row in found["warnings"]] == ["close"]


@pytest.mark.parametrize(
    ("values", "where", "said"),
    [
        ({"thickness": 0.0}, "thickness", "must be positive and finite"),
        ({"thickness": 1e308}, "thickness", "more than the bench takes"),
        ({"punch_angle": 180.0}, "punch_angle", "a number between 0 and 180"),
        ({"length": 1e9}, "length", "more than the bench takes"),
        ({"work": "hem", "base": 1e9}, "base", "more than the bench takes"),
        ({"thickness": math.nan}, "thickness", "must be positive and finite"),
        ({"opening": "16"}, "opening", "must be positive and finite"),
        ({"opening": None}, "opening", "must be positive and finite"),
        ({"angle": True}, "angle", "a number between 0 and 180"),
        ({"stroke": 2.0}, "angle", "give the angle or the stroke"),
        ({"angle": None}, "angle", "give the angle or the stroke"),
        ({"tensile_strength": 300.0}, "yield_stress", "both, Re and Rm"),
        ({"work": "bottom"}, "travel", "give the force or the way"),
        ({"work": "sequence", "bends": []}, "bends", "1 to 20 bends"),
        (
            {"work": "sequence", "bends": [{"position": 40.0, "angle": 0.0}]},
            "bend 1, angle",
            "a number between 0 and 180",
        ),
        ({"work": "sequence", "bends": [{"position": 40.0, "x": 5.0}]}, "bend 1, x", "no such field"),
        (
            {"work": "sequence", "strip_length": 60.0, "bends": [{"position": 3.0, "angle": 90.0}]},
            "bend 1 at 3",
            "too short",
        ),
        ({"work": "hem", "first_angle": 40.0}, "first_angle", "cannot be reached"),
        (
            {"work": "sequence", "bends": [{"position": 40.0, "angle": 5.0}]},
            "bend 1, angle",
            "cannot be reached",
        ),
        ({"work": "bottom", "travel": 0.0, "punch_angle": 88.0}, "punch_angle", "sharper die"),
        ({"work": "bottom", "travel": 3.0}, "stroke", "half of its thickness"),
        ({"mesh": "../../etc"}, "mesh", "must be quick, usual or fine"),
        ({"__class__": 1}, "__class__", "no such field"),
        ({"opening": 1.0}, "opening", "does not fit"),
        ({"material": "unobtainium"}, "sheet_metals", "no sheet metal"),
        ({"punch_radius": 150.0}, "punch_radius", "wider than the opening"),
        ({"angle": None, "stroke": 900.0}, "stroke", "beyond air bending"),
    ],
)
def test_what_cannot_be_meant_is_refused_by_its_name(values, where, said):
    found = look(values)
    assert any(row["where"] == where and said in row["what"] for row in found["problems"]), found["problems"]


@pytest.mark.parametrize("values", [None, 3, "x", [], [[]], {"a": {"b": [1] * 1000}}, {1: 2}])
def test_what_is_no_form_is_refused(values):
    assert look(values)["problems"]


def test_numbers_of_a_coil_are_those_that_are_computed_with():
    """The curve has its largest force at the Rm of the coil, by Considère."""
    coils = [("DC04", 160, 295, None), ("DC04", 160, 295, 15), ("S235", 290, 410, None), ("1.4301", 280, 620, None)]
    for name, re, rm, elongation in [*coils, ("EN AW-5754", 100, 215, None), ("EN AW-5754", 100, 215, 17)]:
        given = {
            "yield_stress": float(re),
            "tensile_strength": float(rm),
            "uniform_elongation": elongation and float(elongation),
        }
        law, note = Wanted.read({"material": name, **given}).law()
        assert tensile_strength(law) == pytest.approx(rm, rel=5e-3)
        assert "coil" in note


def test_coil_of_a_published_card_is_refused():
    card = next(metal for metal in library()["metals"] if metal["card"])
    found = look({"material": card["name"], "yield_stress": 160.0, "tensile_strength": 295.0})
    assert kinds(found) == {("material", "refused")}


def test_all_tools_of_the_library_can_be_taken():
    for die in tools()["dies"]:
        form = {"thickness": die["opening"] / 8, "opening": float(die["opening"]), "die_radius": die["radius"]}
        for punch in tools()["punches"]:
            found = look(
                {**form, "punch_angle": float(punch["angle"]), "punch_radius": punch["radius"], "angle": 120.0}
            )
            problems = [row for row in found["problems"] if row["where"] != "punch_radius"]
            assert not problems, (die, punch)


def test_usual_mesh_is_that_of_the_command():
    assert MESHES["usual"] == {}
    assert Wanted.read({}).case() == AirBending(material=Wanted.read({}).law()[0])


def test_the_thickness_chooses_the_values_of_the_standard():
    for thickness, strength in [(2.9, 510.0), (3.0, 470.0)]:
        law, note = Wanted.read({"material": "S355", "thickness": thickness, "opening": 24.0}).law()
        assert tensile_strength(law) == pytest.approx(strength, abs=3.0)  # elastic strains are neglected
        assert f"Rm {strength:g} MPa (minimum values" in note
    (metal,) = (metal for metal in library()["metals"] if metal["name"] == "S355")
    assert [(row["from"], row["tensile_strength"]) for row in metal["thicker"]] == [(3.0, 470.0)]
