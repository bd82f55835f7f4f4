"""Two runs that would go different ways have different fingerprints, whatever they are made of."""

from __future__ import annotations

import functools

import numpy as np
import pytest

from umform.analysis.run.fingerprint import text


class Ramp:
    """A motion with a speed."""

    def __init__(self, speed):
        self.speed = speed

    def __call__(self, time):
        return np.array([0.0, 0.0, self.speed * time])


class Steps(Ramp):
    def __call__(self, time):
        return np.array([0.0, 0.0, self.speed * round(time)])


def scaled(factor, time):
    return factor * time


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (Ramp(1.0), Ramp(2.0)),
        (Ramp(1.0), Steps(1.0)),
        (Ramp(1.0).__call__, Ramp(2.0).__call__),
        (functools.partial(scaled, 1.0), functools.partial(scaled, 2.0)),
        (functools.partial(Ramp(1.0)), functools.partial(Ramp(3.0))),
        (lambda x: x + 1, lambda x: x + 2),
        (Ramp, Steps),
        ([Ramp(1.0), 2], [Ramp(1.5), 2]),
    ],
)
def test_what_differs_has_another_text(one, other):
    assert text(one) != text(other)


def test_what_is_equal_has_the_same_text():
    assert text(Ramp(1.0)) == text(Ramp(1.0))
    assert text(np.sin) == text(np.sin)
