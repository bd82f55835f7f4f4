"""Errors: each public class has an id of its own, answers its five questions, and crosses process boundaries."""

from __future__ import annotations

import ast
import copy
import inspect
import pickle
from pathlib import Path

import numpy as np
import pytest

import umform
from umform import errors
from umform.errors import InvalidValue, UmformError

CLASSES = [value for _, value in inspect.getmembers(errors, inspect.isclass) if issubclass(value, UmformError)]
QUESTIONS = {
    "where": "cell 3, nodes [1, 2]",
    "value": (1.5, "two"),
    "cause": "two nodes exchanged",
    "remedy": "exchange them back",
}
every_class = pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)


def test_the_list_of_classes_is_complete():
    assert len(CLASSES) >= 17
    assert umform.UmformError is UmformError


def test_every_class_has_an_id_of_its_own():
    ids = [kind.id for kind in CLASSES]
    assert len(set(ids)) == len(ids)


@every_class
def test_a_message_answers_what_where_value_cause_remedy(kind):
    lines = str(kind("a cell is folded", **QUESTIONS)).splitlines()
    assert lines[0] == f"a cell is folded [{kind.id}]"
    assert [line.split(":")[0].strip() for line in lines[1:]] == list(QUESTIONS)
    for line, answer in zip(lines[1:], QUESTIONS.values(), strict=True):
        assert line.endswith(str(answer))


@every_class
def test_questions_without_an_answer_are_left_out(kind):
    assert str(kind("a cell is folded")) == f"a cell is folded [{kind.id}]"
    assert str(kind("no", value=0)) == f"no [{kind.id}]\n  value:  0"


@every_class
@pytest.mark.parametrize("carry", [lambda e: pickle.loads(pickle.dumps(e)), copy.copy, copy.deepcopy])
def test_an_error_survives_pickling_and_copying(kind, carry):
    error = kind("a cell is folded", **QUESTIONS)
    twin = carry(error)
    assert type(twin) is kind
    assert str(twin) == str(error)
    assert {name: getattr(twin, name) for name in ("what", *QUESTIONS)} == {"what": "a cell is folded"} | QUESTIONS


@every_class
def test_every_class_is_raised_and_caught_as_the_base(kind):
    with pytest.raises(UmformError, match="a cell is folded"):
        raise kind("a cell is folded")


@pytest.mark.parametrize(
    ("kind", "builtin"),
    [(errors.InvalidValue, ValueError), (errors.UnknownSet, KeyError), (errors.FileProblem, OSError)],
)
def test_kin_of_builtin_errors_are_caught_as_such(kind, builtin):
    assert issubclass(kind, builtin)


@every_class
def test_every_class_has_a_sentence_of_documentation(kind):
    assert kind.__doc__
    assert kind.__doc__ != UmformError.__doc__ or kind is UmformError


SOURCE = Path(umform.__file__).parent
FILES = [
    *sorted(SOURCE.glob("materials/*.py")),
    *sorted(SOURCE.glob("surfaces/*.py")),
    *(SOURCE / "model/supports" / f"{name}.py" for name in ("axes", "held", "support", "supports", "ties")),
    *(SOURCE / "model/bodies" / f"{name}.py" for name in ("bodies", "body", "selected_cells")),
    *(SOURCE / "model" / f"{name}.py" for name in ("terms/forces", "tools/tool", "contact/contacts", "contact/tools")),
    *(SOURCE / "mesh" / f"{name}.py" for name in ("blanks", "generators", "mesh")),
    *(
        SOURCE / "analysis" / f"{name}.py"
        for name in ("run/checked", "run/stages", "steps/move", "steps/arc_length/arc")
    ),
    SOURCE / "elements/technology.py",
]


@pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}/{file.stem}")
def test_what_users_meet_first_is_refused_with_place_cause_and_remedy(file):
    """Meshes, elements, materials, tools, supports and steps: each refusal says where, why, and what to do."""
    for node in ast.walk(ast.parse(file.read_text())):
        if (
            isinstance(node, ast.Raise)
            and isinstance(node.exc, ast.Call)
            and hasattr(errors, ast.unparse(node.exc.func))
        ):
            given = {keyword.arg for keyword in node.exc.keywords}
            assert {"where", "cause", "remedy"} <= given, f"line {node.lineno}: {ast.unparse(node.exc)}"


def test_a_long_array_is_not_shown_as_a_whole():
    text = str(InvalidValue("wrong", value=np.arange(1000.0)))
    assert len(text) < 300 and text.endswith("…")
    assert str(InvalidValue("wrong", value="a" * 1000)).count("a") > 1000
