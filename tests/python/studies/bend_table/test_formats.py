"""Files for CAD systems: read back, they give the flat lengths of the runs."""

from __future__ import annotations

import csv
import shutil
import subprocess
from dataclasses import replace

import pytest

from umform.errors import FileProblem, InvalidValue
from umform.studies.bend_table import FORMATS, write_table
from umform.studies.bend_table.formats import creo, file_names, freecad, inventor, solidworks, table_csv, table_json
from umform.studies.bend_table.head import head

#: Largest error of a flat length in mm.
_CLOSE = 1e-6


@pytest.fixture(scope="module")
def folder(table, tmp_path_factory):
    place = tmp_path_factory.mktemp("cad")
    written = write_table(table, place, FORMATS)
    assert sorted(path.name for path in written) == file_names([part.setup for part in table.parts], FORMATS)
    return place


def _readings(name, table, folder):
    """What a reader makes of each setup."""
    setups = [part.setup for part in table.parts]
    if name == "csv":
        read = table_csv.read(folder / "bends.csv")
        return [read[s.metal, s.case.thickness, s.case.opening, s.case.punch_radius, s.case.die_radius] for s in setups]
    if name == "json":
        read = table_json.read(folder / "bends.json")
        return [read[s.name] for s in setups]
    if name == "inventor":
        return [inventor.read(folder / f"{s.tools}.inventor.txt")[s.case.thickness] for s in setups]
    if name == "creo":
        return [creo.read(folder / f"{s.name}.bnd") for s in setups]
    return [solidworks.read(folder / f"{s.name}.solidworks.txt") for s in setups]


@pytest.mark.parametrize("name", ["csv", "json", "inventor", "solidworks", "creo"])
def test_a_flat_length_of_the_file_is_that_of_the_run(name, table, folder):
    for part, reading in zip(table.parts, _readings(name, table, folder), strict=True):
        for one in part.bends:
            angle = one.measures.angle if name == "creo" else one.wanted  # of other tables, the angle is a name
            found = reading.flat_length(angle, one.radius, (one.outside, one.outside))
            assert found == pytest.approx(2.0 * one.case.half_length, abs=_CLOSE)
            assert one.flat_length == pytest.approx(2.0 * one.case.half_length, abs=1e-9)
            found = reading.flat_length(angle, one.radius, (10.0, 20.0))
            assert found == pytest.approx(30.0 - one.deduction, abs=_CLOSE)


@pytest.mark.parametrize("name", ["csv", "inventor", "creo"])
def test_a_file_is_not_extrapolated(name, table, folder):
    reading = _readings(name, table, folder)[0]
    with pytest.raises(InvalidValue, match="does not reach so far"):
        reading.flat_length(170.0, 100.0, (10.0, 10.0))


def test_material_sheets_of_freecad_give_the_flat_length(table, folder):
    for part in table.parts:
        sheets = freecad.read(folder / f"{part.setup.name}.FCStd")
        for one in part.bends:
            of_angle = f"material_{part.setup.name}-{one.wanted:g}deg"
            for label in (f"material_{part.setup.name}", of_angle):
                sides = (one.outside, one.outside)
                found = sheets[label].flat_length(one.measures.angle, one.radius, one.case.thickness, sides)
                assert found == pytest.approx(2.0 * one.case.half_length, abs=_CLOSE)


_SCRIPT = """
import FreeCAD
document = FreeCAD.openDocument({path!r})
for sheet in document.Objects:
    row = 2
    while sheet.getContents(f"A{{row}}"):
        cells = [sheet.get(at) for at in ("A1", "B1", f"A{{row}}", f"B{{row}}")]
        print("ROW", sheet.Label, *cells, sep="|")
        row += 1
"""


