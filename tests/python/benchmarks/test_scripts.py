"""Every benchmark runs, on the smallest sheet it can be asked for, and what it prints and records goes together."""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import subprocess
import sys
from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest

import umform as uf

FOLDER = Path(__file__).parents[3] / "benchmarks"


@pytest.fixture
def run(script, monkeypatch, capsys, tmp_path):
    """Lines that a script prints, and the numbers that it records."""

    def ran(name: str, *words: str, benchmark: str = "") -> tuple[list[str], dict[str, float]]:
        file = tmp_path / "bench.json"
        record = ["--json", str(file)] if benchmark else []
        monkeypatch.setattr(sys, "argv", [str(FOLDER / f"{name}.py"), *words, *record])
        script(name).main()
        numbers = json.loads(file.read_text())["benchmarks"][benchmark]["numbers"] if benchmark else {}
        return capsys.readouterr().out.splitlines(), numbers

    return ran


def last(line: str, count: int) -> list[float]:
    """The numbers that a line ends with."""
    return [float(word.rstrip("%")) for word in line.split()[-count:]]


def test_kernels(run, monkeypatch):
    monkeypatch.setattr(shutil, "which", lambda name: None)  # the native programs have a test of their own
    lines, numbers = run("kernels", "--cells", "2", "--elements", "ANS3DEAS", "--repeat", "1", benchmark="kernels")
    rows = {line[:27].split(maxsplit=1)[1].strip(): last(line, 2) for line in lines if line.startswith("ANS3DEAS")}
    assert list(rows) == ["SVK", "NeoHooke", "NeoHookePower", "J2 elastic", "J2 plastic"]
    for law, (us, kilobytes) in rows.items():
        assert us == pytest.approx(numbers[f"ANS3DEAS {law}: us"], abs=0.006)
        assert kilobytes == pytest.approx(1e-3 * numbers[f"ANS3DEAS {law}: bytes"], abs=0.06)
    assert numbers["ANS3DEAS SVK: points"] == 8
    assert numbers["ANS3DEAS J2 plastic: points"] == 20


def test_threads(run):
    lines, numbers = run("kernels", "--scaling", "4", "--repeat", "1", benchmark="threads")
    assert len(lines) == 3
    assert numbers["MI9K3DEAS SVK: elements"] == 4
    assert all(0.0 < ratio < math.inf for ratio in numbers.values())


@pytest.mark.skipif(not shutil.which("c++"), reason="no C++ compiler")
def test_threads_in_an_evaluation(run, script):
    lines, _ = run("threads", "sheets", "--elements", "16", "--repeat", "1")
    cells = lines[-1].strip("| ").split(" | ")
    assert cells[:2] == ["16", "768"]
    assert len(cells) == lines[-3].count(" | ") + 1
    estimate = script("threads").estimate
    assert estimate({"elements": 36, "cpu": 10.0, "outside": 1.0}, 2) == pytest.approx(10.0 / (1.0 + 9.0 * 5 / 9))


def test_operations_of_an_element_are_counted(script, tmp_path):
    """More operations where the material flows than where it does not, and as many in each element of a kind."""
    native, sheet = script("kernels").Native(tmp_path), script("sheets").sheet
    elastic, plastic = (native.operations(*sheet("DISP3D", law, (1, 1))) for law in ("J2 elastic", "J2 plastic"))
    assert len(elastic) == len(plastic) == 4
    assert min(elastic) >= 0.0
    assert elastic[0] == plastic[0] > 0.0  # the strains do not know the law
    assert plastic[1] > elastic[1] > 0.0
    assert native.operations(*sheet("DISP3D", "NeoHooke", (1, 1))) is None


def test_the_sheet_flows_where_its_law_can(script):
    sheets = script("sheets")
    for law in sheets.LAWS:
        model, u = sheets.sheet("ANS3DEAS", law, (2, 2), side=10.0)
        before = model.bodies.only.block.state.copy()
        evaluation = model.evaluate(u)
        assert evaluation.failed < 0
        model.system.commit(evaluation)
        assert (not np.array_equal(model.bodies.only.block.state, before)) == (law in ("J2 plastic", "J2 Voce"))


