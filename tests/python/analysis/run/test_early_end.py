"""A run that ends early: frame, history and checkpoint are of the same state, and the remedy works."""

import signal

import numpy as np
import pytest

import umform as uf
from umform.analysis.run.open_run import OpenRun
from umform.errors import NoConvergence


class Broken(Exception):
    """A failure in a function of a user."""


#: Times at which the function of the user fails, or Ctrl-C is pressed.
WHEN = {"fails": np.inf, "stops": np.inf}


def motion(time):
    """The motion of a tool, which stays."""
    if time > WHEN["fails"]:
        raise Broken
    if time > WHEN["stops"]:
        WHEN["stops"] = np.inf  # once: the second Ctrl-C ends at once
        signal.raise_signal(signal.SIGINT)
    return np.zeros(3)


def strip():
    """An elastic strip that is pulled, and a tool far away whose motion is a function of a user."""
    model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (4, 1)), material=uf.SVK(E=1e3, nu=0.3))
    model.fix("x0")
    pull = model.prescribe("x1", "x", "pull")
    tool = model.tool("far", uf.Plane((0.0, 0.0, -9.0), "z"))
    model.contact("lower", tool, penalty=1.0)
    model.set_motion(tool, motion)
    return model, uf.Move(pull, 1.0, steps=10)


def of_one_state(result, model):
    frame = result.frames[-1]
    assert frame.number == len(result) - 1 and frame.time == result["time"][-1] == model.system.time
    np.testing.assert_array_equal(frame.points["displacement"].ravel(), model.u)
    return result["pull"][-1]


@pytest.mark.parametrize(("what", "time"), [("fails", 0.65), ("stops", 0.55)])
def test_frame_history_and_checkpoint_agree(tmp_path, monkeypatch, what, time):
    whole = uf.solve(*strip(), frames=2, progress=False)
    monkeypatch.setitem(WHEN, what, time)
    model, move = strip()
    with pytest.raises((Broken, KeyboardInterrupt)) as caught:
        uf.solve(model, move, frames=2, progress=False, checkpoint=tmp_path / "c.h5", every=1e6)
    assert of_one_state(caught.value.result, model) == pytest.approx(0.6)
    monkeypatch.setitem(WHEN, what, np.inf)
    again, move = strip()
    resumed = uf.resume(tmp_path / "c.h5", again, move, frames=2, progress=False)
    assert resumed.seconds >= 0.0 and [frame.number for frame in resumed.frames] == [f.number for f in whole.frames]
    np.testing.assert_array_equal(resumed["pull_force"], whole["pull_force"])


def test_steps_of_an_open_run_agree_too(monkeypatch):
    monkeypatch.setitem(WHEN, "fails", 0.65)
    model, move = strip()
    run = OpenRun(model, frames=2)
    with pytest.raises(Broken):
        run.take(move)
    assert of_one_state(run.result, model) == pytest.approx(0.6)


def bulge(radius=50.0, cells=(2, 2)):
    """A quarter of a clamped disc under pressure; the wall thins faster than the metal hardens."""
    metal = uf.J2(E=70e3, nu=0.33, hardening=uf.Voce(125.95, 314.98, 12.22))
    model = uf.Model(uf.mesh.disc(radius, 1.0, cells, part="quarter"), "ANS3DEAS", material=metal)
    model.symmetry("x0", "x")
    model.symmetry("y0", "y")
    model.fix("rim")
    return model, model.pressure("lower", "p")


def test_beyond_the_largest_pressure_the_arc_is_named_and_works():
    model, p = bulge()
    with pytest.raises(NoConvergence) as caught:
        uf.solve(model, uf.Move(p, 20.0, steps=40), frames=5, progress=False)
    error, reached = caught.value, caught.value.result["p"][-1]
    assert "a maximum of the load" in error.cause and "inside out" not in error.cause
    assert "the step Arc" in error.remedy and "to = { p = ... }" in error.remedy
    assert caught.value.result.frames[-1].number == len(caught.value.result) - 1
    model, p = bulge()
    values = []

    def falls(value):
        """All falls of the pressure so far."""
        values.append(value)
        return [k for k in range(1, len(values)) if values[k] < values[k - 1]]

    arc = uf.Arc(p, 20.0, increment=0.05, until=lambda model: len(falls(p.value)) > 1)
    passed = uf.solve(model, arc, frames=0, progress=False)
    assert any("a maximum of the load" in event for event in passed.events)
    assert passed["p"].max() == pytest.approx(reached, rel=0.02)


@pytest.mark.parametrize("arc", [False, True])
def test_a_mesh_too_coarse_for_the_maximum_is_named_by_its_thinning(arc):
    """One element carries more than the sheet does, until it is turned inside out while the load still rises."""
    model, p = bulge(20.0, (1, 1))
    step = uf.Arc(p, 60.0, increment=0.05) if arc else uf.Move(p, 60.0, steps=20)
    with pytest.raises(NoConvergence) as caught:
        uf.solve(model, step, frames=0, progress=False)
    error, result = caught.value, caught.value.result
    assert result["p"].argmax() == len(result) - 1
    loss = float(error.cause.split("has lost ")[1].split(" %")[0])
    assert loss == pytest.approx(-100.0 * uf.fields.thickness_change(model).min(), abs=0.5)
    assert "maximum of the load" not in error.cause and "more elements where it thins" in error.remedy


def test_an_arc_that_ends_behind_the_largest_pressure_names_it():
    model, p = bulge(20.0, (3, 3))
    with pytest.raises(NoConvergence) as caught:
        uf.solve(model, uf.Arc(p, 60.0, increment=0.05), frames=0, progress=False)
    cause, largest = caught.value.cause, caught.value.result["p"].max()
    assert caught.value.result["p"][-1] < largest
    assert f"had passed the maximum of the load near p = {largest:.6g}" in cause


def test_a_failure_below_the_largest_load_names_no_arc():
    """Eight iterations are too few for the first increments of a plate: nothing gives way."""
    model, p = bulge()
    options = uf.NewtonOptions(max_iterations=1)
    with pytest.raises(NoConvergence) as caught:
        uf.solve(model, uf.Move(p, 4.0, steps=2, cuts=1), options=options, frames=0, progress=False)
    assert "maximum of the load" not in caught.value.cause
