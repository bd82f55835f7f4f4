"""A form is looked at before anything is run."""

import math

import pytest

from umform.bench import forces
from umform.bench.form import MESHES
from umform.bench.form_check import look
from umform.bench.library import library, tools
from umform.bench.wanted import Wanted
from umform.processes.air_bending import AirBending
from umform.processes.air_bending.formulas import tensile_strength
from umform.results.quantity import Band, Quantity


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


def test_a_second_sheet_is_below_the_punch_and_needs_a_force():
    one, two = look({}), look({"second_material": "DC04", "second_thickness": 0.5})
    assert two["problems"] == []
    assert two["drawing"]["thickness"] == one["drawing"]["thickness"] + 0.5
    lowest = [min(z for _, z in found["drawing"]["punch"]) for found in (one, two)]
    assert lowest[1] - lowest[0] == pytest.approx(0.5)
    assert two["expected"]["force"][0] > one["expected"]["force"][0]


@pytest.mark.parametrize(
    ("values", "field"),
    [
        ({"second_material": "no metal"}, "second_material"),
        ({"second_material": "DC04", "second_thickness": -1.0}, "second_thickness"),
        ({"second_material": "DC04", "second_friction": 0.1, "second_bonded": True}, "second_friction"),
        ({"second_material": "AA6016-T4"}, "rolling"),
    ],
)
def test_a_second_sheet_that_cannot_be_names_its_field(values, field):
    assert [row["where"] for row in look(values)["problems"]] == [field]


HEM = {
    "form": "insert",
    "opening": 16.0,
    "die_angle": 30.0,
    "punch_angle": 30.0,
    "punch_radius": 1.0,
    "flange": 24.0,
    "base": 60.0,
}


def test_the_press_is_chosen_by_the_operation_with_the_largest_force():
    """A hem of DC04, 2 mm over an insert of 2 mm, needs 606 N/mm (default mesh); its first bend 98."""
    press = look({"work": "hem", **HEM, "gap": 2.0})["expected"]["press"]
    assert press["operation"] == "flatten" and 606.0 < press["force"] < 1.5 * 606.0
    wanted = Wanted.read({"work": "hem", **HEM, "gap": 2.0})
    bend, flatten = (Quantity("force", value=value, band=Band(20.0, "studies")) for value in (98.0, 606.0))
    needed = forces.largest(forces.computed_forces(wanted, wanted.case(), {"bend": bend, "flatten": flatten})).over(
        500.0
    )
    assert (needed["operation"], needed["basis"], needed["force"]) == ("flatten", "computed", 303.0)
    assert needed["band"] == {"error": 10.0, "middle": None, "source": "studies"}
    tools = {"die_angle": 88.0, "punch_angle": 88.0, "angle": None}
    given = look({"work": "bottom", "force_per_metre": 800.0, "length": 2000.0, **tools})["expected"]["press"]
    assert (given["operation"], given["basis"], given["force"]) == ("bottom", "given", 1600.0)
    assert look({"work": "bottom", "travel": 0.0, **tools})["expected"]["press"]["beyond"]  # it resists as it must


def test_a_part_that_will_collide_is_said_before_the_run():
    assert look({"work": "sequence", "angle": None})["warnings"] == []  # the default part
    bends = [{"position": place, "angle": 90.0} for place in (25.0, 55.0)]
    (row,) = look({"work": "sequence", "angle": None, "bends": bends})["warnings"]
    assert (row["where"], row["kind"], row["level"]) == ("bend 2", "collides_punch", "bad")


def test_outside_dimensions_are_developed_at_once(tmp_path, monkeypatch):
    """By hand: 2 (t + R) = 9.12 outside, less a quarter of a circle of R + 0.44 t = 3.44, is each deduction."""
    monkeypatch.setenv("UMFORM_STORE", str(tmp_path))
    bends = [{"line": 2, "angle": 90.0}, {"line": 1, "angle": 90.0, "direction": "down"}]
    found = look({"work": "outside", "outside": {"flanges": [30.0, 50.0, 40.0], "bends": bends}})
    assert found["problems"] == []
    flat, deduction = found["expected"]["flat"], 9.12 - 0.5 * math.pi * 3.44
    assert flat["length"] == pytest.approx(120.0 - 2.0 * deduction) and flat["computed"] is False
    assert flat["lines"] == pytest.approx([30.0 - 0.5 * deduction, 80.0 - 1.5 * deduction])
    assert [bend["position"] for bend in found["shown"]["bends"]] == flat["lines"][::-1]  # in order of bending