def test_run(run):
    lines, numbers = run("run", "--increments", "10", benchmark="run")
    increments, evaluations = map(int, re.match(r"(\d+) increments, (\d+) evaluations", lines[0]).groups())
    assert evaluations > increments > 10  # the way back follows
    shares = [last(line, 3)[1] for line in lines[2:]]
    assert sum(shares) == pytest.approx(100.0, abs=0.5)
    each = sum(number for name, number in numbers.items() if name.endswith("evaluation"))
    assert each * evaluations == pytest.approx(1e3 * numbers["all, s"], rel=0.01)


def test_ubend(run):
    lines, numbers = run("ubend", "--stroke", "1", "--calculix", "0", benchmark="ubend")
    forces = [float(line.split("|")[3]) for line in lines[2:6]]
    assert numbers["umform, BEND8, 3 x 3 cells: stroke"] == 1.0
    assert forces[0] > forces[1] > 0.0 and forces[2] > forces[3] > 0.0  # friction costs force
    assert abs(forces[2] / forces[0] - 1) < 0.05


def test_memory(run):
    lines, numbers = run("memory", "--elements", "4", benchmark="memory 4")
    assert [line[:16] for line in lines[1:3]] == ["umform and numpy", "history, converg"]
    assert 20.0 < numbers["peak, MB"] < 2000.0
    unknowns = 1e6 * numbers["solution, MB"] / 8  # 18 nodes, of which 6 are clamped
    assert unknowns == pytest.approx(36)
    assert 1e6 * numbers["matrix, upper triangle, MB"] / 8 < unknowns * (unknowns + 1) / 2 + 0.5


def test_mixed(run):
    lines, numbers = run("mixed", "--cells", "8", benchmark="mixed")
    assert lines[1].split()[0] == "hemisphere"
    assert numbers["hemisphere in 5, evaluations over those of the consistent tangent"] < 0.6
    assert 0.9 < numbers["an evaluation of ANS3DEAS, over one with the consistent tangent"] < 1.5


def test_dome(run, tmp_path):
    picture, page = tmp_path / "dome.png", tmp_path / "page.md"
    page.write_text("before\n<!-- dome -->\nold\n<!-- /dome -->\nafter\n")
    words = ("--elements", "4", "9", "--plot", str(picture), "--page", str(page))
    lines, numbers = run("dome", *words, benchmark="dome 9")
    assert picture.stat().st_size > 10_000
    rows = {int(line.split("|")[1]): line.split("|")[2:-1] for line in lines[2:4]}
    assert list(rows) == [4, 9]
    assert int(rows[9][4]) == numbers["increments"] == 10
    assert int(rows[9][5]) == numbers["iterations"] < numbers["evaluations"]
    assert 0.0 < numbers["s per iteration"] * numbers["iterations"] < 1.5 * numbers["CPU s"]
    assert numbers["way"] == -8.0
    assert numbers["failure"] == ""
    text = page.read_text().splitlines()
    assert text == ["before", "<!-- dome -->", *lines[:4], "<!-- /dome -->", "after"]
    lines, _ = run("dome", "--elements", benchmark="dome 9")
    assert [line for line in lines if line.startswith("| 9 ")]  # the file is enough for the table


def test_s_rail(run):
    name = "45 degrees, 14 along"
    lines, numbers = run("s_rail", "--stroke", "0.1", "--only", name, benchmark="s_rail")
    assert [float(word) for word in lines[2].split("|")[2:4]] == [448, 0.1]
    assert numbers[f"{name}: force"] == pytest.approx(float(lines[2].split("|")[4]), abs=0.006)


def test_beside_counts_each_evaluation_once(run):
    lines, numbers = run("beside", "--job", "hemisphere", benchmark="beside")
    name, _, evaluations, beside, *purposes, _ = lines[-1].split(" | ")
    assert numbers == {f"{name}, evaluations": float(evaluations)}
    assert round(100.0 * sum(int(number) for number in purposes) / float(evaluations)) == int(beside)


