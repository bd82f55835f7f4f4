"""What `umform check` finds is found before a run too: errors refuse, warnings are printed."""

import logging

import pytest
from command_line import umform

from umform.problem.templates import template

SHORT = ["--set", "mesh.cells=[12, 1]", "--set", "steps.0.increments=4", "--set", "steps.0.to.punch=-1.0"]
IN_PER_CENT = "0,200\n5,300\n20,400\n"


@pytest.fixture
def deck(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "deck.toml"
    path.write_text(template("free-bending").replace("kappa = 175000.0\nmu = 80770.0", "E = 210e3\nnu = 0.3"))
    return path


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ("material.E=210.0", "first yield at a strain of 0.762"),
        ("material.hardening.yield_stress=0.1", "first yield at a strain of 4.76e-07"),
        ("tools.cylinder.centre=[25.0, 0.0, -20.01]", "46.1 % of the thickness"),
        ("mesh.width=0.001", "a side of 0.001 thicknesses"),
        ('material.hardening={curve="Table", eqps=[0, 5, 20], stress=[200, 300, 400]}', "per cent"),
    ],
)
def test_a_run_refuses_what_cannot_be_meant(change, text, deck, tmp_path):
    refused = umform("run", deck, *SHORT, "--set", change)
    assert refused.exit_code == 1
    assert text in refused.stderr
    assert "--force" in refused.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["deck.toml"]
    assert umform("check", deck, *SHORT, "--set", change).exit_code == 1


@pytest.mark.parametrize("command", ["derive", "sigma", "compensate", "identify", "run", "net"])
def test_a_changed_thickness_that_leaves_tools_behind_is_said_before_the_run(command, tmp_path):
    path = tmp_path / "deck.toml"
    path.write_text(template("air-bending"))
    # the run is refused afterwards, for a path or a solver that is not known
    wrong = {
        "derive": ["--by", "no.path"],
        "sigma": ["--scatter", "no.path=1%"],
        "compensate": ["--by", "no.path", "--want", "stroke=1+-0.1"],
        "identify": ["--find", "no.path", "--quantity", "stroke=1+-0.1"],
        "run": ["--solver", "none"],
        "net": ["--height", "5"],
    }
    for thickness, count in (("1.6", 1), ("2.0", 0)):
        said = umform(command, path, *wrong[command], "--set", f"mesh.thickness={thickness}")
        assert said.exit_code == 1
        assert said.stderr.count("places of tools do not follow the thickness: at 2 and 1.6") == count


def test_force_runs_it_all_the_same(deck, tmp_path):
    forced = umform("run", deck, *SHORT, "--set", "mesh.width=0.005", "--set", "output.report=false", "--force")
    assert "a side of 0.005 thicknesses" in forced.stderr
    assert forced.exit_code == 0
    assert (tmp_path / "results/deck/history.csv").exists()


def test_a_run_warns_of_what_is_unusual(deck):
    fine = ["--set", "mesh.cells=[24, 1]", "--set", "output.report=false"]
    run = umform("run", deck, *SHORT, *fine, "--set", "contacts.cylinder.points=1")
    assert run.exit_code == 0
    assert run.stderr.count("the force climbs in stairs") == 1
    assert run.stderr.count("--set mesh.cells is given twice; the last value counts: [24, 1]") == 1
    quiet = umform("run", deck, *SHORT, *fine, "--overwrite")
    assert "stairs" not in quiet.stderr


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--young", "210", "--yield-stress", "160"], "stresses are in MPa"),
        (["--young", "210", "--yield-stress", "0.2"], "stresses are in MPa"),
        (["--yield-stress", "0.2"], "first yield at a strain of 9.52e-07"),
        (["--width", "0.001"], "a side of 0.00025 thicknesses"),
        (["--flow-curve", "coil.csv"], "per cent"),
    ],
)
def test_a_bend_refuses_what_cannot_be_meant(options, text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "coil.csv").write_text(IN_PER_CENT)
    refused = umform("bend", "--stroke", "6", *options)
    assert refused.exit_code == 1
    assert text in refused.stderr
    assert "--force" in refused.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["coil.csv"]


IN_GPA = """[material]
law = "J2"
E = 210e3
nu = 0.3
hardening = { curve = "Swift", strength = 0.4, offset = 0.001, exponent = 0.18 }
"""


@pytest.mark.parametrize(
    "command",
    [
        "bend table --thickness 1 --opening 8 --angle 120",
        "bend correct --thickness 1 --opening 8 --stroke 3 --measured-angle 100",
        "draw cup --coarse",
        "draw u --coarse",
        "bead --no-extrapolate",
        "hem",
    ],
)
def test_stresses_in_another_unit_are_refused_by_each_process(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "gpa.toml").write_text(IN_GPA)
    refused = umform(*command.split(), "--material", "gpa.toml")
    assert refused.exit_code == 1
    assert "first yield at a strain of 5.49e-07" in refused.stderr and "--force" not in refused.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["gpa.toml"]


def test_a_warning_is_printed_once(deck):
    """Too soft a penalty: the run logs it, and its result keeps it."""
    soft = ["--set", "mesh.cells=[24, 1]", "--set", "output.report=false", "--set", "steps.0.to.punch=-6.0"]
    soft += ["--set", "steps.0.increments=40", "--set", "contacts.cylinder.penetration=1e-9"]
    deck.write_text(deck.read_text().replace("penalty = 100.0", ""))
    run = umform("run", deck, *soft)
    assert run.exit_code == 0
    assert run.stderr.count("exceeds") == 1
    assert run.stderr.count("umform: contact cylinder: the penetration of") == 1


def test_a_warning_that_comes_again_is_counted(monkeypatch, deck):
    from umform.results.history import History

    add = History.add

    def warns(self, *arguments, **options):
        add(self, *arguments, **options)
        self.warn(f"step 1, time 0.{len(self.rows)}: it chatters")

    monkeypatch.setattr(History, "add", warns)
    run = umform("run", deck, *SHORT, "--set", "mesh.cells=[24, 1]", "--set", "output.report=false")
    assert run.stderr.count("it chatters") == 2
    assert "umform: step 1, time 0.1: it chatters\n" in run.stderr
    assert "times, first at step 1, time 0.1" in run.stderr


def test_with_the_log_a_warning_is_printed_once_too(deck, monkeypatch):
    logger = logging.getLogger("umform")
    monkeypatch.setattr(logger, "handlers", [])
    monkeypatch.setattr(logger, "level", logger.level)
    fine = ["--set", "mesh.cells=[24, 1]", "--set", "output.report=false", "--set", "contacts.cylinder.points=1"]
    run = umform("run", "-v", deck, *SHORT, *fine)
    assert run.stderr.count("the force climbs in stairs") == 1
    assert "step 1  time 0.25" in run.stderr


def test_a_demo_without_room_for_its_stroke_is_refused_with_its_options(tmp_path):
    refused = umform("demo", "free-bending", "--radius", "30", "--out", tmp_path / "out")
    assert refused.exit_code == 1
    assert "no room for the stroke" in refused.stderr
    assert "--stroke" in refused.stderr
    assert "12.67 at most" in refused.stderr
    assert "--tool-x 31 or more" in refused.stderr
    assert not (tmp_path / "out").exists()


def test_a_taken_folder_is_refused_before_warnings(deck, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "history.csv").touch()
    run = umform("run", deck, *SHORT, "--set", "contacts.cylinder.points=1", "--out", "out")
    assert run.exit_code == 1
    assert run.stderr.startswith("umform: the folder holds the results of another run")
