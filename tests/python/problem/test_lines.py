import tomllib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from umform.problem.lines import lines_of, nearest_line

TEXT = '''\
# a comment with [brackets] = and "quotes"
title = "two words" # with = and [
text = """
[not.a.header]
key = 1
"""
raw = \'\'\'
[[nor.this]]\'\'\'
[mesh]
cells = [ # with a comment ]
  40,
  1,
]
nested = [[1, 2], [
  3, "]", 4]]
[tools.die]
"quoted key" = 1
'single.quoted' = 2
origin.x = 1
origin . y = 2
[[steps]]
to = { stroke = 5.0, "other" = { deep = [1,
  2] } }
[[steps]]
kind = "move"
[steps.more]
inner = 1
[[steps.list]]
a = 1
[[steps.list]]
b = 2
[last]
a.b.c = 3
"new\\nline \\u00e9\\\\ \\"q" = 4
'''

EXPECTED = {
    ("title",): 2,
    ("text",): 3,
    ("raw",): 7,
    ("mesh",): 9,
    ("mesh", "cells"): 10,
    ("mesh", "cells", 0): 11,
    ("mesh", "cells", 1): 12,
    ("mesh", "nested", 0, 1): 14,
    ("mesh", "nested", 1): 14,
    ("mesh", "nested", 1, 0): 15,
    ("mesh", "nested", 1, 2): 15,
    ("tools", "die", "quoted key"): 17,
    ("tools", "die", "single.quoted"): 18,
    ("tools", "die", "origin"): 19,
    ("tools", "die", "origin", "x"): 19,
    ("tools", "die", "origin", "y"): 20,
    ("steps",): 21,
    ("steps", 0): 21,
    ("steps", 0, "to", "stroke"): 22,
    ("steps", 0, "to", "other", "deep", 0): 22,
    ("steps", 0, "to", "other", "deep", 1): 23,
    ("steps", 1): 24,
    ("steps", 1, "kind"): 25,
    ("steps", 1, "more"): 26,
    ("steps", 1, "more", "inner"): 27,
    ("steps", 1, "list", 0, "a"): 29,
    ("steps", 1, "list", 1): 30,
    ("steps", 1, "list", 1, "b"): 31,
    ("last", "a", "b", "c"): 33,
    ("last", 'new\nline \u00e9\\ "q'): 34,
}


@pytest.mark.parametrize(("path", "line"), EXPECTED.items(), ids=lambda value: str(value))
def test_line_of_each_key(path, line):
    assert lines_of(TEXT)[path] == line


def paths(data, path=()):
    """All paths of a tree of tables and arrays."""
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        yield (*path, key)
        yield from paths(value, (*path, key))


def test_each_path_that_tomllib_sees_has_a_line_and_there_are_no_others():
    assert set(lines_of(TEXT)) == set(paths(tomllib.loads(TEXT)))


def test_a_key_without_a_line_has_that_of_its_table():
    lines = lines_of(TEXT)
    assert nearest_line(lines, ("steps", 1, "missing")) == 24
    assert nearest_line(lines, ("nowhere",)) is None


@settings(max_examples=200, deadline=None)
@given(st.text(alphabet="[]{}=\"'.,#\n\\ ab1\u00e9", max_size=60))
def test_never_fails(text):
    lines = lines_of(text)
    assert all(1 <= line <= text.count("\n") + 1 for line in lines.values())
    try:
        data = tomllib.loads(text)
    except ValueError:
        return
    assert set(paths(data)) <= set(lines)


def test_deep_nesting_is_no_matter():
    assert lines_of("a = " + "[" * 5000)[("a",)] == 1
    assert lines_of("a = " + "{b=" * 5000)[("a",)] == 1
