"""Parts on the bench: STEP files are read apart, kept by their names, and unfolded by the calls of `umform flat`."""

import base64

import pytest

pytest.importorskip("OCP")
pytest.importorskip("ezdxf")

from brackets import BRACKETS

from umform.bench.parts import LONGEST_PART
from umform.bench.wanted import Wanted
from umform.flat_pattern import FILES, Orders, flat
from umform.flat_pattern.files import record
from umform.processes.bend_sequence import Bodies

FORM = {"work": "flat", "part": "U 60.step", "mesh": "quick"}


def sent(bench, name, content):
    return bench.client.post("/api/parts", json={"name": name, "content": base64.b64encode(content).decode()})


@pytest.fixture(scope="module")
def part(bench, tmp_path_factory):
    """A U of three legs on the bench, and its file."""
    path = BRACKETS["u"].file(tmp_path_factory.mktemp("parts") / "U 60.step")
    answer = sent(bench, path.name, path.read_bytes())
    assert answer.status_code == 200, answer.text
    return path, answer.json()


def test_part_is_read_before_a_run(bench, part):
    row = part[1]
    assert row["thickness"] == 2.0 and [one["angle"] for one in row["bends"]] == [90.0, 90.0]
    assert bench.client.get("/api/parts").json()["parts"] == [row]
    assert bench.client.post("/api/look", json=FORM).json()["part"] == row
    view = bench.client.get("/files/parts/U%2060.step")
    assert view.status_code == 200 and "sandbox" in view.headers["content-security-policy"]
    assert 'id="scene"' in view.text


def test_unfolded_part_is_that_of_the_command(bench, part):
    name = bench.client.post("/api/jobs", json={"forms": [FORM]}).json()["jobs"][0]
    job = bench.ended(name)
    assert job["state"] == "done", job["reason"]
    assert set(FILES) <= set(job["files"]) and job["has_shape"]
    wanted = Wanted.read(FORM)
    tooling, bodies = wanted.tooling(2.0), Bodies()
    pattern = flat(part[0], tooling=tooling, bodies=bodies)
    expected = record(Orders(pattern, tooling, bodies))
    found = job["summary"]["flat"]
    assert {**found, "versions": None} == {**expected, "versions": None, "order": list(expected["order"])}
    assert job["summary"]["press"] == max(step["force"] for step in expected["steps"])
    drawing = bench.client.get(f"/files/{name}/flat.svg")
    assert f">{pattern.size[0]:.2f}</text>" in drawing.text
    assert "attachment" in bench.client.get(f"/files/{name}/flat.dxf").headers["content-disposition"]


def test_k_factor_takes_the_place_of_computed_bends(bench, part):
    name = bench.client.post("/api/jobs", json={"forms": [FORM | {"k_factor": 0.5}]}).json()["jobs"][0]
    found = bench.ended(name)["summary"]
    assert {bend["source"] for bend in found["flat"]["bends"]} == {"K-factor 0.5"} and found["press"] is None


@pytest.mark.parametrize(
    ("name", "what"), [("tube", "is closed"), ("hem", "by more than 165 degrees")], ids=["tube", "hem"]
)
def test_part_that_does_not_unfold_is_one_message_and_not_kept(bench, tmp_path, name, what):
    path = BRACKETS[name].file(tmp_path / f"{name}.step")
    problem = sent(bench, path.name, path.read_bytes()).json()["problem"]
    assert what in problem["what"] and problem["where"] == "part" and problem["cause"] and problem["remedy"]
    assert "/" not in problem["value"]
    assert path.name not in [row["name"] for row in bench.client.get("/api/parts").json()["parts"]]


@pytest.mark.parametrize("content", [b"x", b"\0" * 100, b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\n"])
def test_file_that_is_no_part_is_refused(bench, content):
    problem = sent(bench, "broken.step", content).json()["problem"]
    assert problem["what"] and problem["remedy"]


@pytest.mark.parametrize(
    "name", ["../up.step", "/etc/passwd.step", ".step", "a.exe", "a/b.step", "x" * 80 + ".step", "a\0.step"]
)
def test_name_that_could_leave_the_folder_is_refused(bench, name):
    answer = sent(bench, name, b"x")
    assert answer.status_code == 422 and answer.json()["where"] == "part"
    assert bench.client.post("/api/parts/remove", json={"name": name}).status_code == 422


def test_sizes_are_limited(bench):
    assert sent(bench, "large.step", b"x" * (LONGEST_PART + 1)).status_code == 422
    assert sent(bench, "large.step", b"x" * (LONGEST_PART + 200_000)).status_code == 413
    assert bench.client.post("/api/jobs", content=b" " * 2_000_000).status_code == 413
    assert sent(bench, "empty.step", b"").status_code == 422


def test_form_without_a_part_is_refused(bench):
    for form in ({"work": "flat"}, FORM | {"part": "none.step"}):
        (problem,) = bench.client.post("/api/look", json=form).json()["problems"]
        assert problem["where"] == "part"
        assert bench.client.post("/api/jobs", json={"forms": [form]}).status_code == 422


def test_removed_part_stays_with_its_jobs(bench, part, tmp_path):
    other = "copy.step"
    sent(bench, other, part[0].read_bytes())
    form = FORM | {"part": other, "k_factor": 0.4}
    name = bench.client.post("/api/jobs", json={"forms": [form]}).json()["jobs"][0]
    assert bench.client.post("/api/parts/remove", json={"name": other}).status_code == 200
    assert bench.client.get(f"/files/parts/{other}").status_code == 404
    assert bench.ended(name)["state"] == "done"
    assert (bench.queue.folder_of(name) / other).is_file()
