"""The table of mutants: its texts and tests are there, and the tool notices where they are not."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from mutants import Mutant, load, problems  # noqa: E402


def test_every_old_text_occurs_once_and_every_test_is_there():
    assert problems(load()) == []


@pytest.fixture
def mutant(tmp_path):
    (tmp_path / "law.py").write_text("a = 1\nb = 1\n")
    (tmp_path / "test_law.py").write_text("class TestLaw:\n    def test_a(self):\n        pass\n")
    return Mutant("a is two", "law.py", "a = 1", "a = 2", ("test_law.py::TestLaw::test_a[0]",))


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        ({"old": "= 1"}, "occurs 2 times"),
        ({"old": "c = 1"}, "occurs 0 times"),
        ({"file": "gone.py"}, "occurs 0 times"),
        ({"new": "a = 1"}, "changes nothing"),
        ({"tests": ()}, "names no test"),
        ({"tests": ("test_law.py::test_b",)}, "there is no test"),
        ({"tests": ("test_none.py::test_a",)}, "there is no test"),
    ],
)
def test_what_is_wrong_with_a_row_is_said(mutant, tmp_path, change, problem):
    assert problems([mutant], tmp_path) == []
    (found,) = problems([replace(mutant, **change)], tmp_path)
    assert problem in found
    assert "occurs twice" in problems([mutant, mutant], tmp_path)[0]
