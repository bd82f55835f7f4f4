"""Offset fields for a wanted shape: deviations of known shapes, few runs, punch and die follow alike, the command."""

import numpy as np
import pytest
from typer.testing import CliRunner

import umform as uf
from umform import cli
from umform.errors import InvalidValue
from umform.problem import Problem, load
from umform.report.symmetry import Mirror
from umform.studies.goals.deviation import SmoothFace, deviations
from umform.studies.goals.shape import _next
from umform.surfaces import Cylinder

#: Half of a strip, pressed between two cylinders and released.
DECK = """
[mesh]
generator = "strip"
length = 30.0
width = 1.0
thickness = 1.0
cells = [20, 1]
[material]
law = "J2"
E = 206e3
nu = 0.3
hardening = { curve = "Swift", strength = 565.3, offset = 0.0071, exponent = 0.259 }
[tools.die]
shape = "Cylinder"
centre = [0.0, 0.0, 59.5]
axis = "y"
radius = 60.0
inside = true
translation = [0.0, 0.0, -9.5]
offset_field = { along = ["x"], span = [[0, 30]], coefficients = [8] }
[tools.punch]
shape = "Cylinder"
centre = [0.0, 0.0, 59.5]
axis = "y"
radius = 59.0
translation = [0.0, 0.0, 1.5]
offset_field = { along = ["x"], span = [[0, 30]], coefficients = [8] }
[contacts.die]
tool = "die"
faces = "lower"
penalty = 3e3
points = 3
[contacts.punch]
tool = "punch"
faces = "upper"
penalty = 3e3
points = 3
may_bottom = true
[[supports]]
kind = "symmetry"
nodes = "x0"
normal = "x"
[[supports]]
kind = "fix"
nodes = { min = [-inf, -inf, -inf] }
directions = "y"
[[supports]]
kind = "rigid"
name = "gauge"
nodes = "x0"
[controls.stroke]
kind = "tool"
contact = "punch"
direction = "-z"
[[steps]]
kind = "move"
to = { stroke = 11.0 }
increments = 30
[[steps]]
kind = "free"
contacts = ["die", "punch"]
on = "gauge"
increments = 5
"""


def bent(mesh, radius):
    """A flat mesh bent to a circle about an axis along y, above."""
    angle, r = mesh.points[:, 0] / radius, radius - mesh.points[:, 2]
    return np.c_[r * np.sin(angle), mesh.points[:, 1], radius - r * np.cos(angle)]


@pytest.mark.parametrize(("faces", "out"), [("upper", -1.0), ("lower", 1.0)])
def test_deviations_are_those_of_the_surface_not_of_its_points(faces, out):
    """A strip moved along itself deviates by nothing, one of another radius by the difference of the circles."""
    mesh, planes = uf.mesh.strip(20.0, 2.0, 0.5, (20, 1)), [Mirror(0, 0.0)]
    face = SmoothFace.of(mesh, faces, bent(mesh, 12.0), planes)
    shifted = mesh.transformed(lambda x: x * np.array([0.98, 1.0, 1.0]))
    slid = deviations(bent(shifted, 12.0)[face.nodes], face.points, face.gap, planes)
    assert np.abs(slid).max() < 2e-4  # facets alone would deviate by 1^2/(8 12) = 0.01
    wider = bent(mesh, 12.5)[face.nodes]
    found = deviations(wider + np.array([0.0, 0.0, 3.0]), face.points, face.gap, planes)
    radius = np.hypot(wider[:, 0], wider[:, 2] - 12.5).mean()
    own = np.hypot(face.points[:, 0], face.points[:, 2] - 12.0).mean()
    shift = np.linspace(-1.5, 1.5, 20001)  # of the centre along z; the best of all
    x = wider[:, None, :] - [0.0, 0.0, 12.5]
    true = np.hypot(x[..., 0], x[..., 2] + shift) - own
    best = true[:, (true**2).sum(axis=0).argmin()]
    np.testing.assert_allclose(found, out * best, atol=2e-3)
    assert radius - own == pytest.approx(0.5, abs=1e-6)