@pytest.mark.skipif(shutil.which("freecadcmd") is None, reason="FreeCAD is not installed")
def test_freecad_opens_the_sheets(table, folder, tmp_path):
    part = table.parts[0]
    script = tmp_path / "read.py"
    script.write_text(_SCRIPT.format(path=str(folder / f"{part.setup.name}.FCStd")))
    done = subprocess.run(["freecadcmd", str(script)], capture_output=True, text=True, timeout=120, check=False)
    rows = [line.split("|")[1:] for line in done.stdout.splitlines() if "ROW|" in line]
    assert {row[1] for row in rows} == {"Radius / Thickness"} and {row[2] for row in rows} == {"K-factor (ANSI)"}
    found = {(row[0], float(row[3])): float(row[4]) for row in rows}
    label = f"material_{part.setup.name}"
    for one in part.bends:
        ratio = float(f"{one.radius / one.case.thickness:.12g}")
        assert found[label, ratio] == pytest.approx(one.k_factor, abs=1e-9)
        assert found[f"{label}-{one.wanted:g}deg", ratio] == found[label, ratio]


def test_every_file_has_the_definitions_and_the_notes(table, tmp_path):
    noted = replace(table, notes=("corrected by one measured bend",))
    for path in write_table(noted, tmp_path, ["csv", "json", "inventor", "creo", "solidworks"]):
        text = path.read_text()
        for words in ("K (ANSI)", "DIN 6935", "2 (R + T) tan(bend angle / 2) - BA", "corrected by one measured bend"):
            assert words in text
        assert "nothing was checked" in text or path.suffix == ".json"


def test_csv_has_both_factors_and_both_deductions(table, folder):
    lines = [line for line in (folder / "bends.csv").read_text().splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    assert len(rows) == 6
    for row in rows:
        assert float(row["k_din"]) == 2.0 * float(row["k_ansi"])
        assert float(row["angle degrees"]) + float(row["bend_angle degrees"]) == 180.0
        length = 2.0 * (float(row["radius mm"]) + float(row["thickness mm"]))
        assert float(row["tangent_deduction mm"]) == pytest.approx(length - float(row["bend_allowance mm"]))


def test_the_head_of_a_file_says_how_the_sheet_lies(table):
    part = table.parts[0]
    case = replace(part.setup.case, width=5.0, rolling=90.0, friction=0.1)
    assert any(line.endswith("; plane strain") for line in head(table, part))
    told = " ".join(head(table, replace(part, setup=replace(part.setup, case=case))))
    words = "5 wide with free ends, rolling direction at 90 degrees from the bend line, friction 0.1"
    assert words in told and "plane strain" not in told


def test_a_wrong_line_is_named(tmp_path):
    path = tmp_path / "bad.txt"
    path.write_text("/U mm\n/S 1\n/A ninety 1\n")
    with pytest.raises(FileProblem, match="line 3"):
        inventor.read(path)


def test_units_of_a_file_are_read(tmp_path):
    path = tmp_path / "cm.txt"
    path.write_text("/S 0.1\n/R 0.2 0.4\n/A 90 0.2 0.2\n")
    assert inventor.read(path)[1.0].flat_length(90.0, 2.0, (10.0, 10.0)) == pytest.approx(18.0)


def test_a_radius_that_two_angles_have_ends_the_tables_over_radii(table, tmp_path):
    part = table.parts[0]
    sharp = replace(part.bends[0], wanted=30.0, measures=replace(part.bends[1].measures, k_factor=-0.2))
    turned = replace(part, bends=(sharp, *part.bends))
    write_table(replace(table, parts=(turned,)), tmp_path, ["freecad", "creo", "csv"])
    sheets = freecad.read(tmp_path / f"{part.setup.name}.FCStd")
    assert len(sheets[f"material_{part.setup.name}"].k_factors) == 3 and len(sheets) == 5
    assert len(creo.read(tmp_path / f"{part.setup.name}.bnd").lengths) == 3
    head = (tmp_path / "bends.csv").read_text()
    assert "K is -0.20 at 30 degrees" in head and "the radius of 30 degrees is larger than that of 120" in head
