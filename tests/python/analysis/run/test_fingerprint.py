"""Two runs that would go different ways have different fingerprints, whatever they are made of."""

from __future__ import annotations

import functools
from dataclasses import dataclass

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


def curve_of(slope, base=object):
    """A curve of the user, whose class has the same name whatever it computes."""

    @dataclass(frozen=True)
    class Curve(base):
        first: float = 1.0

        @property
        def stress(self):
            return self.first + slope

    return Curve()


class Doubled:
    def curve(self):
        return 2.0


class Trebled:
    def curve(self):
        return 3.0


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
        (curve_of(1.0), curve_of(2.0)),
        (curve_of(1.0, Doubled), curve_of(1.0, Trebled)),
    ],
)
def test_what_differs_has_another_text(one, other):
    assert text(one) != text(other)


def test_what_is_equal_has_the_same_text():
    assert text(Ramp(1.0)) == text(Ramp(1.0))
    assert text(np.sin) == text(np.sin)
    assert text(curve_of(1.0, Doubled)) == text(curve_of(1.0, Doubled))
