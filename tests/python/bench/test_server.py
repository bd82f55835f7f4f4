"""The server: who may ask, what it answers, and that its numbers are those of `umform bend`."""

import csv
import io
import json

import pytest
from starlette.testclient import TestClient

from umform.bench.check_deck import findings
from umform.bench.guard import LONGEST_BODY
from umform.bench.shelf import Shelf
from umform.bench.wanted import Wanted
from umform.problem import DeckError
from umform.problem.templates import template
from umform.processes.air_bending import air_bending, find_stroke
from umform.processes.air_bending.files import FILES, record
from umform.processes.bend_sequence import bend_sequence
from umform.processes.bend_sequence.files import FILES as PART_FILES
from umform.processes.bend_sequence.spec import MOST_BENDS
from umform.processes.hemming import hemming
from umform.processes.plausible import accepted

JSON = {"content-type": "application/json"}
HARMFUL = ["/etc/passwd", "../bench.sqlite", "..%2f..%2ftoken", "job.json", "deck.toml", "%00", "live.json", "a" * 5000]


@pytest.fixture(scope="module")
def done(bench):
    """A finished bend."""
    job = bench.ended(bench.order())
    assert job["state"] == "done", job["reason"]
    return job


@pytest.fixture
def stranger(bench):
    """A browser that has not opened the link."""
    return TestClient(bench.app, base_url=str(bench.client.base_url))


def test_numbers_are_those_of_the_library_to_the_last_bit(bench, done):
    wanted = Wanted.read(done["parameters"])
    expected = json.loads(json.dumps(record(air_bending(wanted.case(), progress=False))))
    for name in ("measures", "shop_forces", "parameters", "increments", "force_balance"):
        assert done["summary"][name] == expected[name], name


def test_two_sheets_are_those_of_the_library(bench):
    form = {"second_material": "1.4301", "second_thickness": 0.5, "second_friction": 0.1}
    job = bench.ended(bench.order(**form))
    assert job["state"] == "done", job["reason"]
    assert job["title"] == "DC04 2 mm + 1.4301 0.5 mm, V16, 1 mm"
    bend = air_bending(Wanted.read(job["parameters"]).case(), progress=False)
    assert [sheet.thickness for sheet in bend.case.on_top] == [0.5]
    expected = {one.name: one.value for one in bend.quantities}
    found = {row["name"]: row["value"] for row in job["summary"]["quantities"]}
    assert found == expected and "sheet2_springback" in found
    (_, low), (_, high) = (face[0] for face in job["live"]["section"])
    lower, upper = (sheet.released.current[0, :, 1] for sheet in bend.stack)
    assert high - low == pytest.approx(upper[-1] - lower[0], abs=1e-3)


def test_bottoming_is_that_of_the_library(bench):
    form = {"work": "bottom", "angle": None, "travel": 0.0, "mesh": "quick", "die_angle": 88.0, "punch_angle": 88.0}
    wanted = Wanted.read(form)
    job = bench.ended(bench.order(**form, stroke=None))
    assert job["state"] == "done", job["reason"]
    assert job["summary"]["measures"]["angle"] == air_bending(wanted.case(), progress=False).measures.angle
    assert wanted.case().bottoming and not any("flank" in text for text in job["summary"]["warnings"])


def test_part_of_a_bend_is_that_of_the_library(bench):
    form = {"work": "sequence", "mesh": "quick", "strip_length": 40.0}
    form["bends"] = [{"position": 18.0, "angle": 165.0, "direction": "down"}]
    wanted = Wanted.read(form)
    name = bench.order(**form, stroke=None)
    part = bend_sequence(wanted.sequence(wanted.case()), progress=False)
    job = bench.ended(name)
    assert job["state"] == "done", job["reason"]
    [bend] = job["summary"]["bends"]
    assert bend["stroke"] == part.bends[0].measures.stroke and bend["over"]
    assert job["summary"]["flanges"] == part.flanges and len(job["summary"]["profile"]) > 20
    others = {f"bend{number}.toml" for number in range(2, MOST_BENDS + 1)}
    assert set(job["files"]) == set(PART_FILES) - others
    assert job["live"]["operation"] == job["live"]["operations"] == 1 and len(job["live"]["outline"]) > 20
    assert job["summary"]["coarse_mesh"] and "force, springback and thinning" in job["summary"]["coarse_mesh"][0]
    assert job["summary"]["press"]["force"] >= 0.5 * bend["largest_force"]
    for collisions in ([], ["bend 1: the part collides"]):  # which is not listed as done
        summary = {**job["summary"], "collisions": collisions}
        assert collisions or summary == job["summary"]
        bench.queue.index.change(name, "done", summary=summary)
        row = next(row for row in bench.client.get("/api/jobs").json()["jobs"] if row["id"] == name)
        assert (row["summary"]["verdict"] == "collides") == bool(collisions)


