"""What a notebook shows of results and tables: a line."""

from __future__ import annotations

import numpy as np

import umform as uf
from umform.materials.laws import full_text
from umform.processes.air_bending import AirBending, air_bending
from umform.processes.air_bending.files import parameters


def test_long_tables_are_shown_by_their_ends_and_recorded_whole():
    strains = np.linspace(0.0, 1.0, 2000)
    table = uf.Table(strains, 200.0 + 1000.0 / 3.0 * strains)
    assert repr(table) == "Table(2000 points: eqps 0 to 1, stress 200 to 533.333)"
    law = uf.J2(E=210e3, nu=0.3, hardening=table)
    assert len(repr(law)) < 150
    recorded = parameters(AirBending(material=law))["material"]
    assert recorded == full_text(law) and f"stress={table.stress}" in recorded
    short = uf.Table((0.0, 0.1), (200.0, 1000.0 / 3.0))
    assert repr(short) == full_text(short) == f"Table(eqps=(0.0, 0.1), stress=(200.0, {1000.0 / 3.0}))"
    swift = uf.J2(E=210e3, nu=0.3, hardening=uf.Swift(520.0, 0.004, 0.22))
    assert full_text(swift) == repr(swift)


def test_results_are_a_line():
    bend = air_bending(AirBending(stroke=0.5, layers=1, elements_per_thickness=1, increment=0.025))
    assert repr(bend).startswith("AirBend(stroke=0.500")
    assert f"angle={bend.measures.angle:.2f}" in repr(bend)
    assert repr(bend.result).startswith(f"Result({len(bend.result)} rows, ")
    assert all(len(repr(one)) < 500 for one in (bend, bend.result, bend.result.frames[-1]))
    assert "displacement" in repr(bend.result.frames[-1])
