"""A small table on a coarse mesh, computed once."""

from __future__ import annotations

import pytest

from umform.io.store import Store
from umform.processes.air_bending import AirBending
from umform.studies.bend_table import bend_table, setups

COARSE = {"elements_per_thickness": 1, "layers": 1, "thickness_points": 5, "increment": 0.02}
ANGLES = [150.0, 135.0, 120.0]


@pytest.fixture(scope="session")
def store(tmp_path_factory):
    return Store(tmp_path_factory.mktemp("bends"))


@pytest.fixture(scope="session")
def case():
    return AirBending(thickness=1.0, opening=8.0, **COARSE)


@pytest.fixture(scope="session")
def table(store, case):
    return bend_table(setups(["DC04"], case, thicknesses=[1.0, 1.5]), ANGLES, store=store, processes=1)
