"""Decks with mistakes: templates whose text, keys and values are changed at random; and what their refusal must say."""

import copy
import datetime
import json
import tomllib
import warnings

from hypothesis import HealthCheck, Phase
from hypothesis import strategies as st

from umform.problem import DeckError, Problem
from umform.problem.check import check as check_problem
from umform.problem.templates import template, template_file, templates

FOLDER = template_file("own-mesh").parent
TEXTS = {name: template(name) for name in templates()}
#: Words of all decks, so that keys and values get into each other's places.
WORDS = sorted({word for text in TEXTS.values() for word in text.replace('"', " ").split() if word.isidentifier()})


def shortened(data):
    """The deck with a coarse mesh, two increments a step, a twentieth of each motion, and without slow files."""
    mesh = data["mesh"]
    if "cells" in mesh:
        most = (2, 2) if mesh["generator"] == "disc" else (24, 6)
        mesh["cells"] = [min(pair) for pair in zip(mesh["cells"], most, strict=True)]
    mesh |= {axis: mesh[axis][::4] for axis in "xy" if axis in mesh}
    for step in data["steps"]:
        if step["kind"] == "move":
            step["to"] = {name: value / 20 for name, value in step["to"].items()}
        if step["kind"] == "arc":
            step["most"] = 2
        if step["kind"] in ("move", "free"):
            step |= {"increments": 2, "cuts": 1}
    data["output"] = data.get("output", {}) | {"report": False, "pictures": False}
    return data


#: The templates, made so small that a run takes a fraction of a second.
SHORT = {name: shortened(tomllib.loads(text)) for name, text in TEXTS.items()}

numbers = st.sampled_from(
    [0, 1, 2, 3, -1, 7, 0.0, 0.5, -2.5, 1e-9, 1e9, 1e200, -1e300, float("nan"), float("inf"), 10**30]
)
words = st.one_of(st.sampled_from(WORDS), st.text(max_size=5), st.sampled_from(["", "x0", "nodes", "$\\frac$", "../x"]))
scalars = st.one_of(numbers, words, st.booleans(), st.just(datetime.date(2020, 2, 2)))
values = st.one_of(
    scalars,
    st.lists(scalars, max_size=4),
    st.dictionaries(words, scalars, max_size=3),
    st.just([]),
    st.just({}),
    st.just([[0, 1], [2]]),
)


def written(value):
    """A value as TOML."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value).replace("\x7f", "\\u007f")
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {written(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    return str(value)


def places(data, path=()):
    """All paths of a tree."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ():
        yield (*path, key)
        yield from places(value, (*path, key))


def holder(data, path):
    for key in path[:-1]:
        data = data[key]
    return data


@st.composite
def changed_data(draw, most=3):
    """A short template with some keys renamed, dropped, copied elsewhere, or given other values."""
    data = copy.deepcopy(SHORT[draw(st.sampled_from(sorted(SHORT)))])
    for _ in range(draw(st.integers(1, most))):
        path = draw(st.sampled_from(list(places(data)) or [("mesh",)]))
        inside = holder(data, path)
        how = draw(st.sampled_from(["value", "number", "drop", "rename", "copy"]))
        if how == "drop":
            del inside[path[-1]]
        elif how == "rename" and isinstance(inside, dict):
            inside[draw(words)] = inside.pop(path[-1])
        elif how == "copy":
            source = draw(st.sampled_from(list(places(data))))
            inside[path[-1]] = copy.deepcopy(holder(data, source)[source[-1]])
        else:
            inside[path[-1]] = copy.deepcopy(draw(numbers if how == "number" else values))
    return "".join(f"{json.dumps(key)} = {written(value)}\n" for key, value in data.items())


@st.composite
def changed_text(draw):
    """A template with pieces of text cut out, doubled, or put in."""
    text = TEXTS[draw(st.sampled_from(sorted(TEXTS)))]
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(text)))
        end = min(start + draw(st.sampled_from([0, 1, 2, 10, 60])), len(text))
        piece = draw(
            st.one_of(
                st.text(max_size=3), st.sampled_from(['"', "[", "]]", "{", "\n", "=", "'''", "#", text[start:end] * 2])
            )
        )
        text = text[:start] + piece + text[end:]
    return text


decks = st.one_of(changed_data(), changed_data(), changed_text())

#: A model of more cells than this is read, but not built.
_SMALL = 200
#: Settings of hypothesis for tests that are slow and whose failures are short enough.
SETTINGS = {
    "deadline": None,
    "suppress_health_check": [HealthCheck.too_slow, HealthCheck.function_scoped_fixture, HealthCheck.filter_too_much],
    "phases": [Phase.explicit, Phase.generate],
}


def read(text):
    """The deck, or None if it was refused; each refusal must say where and why."""
    try:
        return Problem.read(text, "deck.toml", FOLDER)
    except DeckError as error:
        for told in error.errors:
            assert told.where.startswith("deck.toml"), str(told)
            assert told.what, str(told)
            assert told.cause, str(told)
            assert told.remedy, str(told)
            assert "\n" not in told.where
        return None


def small(deck):
    mesh = deck.contents.mesh
    cells = getattr(mesh, "cells", (1, 1))
    lines = [len(getattr(mesh, axis, ())) for axis in "xyz"]
    if getattr(mesh, "generator", "") in ("disc", "ring"):  # cells of a side of the core, or of a quarter of the circle
        cells = 4 * (cells[0] + 2 * cells[1]), cells[0]
    return cells[0] * cells[1] * getattr(mesh, "layers", 1) <= _SMALL and lines[0] * lines[1] <= _SMALL


def built(deck):
    """The problem and what a look at it finds, or None if it was refused."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # numbers near the end of the range
        try:
            problem = deck.build()
        except DeckError as error:
            for told in error.errors:
                assert told.where.startswith("deck.toml, "), str(told)
                assert told.cause, str(told)
                assert told.remedy, str(told)
            return None
        for finding in check_problem(deck, problem):
            assert finding.text
            assert finding.remedy or finding.level.value == "ok"
        return problem
