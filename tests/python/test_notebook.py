"""What a notebook shows of models, results, laws, tools and studies: tables, and no more than a few kilobytes."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from types import SimpleNamespace

import numpy as np
import pytest

import umform as uf
from umform.notebook import Display
from umform.processes.air_bending import AirBending, air_bending
from umform.results.quantity import Quantity


class Cells(HTMLParser):
    """Rows of text of all tables of an HTML text, whose elements must be closed in their order."""

    def __init__(self, text):
        super().__init__()
        self.rows, self.open = [], []
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if {"td", "th"} & set(self.open):
            self.rows[-1][-1] += data


def rows_of(thing):
    return Cells(thing._repr_html_()).rows


@pytest.fixture(scope="module")
def strip():
    """A model with all kinds of parts, and its run."""
    model = uf.Model(uf.mesh.strip(10.0, 2.0, 0.5, (10, 1)), material=uf.J2(E=210e3, nu=0.3, hardening=steel()))
    model.fix("x0")
    tip = model.prescribe("x1_lower", "z", name="tip")
    model.contact("upper", uf.Cylinder((5, 0, 3.5), "y", 3.0), penalty=100, name="roll", friction=0.1)
    return SimpleNamespace(model=model, result=uf.solve(model, [uf.Move(tip, -0.2, steps=2), uf.Release(tip)]))


def steel():
    strains = np.linspace(0.0, 1.0, 2000)
    return uf.Table(strains, 200.0 + 300.0 * strains)


def test_a_model_is_a_line_and_a_table_of_its_parts(strip):
    assert repr(strip.model) == "Model(44 points, 10 ANS3DEAS; 1 tool, 1 contact, 1 support, 1 control)"
    assert repr(strip.model.contacts) == "[Contact('roll')]" and repr(strip.model.bodies) == "[Body('sheet')]"
    rows = rows_of(strip.model)
    assert [row[0] for row in rows] == ["part", "mesh", "body", "support", "tool", "contact", "control"]
    assert ["contact", "roll", "10 facets with roll, friction"] in rows
    assert ["tool", "roll", "Cylinder"] in rows


def test_a_result_shows_the_ends_of_its_steps(strip):
    header, *rows = rows_of(strip.result)
    assert header == ["step", "time", "tip", "tip_force"]
    steps = strip.result["step"]
    ends = [np.flatnonzero(steps == step)[-1] for step in (0, 1, 2)]
    assert rows == [[f"{strip.result[name][end]:.6g}" for name in header] for end in ends]
    html = strip.result._repr_html_()
    assert f"{len(strip.result) - 1} increments" in html and len(html) < 3000


def test_laws_and_tools_are_tables_of_their_parameters():
    law = uf.J2(E=210e3, nu=0.3, hardening=steel())
    html = law._repr_html_()
    assert len(html) < 2000
    assert ["E", "210000", "Young's modulus."] in rows_of(law)
    assert ["hardening", repr(law.hardening)] == next(row for row in rows_of(law) if row[0] == "hardening")[:2]
    assert ["eqps", "2000 values: 0 ... 1", "Plastic strains, increasing from 0."] in rows_of(steel())
    assert next(row for row in rows_of(uf.VDie(16, 90, 1)) if row[0] == "angle")[:3] == ["angle", "90", "degrees"]


THINGS = [
    uf.SVK(E=210e3, nu=0.3),
    uf.Swift(520.0, 0.004, 0.22),
    uf.Linear(160.0, 500.0),
    uf.Hill48(1.8, 1.5, 2.2),
    uf.Hosford(8),
    uf.Transformation(),
    uf.Chaboche([(1e3, 10.0)]),
    uf.CowperSymonds(40.0, 5.0),
    uf.sheet_metals.get("DC04").law,
    uf.Box((0, 0, 0), (1, 1, 1)),
    uf.Punch(1.0, 85.0),
]


@pytest.mark.parametrize("thing", THINGS, ids=lambda thing: type(thing).__name__)
def test_all_of_them_are_shown(thing):
    rows = rows_of(thing)
    assert rows[0][:2] == ["parameter", "value"] and len(rows) > 1
    assert all(len(row) == len(rows[0]) for row in rows)


def test_an_outcome_shows_its_leading_numbers_and_what_is_beyond_its_limit():
    bend = air_bending(AirBending(stroke=0.5, layers=1, elements_per_thickness=1, increment=0.025))
    rows = rows_of(bend)
    labels = [row[0] for row in rows]
    assert all(one.label in " ".join(labels) for one in bend.leading)
    assert any(re.match(rf"{bend.measures.angle:.2f}", row[1]) for row in rows)
    beyond = Quantity("depth", "mm", 2, value=3.0, limit=1.0)
    assert "#d92d20" in beyond._repr_html_() and rows_of(beyond)[1][1].startswith("3.00 MISSED")


def test_studies_are_a_line_and_their_tables():
    def build(E, way):
        model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (8, 1)), material=uf.SVK(E=E, nu=0.3))
        model.fix("x0")
        return model, uf.Move(model.prescribe("x1_lower", "z", name="tip"), way, steps=2)

    found = uf.derivatives(build, by={"E": 210e3, "way": 0.1}, of=["tip_force"])
    assert repr(found) == "Derivatives(tip_force)"
    assert rows_of(found) == [list(row) for row in found.table]


def test_a_sweep_is_a_table_of_its_jobs():
    row = {"outcome": "done", "warnings": 0, "seconds": 1.0, "reason": "", "folder": "jobs"}
    rows = [row | {"thickness": t, "punch_force:peak": force} for t, force in ((0.8, 21.0), (1.0, 33.5))]
    found = uf.Sweep(["thickness"], ["punch_force:peak"], rows, [])
    assert repr(found) == "Sweep(2 jobs over thickness: punch_force:peak)"
    header, *jobs = rows_of(found)
    assert [dict(zip(header, job, strict=True))["punch_force:peak"] for job in jobs] == ["21", "33.5"]


def test_text_is_escaped_and_long_tables_are_cut():
    shown = Display("<b>", {"a & b": [["<i>"], *([str(n)] for n in range(100))]}, ["x < y"], ["<script>"])
    assert (
        "<script>" not in shown.html
        and "<i>" not in shown.html
        and "&lt;b&gt;" in shown.html
        and "a &amp; b" in shown.html
    )
    rows = Cells(shown.html).rows
    assert rows[1] == ["0"] and rows[-1] == ["99"] and rows[-6] == ["… 65 more rows"] and len(rows) == 1 + 30 + 1 + 5