def test_three_runs_of_a_linear_part_with_two_modes_reach_its_shape():
    """Broyden's method for all runs: exact when they span the deviations."""
    rng = np.random.default_rng(3)
    modes = np.linalg.qr(rng.normal(size=(40, 2)))[0]
    effect = np.eye(40) + modes @ np.diag([0.4, -0.3]) @ modes.T
    wrong = modes @ [1.0, 2.0]
    offsets, found = [np.zeros(40)], [wrong]
    for _ in range(3):
        offsets.append(_next(offsets, found, 1.0))
        found.append(wrong + effect @ offsets[-1])
    assert np.linalg.norm(found[1]) == pytest.approx(np.hypot(0.4, 0.6))
    assert np.linalg.norm(found[3]) < 1e-9


def test_a_pressed_strip_has_its_shape_in_four_runs(tmp_path):
    deck = tmp_path / "strip.toml"
    deck.write_text(DECK)
    found = uf.compensate_shape(load(deck), "upper", ["die", "punch"])
    assert found.reached
    assert len(found.trials) <= 4
    assert found.trials[0].largest > 0.3
    assert found.best.largest < 0.1 * found.trials[0].largest
    assert found.best.rms < found.best.largest
    # both tools move alike: what one gains the other loses
    die, punch = (np.array(found.fields[name].values) for name in ("die", "punch"))
    np.testing.assert_allclose(die, -punch, atol=0.1 * np.abs(die).max())
    table, deviation, written = found.write(tmp_path / "out")
    assert len(table.read_text().splitlines()) == 1 + len(found.trials)
    assert len(deviation.read_text().splitlines()) == 1 + len(found.points)
    # the deck that is written has this shape
    again = uf.compensate_shape(
        load(written), "upper", ["die"], wanted=_wanted(found), within=1.5 * found.best.largest, most=1
    )
    assert again.trials[0].largest == pytest.approx(found.best.largest, rel=0.5)


def _wanted(found):
    """The circle of the strip in the tools of the first run, which a surface gives."""
    x, z = found.points[:, 0], found.points[:, 2]
    rows = np.c_[2 * z, np.ones_like(z)]
    centre, rest = np.linalg.lstsq(rows, x**2 + z**2, rcond=None)[0]
    return Cylinder((0.0, 0.0, centre), "y", float(np.sqrt(rest + centre**2)), inside=True)


def test_the_command(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "strip.toml").write_text(DECK)
    given = ["compensate", "strip.toml", "--shape", "upper", "--by", "die", "--by", "punch", "--runs", "1"]
    done = CliRunner().invoke(cli.app, [*given, "--set", "mesh.cells=[10, 1]", "--set", "steps.0.increments=16"])
    assert done.exit_code == 1  # one run is not enough
    assert "largest deviation" in done.output
    assert (tmp_path / "results/strip-compensated/deviations.csv").exists()
    both = CliRunner().invoke(cli.app, [*given, "--want", "angle=90+-1"])
    assert both.exit_code != 0
    assert "either results or a shape" in both.output


def test_what_cannot_be_compensated_is_refused():
    problem = Problem.read(DECK)
    with pytest.raises(InvalidValue, match="no tool of this name"):
        uf.compensate_shape(problem, "upper", ["dye"])
    with pytest.raises(InvalidValue, match="needs tools with offset fields"):
        uf.compensate_shape(lambda: None, "upper", ["die"])
    for name, values in {"within": (-1.0, "a"), "most": (0, 1.5), "factor": (0.0, np.nan), "wanted": ("x",)}.items():
        for value in values:
            with pytest.raises(InvalidValue) as refused:
                uf.compensate_shape(problem, "upper", "die", **{name: value})
            assert refused.value.where == name
    short = {"mesh.cells": [6, 1], "steps.0.increments": 12, "steps.0.to.stroke": 2.0}
    held = Problem.read(DECK.partition('[[steps]]\nkind = "free"')[0]).with_(short)
    with pytest.raises(InvalidValue, match="the part is not released"):
        uf.compensate_shape(held, "upper", ["die"])
    none = Problem.read(DECK.replace("offset_field =", "#", 1)).with_(short)
    with pytest.raises(InvalidValue, match="a tool has no offset field"):
        uf.compensate_shape(none, "upper", ["die"])
