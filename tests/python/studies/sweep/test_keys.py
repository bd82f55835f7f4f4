"""Names and values of what a sweep varies."""

import tomllib

import pytest

from umform.errors import InvalidValue
from umform.problem.templates import template
from umform.studies.sweep.keys import change, find_key, is_text
from umform.studies.sweep.values import read_values

BEND = tomllib.loads(template("air-bending"))


def values(text, *, as_text=False):
    return [written.value(as_text=as_text) for written in read_values(text, "key")]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.8:1.2:0.1", [0.8, 0.9, 1.0, 1.1, 1.2]),
        ("1:4:2", [1, 3]),
        ("3:1:-1", [3, 2, 1]),
        ("0.5, 1:2:1, true", [0.5, 1, 2, True]),
        ("[24, 1],[48, 1]", [[24, 1], [48, 1]]),
        ('BEND8,"a, b"', ["BEND8", "a, b"]),
        ("{ mu = 0.1, cap = 3 }", [{"mu": 0.1, "cap": 3}]),
    ],
)
def test_values_are_ranges_and_lists(text, expected):
    found = values(text)
    assert found == expected
    assert [type(value) for value in found] == [type(value) for value in expected]


def test_a_number_is_text_where_the_key_takes_text():
    assert values("DC04,1.4301,'S355'", as_text=True) == ["DC04", "1.4301", "S355"]
    assert is_text("material", BEND)
    assert is_text("element.name", BEND)
    assert not is_text("mesh.thickness", BEND)


@pytest.mark.parametrize("text", ["", "1,,2", "1:2:0", "1:2:-0.1", "0:1:1e-9", "1:2", "1,8:2,0:0,1"])
def test_what_is_no_row_of_values_is_refused(text):
    with pytest.raises(InvalidValue, match="key"):
        read_values(text, "key")


@pytest.mark.parametrize(
    ("name", "key"),
    [
        ("thickness", "mesh.thickness"),
        ("mesh.thickness", "mesh.thickness"),
        ("opening", "tools.die.opening"),
        ("die.angle", "tools.die.angle"),
        ("to.stroke", "steps.0.to.stroke"),
        ("stroke", "steps.0.to.stroke"),
        ("thickness_points", "element.thickness_points"),
        ("max_iterations", "solution.max_iterations"),  # a key that the deck leaves out
        ("contacts.die.friction", "contacts.die.friction"),
        ("material", "material"),
        ("origin.2", None),
        ("angle", None),
    ],
)
def test_a_short_name_stands_for_the_one_key_that_ends_like_it(name, key):
    if key is not None:
        assert find_key(name, BEND) == key
        return
    with pytest.raises(InvalidValue, match="ambiguous") as caught:
        find_key(name, BEND)
    assert f"tools.die.{name}" in caught.value.value
    assert f"tools.punch.{name}" in caught.value.value


def test_an_unknown_name_is_refused_with_the_nearest_one():
    with pytest.raises(InvalidValue, match="did you mean thickness"):
        find_key("thicknes", BEND)


def test_the_name_of_a_metal_takes_the_place_of_a_law_and_keeps_the_rolling_direction():
    assert change("material", "DC04", BEND) == ("material", {"library": "DC04"})
    rolled = {"material": {"library": "AA6016-T4", "rolling": "x"}}
    assert change("material.library", "DC04", rolled) == ("material", {"library": "DC04", "rolling": "x"})
    assert change("material.nu", 0.2, BEND) == ("material.nu", 0.2)