@pytest.mark.long
@pytest.mark.parametrize(
    "form", [{}, {"form": "inner"}, {"form": "open", "force": 20.0}], ids=["flat", "inner", "force"]
)
def test_hem_is_that_of_the_library(bench, form):
    tools = {"opening": 8.0, "die_angle": 30.0, "die_radius": 1.0, "punch_angle": 30.0, "punch_radius": 0.5}
    form = {"work": "hem", "mesh": "quick", "thickness": 1.0, **tools, **form}
    wanted = Wanted.read(form)
    job = bench.ended(bench.order(**form, stroke=None), 300)
    assert job["state"] == "done", job["reason"]
    hem = hemming(wanted.hem(wanted.case()), progress=False)
    assert job["summary"]["hem"]["height"] == hem.measures.height
    [force] = [one for one in hem.quantities if one.name == "largest_force"]
    press = job["summary"]["press"]
    assert press["operation"] == ("bend" if "force" in form else "flatten")  # 20 kN/m are less than the first bend
    if "force" not in form:
        assert press["band"]["source"] == force.band.source
        assert press["band"]["error"] / press["force"] == pytest.approx(force.error / force.best)


@pytest.mark.parametrize("work", ["bend", "bottom", "sequence", "outside", "hem", "correct", "cup", "u"])
def test_stresses_in_another_unit_are_refused_before_the_run(work, tmp_path):
    acute = {"opening": 8.0, "die_angle": 30.0, "die_radius": 1.0, "punch_angle": 30.0, "punch_radius": 0.5}
    more = {
        "bottom": {"travel": 0.0},
        "correct": {"stroke": 6.0, "measured_angle": 95.0},
        "hem": {"thickness": 1.0, **acute},
    }
    form = {"work": work, "yield_stress": 0.175, "tensile_strength": 0.31, **more.get(work, {})}
    [case] = Wanted.read(form).cases(Shelf(tmp_path))
    with pytest.raises(DeckError, match="first yield"):
        accepted(case)


def test_the_job_of_such_stresses_fails_at_once(bench):
    job = bench.ended(bench.order(work="sequence", stroke=None, yield_stress=0.175, tensile_strength=0.31))
    assert job["state"] == "failed" and "first yield" in job["reason"]


def test_each_setup_of_a_table_is_looked_at(tmp_path):
    cases = Wanted.read({"work": "table", "thicknesses": [1.0, 2.0]}).cases(Shelf(tmp_path))
    assert [case.thickness for case in cases] == [1.0, 2.0]
    assert Wanted({"work": "flat"}).cases(Shelf(tmp_path)) == []


def test_files_of_a_bend_can_be_taken(bench, done):
    assert set(done["files"]) == set(FILES) - {"table.csv"}
    for file in done["files"]:
        answer = bench.client.get(f"/files/{done['id']}/{file}")
        assert answer.status_code == 200 and len(answer.content) > 100
    report = bench.client.get(f"/files/{done['id']}/report.html")
    assert "sandbox" in report.headers["content-security-policy"]
    assert "allow-same-origin" not in report.headers["content-security-policy"]
    assert bench.client.get(f"/files/{done['id']}/shape.html").status_code == 200


def test_a_bend_that_was_stopped_leaves_no_history_beside_its_results(bench):
    name = bench.order(stroke=0.9)
    bench.ended(name)
    (bench.queue.folder_of(name) / "results" / "history.csv").write_text("half")
    bench.queue.index.change(name, "stopped")
    assert bench.client.post(f"/api/jobs/{name}/resume", json={}).status_code == 200
    job = bench.ended(name)
    assert job["state"] == "done" and "history.csv" not in job["files"] and "curve.csv" in job["files"]


def test_live_file_has_curve_and_section(done):
    live = done["live"]
    assert live["phase"] == "end" and live["fraction"] == 1.0
    assert live["increments"] == done["summary"]["increments"]
    assert len(live["curve"]["x"]) == len(live["curve"]["y"]) == live["increments"] + 1
    outer, inner = live["section"]
    assert len(outer) == len(inner) > 5


