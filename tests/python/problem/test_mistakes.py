"""Whatever stands in a deck, what is said of it has a place, a cause or a remedy."""

import importlib.util
import time
from pathlib import Path

import pytest
from hypothesis import given, settings

_SPEC = importlib.util.spec_from_file_location("mutations", Path(__file__).with_name("mutations.py"))
mutations = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(mutations)


def check(text):
    start = time.process_time()
    deck = mutations.read(text)
    if deck is not None and mutations.small(deck):
        mutations.built(deck)
    assert time.process_time() - start < 30


@settings(max_examples=270, **mutations.SETTINGS)
@given(mutations.decks)
def test_reading(text):
    mutations.read(text)


@settings(max_examples=100, **mutations.SETTINGS)
@given(mutations.changed_data(most=1))
def test_building(text):
    check(text)


@pytest.mark.long
@settings(max_examples=2000, derandomize=True, **mutations.SETTINGS)
@given(mutations.decks)
def test_two_thousand(text):
    check(text)
