import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import pytest
from command_line import umform as umform_cli

import umform
from umform import cli
from umform.errors import InvalidValue, NoConvergence
from umform.problem.templates import template_file, write_template
from umform.processes.bending import case as case_module
from umform.processes.bending import showcase
from umform.processors import available

BEND = ["--stroke", "0.4", "--increment", "0.0125", "--element", "BEND8", "--layers", "1"]
RUN = ["--mesh", "24x1", "--contact", "2", "--steps", "30", "--stroke", "2", "--no-unload"]


#: What takes longer to load than all of `umform --version`.
HEAVY = {"numpy", "scipy", "matplotlib", "h5py", "meshio", "pydantic", "rich", "pyvista", "vtk", "umform._core"}


def loaded_by(code):
    """Modules that Python has loaded at the end of a program."""
    code = f"import sys\ntry:\n    {code}\nexcept SystemExit: pass\nprint(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(run.stdout.split())


@pytest.mark.parametrize(
    "code",
    [
        "import umform; umform.__all__; umform.UmformError",
        "from umform.cli import main; sys.argv = ['umform', '--version']; main()",
    ],
)
def test_what_needs_no_numbers_loads_nothing_heavy(code):
    loaded = loaded_by(code)
    assert "umform" in loaded
    assert not loaded & HEAVY


def test_a_public_name_loads_its_own_home_only():
    loaded = loaded_by("import umform as uf; uf.Model")
    assert "umform.model" in loaded
    assert not loaded & {"scipy", "matplotlib", "h5py", "meshio", "pydantic", "rich", "umform.report", "umform.problem"}


def test_all_public_names_together_load_numpy_and_the_kernels_only():
    loaded = loaded_by("import umform as uf; [getattr(uf, name) for name in uf.__all__]")
    assert {"numpy", "umform._core", "umform.analysis.run.execute", "umform.sheet_metals", "umform.processes"} <= loaded
    assert not loaded & (HEAVY - {"numpy", "umform._core"})


#: A strip of J2 in plane strain, or a sheet, on a cylinder: solved, and its history written.
SMALL_RUN = """
import sys
from pathlib import Path
import umform as uf
def run(cells, width, folder):
    mesh = uf.mesh.strip(length=60, width=width, thickness=1, cells=cells)
    model = uf.Model(mesh, material=uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(160.0, 500.0)))
    model.symmetry("x0", normal="x")
    model.fix(range(len(mesh.points)), "y")
    punch = model.prescribe("x0_lower", "z", name="punch")
    model.contact("lower", uf.Cylinder(centre=(25, 0, -20.5), axis="y", radius=20), penalty=100, points=2)
    result = uf.solve(model, uf.Move(punch, to=-0.5, steps=5), frames=0)
    assert result["punch_force"][-1] < 0
    result.write(Path(folder) / "history.csv")
    print(result.solver)
"""


@pytest.mark.parametrize(("cells", "width"), [((24, 1), 2.5), ((24, 24), 60.0)])
def test_a_run_loads_nothing_of_scipy_but_blas(tmp_path, cells, width):
    loaded = loaded_by(f"exec({SMALL_RUN!r}); run({cells}, {width}, {str(tmp_path)!r})")
    assert {"multifrontal", "scipy.linalg.cython_blas"} <= loaded  # the solver stands in the line before the list
    assert not loaded & {"scipy.linalg", "scipy.sparse", "scipy.spatial", "scipy.optimize", "importlib.metadata"}
    assert not loaded & {"matplotlib", "h5py", "meshio", "rich", "numpy.ma", "numpy.polynomial"}


@pytest.mark.parametrize("words", [["new", "cantilever"], ["new"]])
def test_a_template_is_printed_without_loading_what_computes(words):
    loaded = loaded_by(f"from umform.cli import main; sys.argv = ['umform', *{words}]; main()")
    assert "umform.problem.templates" in loaded
    assert not loaded & (HEAVY - {"pydantic", "rich"})  # which typer loads for its own, and the list is a table


SOLVING = "import umform as uf; uf.Result; uf.solve; from umform.io import write_csv"
CHECKING = f"from umform.cli import main; sys.argv = ['umform', 'check', {str(template_file('cantilever'))!r}]; main()"


@pytest.mark.parametrize("code", [SOLVING, CHECKING])
def test_solving_and_checking_load_nothing_for_files_and_pictures(code):
    loaded = loaded_by(code)
    assert "umform.analysis.run.execute" in loaded
    assert not loaded & {"meshio", "h5py", "matplotlib", "scipy.sparse", "scipy.optimize", "scipy.spatial"}


def run_unread(*words, stderr):
    """A command whose reader has gone before the first word: `umform ... | true`, where `true` is the quicker one."""
    reader, writer = os.pipe()
    os.close(reader)
    try:
        command = [sys.executable, "-m", "umform", *words]
        return subprocess.run(command, stdout=writer, stderr=writer if stderr is None else stderr, check=False)
    finally:
        os.close(writer)