def test_curve_is_that_of_the_file(bench, done):
    curve = bench.client.get(f"/api/jobs/{done['id']}/curve").json()
    assert max(curve["x"]) == pytest.approx(done["summary"]["measures"]["stroke"])
    assert max(curve["y"]) == pytest.approx(done["summary"]["measures"]["largest_force"])


def test_table_of_jobs_as_csv(bench, done):
    answer = bench.client.get(f"/api/jobs.csv?ids={done['id']},nobody,..")
    [row] = csv.DictReader(io.StringIO(answer.text))
    assert row["angle degrees"] == f"{done['summary']['measures']['angle']:.2f}"
    assert row["largest_force kN/m"] == f"{done['summary']['measures']['largest_force']:.1f}"
    assert row["opening"] == "16.0"
    assert max(len(cell) for name, cell in row.items() if name != "title") < 12  # no digits that mean nothing


def test_tables_and_curves_for_a_german_spreadsheet(bench, done):
    """Semicolons, decimal commas, and the mark of UTF-8."""
    answer = bench.client.get(f"/api/jobs.csv?ids={done['id']}&language=de")
    [row] = csv.DictReader(io.StringIO(answer.content.decode("utf-8-sig")), delimiter=";")
    assert answer.content.startswith(b"\xef\xbb\xbf")
    assert row["angle degrees"] == f"{done['summary']['measures']['angle']:.2f}".replace(".", ",")
    plain = bench.client.get(f"/files/{done['id']}/curve.csv").text.splitlines()
    german = bench.client.get(f"/files/{done['id']}/curve.csv?language=de").content.decode("utf-8-sig").splitlines()
    assert [line.replace(";", " ").replace(",", ".") for line in german] == [line.replace(",", " ") for line in plain]


def test_series_finds_angles_as_the_library_does_and_leaves_out_what_cannot_be_reached(bench):
    base = {"mesh": "quick", "stroke": None, "punch_angle": 60.0}
    forms = [{**base, "angle": angle, "opening": 16.0} for angle in (160.0, 80.0)]
    answer = bench.client.post("/api/jobs", json={"forms": forms, "series": "table"}).json()
    assert len(answer["jobs"]) == 1 and [row["form"] for row in answer["refused"]] == [1]
    job = bench.ended(answer["jobs"][0])
    found = find_stroke(Wanted.read(job["parameters"]).case(), 160.0, progress=False)
    assert job["series"] == "table"
    assert job["summary"]["measures"]["stroke"] == found.measures.stroke
    assert abs(job["summary"]["measures"]["angle"] - 160.0) <= 0.02


def test_bend_that_cannot_be_is_refused_before_it_runs(bench):
    before = len(bench.queue.index.jobs())
    for form in ({"angle": 80.0}, {"thickness": -1.0}, {"x": 1}, "form"):
        answer = bench.client.post("/api/jobs", json={"forms": [form]})
        assert answer.status_code == 422 and answer.json()["problems"], form
    assert len(bench.queue.index.jobs()) == before


# ---- who may ask ----


@pytest.mark.parametrize("path", ["/", "/api/jobs", "/api/library", "/files/0123456789ab/report.html", "/?token=wrong"])
def test_without_the_token_nothing_is_told(stranger, path):
    answer = stranger.get(path)
    assert answer.status_code == 401 and "token" in answer.text


def test_assets_have_no_secrets_and_need_no_token(stranger):
    assert stranger.get("/assets/main.js").status_code == 200
    assert stranger.get("/assets/../server.py").status_code in (401, 404)
    assert stranger.get("/assets/%2e%2e%2fserver.py").status_code == 404


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "localhost.evil:8765", "", "[::1]:8765"])
def test_other_names_of_the_host_are_refused(bench, host):
    assert bench.client.get("/api/jobs", headers={"host": host}).status_code == 421


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "http://evil.example"},
        {"origin": "null"},
        {"origin": "https://127.0.0.1:8765"},
        {"origin": "http://127.0.0.1:9999"},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
    ],
)
def test_pages_of_other_origins_are_refused(bench, headers):
    before = len(bench.queue.index.jobs())
    assert bench.client.post("/api/jobs", json={"forms": [{}]}, headers=headers).status_code == 403
    assert len(bench.queue.index.jobs()) == before


def test_form_of_another_kind_is_refused(bench):
    answer = bench.client.post("/api/jobs", content='{"forms": [{}]}', headers={"content-type": "text/plain"})
    assert answer.status_code == 415


