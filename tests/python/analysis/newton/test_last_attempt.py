"""What is said of an increment that fails is that of the last attempt."""

from __future__ import annotations

from collections import Counter
from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest

from umform.analysis.newton import strategies
from umform.analysis.newton.strategies import Strategy, equilibrium
from umform.results.records import Cause, Failed


def failing(reason, cause, motion=None):
    def attempt(increment):
        raise Failed(reason, [], cause, motion)

    return attempt


def increment():
    attempts = SimpleNamespace(trying=lambda name: nullcontext(), causes=Counter())
    statistics = SimpleNamespace(learn=lambda **what: None, record_cut=lambda what: None, last=False)
    newton = SimpleNamespace(timing=SimpleNamespace(attempts=attempts))
    return SimpleNamespace(newton=newton, statistics=statistics, touched=True, accept=lambda found: found)


@pytest.mark.parametrize("last", [None, np.array([0.0, 1.0])])
def test_the_motion_that_is_named_is_that_of_the_last_attempt(monkeypatch, last):
    cause = Cause.OTHER if last is None else Cause.SINGULAR
    tried = (
        Strategy("extrapolation", lambda at: True, failing("singular", Cause.SINGULAR, np.array([1.0, 0.0]))),
        Strategy("tangent", lambda at: True, failing("no convergence", cause, last)),
    )
    monkeypatch.setattr(strategies, "STRATEGIES", tried)
    with pytest.raises(Failed) as caught:
        equilibrium(increment())
    assert caught.value.reason == "no convergence" and caught.value.cause is Cause.SINGULAR
    assert caught.value.motion is last
