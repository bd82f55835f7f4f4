"""Tools against each other and against the sheet: clearance, strokes away from it, places after a new thickness."""

import pytest

from umform.deck.findings import Level


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