def test_exponents_of_the_dome_are_slopes_of_the_large_sizes(script):
    rows = [{"elements": n, "s per iteration": 3.0 * n**1.25, "peak GB": 7.0 * n} for n in (10_000, 40_000, 160_000)]
    rows.insert(0, {"elements": 1000, "s per iteration": 1e9, "peak GB": 1e9})
    dome = script("dome")
    assert dome.exponents(rows) == pytest.approx({"s per iteration": 1.25, "peak GB": 1.0})
    assert dome.exponents(rows[:2]) == {}


def test_sparse(run):
    """Each kind of matrix; a solver that refuses one is left out."""
    kinds = ("positive", "indefinite", "unsymmetric")
    arguments = [word for kind in kinds for word in ("--kind", kind)]
    _, numbers = run("sparse", "--case", "strip 24x1", "--rounds", "1", *arguments, benchmark="sparse")
    assert {f"strip 24x1, {kind}, 1 threads, multifrontal, factor" for kind in kinds} <= set(numbers)
    assert "strip 24x1, positive, 1 threads, banded, analysis" in numbers
    assert "strip 24x1, unsymmetric, 1 threads, banded, factor" not in numbers
    assert min(number for name, number in numbers.items() if not name.endswith("MB")) > 0.0


def test_the_page_has_two_solvers_beside_each_other(script, monkeypatch, tmp_path):
    """Each case of the goal on one thread and two; a case that a solver refuses is left out."""
    sparse, page = script("sparse"), tmp_path / "page.md"
    page.write_text("before\n<!-- sparse -->\nold\n<!-- /sparse -->\nafter\n")

    def apart(case, kind, name, threads):
        if (case, kind, name) == ("sheet 100x100", "unsymmetric", "pardiso"):
            return None
        number = 100.0 * threads + (name == "pardiso")
        return {"n": 60600, "fill": 1.0} | dict.fromkeys(sparse.COLUMNS, number)

    monkeypatch.setitem(sparse.main.__globals__, "apart", apart)
    monkeypatch.setitem(sparse.main.__globals__, "available", lambda: dict.fromkeys(sparse.BESIDE, True))
    monkeypatch.setattr(sys, "argv", ["sparse.py", "--page", str(page), "--rounds", "1"])
    sparse.main()
    before, head, _, *rows, after = page.read_text().replace("<!-- sparse -->\n", "").split("\n")[:-1]
    rows.remove("<!-- /sparse -->")
    assert (before, after) == ("before", "after")
    assert head.count("PARDISO") == len(sparse.COLUMNS)
    assert len(rows) == 2 * (3 * 3 - 1)
    assert rows[0] == "| 100x100 | 60 600 | positive | " + " | ".join(["100 | 101"] * 4) + " |"
    assert rows[-1] == "| 316x316, 2 threads | 60 600 | unsymmetric | " + " | ".join(["200 | 201"] * 4) + " |"
    monkeypatch.setitem(sparse.main.__globals__, "available", lambda: {"multifrontal": True, "pardiso": False})
    with pytest.raises(SystemExit):
        sparse.main()


def test_workloads(run, script):
    names = ["python -c pass, 5 times", "free bending 24x1"]
    lines, _ = run("workloads", *(word for name in names for word in ("--only", name)))
    seconds = json.loads("\n".join(lines))
    assert list(seconds) == names
    assert all(0.0 < number < 60.0 for number in seconds.values())
    assert script("workloads").evaluations("MI9K3DEAS", (1, 1))()


def test_compare_takes_turns_and_prints_the_median_of_ratios(script, monkeypatch, capsys, tmp_path):
    compare, asked = script("compare"), []

    def measure(source):
        asked.append(source.name)
        return {"work": {"a": 1.0, "b": 0.5}[source.name] * len(asked)}

    monkeypatch.setattr(compare, "measure", measure)
    rounds = compare.in_turns([Path("a"), Path("b")], 3)
    assert asked == ["a", "b", "b", "a", "a", "b"]
    compare.report(rounds, Namespace(first="old", second="new", json=tmp_path / "found.json"))
    found = json.loads((tmp_path / "found.json").read_text())["benchmarks"]["compare old new"]["numbers"]
    ratios = sorted([0.5 * 2 / 1, 0.5 * 3 / 4, 0.5 * 6 / 5])
    assert list(found.values()) == pytest.approx([ratios[1], ratios[0], ratios[2]])
    assert last(capsys.readouterr().out.splitlines()[-1].replace("to", ""), 3) == pytest.approx(
        [ratios[1], ratios[0], ratios[2]], abs=6e-4
    )


