"""Outside dimensions of a part: flat length, bend lines, what does not belong together."""

import pytest

from umform.errors import InvalidValue
from umform.processes.air_bending import AirBending
from umform.processes.bend_sequence.form import read_sequence, sequence_form
from umform.processes.bend_sequence.outside import OutsideBend, OutsidePart

RIGHT = OutsideBend(90.0)


def test_bend_lines_are_in_the_middle_of_their_bends():
    """By hand: 30 + 50 + 20 - 4 - 6 = 90; 30 - 4/2 = 28; 80 - 4 - 6/2 = 73."""
    part = OutsidePart((30.0, 50.0, 20.0), (RIGHT, RIGHT))
    assert part.flat([4.0, 6.0]) == (90.0, (28.0, 73.0))


def test_the_order_of_bending_may_be_another_one():
    bends = (OutsideBend(90.0, line=2, direction="down"), OutsideBend(120.0, line=1, tools={"opening": 12.0}))
    part = OutsidePart((30.0, 50.0, 20.0), bends)
    assert part.flat([6.0, 4.0]) == (90.0, (73.0, 28.0))
    sequence = part.sequence([6.0, 4.0], AirBending(thickness=1.0))
    assert [(bend.position, bend.angle, bend.direction) for bend in sequence.bends] == [
        (73.0, 90.0, "down"),
        (28.0, 120.0, "up"),
    ]
    assert sequence.bends[1].tools == {"opening": 12.0} and sequence.length == 90.0


@pytest.mark.parametrize(
    ("flanges", "bends", "where", "message"),
    [
        ((30.0, 50.0), (RIGHT, RIGHT), "flanges", "one flange more than bends"),
        ((30.0, 0.0, 5.0), (RIGHT, RIGHT), "flange 2", "must be positive"),
        ((30.0, 50.0, 20.0), (RIGHT, OutsideBend(90.0, line=1)), "bends", "bent once"),
        ((30.0, 50.0), (OutsideBend(90.0, line=2),), "bends", "bent once"),
        ((30.0, 50.0, 20.0), (OutsideBend(90.0, line=1), OutsideBend(90.0, line=0)), "bends", "bent once"),
        ((30.0, 50.0), (OutsideBend(90.0, tools={"wide": 3.0}),), "bends", "no size of the tools"),
        ((30.0,), (), "bends", "1 to 50 bends"),
    ],
)
def test_what_does_not_belong_together_is_refused(flanges, bends, where, message):
    with pytest.raises(InvalidValue, match=message) as refused:
        OutsidePart(flanges, bends)
    assert refused.value.where == where


def test_a_flange_that_its_bends_use_up_is_refused():
    with pytest.raises(InvalidValue, match="shorter than its bends take") as refused:
        OutsidePart((30.0, 3.0, 30.0), (RIGHT, RIGHT)).sequence([4.0, 4.0])
    assert refused.value.where == "flange 2" and refused.value.value == 3.0


def test_a_file_with_flanges_is_one_of_outside_dimensions(tmp_path):
    file = tmp_path / "part.toml"
    text = "flanges = [30, 50]\nacute = 'tangent'\n[[bends]]\nangle = 60\ndirection = 'down'\nopening = 12\n"
    file.write_text(text)
    part = read_sequence(file).part()
    assert part.flanges == (30.0, 50.0) and part.acute == "tangent"
    assert part.bends == (OutsideBend(60.0, direction="down", tools={"opening": 12.0}),)


@pytest.mark.parametrize(
    ("data", "what", "remedy"),
    [
        ({"flanges": [30, 50], "length": 80, "bends": [{"angle": 90}]}, "unknown here", "known keys: flanges"),
        ({"flanges": [30, 50], "bends": [{"angle": 90, "position": 3}]}, "unknown here", "known keys: angle"),
        ({"flanges": [30, 50], "bends": [{}]}, "the key angle is missing", "flanges, and an angle"),
        ({"bends": [{"position": 3, "angle": 90}]}, "the key length is missing", "or flanges, for outside dimensions"),
    ],
)
def test_a_mistake_in_a_file_is_named(data, what, remedy):
    with pytest.raises(InvalidValue, match=what) as refused:
        sequence_form(data, "part.toml")
    assert remedy in refused.value.remedy
