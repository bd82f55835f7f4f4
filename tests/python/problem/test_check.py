import pytest

from umform.mesh import strip as strip_mesh
from umform.model.contact.encounter import sheet_thickness
from umform.problem import Problem
from umform.problem.check import check
from umform.problem.errors import DeckError
from umform.problem.findings import Level
from umform.processes.air_bending import AirBending
from umform.processes.problems import problem_of


def levels(findings):
    return [finding.level for finding in findings]


OK, WARNING, ERROR = [Level.OK], [Level.WARNING], [Level.ERROR]


def test_free_motions(strip, found):
    assert levels(found(strip, "supports")) == OK
    (free,) = found(strip.replace('kind = "fix"', 'kind = "symmetry"\nnormal = "x"'), "supports")
    assert free.level is Level.ERROR
    assert "translation y" in free.text
    assert free.remedy


def test_a_flange_that_is_wiped_without_a_clamp_tips(texts, found):
    text = texts("wiping")
    assert found(text, "tool punch") == []
    (tips,) = found(text.replace('nodes = "x0"', 'nodes = "x0_lower"\ndirections = "x"'), "tool punch")
    assert tips.level is Level.ERROR and "only block at (" in tips.text and "tips over" in tips.text and tips.remedy


def test_a_face_on_the_other_side_of_the_sheet_looks_away_from_its_tool(texts, found):
    """So are the upper faces of a mesh of one's own whose nodes are numbered clockwise."""
    text = texts("free-bending")
    sides = text, text.replace('faces = "lower"', 'faces = "upper"')
    said = [[row.text for row in found(side, "contact cylinder")] for side in sides]
    assert [any("looks away" in row for row in rows) for rows in said] == [False, True]


def test_gaps(texts, found):
    text = texts("free-bending")
    first = found(text, "contact cylinder")[0]
    assert first.level is Level.OK
    deeper = found(text.replace("-20.5]", "-20.4]"), "contact cylinder")[0]
    assert deeper.level is Level.WARNING
    assert "overlap 0.09" in deeper.text
    half = found(text.replace("-20.5]", "-20.01]"), "contact cylinder")[0]
    assert half.level is Level.ERROR
    assert "48.3 % of the thickness" in half.text  # at the contact points
    away = found(text.replace("-20.5]", "-420.5]"), "contact cylinder")[0]
    assert away.level is Level.WARNING
    assert "gap 400" in away.text
    swallowed = found(text.replace("-20.5]", "-19.5]"), "tools")
    assert levels(swallowed) == ERROR
    centre = found(
        text.replace("[25.0, 0.0, -20.5]", "[25.0, 0.0, -0.5]").replace("points = 2 ", "points = 'nodes' "), "tools"
    )
    assert levels(centre) == ERROR


def test_a_changed_thickness_leaves_tools_behind(texts):
    text = texts("air-bending")
    thinner = Problem.read(text, changes={"mesh.thickness": 1.6})
    (said,) = [one for one in check(thinner, thinner.build()) if one.about == "thickness"]
    assert said.level is Level.WARNING and said.remedy
    assert "at 2 and 1.6 the gap" in said.text and "that of die is 0 and 0.2" in said.text
    places = {"tools.die.origin": [0.0, 0.0, -0.8], "tools.punch.origin": [0.0, 0.0, 0.8]}
    for changes in ({"mesh.cells": [20, 1]}, {"mesh.thickness": 2.0}):
        same = Problem.read(text, changes=changes)
        assert not [one for one in check(same, same.build()) if one.about == "thickness"]
    moved = Problem.read(text, changes={"mesh.thickness": 1.6} | places)
    assert not [one for one in check(moved, moved.build()) if one.about == "thickness"]


def test_the_default_bend_passes():
    deck = Problem.read(problem_of(AirBending(stroke=6.0)).toml())
    assert {finding.level for finding in check(deck, deck.build())} == {Level.OK}


def test_distorted_cells(strip, found, tmp_path):
    assert levels(found(strip, "mesh")) == OK
    lines = 'generator = "grid"\nx = [0, 5, 10]\ny = [0, 2]\nz = [-0.5, 0.5]\n'
    head, tail = strip.split('generator = "strip"')
    deck = Problem.read(head + lines + tail[tail.index("[material]") :])
    problem = deck.build()
    problem.model.mesh.points[:2, 0] += 4.5
    (bad,) = [finding for finding in check(deck, problem) if finding.about == "mesh"]
    assert bad.level is Level.WARNING
    assert "cell 0" in bad.text


def test_thickness_of_stacked_layers():
    assert sheet_thickness(strip_mesh(4.0, 1.0, 0.6, (3, 1), layers=3)) == pytest.approx(0.6)


def test_idle_tools_and_controls(texts, found):
    text = (
        texts("free-bending") + '[tools.spare]\nshape = "Plane"\n[controls.spare]\nkind = "pressure"\nfaces = "upper"\n'
    )
    assert levels(found(text, "tool spare")) == WARNING
    assert levels(found(text, "control spare")) == WARNING


def test_steps_that_cannot_follow_each_other_are_refused_with_their_place(texts):
    text = texts("wiping")
    free = text[text.rindex("[[steps]]") : text.index("[measures.section]")]
    with pytest.raises(DeckError, match=r"steps\[2\]") as caught:
        Problem.read(text.replace(free, 2 * free)).build()
    assert "free each support and each tool of this model once" in str(caught.value)


def test_a_modulus_that_is_none_in_any_unit(texts, found):
    text = texts("free-bending").replace("kappa = 175000.0\nmu = 80770.0", "E = 1e-300\nnu = 0.3")
    assert levels(found(text, "units")) == ERROR


def test_effort(texts, found):
    (effort,) = found(texts("free-bending"), "effort")
    assert "330 increments" in effort.text
    assert "ms an iteration" in effort.text
    (singular,) = found(texts("free-bending").replace("-20.5]", "-21.5]"), "effort")
    assert singular.level is Level.WARNING or "ms an iteration" in singular.text


@pytest.mark.parametrize(("thickness", "warned"), [(2.5, 0), (3.0, 1)])
def test_a_metal_with_other_values_for_the_thickness_of_the_sheet(strip, found, thickness, warned):
    text = strip.replace('law = "SVK"', 'library = "S355"').replace("E = 210e3", "").replace("nu = 0.3", "")
    said = found(text, "material", mesh__thickness=thickness)
    said = [finding for finding in said if "Rm" in finding.text]
    assert len(said) == warned
    assert all("Rm 510 MPa" in finding.text and "R 355, Rm 470 MPa" in finding.text for finding in said)
