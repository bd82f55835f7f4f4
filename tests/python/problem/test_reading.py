"""A deck that is read quickly is what pydantic reads; what does not fit is left to pydantic."""

import copy

import pytest

from umform.errors import InvalidValue
from umform.problem import load
from umform.problem.contents import Contents
from umform.problem.messages import checked
from umform.problem.reading import Unfit, read
from umform.problem.settings import Output, Solution
from umform.problem.steps import Free
from umform.problem.templates import template_file, templates

#: Tables that the templates do not have.
MORE = {
    "beads": {"bead": {"contact": "die", "curve": [[0, 0, 0], [0.0, 9.0, 0.0]], "restraint": 9, "width": 2}},
    "measures": {"curve": {"kind": "section"}, "far": {"kind": "distance", "tool": "die", "within": 3}},
    "placement": {"rotation": [[1.0, 0.0, 0.0], [0, 1, 0], [0.0, 0.0, 1.0]]},
    "output": {"forming_limit": [[-0.2, 0.5], [0.0, 0.3]], "frames": 3},
    "supports": [
        {"kind": "fix", "nodes": {"intersection": ["x0", {"min": [0.0, 0.0, float("-inf")]}]}, "directions": "xz"},
        {"kind": "rigid", "name": "three", "nodes": {"nearest": [1, 2, 3]}},
    ],
    "controls": {
        "press": {"kind": "press", "contact": "die", "direction": [0, 0, 1], "gap": {"to": "die", "least": 1}},
        "turn": {"kind": "turn", "contact": "die", "axis": "-y", "followers": ["punch"]},
    },
    "steps": [
        {"kind": "move", "to": {"press": 1}, "pace": {"first": 0.1}, "follow": {"turn": [[0, 0], [1.0, 2.0]]}},
        {"kind": "move", "to": {"press": 1}, "increments": 3, "time": 2},
        {"kind": "free", "support": "three", "increments": 5},
        {"kind": "arc", "to": {"press": 1.0}, "length": "spherical", "most": 9},
        {"kind": "close", "control": "press", "force": 5.0},
    ],
    "contacts": {
        "die": {
            "tool": "die",
            "faces": "lower",
            "friction": {"mu": [[0, 0.1], [50, 0.05]], "cap": 90},
            "points": "auto",
        },
        "punch": {"tool": "die", "faces": "upper", "friction": 0, "allowed": "any", "penalty": 100},
    },
    "tools": {
        "die": {
            "shape": "VDie",
            "opening": 16,
            "angle": 84,
            "shoulder_radius": 2.0,
            "translation": [0, 0, 1],
            "shared": True,
        },
        "ring": {"shape": "Revolved", "profile": {"corners": [[0, 0], [9, 0], [9.0, 5.0]], "radii": [0, 1.0, 0]}},
        "cut": {
            "shape": "Extruded",
            "profile": {"segments": [{"kind": "line", "start": [0, 0], "end": [1, 0]}], "closed": False},
        },
    },
    "material": {
        "law": "Metal",
        "E": 210e3,
        "nu": 0.3,
        "rolling": {"angle": 45},
        "hardening": {"curve": "Linear", "yield_stress": 200, "modulus": 9.0},
    },
}
WRONG = (
    "word",
    "",
    -1,
    0,
    1,
    2.5,
    True,
    float("nan"),
    float("inf"),
    [],
    [1.0],
    [1.0, 2, 3],
    ["x"],
    {},
    {"kind": "move"},
)


def places(data, way=()):
    """The way to each value, tables and arrays too."""
    entries = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in entries:
        yield (*way, key)
        yield from places(value, (*way, key))


def changed(data, way, value):
    data = copy.deepcopy(data)
    holder = data
    for key in way[:-1]:
        holder = holder[key]
    holder[way[-1]] = value
    return data


def decks():
    for name in templates():
        source = load(template_file(name)).source
        yield pytest.param(source, id=name)
    for key, table in MORE.items():
        yield pytest.param(source.__class__("deck", source.folder, "", source.data | {key: table}, {}, {}), id=key)


def same(source):
    """Whether a deck is read quickly; the content is then that of pydantic, down to the types of its numbers."""
    found, _ = checked(source)
    try:
        quick = read(Contents, source.data, source.context)
    except Unfit:
        return False
    assert repr(quick) == repr(found)
    return True


@pytest.mark.parametrize("source", list(decks()))
def test_a_changed_deck_is_read_as_by_pydantic(source):
    assert same(source)
    own = list(places(source.data))
    for way in own[:: max(len(own) // 8, 1)]:
        for value in WRONG:
            same(type(source)("deck", source.folder, "", changed(source.data, way, value), {}, {}))
        if isinstance(way[-1], str):
            same(type(source)("deck", source.folder, "", changed(source.data, (*way[:-1], "other"), 1), {}, {}))


@pytest.mark.parametrize(
    ("table", "keys", "word"),
    [
        (Output, {"frames": 0}, "frames"),
        (Output, {"colour": 1}, "no such key"),
        (Solution, {"solver": ""}, "solver"),
        (Free, {}, "kind"),
    ],
)
def test_a_table_in_python_is_checked_too(table, keys, word):
    with pytest.raises(InvalidValue, match=word):
        table(**keys)


def test_a_table_is_frozen():
    with pytest.raises(AttributeError, match="frames"):
        Output().frames = 2
