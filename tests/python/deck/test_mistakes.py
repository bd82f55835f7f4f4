"""Whatever stands in a deck, what is said of it has a place, a cause or a remedy, and nothing is left half done."""

import importlib.util
import time
import warnings
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, settings

from umform.deck import Deck, DeckError
from umform.deck.check import check as check_problem
from umform.deck.running import run
from umform.errors import UmformError

_SPEC = importlib.util.spec_from_file_location("mutations", Path(__file__).with_name("mutations.py"))
mutations = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(mutations)

#: A model of more cells than this is read, but not built.
_SMALL = 200
_SLOW = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture, HealthCheck.filter_too_much]
_PHASES = [Phase.explicit, Phase.generate]  # what fails is short enough


def read(text):
    """The deck, or None if it was refused; each refusal must say where and why."""
    try:
        return Deck.read(text, "deck.toml", mutations.FOLDER)
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


def check(text):
    start = time.perf_counter()
    deck = read(text)
    if deck is not None and small(deck):
        built(deck)
    assert time.perf_counter() - start < 30


@settings(max_examples=270, deadline=None, suppress_health_check=_SLOW, phases=_PHASES)
@given(mutations.decks)
def test_reading(text):
    read(text)


@settings(max_examples=30, deadline=None, suppress_health_check=_SLOW, phases=_PHASES)
@given(mutations.changed_data(most=1))
def test_building(text):
    check(text)


@settings(max_examples=2000, derandomize=True, deadline=None, suppress_health_check=_SLOW, phases=_PHASES)
@given(mutations.decks)
def test_two_thousand(text):
    check(text)


def try_to_run(text, folder):
    """Run a deck in a few increments; whatever ends it, its files are whole."""
    deck = read(text)
    if deck is None or not small(deck) or sum(step.expected for step in deck.contents.steps) > 60:
        return
    problem = built(deck)
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


@settings(max_examples=12, deadline=None, suppress_health_check=_SLOW, phases=_PHASES)
@given(mutations.changed_data(most=1))
def test_running(tmp_path_factory, text):
    try_to_run(text, tmp_path_factory.mktemp("run"))


@settings(max_examples=200, derandomize=True, deadline=None, suppress_health_check=_SLOW, phases=_PHASES)
@given(mutations.changed_data(most=1))
def test_two_hundred_runs(tmp_path_factory, text):
    try_to_run(text, tmp_path_factory.mktemp("run"))
