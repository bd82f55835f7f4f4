"""Measures of a deck: numbers, tables, pictures, fields, and what is refused."""

import csv

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

import umform as uf
from umform.cli import app
from umform.errors import InvalidValue
from umform.problem import Problem, load
from umform.problem.measured import Taken, may_report, names_begin
from umform.problem.measures.hat import halves
from umform.problem.templates import template, template_file
from umform.problem.unloading import loading_steps
from umform.report.symmetry import Mirror
from umform.results.forming import Section, forming_fields, lay_by_best_fit, section
from umform.results.forming.sections import horizontal

SHORT = [
    "mesh.cells=[24, 1]", "mesh.length=60.0", "steps.0.to.stroke=6.0", "steps.1.increments=2", "output.frames=2",
    'element.name="ANS3DEAS"', "contacts.die.points=2", "contacts.punch.points=2",
]  # fmt: skip
MORE = """
[measures.edge]
kind = "draw_in"
edge = "x1"

[measures.on_points]
kind = "gauge"
points = [[0.0, 0.0, -0.5], [0.0, 1.0, -0.5], [20.0, 0.0, -0.5]]

[measures.from_punch]
kind = "distance"
tool = "punch"

[measures.forces]
kind = "forces"
control = "stroke"

[measures.strain]
kind = "map"
field = "major_lower"

[measures.hat]
kind = "springback"
heights = [0.5, 1.0, 1.5]
"""


