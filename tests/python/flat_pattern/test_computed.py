"""Computed allowances from the store, and the part bent by simulation from its flat pattern."""

from __future__ import annotations

import json
import math
import time

import pytest
from brackets import strip, write
from typer.testing import CliRunner

from umform.cli.commands import application
from umform.errors import InvalidValue
from umform.flat_pattern import Orders, Tooling, bend_part, flat
from umform.io.store import Store
from umform.processes.air_bending import AirBending
from umform.processes.bend_sequence import Bodies
from umform.studies.bend_table import bend as stored_bend

COARSE = {"elements_per_thickness": 1, "layers": 1, "increment": 0.0125}
OPTIONS = ["--elements-per-thickness", "1", "--layers", "1", "--increment", "0.0125"]


@pytest.fixture(scope="session")
def store(tmp_path_factory):
    return Store(tmp_path_factory.mktemp("store"))


@pytest.fixture(scope="session")
def tooling():
    return Tooling(AirBending(**COARSE), "DC04")


@pytest.fixture(scope="session")
def z(tmp_path_factory):
    return write(strip([30, 50, 30], [90, -60], base=1).shape(), tmp_path_factory.mktemp("z") / "z.step")


@pytest.fixture(scope="session")
def computed(z, tooling, store):
    return flat(z, tooling=tooling, store=store)


def run(*words):
    return CliRunner().invoke(application(words), [str(word) for word in words])


@pytest.mark.parametrize("more", [[], ["--k-factor", 0.44, "--bend"]], ids=["computed", "bent"])
def test_a_metal_in_another_unit_is_refused(more, z, tmp_path, monkeypatch):
    monkeypatch.setenv("UMFORM_STORE", str(tmp_path / "store"))
    metal = tmp_path / "gpa.toml"
    curve = '{ curve = "Perfect", yield_stress = 0.2 }'
    metal.write_text(f'[material]\nlaw = "J2"\nE = 210e3\nnu = 0.3\nhardening = {curve}\n')
    refused = run("flat", z, "--metal", metal, *more, "--out", tmp_path / "out")
    assert refused.exit_code == 1 and "first yield at a strain of 9.52e-07" in refused.stderr


def test_the_flat_length_leaves_the_outer_lengths_of_the_drawing(computed, tooling, store):
    """Outer lengths less the bend deductions of the stored bends are the flat length."""
    outer, deductions = 0.0, 0.0
    for angle in (90.0, 60.0):
        outer += 2.0 * 4.0 * math.tan(math.radians(0.5 * angle))
        case = tooling.case(angle, 2.0, 2.0)
        assert case.thickness == 2.0 and case.opening == 16.0
        deductions += stored_bend(case, 180.0 - angle, store=store).deduction
    assert computed.size.max() == pytest.approx(110.0 + outer - deductions, abs=1e-9)
    assert all("DC04, V 16" in bend.allowance.source for bend in computed.bends)
    assert all(bend.allowance.stroke > 1.0 and bend.allowance.force > 10.0 for bend in computed.bends)


def test_remarks_on_the_runs_are_kept(computed):
    """The mesh of this test is coarse, and each place that shows the allowance says so."""
    assert sum("coarse" in text for text in computed.warnings) == 1
    assert all("coarse" in " ".join(bend.allowance.notes) for bend in computed.bends)


def test_a_filled_store_answers_in_two_seconds(computed, z, tooling, store):
    start = time.process_time()
    again = flat(z, tooling=tooling, store=store)
    assert time.process_time() - start < 2.0
    assert [bend.allowance for bend in again.bends] == [bend.allowance for bend in computed.bends]


def test_the_simulated_part_has_the_flanges_of_the_drawing(computed, tooling):
    bent = bend_part(Orders(computed, tooling, Bodies()), progress=False)
    assert bent.flanges[0] == pytest.approx(30.0 + 4.0 * math.tan(math.radians(bent_angle(bent, 0) / 2.0)), abs=1e-6)
    assert max(map(abs, bent.errors)) < 0.05
    assert abs(sum(bent.errors)) < 0.05 * len(computed.bends)
    wanted = [180.0 - computed.bends[number - 1].angle for number in computed.order]
    assert bent.part.angles == pytest.approx(wanted, abs=0.05)


def bent_angle(bent, place):
    """Angle of the bend at a place from the left."""
    bend = sorted(bent.part.sequence.bends, key=lambda one: one.position)[place]
    return 180.0 - bend.angle


def test_tools_follow_the_drawing():
    tooling = Tooling()
    assert tooling.case(90.0, 2.5, 2.0).opening == 16.0
    assert tooling.case(90.0, 20.0, 2.0).opening == 20.0  # at most 12 thicknesses: 24
    assert [tooling.case(angle, 2.0, 2.0).die_angle for angle in (100.0, 120.0, 140.0)] == [60.0, 45.0, 30.0]
    assert tooling.case(90.0, 2.0, 2.0).die_angle == 85.0
    assert [tooling.case(90.0, radius, 1.0).punch_radius for radius in (0.2, 1.0, 2.0)] == [0.5, 1.0, 1.5]
    sharp = Tooling(AirBending(punch_radius=1.0))
    assert sharp.case(90.0, 0.5, 1.0).punch_radius == 1.0  # as it was given
    assert Tooling(opening=25.0).case(90.0, 2.0, 2.0).opening == 25.0


def test_only_prismatic_parts_are_bent(pattern, tooling):
    with pytest.raises(InvalidValue, match="prismatic"):
        bend_part(Orders(pattern("box"), tooling, Bodies()))


def test_the_command_writes_drawing_numbers_and_sheet(z, store, tmp_path, computed):
    out = tmp_path / "out"
    done = run("flat", z, "--metal", "DC04", "--store", store.folder, *OPTIONS, "--out", out, "--bend")
    assert done.exit_code == 0, done.output
    assert "sheet of 2 mm" in done.output and "Order of the bends" in done.output
    record = json.loads((out / "flat.json").read_text())
    assert record["thickness"] == 2.0 and record["folded_back"] < 1e-6
    assert [bend["allowance"] for bend in record["bends"]] == [bend.allowance.length for bend in computed.bends]
    assert max(map(abs, record["flange_errors"])) < 0.05
    page = (out / "sheet.html").read_text()
    assert all(word in page for word in ("turn over", "flat edge", "Bends by simulation", "stroke, mm"))
    assert {file.name for file in out.iterdir()} == {"flat.dxf", "flat.svg", "flat.json", "sheet.html", "sequence"}
    assert (out / "sequence" / "report.html").exists()
    again = run("flat", z, "--k-factor", ".44", "--out", out)
    assert again.exit_code != 0 and "results of another run" in again.output


def test_the_command_refuses_and_writes_nothing(step, z, tmp_path):
    out = tmp_path / "out"
    for words, text in (
        ((step("hem"), "--k-factor", ".44"), "face 6"),
        ((step("tube"), "--k-factor", ".44"), "closed"),
        ((z,), "--metal DC04"),
        ((z, "--k-factor", ".44", "--table", "x.csv"), "one source"),
        ((z, "--k-factor", ".44", "--bend"), "--metal DC04"),
        ((z, "--metal", "cheese"), "umform metal list"),
        ((z, "--k-factor", ".44", "--layers", "3"), "without computed bends"),
        ((z, "--k-factor", ".44", "--rolling", "45"), "without computed bends"),
    ):
        done = run("flat", *words, "--out", out)
        said = done.output + str(done.exception)
        assert done.exit_code != 0 and text in said, said
        assert not out.exists()
