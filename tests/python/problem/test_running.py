import csv
from html import escape

import meshio
import numpy as np
import pytest
from command_line import umform

from umform.analysis.newton.newton import Newton
from umform.problem import load
from umform.problem.templates import template_file
from umform.results.forming import KeelerBrazier

FILES = {"history.csv", "fields.vtkhdf", "report.html", "curve.png", "shape.png", "as-run.toml"}
#: n - offset = 0.19 is the uniform strain.
SWIFT = '{curve="Swift", strength=520.0, offset=0.01, exponent=0.2}'


@pytest.fixture
def deck(tmp_path, strip):
    path = tmp_path / "pull.toml"
    path.write_text(strip)
    return path


def rows(folder):
    with (folder / "history.csv").open() as file:
        return list(csv.DictReader(file))


def whole(folder):
    """Names of the files in a folder, each of which must be whole."""
    names = {path.name for path in folder.iterdir()}
    assert not any(name.startswith(".") for name in names)
    if "report.html" in names:
        assert (folder / "report.html").read_text().rstrip().endswith("</html>")
    for picture in names & {"curve.png", "shape.png"}:
        assert (folder / picture).read_bytes().endswith(b"IEND\xaeB`\x82")
    if "fields.vtkhdf" in names:
        import h5py

        with h5py.File(folder / "fields.vtkhdf") as file:
            assert file["VTKHDF/Steps"].attrs["NSteps"] > 0
    return names


def test_results_of_a_coarse_mesh_say_so(texts, tmp_path):
    path = tmp_path / "bend.toml"
    text = texts("air-bending").replace("increments = 100", "increments = 1").replace("stroke = 5.0", "stroke = 0.01")
    path.write_text(text.split("[[steps]]                  # springback")[0])
    answer = umform("run", path, "--out", tmp_path / "out", "--set", "mesh.cells=[10, 1]")
    assert "coarse mesh: an element spans" in answer.output and "error is unknown" in answer.output
    assert "coarse mesh: an element spans" in (tmp_path / "out" / "report.html").read_text()


def test_run_writes_everything(deck, tmp_path):
    deck.write_text('title = "A strip that is pulled <far>"\n' + deck.read_text())
    out = tmp_path / "a" / "b"
    answer = umform("run", deck, "--out", out, "--solver", "superlu", "--set", "steps.0.increments=3")
    assert answer.exit_code == 0, answer.output
    assert whole(out) == FILES
    assert [float(row["pull"]) for row in rows(out)] == pytest.approx([0, 0.1 / 3, 0.2 / 3, 0.1])
    assert "solver superlu" in answer.output
    assert "Written to" in answer.output
    copy = (out / "as-run.toml").read_text()
    assert copy == "# run with --set steps.0.increments=3\n" + deck.read_text()
    assert escape(copy) in (out / "report.html").read_text()
    assert "<h1>A strip that is pulled &lt;far&gt;</h1>" in (out / "report.html").read_text()
    assert umform("check", out / "as-run.toml").exit_code == 0


