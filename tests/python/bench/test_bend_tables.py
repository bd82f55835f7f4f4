"""Bend tables and corrections on the bench: numbers of the library, stored bends at once, files of all formats."""

import pytest

from umform.bench.bend_tables import rows_of
from umform.bench.wanted import Wanted
from umform.studies.bend_table import bend_table, correct

TABLE = {
    "work": "table",
    "metals": ["DC04"],
    "thicknesses": [1],
    "openings": [8],
    "angles": [150, 140],
    "mesh": "quick",
}
MEASURED = {"work": "correct", "thickness": 1.0, "opening": 8.0, "stroke": 1.6, "angle": 140.0, "mesh": "quick"}


def ordered(bench, form):
    answer = bench.client.post("/api/jobs", json={"forms": [form]})
    assert answer.status_code == 200, answer.text
    return bench.ended(answer.json()["jobs"][0], 120.0)


@pytest.fixture(scope="module")
def table(bench):
    """The job of a table."""
    job = ordered(bench, TABLE)
    assert job["state"] == "done", job["reason"]
    return job


def test_table_is_that_of_the_library(table):
    wanted = Wanted.read(TABLE)
    expected = rows_of(bend_table(wanted.setups(), wanted.values["angles"], processes=1))
    plain = [{**row, "computed": None} for row in table["summary"]["table"]]
    assert plain == [{**row, "computed": None} for row in expected]
    assert [row["angle"] for row in plain] == [140.0, 150.0]


def test_all_formats_can_be_fetched(bench, table):
    endings = ("bends.csv", "bends.json", ".FCStd", ".bnd", ".inventor.txt", ".solidworks.txt")
    for ending in endings:
        (file,) = (name for name in table["files"] if name.endswith(ending))
        assert bench.client.get(f"/files/{table['id']}/{file}").status_code == 200
    for name in ("job.json", "..%2Fjob.json", "x.FCStd", "%2Fetc%2Fpasswd.bnd"):
        assert bench.client.get(f"/files/{table['id']}/{name}").status_code == 404


def test_stored_bends_are_not_computed_again(bench, table):
    again = ordered(bench, TABLE | {"angles": [140, 150]})
    assert again["summary"]["computed"] == 0 and len(again["live"]["table"]) == 2


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"angles": [30, 120]}, "angles"),
        ({"angles": []}, "angles"),
        ({"angles": "90 to 120"}, "angles"),
        ({"thicknesses": [1.0, -2.0]}, "thicknesses"),
        ({"metals": ["DC04", "/etc/metal.toml"]}, "metals"),
        ({"metals": "DC04"}, "metals"),
        ({"openings": [0.5]}, "openings"),
        ({"angles": [float(90 + k) for k in range(40)], "openings": [float(8 + k) for k in range(40)]}, "angles"),
    ],
)
def test_list_that_cannot_be_bent_is_refused_at_its_field(bench, change, where):
    (problem,) = bench.client.post("/api/look", json=TABLE | change).json()["problems"]
    assert problem["where"] == where and problem["what"]
    assert bench.client.post("/api/jobs", json={"forms": [TABLE | change]}).status_code == 422


def test_measured_bend_corrects_the_metal_and_the_table(bench, table):
    form = MEASURED | {"measured_angle": 136.7, "issue_again": table["id"]}
    wanted = Wanted.read(form)
    expected = correct(wanted.case(), 136.7, name="DC04")
    job = ordered(bench, form)
    assert job["state"] == "done", job["reason"]
    found = job["summary"]
    assert found["corrected"][0]["value"] == expected.found.values["flow_stress"]
    strokes = [next(one["value"] for one in bend if one["name"] == "stroke") for bend in found["bends"]]
    assert strokes[0] != strokes[1]
    assert [row["angle"] for row in found["table"]] == [row["angle"] for row in found["table_before"]]
    assert [row["stroke"] for row in found["table_before"]] == [row["stroke"] for row in table["summary"]["table"]]
    assert all(new["stroke"] != old["stroke"] for new, old in zip(found["table"], found["table_before"], strict=True))
    assert "[material]" in bench.client.get(f"/files/{job['id']}/metal.toml").text


def test_correction_without_numbers_or_with_another_table_is_refused(bench, table):
    for form, where in (
        (MEASURED, "measured_angle"),
        (MEASURED | {"stroke": None, "measured_angle": 139.0}, "stroke"),
        (MEASURED | {"measured_angle": 139.0, "measured_force": -1.0}, "measured_force"),
        (MEASURED | {"measured_angle": 139.0, "material": "S235", "issue_again": table["id"]}, "issue_again"),
        (MEASURED | {"measured_angle": 139.0, "issue_again": "../../x"}, "issue_again"),
    ):
        answer = bench.client.post("/api/jobs", json={"forms": [form]})
        assert answer.status_code == 422 and answer.json()["problems"][0]["where"] == where, form