def test_compare_sees_other_kernels_by_their_sources(script, tmp_path):
    compare = script("compare")
    folders = [tmp_path / name for name in "ab"]
    for folder in folders:
        folder.mkdir()
        with compare.checked_out("WORK", folder):
            pass
        assert (folder / "src" / "umform" / "__init__.py").is_file()
        assert not list(folder.rglob("*.so"))
    assert compare.fingerprint(folders[0]) == compare.fingerprint(folders[1])
    (folders[1] / "src" / "umform" / "model.py").write_text("")
    assert compare.fingerprint(folders[0]) == compare.fingerprint(folders[1])
    (folders[1] / "CMakeLists.txt").write_text("")
    assert compare.fingerprint(folders[0]) != compare.fingerprint(folders[1])


def test_compare_ends_with_what_a_command_says(script):
    with pytest.raises(SystemExit, match="no such luck"):
        script("compare").run(sys.executable, "-c", "import sys; sys.exit('no such luck')")


def test_two_equal_builds_answer_alike():
    core = sys.modules["umform._core"].__file__
    environment = {**os.environ, "PYTHONPATH": str(Path(uf.__file__).parents[1])}
    command = [sys.executable, str(FOLDER / "compare_kernels.py"), core, core]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=environment)
    assert {line.split()[1] for line in done.stdout.splitlines()} == {"0.0e+00"}
    assert {"residual", "tangent", "history"} <= {line.split()[0] for line in done.stdout.splitlines()}


def test_growth_of_the_factors_is_found_again(script):
    ranks = script("ranks")
    sizes = np.array([6400.0, 25600.0, 102400.0])
    fill, flops = 31.0 * sizes * np.log2(sizes) - 90.0 * sizes, 250.0 * sizes**1.5 + 40.0 * sizes * np.log2(sizes)
    growth = ranks.Growth([{"elements": m, "fill": f, "flops": w} for m, f, w in zip(sizes, fill, flops)])
    assert growth.fill_terms == pytest.approx([31.0, -90.0])
    assert growth.flop_terms == pytest.approx([250.0, 40.0])
    assert growth.fill(1e6) == pytest.approx(31e6 * math.log2(1e6) - 90e6)


def test_the_stored_measurements_make_table_forecast_and_figure(script, monkeypatch, capsys, tmp_path):
    ranks = script("ranks")
    monkeypatch.setattr(ranks, "FIGURE", tmp_path / "ranks.png")
    stored = FOLDER / "ranks.json"
    ranks.main([str(stored)])
    printed, runs = capsys.readouterr().out, json.loads(stored.read_text())["runs"]
    rows = [
        line for line in printed.splitlines() if line.startswith(f"| {runs[-1]['elements']} | {runs[-1]['unknowns']} |")
    ]
    assert len(rows) == len({run["ranks"] for run in runs})
    assert rows[0].split("|")[9].split() == ["1.00", "(1.00)"]
    assert "on 2 ranks the fullest one took +12% of that" in printed
    assert (tmp_path / "ranks.png").stat().st_size > 10_000
    page = (FOLDER.parent / "docs" / "performance-ranks.md").read_text()
    assert all("|".join(row.split("|")[:9]) in page for row in rows)


def test_the_bent_sheet_of_the_ranks_is_a_cylinder(script):
    ranks = script("ranks")
    model = ranks.sheet(4)
    X = model.mesh.points
    x = X + ranks.bent(X, radius=40.0).reshape(-1, 3)
    assert np.hypot(x[:, 0], x[:, 2] + 40.0) == pytest.approx(40.0 + X[:, 2])
    assert {contact.name for contact in model.contacts} == {"tool"}


def test_every_kernel_of_the_instruction_counts_is_driven(script, monkeypatch):
    instructions, driven = script("instructions"), []
    sheet = instructions.sheet

    def recorded(name, law, cells, side):
        driven.append((name, law))
        return sheet(name, law, cells, side)

    monkeypatch.setattr(instructions, "sheet", recorded)
    instructions.drive()
    assert driven == instructions.KERNELS