def test_output_is_as_asked_for(deck, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    deck.write_text(deck.read_text() + "[output]\nreport = false\npictures = false\nvtkhdf = false\n")
    assert umform("run", deck).exit_code == 0
    assert whole(tmp_path / "results" / "pull") == {"history.csv", "as-run.toml"}
    assert umform("run", deck, "--set", "output.csv=false", "--set", "output.folder='x'").exit_code == 0
    assert whole(tmp_path / "x") == {"as-run.toml"}


def test_loads_are_drawn_over_what_they_move(tmp_path):
    changes = ["--set", "steps.0.increments=2", "--set", "mesh.cells=[4,1]", "--set", "output.report=false"]
    answer = umform("run", template_file("cantilever"), "--out", tmp_path, *changes)
    assert answer.exit_code == 0, answer.output
    assert "curve.png" in whole(tmp_path)


def test_no_convergence_writes_what_was_reached(deck, tmp_path, monkeypatch):
    solve, calls = Newton.solve, []

    def tired(self, *args, **how):
        calls.append(1)
        if len(calls) > 2:
            self.options = type(self.options)(max_iterations=1)
        return solve(self, *args, **how)

    monkeypatch.setattr(Newton, "solve", tired)
    changes = ["--set", "steps.0.increments=4", "--set", "steps.0.cuts=0"]
    answer = umform("run", deck, "--out", tmp_path / "out", *changes)
    assert answer.exit_code == 1
    assert answer.output.count("did not converge") == 1
    assert "the results so far are written" in answer.output
    assert whole(tmp_path / "out") == FILES
    assert len(rows(tmp_path / "out")) == 3
    assert "the run ended early, Newton" in (tmp_path / "out" / "report.html").read_text()


def test_interrupt_writes_what_was_reached(deck, tmp_path, monkeypatch):
    solve, calls = Newton.solve, []

    def interrupted(self, *args, **how):
        calls.append(1)
        if len(calls) > 3:
            raise KeyboardInterrupt
        return solve(self, *args, **how)

    monkeypatch.setattr(Newton, "solve", interrupted)
    answer = umform("run", deck, "--out", tmp_path / "out", "--set", "steps.0.increments=9")
    assert answer.exit_code == 130
    assert "interrupted; the results so far are written" in answer.output
    assert whole(tmp_path / "out") == FILES | {"checkpoint.h5"}  # also when it is cut off within its first minute
    assert len(rows(tmp_path / "out")) == 4
    said = "the run ended early, interrupted: the numbers are those of its last converged state"
    assert said in (tmp_path / "out" / "report.html").read_text()
    monkeypatch.undo()
    assert umform("resume", tmp_path / "out" / "checkpoint.h5").exit_code == 0
    assert len(rows(tmp_path / "out")) == 10 and whole(tmp_path / "out") == FILES
    assert said not in (tmp_path / "out" / "report.html").read_text()


def test_interrupt_while_writing_leaves_no_half_file(deck, tmp_path, monkeypatch):
    def interrupted(result, path, **texts):
        path.write_text("<html>")
        raise KeyboardInterrupt

    monkeypatch.setattr("umform.report.page.write_report", interrupted)
    answer = umform("run", deck, "--out", tmp_path / "out")
    assert answer.exit_code == 130
    assert whole(tmp_path / "out") == {"history.csv", "fields.vtkhdf", "as-run.toml", "checkpoint.h5"}
    monkeypatch.undo()
    assert umform("resume", tmp_path / "out" / "checkpoint.h5").exit_code == 0
    assert whole(tmp_path / "out") == FILES


def test_what_cannot_be_solved_leaves_no_folder(deck, tmp_path):
    deck.write_text(deck.read_text().replace('kind = "fix"', 'kind = "symmetry"\nnormal = "x"'))
    answer = umform("run", deck, "--out", tmp_path / "out")
    assert answer.exit_code == 1
    assert "rigid whole" in answer.output
    assert not (tmp_path / "out").exists()


def test_folder_that_cannot_be_written(deck, tmp_path):
    (tmp_path / "file").write_text("")
    answer = umform("run", deck, "--out", tmp_path / "file" / "out")
    assert answer.exit_code == 1
    assert "is a file, not a directory" in answer.output


def test_check(deck):
    answer = umform("check", deck)
    assert answer.exit_code == 0
    assert "no rigid-body motion is free" in answer.output
    answer = umform("check", deck, "--set", "material.E=210e9")
    assert answer.exit_code == 0
    assert "Pa with mm?" in answer.output
    deck.write_text(deck.read_text().replace('kind = "fix"', 'kind = "symmetry"\nnormal = "x"'))
    assert umform("check", deck).exit_code == 1


def test_wrong_decks_and_changes(deck, tmp_path):
    two = "mesh.length=3\nmesh.width=2"
    for change in ("mesh.cels=3", "mesh.cells", "mesh.cells=[", "mesh.cells=" + "[" * 5000, two):
        answer = umform("check", deck, "--set", change)
        assert answer.exit_code == 1
        assert "remedy" in answer.output
    answer = umform("run", deck, "--solver", "pardisso")
    assert answer.exit_code == 1
    assert "superlu" in answer.output
    assert "pull.toml" not in answer.output  # it is not the deck that names it
    assert umform("check", tmp_path / "missing.toml").exit_code == 1


def test_check_writes_the_tools(tmp_path):
    (tmp_path / "deck.toml").write_text(template_file("square-cup").read_text())
    assert umform("check", tmp_path / "deck.toml", "--tools", tmp_path / "tools").exit_code == 0
    assert {file.name for file in (tmp_path / "tools").iterdir()} == {"die.stl", "punch.stl", "holder.stl"}
    for name, side, flat in (("die", "max", -0.405), ("punch", "min", 0.405)):
        heights = meshio.read(tmp_path / "tools" / f"{name}.stl").points[:, 2]
        assert getattr(heights, side)() == pytest.approx(flat, abs=1e-5)


def test_pictures_of_a_run_are_laid_out_once_for_their_files_and_the_report(deck, tmp_path, monkeypatch):
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    laid_out, execute = [], ConstrainedLayoutEngine.execute
    monkeypatch.setattr(ConstrainedLayoutEngine, "execute", lambda *args: (laid_out.append(1), execute(*args)))
    answer = umform("run", deck, "--out", tmp_path / "out", "--set", "steps.0.increments=2")
    assert answer.exit_code == 0, answer.output
    page = (tmp_path / "out" / "report.html").read_text()
    assert len(laid_out) == 2 == page.count("<figure><div><svg")


def test_new(tmp_path):
    assert "air-bending" in umform("new").output
    assert umform("new", "cantilever").output == template_file("cantilever").read_text()
    assert umform("new", "--schema").output.startswith("{")
    answer = umform("new", "nothing")
    assert answer.exit_code == 1
    assert "one of air-bending" in answer.output
    assert umform("new", "own-mesh", "--out", tmp_path / "deck.toml").exit_code == 0
    assert umform("check", tmp_path / "deck.toml").exit_code == 0


def test_demo_prints_its_deck(tmp_path):
    answer = umform("demo", "free-bending", "--print-deck", "--mesh", "24x1", "--contact", "5", "--radius", "15")
    assert answer.exit_code == 0
    (tmp_path / "deck.toml").write_text(answer.output)
    checked = umform("check", tmp_path / "deck.toml")
    assert checked.exit_code == 0
    assert "the radius 15 of cylinder" in checked.output


def test_fields_of_forming(deck, tmp_path):
    import h5py

    limit = "output.forming_limit=[[-0.2, 0.5], [0.2, 0.4]]"
    answer = umform("run", deck, "--out", tmp_path / "out", "--set", "steps.0.increments=2", "--set", limit)
    assert answer.exit_code == 0, answer.output
    with h5py.File(tmp_path / "out" / "fields.vtkhdf") as file:
        assert {"major_lower", "minor_upper", "thinning", "limit_margin"} <= set(file["VTKHDF/CellData"])
        last = file["VTKHDF/CellData/thinning"][:][-int(file["VTKHDF/NumberOfCells"][-1]) :]
    table = np.genfromtxt(tmp_path / "out" / "fields.csv", delimiter=",", names=True)
    np.testing.assert_allclose(table["thinning"], last, atol=1e-6)
    assert {"x", "y", "z", "limit_margin"} <= set(table.dtype.names)
    page = (tmp_path / "out" / "report.html").read_text()
    assert "Forming limit diagram" in page and f"{table['limit_margin'].min():.4g}" in page
    assert (tmp_path / "out" / "limits.png").read_bytes()[1:4] == b"PNG"


def test_elements_beyond_the_forming_limit_are_a_warning(deck, tmp_path):
    for limit, torn in (("[[-0.2, 1e-6], [0.2, 1e-6]]", True), ("[[-0.2, 0.9], [0.2, 0.9]]", False)):
        options = ["--set", "steps.0.increments=2", "--set", f"output.forming_limit={limit}", "--overwrite"]
        answer = umform("run", deck, "--out", tmp_path / "out", *options)
        assert answer.exit_code == 0, answer.output
        page = (tmp_path / "out" / "report.html").read_text()
        assert ("beyond the forming limit" in page) is torn


def test_a_forming_limit_of_keeler_and_brazier(deck, tmp_path):
    changes = ["--set", "steps.0.increments=2", "--set", "output.forming_limit=Keeler-Brazier", "--set"]
    elastic, steel = (f"material={{{law}, E=210e3, nu=0.3}}" for law in ('law="SVK"', f'law="J2", hardening={SWIFT}'))
    refused = umform("run", deck, "--out", tmp_path / "out", *changes, elastic)
    assert refused.exit_code == 1 and "needs the hardening" in refused.output
    refused = umform("run", deck, "--out", tmp_path / "out", *changes, steel, "--set", 'units={length="m"}')
    assert refused.exit_code == 1 and "takes the thickness in mm" in refused.output
    answer = umform("run", deck, "--out", tmp_path / "out", *changes, steel)
    assert answer.exit_code == 0, answer.output
    table = np.genfromtxt(tmp_path / "out" / "fields.csv", delimiter=",", names=True)
    thickness = float(np.ptp(load(deck).build().model.mesh.points[:, 2]))
    left = KeelerBrazier(thickness, 0.19)(table["minor_middle"]) - table["major_middle"]
    np.testing.assert_allclose(table["limit_margin"], left, atol=1e-9)


@pytest.mark.parametrize(
    ("limit", "why"), [("[[0.2, 0.5], [-0.2, 0.4]]", "ascending"), ("[[-20, 50], [20, 40]]", "not per cent")]
)
def test_a_forming_limit_that_is_not_sorted_or_in_per_cent_is_refused(deck, tmp_path, limit, why):
    answer = umform("run", deck, "--out", tmp_path / "out", "--set", f"output.forming_limit={limit}")
    assert answer.exit_code == 1 and why in answer.output
    assert not (tmp_path / "out").exists()


def test_a_checkpoint_does_not_replace_another_file(deck, tmp_path):
    text = deck.read_text()
    answer = umform("run", deck, "--checkpoint", deck, "--out", tmp_path / "out")
    assert answer.exit_code == 1
    assert "this file is no checkpoint" in answer.output
    assert deck.read_text() == text
    assert not (tmp_path / "out").exists()


def test_forces_that_are_not_in_balance_are_warned_of(deck, tmp_path):
    answer = umform("run", deck, "--set", "solution.residual=1e9", "--out", tmp_path / "out")
    assert answer.exit_code == 1
    assert "less than 1" in answer.output
    law = "material.law=J2", 'material.hardening={curve="Linear", yield_stress=160.0, modulus=500.0}'
    loose = "solution.residual=0.9", "solution.increment=0.9", "steps.0.to={pull=2.0}"
    words = [word for change in (*law, *loose) for word in ("--set", change)]
    answer = umform("run", deck, *words, "--out", tmp_path / "out")
    assert answer.exit_code == 0, answer.output
    assert "the forces are out of balance by up to" in " ".join(answer.output.split())
