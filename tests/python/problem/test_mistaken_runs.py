"""Whatever stands in a deck, its run leaves nothing half done."""

import importlib.util
import warnings
from pathlib import Path

import pytest
from hypothesis import given, settings

from umform.errors import UmformError
from umform.problem.running import run

_SPEC = importlib.util.spec_from_file_location("mutations", Path(__file__).with_name("mutations.py"))
mutations = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(mutations)


def try_to_run(text, folder):
    """Run a deck in a few increments; whatever ends it, its files are whole."""
    deck = mutations.read(text)
    if deck is None or not mutations.small(deck) or sum(step.expected for step in deck.contents.steps) > 60:
        return
    problem = mutations.built(deck)
    if problem is None:
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        try:
            outcome = run(deck, problem, folder, progress=False)
        except UmformError as refusal:
            assert refusal.what
            return
    assert outcome.ended_by is None or isinstance(outcome.ended_by, UmformError), outcome.ended_by
    names = {path.name for path in folder.iterdir()}
    assert names == {path.name for path in outcome.files}
    assert all(path.stat().st_size > 0 for path in outcome.files)
    if "history.csv" in names:
        rows = (folder / "history.csv").read_text().splitlines()
        assert len(rows) == len(outcome.result) + 1
        assert len({row.count(",") for row in rows}) == 1


@settings(max_examples=25, **mutations.SETTINGS)
@given(mutations.changed_data(most=1))
def test_running(tmp_path_factory, text):
    try_to_run(text, tmp_path_factory.mktemp("run"))


@pytest.mark.long
@settings(max_examples=200, derandomize=True, **mutations.SETTINGS)
@given(mutations.changed_data(most=1))
def test_two_hundred_runs(tmp_path_factory, text):
    try_to_run(text, tmp_path_factory.mktemp("run"))
