"""Brackets of the CAD kernel as STEP files, and their flat patterns for a K-factor."""

from __future__ import annotations

from functools import cache

import pytest

pytest.importorskip("OCP")
pytest.importorskip("ezdxf")

from brackets import BRACKETS

from umform.flat_pattern import KFactor, flat

K = 0.44


@pytest.fixture(scope="session")
def step(tmp_path_factory):
    """The STEP file of a bracket by its name."""
    folder = tmp_path_factory.mktemp("brackets")
    return cache(lambda name: BRACKETS[name].file(folder / f"{name.replace(' ', '-')}.step"))


@pytest.fixture(scope="session")
def pattern(step):
    """The flat pattern of a bracket by its name."""
    return cache(lambda name: flat(step(name), allowance=KFactor(K)))
