"""What `umform bend` refuses, before anything runs."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

from umform.cli import app


@pytest.mark.parametrize(
    ("typed", "message"),
    [
        ([], "none of them is given"),
        (["--stroke", "6", "--angle", "90"], "both are given"),
        (["--table", "1:9:1"], "beyond air bending"),
        (["--stroke", "6", "--swift", "520"], "3 numbers are needed"),
        (["--stroke", "6", "--curve", "Voce,180,330"], "Voce,yield stress,saturation,rate"),
        (["--stroke", "6", "--curve", "Table,180,330"], "no hardening curve of this name is given by numbers"),
        (["--stroke", "6", "--swift", "520,0.004,0.22", "--flow-curve", "a.csv"], "a hardening curve is given by"),
        (["--stroke", "6", "--flow-curve", "no.csv"], "the flow curve cannot be read"),
        (["--angle", "90", "--die", "V16/87"], "V16/88"),
        (["--angle", "90", "--die", "V16/88", "--opening", "12"], "follows from the name of the tool"),
        (["--angle", "90", "--material", "DC04", "--thickness", "0"], "where:  --thickness"),
        (["--angle", "80", "--die", "V16/60"], "the larger of the angles of punch and die is 85"),
        (["--angle", "55", "--die", "V16/60", "--punch", "60/R1"], "the larger of the angles of punch and die is 60"),
        (["--stroke", "6", "--young", "200000"], "a hardening curve is given by"),
        (["--stroke", "6", "--material", "DC04", "--young", "2e5"], "by name or by numbers"),
        (["--stroke", "6", "--material", "cheese"], "cheese"),
        (["--stroke", "6", "--table", "6:4:1"], "does not reach its end"),
        (["--stroke", "6", "--table", "1:4:inf"], "no list of numbers"),
        (["--stroke", "6", "--table", "0:4:1"], "strokes of a table are positive"),
        (["--stroke", "6", "--table", ""], "a list has an empty value"),
        (["--stroke", "6", "--table", "1:5:1e-6"], "has at most 10000 values"),
        (["--stroke", "6", "--table", "1:5:1e-3"], "at most 1000 strokes"),
        (["--stroke", "6", "--table", "1:9:1"], "beyond air bending"),
        (["--table", "1:2:1", "--angles", "90,120"], "a bend has one table"),
        (["--angles", "150:30:15"], "does not reach its end"),
        (["--angles", "90,80"], "cannot be reached"),
        (["--angles", "90,nan"], "where:  --angles"),
        (["--angle", "90", "--angles", "95,nan"], "where:  --angles"),
        (["--angle", "nan", "--angles", "95,90"], "where:  --angle\n"),
        (["--table", "5,20"], "where:  --table"),
        (["--bottoming", "--angles", "90"], "one of them"),
        (["--stroke", "6", "--contact-points", "²"], "or auto"),
        (["--stroke", "9"], "beyond air bending"),
        (["--angle", "80"], "cannot be reached"),
        (["--stroke", "2", "--die-dxf", "no.dxf", "--opening", "20"], "follows from the drawing"),
        (["--stroke", "2", "--punch-layer", "A"], "a layer without its drawing"),
        (["--stroke", "2", "--span", "3000"], "does not deflect"),
        (["--stroke", "2", "--bed-thickness", "0"], "the thickness of the plate of the bed must be positive"),
        (["--stroke", "2", "--punch-width", "2"], "narrower than its round tip"),
        (["--stroke", "2", "--punch-width", "1e300"], "beyond 1e+50"),
        (["--stroke", "2", "--span", "3000", "--ram-height", "900"], "--ram-height and --ram-thickness"),
        (["--stroke", "2", "--span", "3000", "--bed-height", "900", "--bed-thickness", "50"], "needs its length"),
        (
            ["--bottoming", "--span", "3000", "--bed-height", "900", "--bed-thickness", "50", "--length", "900"],
            "one air bend",
        ),
    ],
)
def test_the_command_refuses(typed, message, tmp_path):
    done = CliRunner().invoke(app, ["bend", *typed, "--out", str(tmp_path / "out")])
    assert done.exit_code == 1
    assert message in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("--opening", "0"),
        ("--die-angle", "180"),
        ("--die-radius", "-1"),
        ("--die-radius", "1e-09"),
        ("--punch-angle", "nan"),
        ("--punch-radius", "inf"),
        ("--thickness", "0"),
        ("--width", "-1"),
        ("--layers", "0"),
        ("--thickness-points", "16"),
        ("--elements-per-thickness", "0"),
        ("--width-elements", "-1"),
        ("--contact-points", "11"),
        ("--penalty", "0"),
        ("--penetration", "nan"),
        ("--increment", "0"),
        ("--tolerance", "-1"),
        ("--tolerance", "0"),
        ("--tolerance", "nan"),
        ("--processes", "0"),
        ("--processes", "-2"),
        ("--curve", "nan,0.004,0.22"),
        ("--yield-stress", "0"),
        ("--stroke", "0"),
        ("--punch-width", "0.1"),
        ("--penetration", "1.5"),
        ("--elements-per-thickness", "0.2"),
    ],
)
def test_a_wrong_number_is_refused_with_its_option_before_the_run(option, value, tmp_path, monkeypatch):
    for module, name in (("case", "air_bending"), ("search", "find_stroke")):
        monkeypatch.setattr(f"umform.processes.air_bending.{module}.{name}", lambda *_, **__: pytest.fail("it runs"))
    goal = [] if option == "--stroke" else ["--stroke", "6"]
    done = CliRunner().invoke(app, ["bend", *goal, option, value, "--out", str(tmp_path / "out")])
    assert done.exit_code == 1
    assert f"where:  {option}" in done.stderr
    assert value.partition(",")[0] in done.stderr.split("value:")[1].splitlines()[0]
    assert "remedy:" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("angle", "tolerance"), [("0", "0.1"), ("nan", "0.1"), ("90", "1e-9"), ("90", "20")])
def test_an_angle_or_a_tolerance_that_is_none_is_refused(angle, tolerance, tmp_path):
    typed = ["--angle", angle, "--tolerance", tolerance, "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, ["bend", *typed])
    assert done.exit_code == 1
    assert "where:  --angle" in done.stderr or "where:  --tolerance" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("option", "value"), [("--young", "0"), ("--poisson", "0.5"), ("--hardening-modulus", "-1")])
def test_a_law_that_is_none_names_its_options(option, value, tmp_path):
    typed = ["bend", "--stroke", "6", "--yield-stress", "200", option, value, "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, typed)
    assert done.exit_code == 1
    assert option in done.stderr.split("where:")[1].splitlines()[0]
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_takes_no_files_is_refused_before_the_run(tmp_path, monkeypatch):
    monkeypatch.setattr("umform.processes.air_bending.case.air_bending", lambda case: pytest.fail("it runs"))
    (tmp_path / "file").touch()
    done = CliRunner().invoke(app, ["bend", "--stroke", "6", "--out", str(tmp_path / "file")])
    assert done.exit_code == 1
    assert "the folder cannot be made" in done.stderr


def test_without_a_material_there_is_a_warning_before_the_run(tmp_path):
    done = CliRunner().invoke(app, ["bend", "--stroke", "6", "--print-deck"])
    assert done.stderr.startswith("umform: warning: no --material")
    done = CliRunner().invoke(app, ["bend", "--stroke", "6", "--material", "DC04", "--print-deck"])
    assert done.stderr == ""


def test_the_thickness_chooses_the_values_of_the_standard():
    typed = ["bend", "--stroke", "6", "--opening", "24", "--material", "S355", "--print-deck", "--thickness"]
    thin, thick = (CliRunner().invoke(app, [*typed, thickness]).stdout for thickness in ("2.9", "3"))
    curves = [[line for line in text.splitlines() if "strength" in line] for text in (thin, thick)]
    assert curves[0] and curves[0] != curves[1]