def columns(path):
    with path.open() as file:
        rows = list(csv.DictReader(file))
    return {name: [row[name] for row in rows] for name in rows[0]}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A sheet that is bent into an open die and released, with all measures: its folder, and what was printed."""
    folder = tmp_path_factory.mktemp("bent")
    (folder / "deck.toml").write_text(template("unconstrained-bending") + MORE)
    changes = [word for change in SHORT for word in ("--set", change)]
    answer = CliRunner().invoke(app, ["run", str(folder / "deck.toml"), "--out", str(folder / "out"), *changes])
    assert answer.exit_code == 0, answer.output
    return folder / "out", answer.output


@pytest.fixture(scope="module")
def numbers(run):
    """Numbers by measure and quantity: formed, released, unit."""
    table = columns(run[0] / "measures.csv")
    rows = zip(*(table[key] for key in ("measure", "quantity", "formed", "released", "unit")), strict=True)
    return {(measure, quantity): tuple(rest) for measure, quantity, *rest in rows}


def test_each_measure_has_a_table_and_a_picture(run):
    folder, printed = run
    names = ("section", "from_die", "gauge", "edge", "on_points", "from_punch", "forces", "strain")
    for name in names:
        assert (folder / f"measure-{name}.csv").is_file()
        assert (folder / f"measure-{name}.png").read_bytes().endswith(b"IEND\xaeB`\x82")
        assert name in printed
    page = (folder / "report.html").read_text()
    assert page.count("<figure>") >= len(names) and "<h2>Measures</h2>" in page
    assert page.index("<h2>Measures</h2>") < page.index("<h2>History</h2>")


def test_a_part_that_is_no_hat_is_a_warning_and_the_rest_is_written(run):
    folder, printed = run
    assert "measure hat is left out: the section is no hat" in printed
    assert not (folder / "measure-hat.csv").exists()
    assert "measure hat is left out" in (folder / "report.html").read_text()


def test_numbers_are_those_of_the_functions(run, numbers):
    folder, _ = run
    with h5py.File(folder / "fields.vtkhdf") as file:
        group = file["VTKHDF"]
        steps, times = int(group["Steps"].attrs["NSteps"]), np.asarray(group["Steps/Values"])
        u = np.asarray(group["PointData/displacement"]).reshape(steps, -1, 3)
        field = np.asarray(group["PointData/distance_on_points"]).reshape(steps, -1)
        from_punch = np.asarray(group["PointData/distance_from_punch"]).reshape(steps, -1)
    changes = dict(change.split("=", 1) for change in SHORT)
    deck = load(folder.parent / "deck.toml", {key: _value(text) for key, text in changes.items()})
    mesh = deck.build().model.mesh
    X, loaded = mesh.points, int(np.flatnonzero(times == 1.0)[-1])
    history = columns(folder / "history.csv")
    unloaded = np.asarray(history["step"], dtype=float) == 2.0
    assert unloaded.sum() == 2
    cuts = {name: section(mesh, u[k], (0.0, 0.5, 0.0)) for name, k in (("formed", loaded), ("released", -1))}
    table = columns(folder / "measure-section.csv")
    for name, cut in cuts.items():
        np.testing.assert_allclose(numbers_of(table, f"{name}_lower_z"), cut.lower[:, 2], atol=1e-9)
    way = np.linalg.norm(cuts["released"].middle - cuts["formed"].middle, axis=1).max()
    assert float(numbers["section", "largest displacement by the release"][1]) == pytest.approx(way, rel=1e-9)
    assert way > 0.5
    # three points: the part is laid on nodes 0, ... of the whole part, and does not move there across the plane
    laid = np.asarray(columns(folder / "measure-on_points.csv")["distance"], dtype=float)
    np.testing.assert_allclose(field[-1], laid, atol=1e-9)
    assert laid[0] < 1e-9 < float(numbers["on_points", "largest distance from the gauge"][1])
    whole = [np.concatenate([x, x * [-1.0, 1.0, 1.0]]) for x in (X + u[-1], X + u[loaded])]
    best = lay_by_best_fit(*whole).largest
    assert float(numbers["gauge", "largest distance from the gauge"][1]) == pytest.approx(best, rel=1e-6)
    # the punch, a cylinder of radius 23.5 about y that has come down by the stroke
    stroke = float(numbers_of(history, "stroke")[-1])
    x = X + u[-1]
    radius = np.hypot(x[:, 0], x[:, 2] - (24.0 - stroke)) - 23.5
    half = mesh.connectivity.shape[1] // 2
    upper = mesh.connectivity[:, half:].ravel()
    lower = mesh.connectivity[:, :half].ravel()
    np.testing.assert_allclose(from_punch[-1][upper], np.minimum(radius[upper], radius[lower]), atol=1e-9)
    strain = forming_fields(mesh, u[-1])["major_lower"]
    assert float(numbers["strain", "largest major_lower"][1]) == pytest.approx(strain.max(), rel=1e-9)


def numbers_of(history, name):
    return np.asarray(history[name], dtype=float)


def _value(text):
    import tomllib

    return tomllib.loads(f"value = {text}")["value"]


def test_names_of_numbers_are_known_before_the_run(run, numbers):
    problem = load(run[0] / "as-run.toml")
    for (measure, quantity), (formed, released, _) in numbers.items():
        for state, value in {"formed": formed, "released": released}.items():
            assert may_report(problem.contents, f"{measure}.{quantity}.{state}") or not value
    for wrong in (
        "strain",
        "strain.largest",
        "strain.largest major_lower.releasd",
        "strain.mean.formed",
        "ears.x.formed",
    ):
        with pytest.raises(InvalidValue, match="no such quantity") as refused:
            uf.derivatives(problem, ["mesh.length"], of=[wrong], progress=False)
        assert "strain.largest *.formed; strain.largest *.released" in refused.value.remedy


def test_a_part_that_stays_in_its_tools_has_no_released_numbers():
    contents = load(template_file("dome")).contents
    assert not any("released" in name for name in names_begin(contents))


def test_forces_are_sizes_along_the_stroke_and_the_punch_pushes(run, numbers):
    history = columns(run[0] / "history.csv")
    loading = numbers_of(history, "step") < 2.0
    force = numbers_of(history, "stroke_force")[loading]
    assert force.max() > 0.0 and force.min() >= -1e-9
    np.testing.assert_allclose(force, numbers_of(history, "punch_fz")[loading], atol=1e-12)
    assert float(numbers["forces", "largest force of punch"][0]) == pytest.approx(force.max(), rel=1e-12)
    assert numbers["forces", "work of friction"][2] == "N mm" and numbers["edge", "draw-in, mean"][2] == "mm"
    curve = columns(run[0] / "measure-forces.csv")
    assert len(curve["stroke"]) == loading.sum()


PRESSED = """
[mesh]
generator = "strip"
length = 4.0
width = 1.0
thickness = 1.0
cells = [4, 1]
[material]
law = "SVK"
E = 1e3
nu = 0.0
[placement]
rotation = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]
[tools.plate]
shape = "Plane"
point = [0.5, 0.0, 0.0]
normal = "-x"
[contacts.plate]
tool = "plate"
faces = "upper"
[[supports]]
kind = "fix"
nodes = "lower"
[controls.press]
kind = "press"
contact = "plate"
direction = "-x"
[[steps]]
kind = "move"
to = { press = 12.0 }
increments = 2
[measures.forces]
kind = "forces"
control = "press"
"""


def test_forces_of_a_pressed_tool_are_those_along_its_direction():
    problem = Problem.read(PRESSED, "deck")
    prepared = problem.build()
    taken = Taken.of(problem, prepared, prepared.solve(progress=False), complete=True)
    numbers = {one.name: one.value for one in taken.quantities}
    assert numbers["forces.largest force of plate.formed"] == pytest.approx(12.0, rel=1e-9)


def test_a_measure_that_is_no_longer_asked_for_leaves_no_files(tmp_path):
    deck = tmp_path / "deck.toml"
    deck.write_text(template("dome"))
    words = ["run", str(deck), "--out", str(tmp_path / "out"), "--overwrite"]
    for change in ("steps.0.to.stroke=0.5", "mesh.cells=[1, 2]", "output.report=false", "output.vtkhdf=false"):
        words += ["--set", change]
    assert CliRunner().invoke(app, words).exit_code == 0
    assert (tmp_path / "out" / "measure-thinning.png").is_file()
    deck.write_text(template("dome").replace("[measures.thinning]", "[measures.map]"))
    assert CliRunner().invoke(app, words).exit_code == 0
    names = {file.name for file in (tmp_path / "out").iterdir()}
    assert {"measure-map.png", "measure-map.csv", "measures.csv"} <= names
    assert not {name for name in names if "thinning" in name}


@pytest.mark.parametrize(
    ("name", "measure", "what"),
    [
        ("wiping", 'kind = "distance"\ntool = "puncsh"', "there is no tool of this name"),
        ("wiping", 'kind = "forces"\ncontrol = "strok"', "there is no control of this name"),
        ("wiping", 'kind = "section"\npoint = [90.0, 0.0, 0.0]\nnormal = [1.0, 0.0, 0.0]', "does not cut the sheet"),
        ("wiping", 'kind = "section"\nnormal = [0.0, 0.0, 1.0]', "stands on the sheet"),
        ("wiping", 'kind = "springback"\nheights = [1.0, 2.0, -3.0]', "it should be greater than 0"),
        ("wiping", 'kind = "springback"\nheights = [3.0, 2.0, 1.0]', "rise from the bottom"),
        ("wiping", 'kind = "springback"\nheights = [1.0, 1.0, 2.0]', "rise from the bottom"),
        ("dome", 'kind = "draw_in"\nedge = "centre"', "nodes are no edge of the sheet"),
        ("wiping", 'kind = "gauge"\npoints = [[0, 0, 0], [9, 0, 0], [19, 0, 0]]', "are on a line"),
        ("wiping", 'kind = "draw_in"', "no node set of that name"),
        ("wiping", 'kind = "draw_in"\nedge = { min = [99.0, 0.0, 0.0] }', "this selects no node"),
        ("wiping", 'kind = "ears"\nrim = "x1"', "the rim of a cup goes around the z-axis"),
        ("wiping", 'kind = "sections"', "this kind is unknown"),
        ("wiping", 'kind = "gauge"\npoints = [[0, 0, 0], [0, 0, 0], [1, 1, 1]]', "three different points"),
        ("dome", 'kind = "gauge"', "laid into its gauge when it is released"),
    ],
)
def test_what_cannot_be_measured_is_refused_before_the_run(errors, name, measure, what):
    found = errors(template(name) + f"\n[measures.wrong]\n{measure}\n")
    assert len(found) == 1 and what in str(found[0])
    assert "measures.wrong" in str(found[0]) and found[0].remedy


def test_a_tool_without_contact_is_used_by_a_measure(found):
    text = template("wiping") + '\n[tools.ideal]\nshape = "Plane"\npoint = [0.0, 0.0, -0.5]\n'
    assert found(text, "tool ideal")
    assert not found(text + '[measures.ideal]\nkind = "distance"\ntool = "ideal"\n', "tool ideal")


@pytest.mark.parametrize(("name", "loading"), [("hat-rail", 2), ("air-bending", 1), ("cup", 2), ("dome", 1)])
def test_steps_at_the_end_release_the_part(name, loading):
    assert loading_steps(load(template_file(name)).contents) == loading


# Hats ---------------------------------------------------------------------------------------------------------


def hat(lean, *, side=1.0, down=1.0):
    """Half of a hat section in the plane of x and z whose wall leans outwards and whose flange is level."""
    rise = np.array([np.sin(np.radians(lean)), np.cos(np.radians(lean))])
    bottom = np.stack([np.linspace(0.0, 30.0, 31), np.zeros(31)], axis=1)
    wall = bottom[-1] + np.linspace(1.0, 60.0, 60)[:, None] * rise
    flange = wall[-1] + np.stack([np.linspace(1.0, 40.0, 40), np.zeros(40)], axis=1)
    return np.concatenate([bottom, wall, flange]) * [side, down]


def cut_of(line):
    middle = np.stack([line[:, 0], np.zeros(len(line)), line[:, 1]], axis=1)
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    half = np.array([0.0, 0.0, 0.5])
    return Section(s, middle - half, middle + half, np.zeros(len(s) - 1, dtype=bool))


@pytest.mark.parametrize(("side", "down"), [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0)])
def test_a_half_hat_on_any_side_of_its_plane_of_symmetry(side, down):
    line = hat(5.0, side=side, down=down)
    line = line if side > 0.0 else line[::-1]
    (half,) = halves(cut_of(line), horizontal((0.0, 1.0, 0.0)), [Mirror(0, 0.0)])
    angles = half.angles((15.0, 35.0, 55.0), "formed")
    assert (angles.theta1, angles.theta2) == pytest.approx((95.0, 95.0), abs=1e-6)  # the flange is level
    np.testing.assert_allclose(half.place(half.line[40]), hat(5.0, side=side, down=down)[40], atol=1e-12)


def test_both_halves_of_a_whole_hat():
    line = np.concatenate([hat(8.0, side=-1.0)[:0:-1], hat(3.0)])
    left, right = halves(cut_of(line), horizontal((0.0, -2.0, 0.0)), [])
    assert (left.side, right.side) == (", left", ", right")
    # the halves of the arc length differ from those of the bottom only where the walls differ in length
    assert left.angles((15.0, 35.0, 55.0), "formed").theta1 == pytest.approx(98.0, abs=1e-6)
    assert right.angles((15.0, 35.0, 55.0), "formed").theta1 == pytest.approx(93.0, abs=1e-6)


def test_a_section_that_is_no_hat():
    def half(line):
        return next(halves(cut_of(line), horizontal((0.0, 1.0, 0.0)), [Mirror(0, 0.0)]))

    with pytest.raises(InvalidValue, match="does not reach the heights") as caught:
        half(hat(5.0)[:60]).angles((15.0, 35.0, 55.0), "formed")
    assert "heights = [" in caught.value.remedy
    with pytest.raises(InvalidValue, match="no hat: it has no flange"):
        half(hat(0.0)[:91]).angles((15.0, 35.0, 55.0), "formed")
