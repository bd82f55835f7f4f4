"""One more number of a process is one entry: terminal, page, JSON, CSV, sweep and bench show it with unit and limit."""

import csv
import io
import json
from dataclasses import replace
from types import SimpleNamespace

import pytest

import umform as uf
from umform.cli.outcome_screen import show_outcome
from umform.errors import InvalidValue
from umform.io.tables import write_json
from umform.report import parts
from umform.report.page import outcome_parts
from umform.results.outcome import QUANTITIES, Outcome
from umform.results.quantity import Band, Quantity
from umform.studies.sweep.plan import Plan
from umform.studies.sweep.table import columns


class Pulled(Outcome):
    """A process of a test: a strip between two plates is pulled."""

    def __init__(self, result):
        self.result = result

    title = "Pulled"
    warnings = ("it is short",)

    @property
    def stages(self):
        return {"pulling": self.result}

    @property
    def notes(self):
        return ["a note"]

    @property
    def quantities(self):
        force = float(self.result["pull_force"][-1])
        return [
            Quantity("largest force", "N", 1, name="force", value=force, limit=0.5 * force),
            Quantity("length", "mm", 3, value=10.1, band=Band(0.002, "the mesh")),
        ]


@pytest.fixture(scope="module")
def pulled():
    model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.1, (4, 1)), material=uf.SVK(E=1e5, nu=0.3))
    model.fix("x0")
    model.contact("lower", uf.Plane((0.0, 0.0, -1.0)), penetration=0.01, name="table")
    pull = model.prescribe("x1", "x", "pull")
    return Pulled(uf.solve(model, uf.Move(pull, 0.1, steps=2), progress=False))


def test_the_terminal_shows_it(pulled, capsys):
    show_outcome(pulled, note="the material", everything=True)
    shown = capsys.readouterr()
    row = next(line for line in shown.out.splitlines() if "largest force" in line)
    assert row.split()[-1] == "N" and "MISSED 2 times over" in row
    assert "10.100" in shown.out and "± 0.002" in shown.out and "error: the mesh" in shown.out
    assert "a note" in shown.out and "the material" in shown.out and "contact table: penetration" in shown.out
    assert "it is short" in shown.err


def test_the_terminal_shows_the_leading_numbers_and_what_is_beyond_a_limit(pulled, capsys):
    few = [replace(one, leading=one.name == "length") for one in pulled.quantities]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Pulled, "quantities", [*few, Quantity("width", "mm", 3, value=1.0)])
        show_outcome(pulled, note="the material", everything=False)
    shown = capsys.readouterr().out
    assert "length" in shown and "largest force" in shown and "width" not in shown  # the force is beyond its limit
    assert "the material" not in shown and "contact table" not in shown and "--all" in shown


def test_the_page_shows_it(pulled, tmp_path):
    page = parts.write_html(tmp_path / "a.html", pulled.title, "", outcome_parts(pulled, "", (), {}, "")).read_text()
    force = pulled["force"].text
    assert f'<td>largest force</td><td class="bad">{force}</td>' in page
    assert "<td>length</td><td>10.100</td><td>± 0.002</td><td>mm</td>" in page and "it is short" in page


@pytest.mark.parametrize("kept", [True, False])
def test_contacts_are_folded_unless_one_goes_too_deep(pulled, monkeypatch, kept):
    reached = SimpleNamespace(kept=kept, text="up to 0.1")
    monkeypatch.setattr("umform.report.page.stage_penetrations", lambda stages: {"run": {"table": reached}})
    (part,) = (one for one in outcome_parts(pulled, "", (), {}, "") if "<h2>Contacts</h2>" in one)
    assert part.startswith('<details class="part">' if kept else '<details class="part" open>')


def test_json_and_csv_have_it(pulled, tmp_path):
    write_json(tmp_path / "a.json", pulled.record())
    record = json.loads((tmp_path / "a.json").read_text())
    kept = {one["name"]: one for one in (*record["quantities"], *record["checks"])}
    assert kept["force"]["missed"] and kept["force"]["unit"] == "N" and kept["length"]["band"]["error"] == 0.002
    assert kept["penetration of table"]["limit"] == 0.01 and not kept["penetration of table"]["missed"]
    assert kept["drift of the energies"]["limit"] == 1.0
    pulled.write(tmp_path)
    with (tmp_path / QUANTITIES).open() as file:
        rows = {row["name"]: row for row in csv.DictReader(file)}
    assert float(rows["force"]["value"]) == pulled.values["force"] == kept["force"]["value"]
    assert rows["force"]["missed"] == "True" and rows["length"]["source"] == "the mesh"


def test_a_sweep_has_a_column_of_it_with_its_unit(pulled):
    record = {"outcome": "done", "reason": "", "controls": [], "history": {}, "springback": None, "functions": {}}
    record |= pulled.record() | {"warnings": 1}
    rows, names = Plan(["size"], [{"size": 1.0}, {"size": 2.0}], {}, {}).table({0: record}, [])
    assert names[:2] == ["force", "length"] and {"penetration of table", "drift of the energies"} <= set(names)
    found = columns(rows, ["size"], names, units=True)
    assert found["force N"] == [pulled.values["force"], None] and found["length mm"] == [10.1, None]
    assert rows[0]["quantities"]["force"].missed


def test_the_table_of_the_bench_has_it(pulled, tmp_path):
    pytest.importorskip("starlette", reason="no extra bench")
    pytest.importorskip("httpx2", reason="no httpx2, which Starlette's test client needs")
    from starlette.applications import Starlette
    from starlette.testclient import TestClient

    from umform.bench.api import routes
    from umform.bench.jobs import Queue

    queue = Queue(tmp_path)
    queue.index.add("0" * 12, "bend", "a strip", "", {})
    queue.index.change("0" * 12, "done", summary=pulled.record())
    with TestClient(Starlette(routes=routes(queue))) as client:
        answer = client.get("/api/jobs.csv", params={"ids": "0" * 12})
    (row,) = csv.DictReader(io.StringIO(answer.text))
    assert row["force N"] == "103.8" and row["length mm"] == "10.100"


def test_an_unknown_quantity_of_an_outcome_is_refused_with_the_known_ones(pulled):
    with pytest.raises(InvalidValue, match="the outcome has no such quantity") as refused:
        pulled["foce"]
    assert refused.value.remedy == "one of force, length"