def test_cookie_is_kept_from_programs_and_other_sites(bench, stranger):
    cookie = stranger.get("/?token=a-token-that-nobody-guesses").headers["set-cookie"]
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie
    stranger.cookies.clear()
    others = 'theirs={"a": 1}; half; ' + cookie.partition(";")[0]  # other servers of this host
    assert stranger.get("/api/jobs", headers={"cookie": others}).status_code == 200
    assert stranger.get("/api/jobs", headers={"cookie": others + "x"}).status_code == 401
    stranger.get("/?token=a-token-that-nobody-guesses")
    policy = stranger.get("/").headers["content-security-policy"]
    assert "default-src 'none'" in policy and "script-src 'self';" in policy


# ---- hostile input ----


@pytest.mark.parametrize("file", HARMFUL)
def test_files_that_are_no_results_are_not_given(bench, done, file):
    for path in (f"/files/{done['id']}/{file}", f"/files/{file}/report.html", f"/api/jobs/{file}"):
        assert bench.client.get(path).status_code == 404


def test_link_in_the_results_is_not_followed(bench, done):
    place = bench.queue.folder_of(done["id"]) / "results" / "history.csv"
    place.symlink_to("/etc/hostname")
    assert bench.client.get(f"/files/{done['id']}/history.csv").status_code == 404
    place.unlink()


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"{",
        b"[" * 200_000,
        b'{"forms": [{"thickness": NaN}]}',
        b'{"forms": [{"thickness": 1' + b"0" * 400_000 + b"}]}",
        b'{"forms": ' + b"[{}," * 100 + b"{}" + b"]" * 100 + b"}",
        b'{"forms": [' + b",".join([b"{}"] * 1000) + b"]}",
        b"\xff\xfe\x00",
        b'{"text": 3}',
        b'{"forms": [{}], "series": "\\ud800", "text": "\\ud800"}',
        b"null",
    ],
)
@pytest.mark.parametrize("path", ["/api/jobs", "/api/decks/jobs", "/api/look", "/api/decks/check"])
def test_bodies_that_are_no_question_are_answered(bench, body, path):
    before = len(bench.queue.index.jobs())
    answer = bench.client.post(path, content=body, headers=JSON)
    assert answer.status_code in (200, 400, 422)
    assert answer.status_code != 200 or answer.json()["problems"]
    assert len(bench.queue.index.jobs()) == before


def test_body_that_is_too_long_is_refused(bench):
    assert bench.client.post("/api/look", content=b" " * (LONGEST_BODY + 1), headers=JSON).status_code == 413

    def pieces():
        for _ in range(20):
            yield b" " * (LONGEST_BODY // 10)

    assert bench.client.post("/api/look", content=pieces(), headers=JSON).status_code == 413


def test_text_of_a_title_is_no_formula(bench, done):
    with bench.queue._lock:  # lest it is started in between
        bench.queue.index.add("feedfeedfeed", "bend", "=1+1", "", {"material": "@x"})
        bench.queue.index.change("feedfeedfeed", "stopped", summary={"measures": {}})
    text = bench.client.get("/api/jobs.csv?ids=feedfeedfeed").text
    assert "'=1+1" in text and "'@x" in text
    bench.queue.index.remove("feedfeedfeed")


# ---- decks ----


def test_templates_can_be_opened(bench):
    names = [one["name"] for one in bench.client.get("/api/decks").json()["templates"]]
    assert "cantilever" in names
    assert bench.client.get("/api/decks/template/cantilever").json()["text"] == template("cantilever")
    assert bench.client.get("/api/decks/template/..%2fcontents").status_code == 404
    assert "properties" in bench.client.get("/api/decks/schema").json()


def test_check_finds_what_the_command_finds(tmp_path):
    deck = tmp_path / "deck.toml"
    deck.write_text(template("cantilever"))
    found = findings(deck, tmp_path)
    assert {row["level"] for row in found} <= {"ok", "warning"} and len(found) > 2
    deck.write_text(template("cantilever").replace("ANS3DEAS", "ANS3DEASS").replace("[element]", "[elements]"))
    found = findings(deck, tmp_path)
    assert {row["level"] for row in found} == {"error"}
    assert any("elements" in row["about"] for row in found)


def test_deck_of_a_giant_harms_nobody(bench):
    giant = template("cantilever").replace("cells = [24, 1]", "cells = [2000000, 2000000]")
    findings = bench.client.post("/api/decks/check", json={"text": giant}).json()["findings"]
    assert any(row["level"] == "error" for row in findings)
