"""Tools of one's own: uploaded drawings are read, kept, drawn, bent with as by the command, refused, copied to jobs."""

import base64
import io
import math

import pytest

from umform.bench import subprocess_json
from umform.bench.read_tool import read
from umform.bench.shelf import LONGEST_DRAWING, Shelf
from umform.bench.wanted import Wanted
from umform.errors import InvalidValue
from umform.processes.air_bending import air_bending
from umform.processes.air_bending.drawn_tools import read_die
from umform.processes.air_bending.spec import AirBending
from umform.surfaces import Profile

ezdxf = pytest.importorskip("ezdxf")


def die(opening=20.0, radius=2.5, units=4, gap=False):
    """A DXF file with a die, as bytes."""
    half = 0.5 * opening
    deep = half / math.tan(math.radians(40.0))
    corners = [(-30.0, -40.0), (30.0, -40.0), (30.0, 0.0), (half, 0.0), (0.0, -deep), (-half, 0.0), (-30.0, 0.0)]
    parts = Profile.from_corners(corners, [0.0, 0.0, 0.0, radius, 0.0, radius, 0.0]).segments
    document = ezdxf.new(units=units)
    for one in parts[1:4] + parts[6:] if gap else parts:
        if hasattr(one, "centre"):
            angles = [math.degrees(math.atan2(y - one.centre[1], x - one.centre[0])) for x, y in (one.start, one.end)]
            document.modelspace().add_arc(one.centre, one.radius, *angles, dxfattribs={"layer": "V"})
        else:
            document.modelspace().add_line(one.start, one.end, dxfattribs={"layer": "V"})
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


def upload(bench, content, name="V20", kind="die", layer=""):
    coded = base64.b64encode(content).decode()
    return bench.client.post("/api/tools", json={"kind": kind, "name": name, "layer": layer, "drawing": coded})


@pytest.fixture(scope="module")
def kept(bench):
    """A die on the shelf."""
    answer = upload(bench, die())
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_drawing_is_measured_and_kept_under_its_name(bench, kept):
    assert (kept["opening"], kept["angle"], kept["radius"]) == pytest.approx((20.0, 80.0, 2.5))
    assert kept["unit"] == "mm" and kept["layers"] == ["V"]
    assert kept in bench.client.get("/api/tools").json()["tools"]
    assert (bench.queue.folder / "tools" / "die" / "V20.dxf").is_file()


def test_look_draws_the_tool_and_tells_its_sizes(bench, kept):
    found = bench.client.post("/api/look", json={"die": "V20", "opening": 99.0}).json()
    assert found["problems"] == []
    assert found["measured"] == pytest.approx({"opening": 20.0, "die_angle": 80.0, "die_radius": 2.5})
    assert found["drawing"]["closed"] == {"die": True, "punch": False}
    assert min(z for _, z in found["drawing"]["die"]) == pytest.approx(-40.0)
    assert found["drawing"]["depth"] == pytest.approx(10.0 / math.tan(math.radians(40.0)), abs=1e-5)


def test_bend_is_that_of_the_command_to_the_last_bit_and_outlives_the_shelf(bench, kept, tmp_path):
    path = tmp_path / "die.dxf"
    path.write_bytes(die())
    place = bench.queue.shelf.path_of("die", "borrowed")
    place.write_text(bench.queue.shelf.path_of("die", "V20").read_text())
    name = bench.order(die="borrowed")
    bench.client.post("/api/tools/remove", json={"kind": "die", "name": "borrowed"})
    job = bench.ended(name)
    assert job["state"] == "done", job["reason"]
    assert job["parameters"]["opening"] == pytest.approx(20.0)
    quick = Wanted.read({"mesh": "quick", "angle": None, "stroke": 1.0}).case()
    case = AirBending(**{**quick.record(), "die_section": read_die(path)})
    assert job["summary"]["measures"]["force"] == air_bending(case, progress=False).measures.force
    assert 'kind = "arc"' in bench.client.get(f"/files/{name}/bend.toml").text
    refused = bench.client.post("/api/jobs", json={"forms": [{"die": "borrowed"}]})
    assert refused.status_code == 422 and refused.json()["problems"][0]["where"] == "die"


def test_drawing_of_something_else_is_refused_with_its_layers_and_not_kept(bench):
    answer = upload(bench, die(gap=True), name="gap").json()
    assert "do not make one curve" in answer["problem"]["what"] and answer["layers"] == ["V"]
    assert "gap" not in {row["name"] for row in bench.client.get("/api/tools").json()["tools"]}


def test_layer_and_kind_are_looked_at(tmp_path):
    path = tmp_path / "drawing.dxf"
    path.write_bytes(die())
    answer = read("die", path, "W")
    assert answer["problem"]["where"] == "layer" and "V" in answer["problem"]["remedy"]
    assert "no round tip" in read("punch", path, "")["problem"]["what"]
    assert "problem" not in read("die", path, "v")


@pytest.mark.parametrize(("units", "name", "right"), [(1, "in", 25.4 * 12.0), (0, "", 12.0), (5, "cm", 120.0)])
def test_unit_of_the_drawing_is_told(tmp_path, units, name, right):
    path = tmp_path / "drawing.dxf"
    path.write_bytes(die(units=units))
    found = read("die", path, "")
    assert found["unit"] == name
    assert max(value for row in found["segments"] for value in row) == pytest.approx(2.5 * right)  # half of the block


@pytest.mark.parametrize("name", ["", "..", "../x", "a/b", "x" * 41, " x", "x.", "a\x00b", "CON\n"])
def test_names_that_no_file_can_have_are_refused(bench, name):
    assert upload(bench, b"0", name=name).status_code == 422
    for kind in ("die", "../jobs"):
        assert bench.client.post("/api/tools/remove", json={"kind": kind, "name": name}).status_code == 422
    assert bench.client.post("/api/look", json={"die": name}).json()["problems"]


@pytest.mark.parametrize("content", [b"\x00\xff" * 50, b"0\nSECTION\n", b"0\nEOF\n", b"999\n" * 1000])
def test_files_that_are_no_drawing_are_refused(tmp_path, content):
    path = tmp_path / "drawing.dxf"
    path.write_bytes(content)
    assert read("die", path, "")["problem"]["what"]


def test_drawing_that_is_too_large_is_refused(bench):
    assert upload(bench, b"0" * (LONGEST_DRAWING + 1)).status_code == 422
    assert upload(bench, b"0" * (2 * LONGEST_DRAWING)).status_code == 413
    sent = {"kind": "die", "name": "x", "layer": "", "drawing": "%%%"}
    assert bench.client.post("/api/tools", json=sent).status_code == 422


def test_no_more_checks_at_once_than_there_are_places(bench):
    taken = [subprocess_json._places.acquire(blocking=False) for _ in range(subprocess_json.AT_ONCE)]
    assert all(taken)
    try:
        answer = upload(bench, die(), name="later")
        assert answer.status_code == 422 and "checks run already" in answer.json()["what"]
        assert bench.client.post("/api/decks/check", json={"text": "title = 1"}).status_code == 422
    finally:
        for _ in taken:
            subprocess_json._places.release()


def test_file_of_a_tool_that_is_broken_is_an_answer(bench, tmp_path):
    shelf = Shelf(tmp_path)
    place = shelf.path_of("punch", "mine")
    place.parent.mkdir(parents=True)
    place.write_text('{"segments": [[1]], "closed": true}')
    assert shelf.rows() == [{"kind": "punch", "name": "mine", "broken": True}]
    with pytest.raises(InvalidValue):
        shelf.tool("die", "mine")