@pytest.mark.parametrize(
    "words", [["new", "cantilever"], ["new"], ["elements"], ["--version"], ["--help"], ["run"], ["run", "missing.toml"]]
)
def test_streams_that_nobody_reads_end_a_command(words):
    assert run_unread(*words, stderr=None).returncode == cli.CLOSED_PIPE


@pytest.mark.parametrize("words", [["new", "cantilever"], ["new"], ["--help"]])
def test_nothing_is_said_of_a_pipe_that_nobody_reads(words):
    run = run_unread(*words, stderr=subprocess.PIPE)
    assert run.returncode == cli.CLOSED_PIPE
    assert run.stderr == b""


def test_a_bend_is_written_although_nobody_reads_of_it(tmp_path):
    run = run_unread("bend", *BEND, "--out", str(tmp_path), stderr=subprocess.PIPE)
    assert run.returncode == cli.CLOSED_PIPE
    assert b"Error" not in run.stderr
    assert {"curve.csv", "bend.json", "bend.vtkhdf", "report.html"} <= {path.name for path in tmp_path.iterdir()}


@pytest.mark.parametrize("start", [["-m", "umform"], ["-c", "from umform.cli import main; main()"]])
def test_usage_names_the_command_however_it_is_started(start):
    run = subprocess.run([sys.executable, *start, "new", "--help"], capture_output=True, text=True, check=True)
    assert "Usage: umform new [OPTIONS]" in run.stdout


def test_version_is_printed():
    assert umform_cli("--version").stdout.split() == ["umform", umform.__version__]


def test_timing_sums_up_all_runs(tmp_path):
    run = umform_cli("demo", "free-bending", "--out", tmp_path, *RUN, "--contact", "nodes", "--timing")
    assert run.exit_code == 0, run.output
    table = run.stdout[run.stdout.index("Where the time went") :]
    rows = {" ".join(words[:-4]): words[-4:] for line in table.splitlines() if len(words := line.split()) > 4}
    assert f"{umform.threads()} thread" in table and f"{available()} processor" in table
    assert rows["elements"][2] == rows["contact and pressure"][2]  # a call of each in each evaluation
    assert 2 * 30 < int(rows["factorisation"][2]) < int(rows["elements"][2])
    whole = next(line for line in table.splitlines() if line.split()[:1] == ["all"])
    assert whole.split()[2:] == ["100.0", "2", "runs"]


def test_elements_are_listed():
    run = umform_cli("elements")
    assert run.exit_code == 0
    for name in ("DISP3D", "ANS3DEAS", "MI9K3DEAS"):
        assert name in run.stdout


def test_a_restricted_run_gives_the_force_of_the_reference(tmp_path):
    run = umform_cli("demo", "free-bending", "--out", tmp_path, *RUN)
    assert run.exit_code == 0, run.output
    assert "ANS3DEAS 24x1 2x2" in run.stdout
    assert "reconstruction" in run.stdout
    record = json.loads((tmp_path / "free_bending.json").read_text())
    assert [row["run"] for row in record["runs"]] == ["ANS3DEAS 24x1 2x2"]
    assert record["runs"][0]["F_2"] == pytest.approx(18.793, rel=2e-3)


@pytest.mark.parametrize(
    ("options", "exit_code", "message"),
    [
        (["--element", "FOO"], 1, "unknown element"),
        (["--penalty", "-1", "--mesh", "24x1"], 1, "penetration must be positive"),
        (["--thickness-order", "3", "--thickness-points", "3", "--contact", "2"], 1, "needs at least 4"),
        (["--mesh", "24"], 1, "24x1"),
        (["--contact", "2x3"], 1, "nodes"),
        (["--steps", "many"], 2, "a whole number is needed"),
        (["--nonsense"], 2, "nonsense"),
    ],
)
def test_errors_are_messages(options, exit_code, message, tmp_path):
    run = umform_cli("demo", "free-bending", "--out", tmp_path, "--processes", 1, *options)
    assert run.exit_code == exit_code
    assert message in run.stderr
    assert "Traceback" not in run.output


def test_errors_in_other_processes_are_messages_too(tmp_path):
    run = umform_cli("demo", "free-bending", "--out", tmp_path, "--processes", 2, "--yield-stress", "-1")
    assert run.exit_code == 1
    assert "yield" in run.stderr
    assert "Traceback" not in run.output


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("--mesh", "0x1"),
        ("--mesh", "abc"),
        ("--mesh", "24"),
        ("--element", "FOO"),
        ("--contact", "11"),
        ("--contact", "2x"),
        ("--contact", "nodesx"),
        ("--yield-stress", "-1"),
        ("--kappa", "0"),
        ("--hardening", "-1"),
        ("--radius", "nan"),
        ("--length", "inf"),
        ("--tool-z", "nan"),
        ("--steps", "0"),
        ("--thickness-points", "16"),
        ("--thickness-order", "5"),
        ("--thickness-rule", "simpson"),
        ("--penalty", "-1"),
        ("--stroke", "0"),
        ("--solver", "magic"),
        ("--processes", "0"),
        ("--processes", "-3"),
    ],
)
def test_a_wrong_value_is_refused_with_its_option_and_leaves_no_folder(option, value, tmp_path):
    run = umform_cli("demo", "free-bending", "--out", tmp_path / "deep" / "out", option, value)
    assert run.exit_code == 1
    assert f"where:  {option}" in run.stderr
    assert value in run.stderr.split("value:")[1].splitlines()[0]
    assert "remedy:" in run.stderr
    assert "Warning" not in run.output
    assert list(tmp_path.iterdir()) == []


