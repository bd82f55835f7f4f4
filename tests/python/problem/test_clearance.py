"""Tools against each other and against the sheet: clearance, strokes away from it, places after a new thickness."""

import numpy as np
import pytest

import umform as uf
from umform.problem.clearance import smallest_distance
from umform.problem.findings import Level


@pytest.mark.parametrize(
    ("opening", "apart", "level"), [(62.4, 1.2, "ok"), (61.0, 0.5, "warning"), (59.0, -0.5, "warning")]
)
def test_clearance_beside_a_punch(texts, found, opening, apart, level):
    (row,) = found(texts("hat-rail"), "tools die, punch", tools__die__opening=opening)
    assert row.level is Level(level) and "end of step 2" in row.text
    assert float(row.text.split("they are ")[1].split()[0]) == pytest.approx(apart, abs=1e-6)


def test_clearance_of_a_thicker_sheet(texts, found):
    thick = {"mesh__thickness": 1.5, "tools__die__origin": [0.0, 0.0, -0.75], "tools__punch__centre": [0.0, 0.0, 50.75]}
    (row,) = found(texts("hat-rail"), "tools die, punch", **thick)
    assert row.level is Level.WARNING and "80 % of it" in row.text and "larger opening" in row.remedy


def test_clearance_at_the_bottom_and_round_a_cup(texts, found):
    (short,) = found(texts("hat-rail"), "tools die, punch", tools__die__depth=39.5)
    assert short.level is Level.WARNING and "0.5 apart" in short.text
    (cup,) = found(texts("cup"), "tools die, punch")
    assert cup.level is Level.OK and "1.2 apart" in cup.text


def test_tools_that_follow_forces_are_left_out(texts, found):
    assert found(texts("hat-rail"), "tools die, holder") == []


def test_a_stroke_away_from_the_sheet(texts, found):
    text = texts("hat-rail")
    assert not any("away" in finding.text for finding in found(text, "step 2"))
    (wrong,) = [finding for finding in found(text, "step 2", steps__1__to__stroke=-40.0) if "away" in finding.text]
    assert wrong.level is Level.WARNING and "punch" in wrong.text and "stroke" in wrong.remedy
    below = found(text.replace("[0.0, 0.0, 50.5]", "[0.0, 0.0, -150.5]"), "step 2")
    assert any("away from the sheet" in finding.text for finding in below)


def test_a_tool_of_stretch_bending_may_move_away(texts, found):
    """Grips that pull the sheet over a block bring it after a tool that moves away from its first place."""
    text = texts("hat-rail")
    wrong = {"steps__1__to__stroke": -40.0}
    assert any("away" in row.text for row in found(text, "step 2", **wrong))  # without grips it is a mistake
    pull = '[controls.pull]\nkind = "force"\nnodes = "x1"\nforce = [1.0, 0.0, 0.0]\n'
    first, _, last = text.rpartition("[[steps]]")  # the one that opens the tools
    grips = f'{first}{pull}[[steps]]\nkind = "move"\nto = {{ pull = 1.0 }}\nincrements = 2\n[[steps]]{last}'
    assert grips != text and not any("away" in row.text for row in found(grips, "step 2", **wrong))


def test_a_quarter_of_a_disc_is_as_long_as_the_disc(texts, found):
    """Its radius is 53.75: a stroke of 60 mm is not longer than the sheet, one of 120 is."""
    said = [
        [row.level.value for row in found(texts("cup"), "step 2", steps__1__to__stroke=way)] for way in (60.0, 120.0)
    ]
    assert said == [["ok"], ["warning"]]
    text = texts("cup")
    far = [found(text.replace("[0.0, 0.5], [30.0, 0.5], [30.0, 90.0]", f"[0.0, {z}], [30.0, {z}], [30.0, 290.0]"),
                 "contact punch") for z in (80.0, 120.0)]  # fmt: skip
    assert [any("farther away" in row.text for row in rows) for rows in far] == [False, True]


def test_controls_that_no_step_moves_are_what_they_are(texts, found):
    """A cushion on a spring works without a step; a grip is a support; a press without its force lets the tool go."""
    text = texts("hat-rail")

    def idle(lines, text=text):
        return found(f"{text}\n[controls.still]\n{lines}", "control still")

    (spring,) = idle('kind = "spring"\ncontact = "die"\ndirection = "z"\nstiffness = 50.0\npreload = 100.0')
    assert spring.level is Level.OK and "a spring with its preload" in spring.text
    (grip,) = idle('kind = "displacement"\nnodes = "x1"\ndirection = "y"', texts("cantilever"))
    assert grip.level is Level.WARNING and "fix the nodes" in grip.remedy and "take it out" not in grip.remedy
    (press,) = idle('kind = "press"\ncontact = "die"\ndirection = "z"')
    assert press.level is Level.WARNING and "nothing holds the tool" in press.text
    (load,) = idle('kind = "pressure"\nfaces = "upper"')
    assert load.level is Level.WARNING and "take it out" in load.remedy


def test_an_overlap_after_a_new_thickness_names_the_key(texts, found):
    text = texts("hat-rail")
    (die,) = [row for row in found(text, "contact die", mesh__thickness=1.5) if "overlap" in row.text]
    assert die.level is Level.WARNING and "do not follow the thickness" in die.remedy
    assert "tools.die.origin = [0, 0, -0.75] instead of [0, 0, -0.5]" in die.remedy
    (punch,) = [row for row in found(text, "contact punch", mesh__thickness=1.5) if "overlap" in row.text]
    assert "tools.punch.centre = [0, 0, 50.75]" in punch.remedy
    shifted = text.replace('shape = "UDie"', 'shape = "UDie"\nrotation = [0.0, 0.0, 180.0]')
    (die,) = [row for row in found(shifted, "contact die", mesh__thickness=1.5) if "overlap" in row.text]
    assert "tools.die.translation = [0, 0, -0.25]" in die.remedy


def test_the_effort_of_adaptive_steps_is_a_lower_bound(texts, found):
    (row,) = found(texts("hat-rail"), "effort")
    assert row.text.startswith("at least")


@pytest.mark.parametrize("along", ["x", "y"])
def test_the_nearest_places_of_tools_are_found_wherever_the_sheet_bends(along):
    """A roll above a table: the way that brings a place nearer is short, so that it needs a near one to begin with."""
    model = uf.Model(uf.mesh.strip(20.0, 6.0, 1.0, (10, 3)), material=uf.SVK(E=210e3, nu=0.3))
    k = "xy".index(along)
    centre, low, high = np.array([3.0, 3.0, 3.25]), np.array([0.0, 0.0, -3.0]), np.array([6.0, 6.0, 2.0])
    centre[k], high[k] = 17.0, 20.0
    table = model.contact("lower", uf.Plane((0, 0, -2.0), "z"), penalty=1.0).tool
    roll = model.contact("upper", uf.Cylinder(centre, "yx"[k], 5.0), penalty=1.0).tool
    distance, place = smallest_distance((table, table.pose_now), (roll, roll.pose_now), (low, high))
    assert distance == pytest.approx(0.25, abs=1e-3)
    assert place[k] == pytest.approx(17.0, abs=0.3)
