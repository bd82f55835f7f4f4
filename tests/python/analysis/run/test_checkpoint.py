"""Runs that are killed, interrupted or stopped anywhere, and go on to the same bits as if nothing had happened."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import umform
from umform import materials as mt
from umform.analysis.newton.newton import Newton
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.newton.recorder import Recorder
from umform.analysis.run import Result, resume, solve
from umform.analysis.steps import Arc, Move, Release
from umform.io.atomic import PendingFile
from umform.io.trees import read_tree, write_tree
from umform.mesh import strip, together
from umform.model import Body, Model
from umform.solvers import pardiso
from umform.surfaces import Cylinder, Plane, Sphere

needs_mkl = pytest.mark.skipif(not pardiso.available(), reason="MKL is not installed")


def bending(cells=(8, 1), kappa=175e3, penalty=100.0, stroke=-5.0, radius=20.0):
    """A strip of J2 bent over a cylinder and released."""
    material = mt.J2(kappa=kappa, mu=80.77e3, hardening=mt.Linear(160.0, 500.0))
    model = Model(strip(60.0, 10.0, 1.0, cells), material=material)
    model.symmetry("x0", normal="x")
    model.symmetry(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), normal="y")
    punch = model.prescribe("x0_lower", "z", "punch")
    tool = Cylinder(centre=(25.0, 0.0, -radius - 0.5), axis="y", radius=radius)
    model.contact("lower", tool, penalty=penalty, name="tool")
    return model, [Move(punch, stroke, steps=10), Release(punch, tolerance=1e-9)], {"solver": "banded", "frames": 4}


def moves():
    """Bent in moves that go on from each other along parabolas."""
    model, (move, release), options = bending()
    parts = [replace(move, to=to, steps=steps) for to, steps in ((-1.0, 3), (-2.0, 2), (-2.5, 1), (-4.0, 4))]
    return model, [*parts, release], options | {"options": NewtonOptions(extrapolate=2)}


def cut():
    """The same in increments that fail and are cut, along a function of time."""
    model, (move, release), options = bending()
    move = replace(move, to=lambda fraction: -4.0 * fraction**1.5, steps=3, grow=2.0)
    return model, [move, release], options | {"options": NewtonOptions(max_iterations=7)}


def bar():
    """Stretched and released past zero, so that the zero is closed in on from both sides; and stretched again."""
    material = mt.J2(kappa=175e3, mu=80770.0, hardening=mt.Linear(160.0, 500.0))
    model = Model(strip(1.0, 0.5, 0.4, (1, 1)), "EAS3DEAS", material=material)
    for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(face, normal=normal)
    pull = model.prescribe("x1", "x", "pull")
    return model, [Move(pull, 0.2, steps=5), Release(pull, increment=5e-3), Move(pull, 0.3, steps=3)], {}


def block():
    """Pressed on a plane and released until it lifts off: the zero of the force is closed in on, increment by half."""
    model = Model(strip(1.0, 1.0, 0.5, (1, 1)), material=mt.NeoHooke(E=1000.0, nu=0.3))
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    press = model.prescribe("upper", "z", "press")
    model.contact("lower", Plane((0, 0, -0.25)), penalty=1e4, name="die")
    return model, [Move(press, -0.05, steps=3), Release(press)], {}


def arch():
    """Half of a shallow arch that snaps through under a force, in two arcs of each kind."""
    mesh = strip(10.0, 1.0, 0.8, (4, 1)).transformed(lambda x: x + [0.0, 0.0, 0.6] * (1 - x[:, :1] / 10.0))
    model = Model(mesh, material=mt.SVK(E=1000.0, nu=0.0))
    model.hinge("x1", "xz")
    model.hinge("x0", "x")
    for side in ("y0", "y1"):
        model.symmetry(side, "y")
    nodes = mesh.nodes("x0")
    load = model.force(nodes, (0.0, 0.0, -1.0 / len(nodes)), "load")
    steps = [Arc(load, 0.2, increment=0.5, kind="spherical"), Arc(load, 1.0, increment=0.5, cuts=6)]
    return model, steps, {"solver": "superlu", "frames": 7, "options": NewtonOptions(max_iterations=6)}


def rubbed():
    """A strip under a holder that a force presses, drawn over two dies with friction, back and forth."""
    material = mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.Linear(160.0, 500.0))
    model = Model(strip(30.0, 2.0, 1.0, (12, 1)), material=material)
    model.symmetry("y0", "y")
    pull = model.prescribe("x1", "x", "pull")
    bump = Cylinder(centre=(10.0, 0.0, -5.49), axis="y", radius=5.0)
    model.contact("lower", bump, penalty=1e3, points=3, friction=0.2, name="die")
    model.contact("lower", Cylinder((28.0, 0.0, -5.49), "y", 5.0), penalty=1e3, points=3, friction=0.1, name="bed")
    lid = model.contact(
        "upper",
        Plane((0, 0, 0.5), (0, 0, -1)),
        penalty=50.0,
        penetration=0.01,
        augmented=True,
        friction=0.1,
        name="lid",
    )
    force = model.press(lid, "z", "force")
    return model, [Move(force, -8.0, steps=2), Move(pull, 0.3, steps=4), Move(pull, 0.1, steps=3)], {"frames": 3}


def beaded():
    """A strip on a bed under a lid, drawn through a bead and back."""
    model = Model(strip(30.0, 2.0, 1.0, (12, 1)), material=mt.NeoHooke(E=1e4, nu=0.3))
    model.symmetry("y0", "y")
    pull = model.prescribe("x1", "x", "pull")
    bed = model.contact("lower", Plane((0, 0, -0.5)), penalty=1e3, name="bed")
    model.contact("upper", Plane((0, 0, 0.5), (0, 0, -1)), penalty=1e3, name="lid")
    model.bead("lower", bed, [(9, -9, -0.5), (10, 9, -0.5)], restraint=30.0, uplift=5.0, width=6.0, name="bead")
    return model, [Move(pull, 1.0, steps=4), Move(pull, 0.5, steps=4)], {"frames": 3}


def kept():
    """A clamped sheet and a sphere, with a penalty that grows to keep the allowed penetration."""
    material = mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.Linear(160.0, 500.0))
    model = Model(strip(20.0, 20.0, 1.0, (3, 3)), material=material)
    for side, normal in (("x0", "x"), ("y0", "y")):
        model.symmetry(side, normal)
        model.fix(side.replace("0", "1"))
    ball = model.contact("upper", Sphere(centre=(0, 0, 12.5), radius=12.0), friction=0.1, name="ball")
    return model, [Move(model.drive(ball, "z", "punch"), -2.0, steps=6)], {"frames": 3}


def celled():
    """A strip bent over a die with friction and a bare one, both over cells, and let go again."""
    material = mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.Linear(160.0, 500.0))
    model = Model(strip(30.0, 2.0, 1.0, (12, 1)), material=material)
    model.symmetry("y0", "y")
    model.symmetry("x0", "x")
    punch = model.prescribe("x0_lower", "z", "punch")
    model.contact("lower", Cylinder((9.0, 0.0, -5.5), "y", 5.0), penalty=500.0, cells=3, friction=0.2, name="die")
    lid = Cylinder((25.0, 0.0, 5.4), "y", 5.0)
    model.contact("upper", lid, penalty=50.0, penetration=0.01, augmented=True, cells=2, name="lid")
    return model, [Move(punch, -2.0, steps=5), Move(punch, -1.5, steps=3)], {"frames": 3}


def pressed():
    """A clamped plate under a follower pressure, then pushed by a tool that moves and turns."""
    mesh = strip(4.0, 1.0, 0.2, (3, 1), cell="hex18")
    model = Model(mesh, "MI9K3DEAS", material=mt.NeoHooke(E=1e4, nu=0.3))
    model.fix("x0")
    pressure = model.pressure("lower")
    contact = model.contact("upper", Plane((0.0, 0.0, 0.4), (0.0, 0.0, -1.0)), penalty=500.0, name="lid")
    model.set_motion(contact, lambda time: (np.zeros(3), np.array([0.0, 0.02 * time, 0.0])))
    ram = model.drive(contact, "z", "ram")
    return model, [Move(pressure, 0.1, steps=3), Move([ram, pressure], [-0.2, 0.12], steps=3)], {"frames": 2}


def elastic():
    """A thin strip under a load and a pressure, which begins with kept tangents, then with extrapolations."""
    model = Model(strip(10.0, 1.0, 0.1, (12, 1)), material=mt.SVK(E=1e5, nu=0.3))
    model.fix("x0")
    nodes = model.mesh.nodes("x1")
    load, pressure = model.force(nodes, (0.0, 0.0, 1.0 / len(nodes)), "load"), model.pressure("lower")
    return model, [Move([load, pressure], [0.5, 0.01], steps=4), Move(load, 4.0, steps=3)], {"frames": 3}


def metals():
    """Metals with back stresses, a modulus that falls, a rate over the time of the step, and with two surfaces."""
    steel, hill = {"E": 206e3, "nu": 0.3}, mt.Hill48(1.8, 1.5, 2.2)
    dull = mt.Metal(
        **steel,
        hardening=mt.Voce(180.0, 330.0, 14.0),
        yield_function=hill,
        back_stress=mt.Chaboche([(4000.0, 80.0), (600.0, 6.0)]),
        modulus=mt.FallingModulus(saturated=160e3, rate=30.0),
        rate=mt.CowperSymonds(reference=40.0, exponent=5.0),
    )
    surfaces = mt.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)
    bounded = mt.Metal(**steel, hardening=mt.Perfect(124.0), yield_function=hill, back_stress=surfaces)
    bodies = [
        Body(material=dull, cells=lambda x, y, z: x < 4.0, name="dull", rolling=(1.0, 0.5, 0.0)),
        Body(material=bounded, cells=lambda x, y, z: x > 4.0, name="bounded", rolling=(0.0, 1.0, 0.0)),
    ]
    model = Model(strip(8.0, 4.0, 1.0, (4, 1)), bodies=bodies)
    model.fix("x0")
    tip = model.prescribe("x1", "z", "tip")
    return model, [Move(tip, 0.8, steps=4, time=0.01), Move(tip, 0.2, steps=3, time=2.0)], {"frames": 3}


def multiplied():
    """The same with multipliers, over cells."""
    return stacked(augmented=True, penetration=0.001, penalty=1e3, cells=3)


def stacked(**rule):
    """Two strips of other meshes, pressed on each other and bent together, which slip on each other back and forth."""
    lower = strip(20.0, 2.0, 1.0, (10, 1))
    upper = strip(20.0, 2.0, 0.8, (13, 1)).moved((0.0, 0.0, 0.9))
    material = mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.Linear(160.0, 500.0))
    model = Model(together(a=lower, b=upper), material=material)
    model.sheet_contact("upper of a", "lower of b", name="stack", friction=0.15, **rule)
    for sheet in "ab":
        model.fix(f"x0 of {sheet}")
    pressures = [model.pressure("lower of a", "below"), model.pressure("upper of b", "above")]
    end = model.prescribe("x1 of b", "z", "end")
    return (
        model,
        [Move(pressures, [2.0, 2.0], steps=1), Move(end, -3.0, steps=4), Move(end, -2.0, steps=4)],
        {"frames": 3},
    )


def folded():
    """A strip with half a turn, whose shorter flank is pushed onto the other one, and along it; over cells."""

    def turned(X):
        s, y, z = X[:, 0], X[:, 1], X[:, 2]
        angle, beyond = np.clip((s - 5.0) / 0.9, 0.0, np.pi), np.maximum(s - 5.0 - 0.9 * np.pi, 0.0)
        x = np.minimum(s, 5.0) - beyond + (0.9 - z) * np.sin(angle)
        return np.column_stack([x, y, 0.9 - (0.9 - z) * np.cos(angle)])

    material = mt.J2(kappa=175e3, mu=80.77e3, hardening=mt.Linear(160.0, 500.0))
    model = Model(strip(8.0 + 0.9 * np.pi, 2.0, 1.0, (20, 1)).transformed(turned), material=material)
    model.self_contact("upper", name="inside", friction=0.1, cells=3)
    model.fix("x0")
    end, along = model.prescribe("x1", "z", "end"), model.prescribe("x1", "x", "along")
    return model, [Move(end, -1.2, steps=5), Move(along, 0.1, steps=3), Move(along, 0.05, steps=2)], {"frames": 3}


@pytest.fixture
def assert_the_same(same_state):
    """Bit by bit, but for the seconds."""

    def check(model, result, other, expected):
        assert same_state(model.system.snapshot(), other.system.snapshot())
        assert_the_same_results(result, expected)

    return check


def assert_the_same_results(result, expected):
    assert result.columns() == expected.columns()
    for column in expected.columns():
        np.testing.assert_array_equal(result[column], expected[column], err_msg=column)
        assert result[column].dtype == expected[column].dtype

    def records(run):
        return [[replace(record, seconds=0.0) for record in increment] for increment in run.iterations]

    assert records(result) == records(expected)
    assert (result.events, result.warnings, result.solver) == (expected.events, expected.warnings, expected.solver)
    assert len(result.frames) == len(expected.frames)
    for one, two in zip(result.frames, expected.frames, strict=True):
        assert (one.number, one.time) == (two.number, two.time)
        np.testing.assert_equal((one.points, one.cells), (two.points, two.cells))
        assert list(one.contacts) == list(two.contacts)
        for name in one.contacts:
            np.testing.assert_equal(vars(one.contacts[name]), vars(two.contacts[name]))
    np.testing.assert_equal(vars(result.balance()), vars(expected.balance()))


# The same bits ----------------------------------------------------------------------------------------------


BUILDS = (bending, moves, cut, bar, block, arch, pressed, rubbed, celled, beaded, elastic, metals)


@pytest.mark.parametrize("build", [*BUILDS, kept, stacked, multiplied, folded])
def test_a_run_goes_on_from_any_place_to_the_same_bits(build, copies, tmp_path, assert_the_same):
    model, steps, options = build()
    expected = solve(model, steps, **options)
    watched, steps, options = build()
    assert_the_same(watched, solve(watched, steps, **options, checkpoint=tmp_path / "run.h5", every=0), model, expected)
    places = list(copies)
    assert len(places) >= len(expected)
    for place in places[:: max(1, len(places) // 3)] + places[-1:]:
        again, steps, options = build()
        result = resume(place, again, steps, **options, every=1e9)
        assert_the_same(again, result, model, expected)
        assert result.seconds > 0


def test_the_cases_are_cut_touched_lifted_and_snap_through(caplog):
    """What the tests above are about does happen."""
    caplog.set_level("INFO", logger="umform")
    model, steps, options = cut()
    result = solve(model, steps, **options)
    assert np.diff(result["time"][result["step"] == 1]).min() < 0.1  # and not a third
    assert "increment cut" in caplog.text
    model, steps, options = bending()
    assert "lifted off" in solve(model, steps, **options).events[0]
    model, steps, options = bar()
    assert "the force is zero" in solve(model, steps, **options).events[0]
    model, steps, options = arch()
    events = " ".join(solve(model, steps, **options).events)
    assert "maximum of the load" in events
    assert "minimum of the load" in events
    assert "arc length cut" in caplog.text
    model, steps, options = pressed()
    active = solve(model, steps, **options)["lid_active"]
    assert active[0] == 0 < active[-1]
    model, steps, options = stacked()
    slipping = solve(model, steps, **options)["stack_slipping"]
    assert slipping.max() > slipping[6:].min() + 10  # there, and back again
    model, steps, options = folded()
    result = solve(model, steps, **options)
    assert result["inside_active"][4] == 0 < result["inside_active"][-1]
    assert model.system.penalised[0].penalty > model.system.penalised[0].initial_penalty


@pytest.mark.parametrize("solver", ["multifrontal", "superlu", pytest.param("pardiso", marks=needs_mkl)])
def test_other_solvers_too(solver, copies, tmp_path, assert_the_same):
    def run(go, *where, **more):
        model, steps, options = bending()
        return model, go(*where, model, steps, **options | {"solver": solver}, **more)

    model, expected = run(solve, checkpoint=tmp_path / "run.h5", every=0)
    for place in copies[2::5]:
        assert_the_same(*run(resume, place, every=1e9), model, expected)


def test_the_blocks_of_the_last_evaluation_are_those_of_the_history_that_it_had_read(copies, tmp_path, monkeypatch):
    """Evaluated from the history that the increment has left behind, the same state gives other blocks."""
    model, steps, options = bending()
    expected = solve(model, steps, **options, checkpoint=tmp_path / "run.h5", every=0)
    tree = read_tree(copies[4], "checkpoint of umform")
    sheet = "body sheet"
    left_behind = tree["model"]["terms"][sheet]["history"]
    assert not np.array_equal(tree["before"][sheet], left_behind)
    tree["before"][sheet] = left_behind
    write_tree(copies[4], tree, "checkpoint of umform")
    again, steps, options = bending()
    result = resume(copies[4], again, steps, **options)
    assert not np.array_equal(result["punch_force"], expected["punch_force"])
    np.testing.assert_allclose(result["punch_force"][:7], expected["punch_force"][:7], rtol=1e-6, atol=1e-9)


def test_a_run_at_its_end_has_nothing_left_to_do(tmp_path, monkeypatch, assert_the_same):
    path = tmp_path / "run.h5"
    model, steps, options = bending()
    expected = solve(model, steps, **options, checkpoint=path)
    monkeypatch.setattr(Newton, "solve", None)
    again, steps, options = bending()
    assert_the_same(again, resume(path, again, steps, **options), model, expected)


# Killed -----------------------------------------------------------------------------------------------------


def run_until_killed(path: str, increment: int, writing: bool) -> None:
    """In a process of its own: kill -9 in an increment, or before the checkpoint after it takes its name."""
    add, record, commit = Result.add, Recorder.add, PendingFile.commit
    rows = []

    def counted(self, *arguments, **more):
        add(self, *arguments, **more)
        rows.append(len(self))

    def kill_in_the_second_iteration(self, *arguments):
        record(self, *arguments)
        if not writing and len(rows) > increment and len(self.iterations) == 2:
            os.kill(os.getpid(), signal.SIGKILL)

    def kill(self):
        if writing and len(rows) > increment + 1:
            os.kill(os.getpid(), signal.SIGKILL)
        commit(self)

    Result.add, Recorder.add, PendingFile.commit = counted, kill_in_the_second_iteration, kill
    model, steps, options = bending()
    solve(model, steps, **options, checkpoint=path, every=0)


@pytest.mark.parametrize(("increment", "writing"), [(0, False), (3, False), (12, False), (3, True)])
def test_a_process_that_is_killed_leaves_a_checkpoint_that_goes_on_to_the_same_bits(
    increment, writing, tmp_path, assert_the_same
):
    """In the first increment, on the way, in the release, and while a checkpoint is written."""
    path = tmp_path / "run.h5"
    command = f"import test_checkpoint as t; t.run_until_killed({str(path)!r}, {increment}, {writing})"
    environment = os.environ | {"PYTHONPATH": str(Path(umform.__file__).parents[1])}
    process = subprocess.run([sys.executable, "-c", command], cwd=Path(__file__).parent, env=environment, timeout=120)
    assert process.returncode == -signal.SIGKILL
    assert rows_in(path) == increment + 1
    model, steps, options = bending()
    expected = solve(model, steps, **options)
    again, steps, options = bending()
    assert_the_same(again, resume(path, again, steps, **options), model, expected)


def rows_in(path):
    """Number of converged states that a checkpoint holds."""
    return len(read_tree(path, "checkpoint of umform")["result"]["history"][0])


# Ctrl-C -----------------------------------------------------------------------------------------------------


@pytest.fixture
def interrupted(monkeypatch):
    """Let Ctrl-C come, as often as asked, in the first iteration after a number of rows."""
    record, add, rows, pending = Recorder.add, Result.add, [], []

    def counted(self, *arguments, **more):
        add(self, *arguments, **more)
        rows.append(len(self))

    def interrupt(self, *arguments):
        record(self, *arguments)
        while pending and rows[-1] == pending[0]:
            pending.pop(0)
            signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr(Result, "add", counted)
    monkeypatch.setattr(Recorder, "add", interrupt)
    return lambda rows, times: pending.extend([rows] * times)


@pytest.mark.parametrize("rows", [1, 4, 12])
def test_the_first_interrupt_ends_the_run_after_the_increment(rows, tmp_path, interrupted, assert_the_same):
    model, steps, options = bending()
    expected = solve(model, steps, **options)
    path = tmp_path / "run.h5"
    interrupted(rows, 1)
    stopped, steps, options = bending()
    with pytest.raises(KeyboardInterrupt, match="resume") as caught:
        solve(stopped, steps, **options, checkpoint=path, every=1e9)
    result = caught.value.result
    assert len(result) == rows + 1
    for column in expected.columns():
        np.testing.assert_array_equal(result[column], expected[column][: rows + 1])
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    again, steps, options = bending()
    assert_the_same(again, resume(path, again, steps, **options), model, expected)


def test_an_interrupt_in_an_increment_that_fails_comes_before_the_next_try(tmp_path, interrupted, assert_the_same):
    model, steps, options = cut()
    expected = solve(model, steps, **options)
    path = tmp_path / "run.h5"
    interrupted(1, 1)  # the first increment is cut
    stopped, steps, options = cut()
    with pytest.raises(KeyboardInterrupt) as caught:
        solve(stopped, steps, **options, checkpoint=path)
    assert len(caught.value.result) == rows_in(path) == 1
    assert not stopped.u.any()
    again, steps, options = cut()
    assert_the_same(again, resume(path, again, steps, **options), model, expected)


def test_the_second_interrupt_ends_the_run_at_once(tmp_path, interrupted):
    interrupted(4, 2)
    model, steps, options = bending()
    with pytest.raises(KeyboardInterrupt) as caught:
        solve(model, steps, **options, checkpoint=tmp_path / "run.h5", every=0)
    result = caught.value.result
    assert len(result) == 4
    assert model.system.time == result["time"][-1]
    np.testing.assert_array_equal(model.u[model.controls[0].dofs], result["punch"][-1])
    assert rows_in(tmp_path / "run.h5") == 4


def test_without_a_checkpoint_too(interrupted):
    interrupted(2, 1)
    model, steps, options = bending()
    with pytest.raises(KeyboardInterrupt) as caught:
        solve(model, steps, **options)
    assert len(caught.value.result) == 3


def test_a_run_in_another_thread_leaves_signals_alone():
    model, steps, options = bending()
    lengths = []
    thread = threading.Thread(target=lambda: lengths.append(len(solve(model, steps[0], **options))))
    thread.start()
    thread.join()
    assert lengths == [11]