def test_drawn_parts_have_their_ratios_and_a_sketch():
    cup = look({"work": "cup"})
    assert cup["expected"]["draw"]["ratio"] == pytest.approx(107.5 / 60.0)
    assert cup["expected"]["draw"]["pressure"] == pytest.approx(40e3 / (math.pi * (53.75**2 - 41.2**2)))
    assert cup["follow"] == {"cup_opening": 62.4, "cup_holder_gap": 1.04, "cup_stroke": 49.043}
    strip = look({"work": "u"})
    assert strip["expected"]["draw"]["pressure"] == pytest.approx(2450.0 / (35.0 * (350.0 - 52.0 - 10.0)))
    for found, throat in ((cup, 31.2), (strip, 26.0)):
        dies = found["drawing"]["tools"][:2]
        assert min(abs(x) for die in dies for x, _ in die) == pytest.approx(throat)
        assert max(z for die in dies for _, z in die) == 0.0
        assert min(z for _, z in found["drawing"]["tools"][-1]) == pytest.approx(found["drawing"]["thickness"])


def test_drawn_parts_have_the_meshes_of_the_command():
    quick, usual = (Wanted.read({"work": "cup", "mesh": mesh}).draw() for mesh in ("quick", "usual"))
    assert (quick.turn, quick.around) == (30.0, 8) and (usual.turn, usual.around) == (15.0, 12)
    assert Wanted.read({"work": "cup", "mesh": "quick", "cup_turn": 20.0}).draw().turn == 20.0
    assert Wanted.read({"work": "u", "mesh": "quick"}).draw().element == "BEND8"
    assert Wanted.read({"work": "cup", "cup_layers": None}).draw().layers is None  # the rule for sharp bends
    assert library()["meshes"]["quick"]["cup_turn"] == 30.0 and library()["meshes"]["usual"]["u_contact_points"] == 4


@pytest.mark.parametrize("sheet", [{}, {"thickness": 1.0, "opening": 8.0}, {"thickness": 6.0, "opening": 47.0}])
@pytest.mark.parametrize("angle", [30.0, 50.0, 70.0, 84.0, 85.0])
def test_angle_out_of_reach_is_refused_with_tools_that_do(angle, sheet):
    found = look({"angle": angle, **sheet})
    assert kinds(found) == {("angle", "refused")}
    again = look({"angle": angle, **sheet, **found["change"]})
    assert again["problems"] == [] and again["warnings"] == []
    assert max(found["change"]["die_angle"], found["change"]["punch_angle"]) < angle
    assert "opening" not in found["change"]  # the opening suits the thickness: it stays


def test_tools_are_offered_where_those_of_the_form_do_not_fit():
    form = {"angle": 60.0, "thickness": 0.5, "opening": 4.0}  # the radii of the form are too large for V 4
    found = look(form)
    assert kinds(found) == {("opening", "refused")}
    assert look({**form, **found["change"]})["problems"] == []


@pytest.mark.parametrize("work", ["sequence", "hem", "bottom"])
def test_other_work_is_looked_at_too(work):
    tools = {"opening": 16.0, "die_angle": 30.0, "die_radius": 2.0, "punch_angle": 30.0, "punch_radius": 1.0}
    form = {
        "form": "inner",
        "flange": 24.0,
        "base": 60.0,
        "gap": 2.0,
        "travel": 0.0,
        "punch_angle": 88.0,
        "die_angle": 88.0,
    }
    found = look({"work": work, **form, **(tools if work == "hem" else {"angle": None})})
    assert found["problems"] == [] and found["drawing"]["closed"]["punch"] == (work != "bottom")


def test_angle_close_to_that_of_the_tools_is_a_warning():
    found = look({"angle": 87.0})
    assert found["problems"] == [] and [row["kind"] for row in found["warnings"]] == ["close"]