def test_a_remedy_names_options():
    run = umform_cli("demo", "free-bending", "--thickness-order", "3", "--thickness-points", "3")
    assert "remedy: --thickness-points 4 or more" in run.stderr


@pytest.mark.parametrize(
    ("out", "cause"), [("", "empty"), ("file", "there is a file of this name"), ("file/a/b", "file is a file")]
)
def test_a_folder_that_cannot_be_is_refused(out, cause, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("")
    run = umform_cli("demo", "free-bending", "--out", out, *RUN)
    assert run.exit_code == 1
    assert cause in run.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize("words", [["bend", *BEND], ["run", "deck.toml"]])
def test_a_folder_without_a_name_is_not_the_present_one(words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_template("cantilever", tmp_path / "deck.toml")
    run = umform_cli(*words, "--out", "")
    assert run.exit_code == 1
    assert "the folder for the results has no name" in run.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["deck.toml"]


def test_failed_runs_and_repeated_warnings_are_shown(monkeypatch, tmp_path):
    def fails(case, **options):
        if case.contact == "nodes":
            raise NoConvergence("stopped", remedy="take line_search=True")
        run = case_module.free_bending(case, **options)
        return replace(run, warnings=tuple(f"step 1, time 0.{n}: it chatters" for n in range(1, 4)))

    monkeypatch.setattr(showcase, "free_bending", fails)
    contacts = ["--contact", "nodes", "--line-search"]
    run = umform_cli("demo", "free-bending", "--out", tmp_path, "--processes", "1", *RUN, *contacts)
    assert run.exit_code == 1
    assert run.stderr.count("it chatters") == 1
    assert "3 times" in run.stderr
    assert "take --line-search" in run.stderr
    assert (tmp_path / "report.html").read_text().count("it chatters") == 1
    record = json.loads((tmp_path / "free_bending.json").read_text())
    assert record["settings"]["line_search"] is True
    assert {row["run"]: len(row["warnings"]) for row in record["runs"]} == {
        "ANS3DEAS 24x1 2x2": 1,
        "ANS3DEAS 24x1 nodes": 0,
    }


def broken(*arguments, **options):
    raise ZeroDivisionError("a bug")


def refused(*arguments, **options):
    raise InvalidValue("refused", where="here")


@pytest.mark.parametrize(("place", "shown"), [("before", True), ("after", True), ("nowhere", False)])
@pytest.mark.parametrize("failure", [broken, refused])
def test_tracebacks_only_when_asked_for(failure, place, shown, monkeypatch, tmp_path):
    monkeypatch.setattr(showcase, "demo", failure)
    before, after = ["--debug"] * (place == "before"), ["--debug"] * (place == "after")
    run = umform_cli(*before, "demo", "free-bending", *after)
    assert run.exit_code == 1
    assert ("Traceback" in run.stderr) == shown
    if failure is broken:
        assert "ZeroDivisionError: a bug" in run.stderr
        assert "--debug" in run.stderr
    else:
        assert "refused" in run.stderr
        assert "where:  here" in run.stderr


def test_interrupt_of_a_command(monkeypatch):
    def interrupted(*arguments, **options):
        raise KeyboardInterrupt

    monkeypatch.setattr(showcase, "demo", interrupted)
    run = umform_cli("demo", "free-bending")
    assert run.exit_code == 130
    assert "interrupted" in run.stderr


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_ends_all_processes(tmp_path):
    command = [sys.executable, "-m", "umform", "demo", "free-bending", "--out", tmp_path, "--processes", "2"]
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True, text=True
    )
    deadline = time.monotonic() + 60.0
    while not list(tmp_path.glob(".umform-*")) and time.monotonic() < deadline:  # until the runs have begun
        time.sleep(0.05)
    time.sleep(1.0)
    os.killpg(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=20)  # ends when no process holds the pipes any more
    assert process.returncode == 130
    assert "interrupted" in errors
    assert "Traceback" not in errors
    assert list(tmp_path.iterdir()) == []


def test_log_of_increments(tmp_path):
    command = [sys.executable, "-m", "umform", "-v", "demo", "free-bending", "--out", tmp_path, *RUN]
    run = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=True)
    assert "step 1  time" in run.stderr
    assert "umform.analysis.newton.newton" not in run.stdout