@pytest.mark.parametrize(
    ("values", "where", "said"),
    [
        ({"thickness": 0.0}, "thickness", "more than 0 and at most 1000"),
        ({"thickness": 1e308}, "thickness", "more than the bench takes"),
        ({"punch_angle": 180.0}, "punch_angle", "a number between 1 and 180"),
        ({"die_angle": 5e-324}, "die_angle", "a number between 1 and 180"),
        ({"length": 1e9}, "length", "more than the bench takes"),
        ({"work": "hem", "base": 1e9}, "base", "more than the bench takes"),
        ({"thickness": math.nan}, "thickness", "more than 0 and at most 1000"),
        ({"opening": "16"}, "opening", "must be positive and finite"),
        ({"opening": None}, "opening", "must be positive and finite"),
        ({"angle": True}, "angle", "a number between 0 and 180"),
        ({"stroke": 2.0}, "angle", "give the angle or the stroke"),
        ({"angle": None}, "angle", "give the angle or the stroke"),
        ({"tensile_strength": 300.0}, "yield_stress", "both, Re and Rm"),
        ({"yield_stress": 410.0, "tensile_strength": 290.0}, "yield_stress", "Re 410 is not below Rm 290"),
        ({"yield_stress": 300.0, "tensile_strength": 300.0}, "yield_stress", "is not below"),
        (
            {"yield_stress": 299.9, "tensile_strength": 300.0, "uniform_elongation": 30.0},
            "tensile_strength",
            "goes through these values",
        ),
        ({"work": "cup", "cup_blank": 60.0}, "cup_blank", "does not lie on the die"),
        ({"work": "cup", "cup_opening": 60.5}, "cup_opening", "gap between punch and die"),
        ({"work": "u", "u_stroke": 200.0}, "u_stroke", "drawn off the die"),
        ({"work": "u", "u_punch_width": 6.0}, "u_punch_edge", "larger than half of the punch"),
        ({"work": "cup", "cup_blank": 1e300}, "cup_blank", "the diameter of the blank is more than the bench takes"),
        ({"work": "cup", "cup_punch": -(10**400)}, "cup_punch", "a number from 0.001 to 100000"),
        ({"work": "cup", "cup_around": 1e29}, "cup_around", "a whole number from 2 to 1000"),
        ({"work": "u", "u_width": 5e-324}, "u_width", "a number from 0.001 to 100000"),
        ({"work": "table", "angles": None}, "angles", "no list of 1 to 40 entries"),
        ({"work": "table", "angles": [90.0, None]}, "angles", "no list of 1 to 40 entries"),
        ({"work": "u", "u_thickness": 0.0}, "u_thickness", "a number from 0.01 to 100"),
        ({"work": "outside", "outside": {"flanges": [1.0]}}, "outside", "flanges and bends"),
        ({"work": "outside", "outside": {"flanges": [9, "x"], "bends": [{"angle": 90}]}}, "flange 2", "positive"),
        (
            {"work": "outside", "outside": {"flanges": [9, 9, 9], "bends": [{"angle": 90}]}},
            "outside",
            "one flange more",
        ),
        ({"work": "outside", "outside": {"flanges": [9, 9], "bends": [{"line": 1}]}}, "bend 1", "angle of a bend"),
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
        ({"material": "unobtainium"}, "material", "no sheet metal"),
        ({"work": "cup", "material": "unobtainium"}, "material", "no sheet metal"),
        ({"punch_radius": 150.0}, "punch_radius", "wider than the opening"),
        ({"angle": None, "stroke": 900.0}, "stroke", "beyond air bending"),
    ],
)
def test_what_cannot_be_meant_is_refused_by_its_name(values, where, said):
    found = look(values)
    assert any(row["where"] == where and said in row["what"] for row in found["problems"]), found["problems"]


@pytest.mark.parametrize(
    ("values", "where", "cause", "remedy"),
    [
        ({"work": "bottom"}, "travel", "none of them", "fill in one field"),
        ({"work": "bend", "angle": 90.0, "stroke": 3.0}, "angle", "both are given", "leave one of them out"),
        ({"yield_stress": 160.0}, "yield_stress", "one of them is missing", "both from the certificate"),
        ({"work": "correct", "stroke": 3.0}, "measured_angle", "one of them is missing", "fill in both fields"),
        ({"work": "sequence", "bends": [{"angle": 90.0}]}, "bend 1", "an empty field", "in mm from the left end"),
        ({"work": "sequence", "bends": []}, "bends", "no bend", "add or delete rows"),
        ({"nothing": 1.0}, "nothing", "another version", "load the page again"),
    ],
)
def test_cause_and_remedy_are_said(values, where, cause, remedy):
    (row,) = (row for row in look(values)["problems"] if row["where"] == where)
    assert cause in row["cause"] and remedy in row["remedy"]


def test_value_and_cause_of_a_small_blank_are_diameters():
    (problem,) = look({"work": "cup", "cup_blank": 60.0})["problems"]
    assert problem["value"] == "60.0" and "a diameter of 82.4" in problem["cause"]


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


@pytest.mark.parametrize("angle", [88.0, 60.0])
def test_all_tools_of_the_library_can_be_taken(angle):
    for die in (one["sizes"] for one in tools()["die"] if one["sizes"]["die_angle"] == angle):
        form = {"thickness": die["opening"] / 8, **die}
        for punch in (one["sizes"] for one in tools()["punch"]):
            found = look({**form, **punch, "angle": 120.0})
            fits = punch["punch_radius"] <= die["opening"] / 6  # a larger tip is as wide as the V
            assert not found["problems"] or not fits, (die, punch)


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
