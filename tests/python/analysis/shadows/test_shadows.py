"""Shadows of a run: what they leave alone, what they keep, and what they say when they are lost."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.augmentation import augmented
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run import resume, solve
from umform.analysis.shadows import resume_with_shadows, solve_with_shadows
from umform.analysis.shadows.group import Shadows
from umform.analysis.shadows.shadow import Shadow
from umform.analysis.steps import increment
from umform.errors import FileProblem, InvalidValue
from umform.results.records import Failed

TIGHT = NewtonOptions(residual=1e-12, increment=1e-9, max_iterations=60)


def bending(Y=160.0, R=20.0, cells=8, **moved):
    """A strip drawn over a cylinder with friction and let go."""
    material = uf.J2(kappa=175e3, mu=80.77e3, hardening=uf.Linear(Y, 500.0))
    model = uf.Model(uf.mesh.strip(60.0, 10.0, 1.0, (cells, 1)), material=material)
    model.symmetry("x0", normal="x")
    model.symmetry(lambda x, y, z: (x < 1e-9) & (y < 1e-9) & (z < 0), normal="y")
    punch = model.prescribe("x0_lower", "z", "punch")
    model.contact("lower", uf.Cylinder((25.0, 0.0, -R - 0.5), "y", R), penalty=100.0, friction=0.1, name="tool")
    return model, [uf.Move(punch, **{"to": -5.0, "steps": 6} | moved), uf.Release(punch)]


def group(size=1e-4, **moved):
    """The run, its reference, and two shadows."""
    shadows = {"Y": bending(160.0 * (1.0 + size), **moved), "R": bending(R=20.0 * (1.0 + size), **moved)}
    return bending(**moved), bending(**moved), shadows


def all_results(found):
    return [found.run, found.reference, *found.shadows.values()]


@pytest.fixture(scope="module")
def whole():
    return solve_with_shadows(*group(), frames=3)


def assert_the_same(found, expected):
    for one, other in zip(all_results(found), all_results(expected), strict=True):
        for column in other.columns():
            np.testing.assert_array_equal(one[column], other[column], err_msg=column)
    assert found.kept == expected.kept


# The run --------------------------------------------------------------------------------------------------------


def test_a_run_has_the_same_bits_with_shadows(whole, same_state):
    model, steps = bending()
    alone = solve(model, steps, frames=3)
    for column in alone.columns():
        np.testing.assert_array_equal(whole.run[column], alone[column], err_msg=column)
    assert same_state(model.system.snapshot(), whole.run.model.system.snapshot())
    assert (alone.events, alone.warnings) == (whole.run.events, whole.run.warnings)
    assert alone.timing.attempts.evaluations == whole.run.timing.attempts.evaluations
    assert [frame.number for frame in alone.frames] == [frame.number for frame in whole.run.frames]


def test_all_have_the_same_rows(whole):
    for result in all_results(whole):
        np.testing.assert_array_equal(result["step"], whole.run["step"])
    assert all(len(kept.switched) == len(whole.run) for kept in whole.kept.values())
    assert all(kept.residual < 1e-9 for kept in whole.kept.values())


def test_failed_increments_are_no_increments_of_shadows():
    """The run is cut several times; its shadows see what was accepted, and have the derivatives of its path."""
    moved = {"to": -4.0, "steps": 3, "grow": 2.0}
    options = NewtonOptions(max_iterations=7)
    found = solve_with_shadows(*group(**moved), options=options, frames=0)
    move = found.run["step"] == 1
    fractions = found.run["time"][move]
    assert np.diff(fractions).min() < 0.2  # and not a third
    np.testing.assert_array_equal(found.shadows["Y"]["punch"][move], found.run["punch"][move])
    ends = []
    for Y in (160.0 * 1.0001, 160.0):
        model, (step, _) = bending(Y, **moved)
        steps = [uf.Move(step.control, -4.0 * fraction, steps=1) for fraction in fractions]
        ends.append(solve(model, steps, options=TIGHT, frames=0)["punch_force"][1:])
    own = (found.shadows["Y"]["punch_force"] - found.reference["punch_force"])[move]
    np.testing.assert_allclose(own, ends[0] - ends[1], rtol=0, atol=1e-4 * np.abs(own).max())


@pytest.mark.parametrize("first", [True, False])
def test_a_step_with_nothing_to_do(first):
    """A release without a force has no increment: shadows begin the next step without it, or end."""

    def build(E):
        model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (4, 1)), material=uf.SVK(E=E, nu=0.3))
        model.fix("x0")
        tip, load = model.prescribe("x1_lower", "z", name="tip"), model.force("x1_upper", (0, 0, 1.0), "load")
        move = uf.Move(load, 1e-3, steps=2) if first else uf.Move(tip, -0.1, steps=2)
        return model, [uf.Release(tip), move] if first else [move, uf.Release(tip), uf.Release(tip)]

    found = solve_with_shadows(build(1e5), build(1e5), {"E": build(1.001e5)}, frames=0)
    assert any("nothing to release" in event for event in found.run.events)
    column = "tip_force" if first else "tip"
    assert len(found.shadows["E"]) == len(found.run)
    assert np.abs(found.shadows["E"][column] - found.reference[column])[-1] < 1e-5 * np.abs(found.run[column]).max()


def test_the_derivative_of_a_limit_load():
    """On the planes across the path the load of a shadow is free: its maximum moves as that of whole arcs."""

    def arch(E, h, increment=0.02):
        mesh = uf.mesh.strip(10.0, 1.0, 0.8, (4, 1)).transformed(lambda x: x + [0.0, 0.0, h] * (1 - x[:, :1] / 10.0))
        model = uf.Model(mesh, material=uf.SVK(E=E, nu=0.0))
        model.hinge("x1", "xz")
        model.hinge("x0", "x")
        for side in ("y0", "y1"):
            model.symmetry(side, "y")
        nodes = mesh.nodes("x0")
        load = model.force(nodes, (0.0, 0.0, -1.0 / len(nodes)), "load")
        return model, uf.Arc(load, 1.0, increment=increment, grow=1.0, most=round(0.3 / increment))

    def peak(result):
        """The maximum of the parabola through the three largest loads, over the elastic energy."""
        load, at = result["load"], int(np.argmax(result["load"]))
        x, y = result["elastic_energy"][at - 1 : at + 2], load[at - 1 : at + 2]
        a, b, c = np.polyfit((x - x[1]) / x[1], y, 2)
        return c - 0.25 * b * b / a

    values = {"E": 1000.0, "h": 0.8}
    found = uf.derivatives(arch, by=values, of=[peak], options=TIGHT, progress=False)
    load = found.run["load"]
    assert 0 < np.argmax(load) < len(load) - 1
    assert found["peak", "E"].relative == pytest.approx(1.0, rel=1e-6)
    ends = [peak(solve(*arch(1000.0, 0.8 + change, 0.005), options=TIGHT, frames=0)) for change in (16e-3, -16e-3)]
    assert found["peak", "h"].value == pytest.approx((ends[0] - ends[1]) / 32e-3, rel=5e-4)
    raw = uf.derivatives(arch, by=values, of=["load:max"], options=TIGHT, progress=False)
    assert raw["load:max", "h"].value == pytest.approx(found["peak", "h"].value, rel=5e-2)


# Multipliers ----------------------------------------------------------------------------------------------------


def pressed(strength=300.0, down=4, up=4, cells=5, below=0):
    """A strip, on another one if that has elements, which a roll with multipliers presses down and leaves."""
    mesh = uf.mesh.strip(20.0, 1.0, 0.8, (cells, 1))
    if below:
        mesh = uf.mesh.together(below=uf.mesh.strip(20.0, 1.0, 1.0, (below, 1)).moved((0, 0, -0.92)), above=mesh)
    model = uf.Model(mesh, material=uf.J2(E=70e3, nu=0.33, hardening=uf.Swift(strength, 0.01, 0.2)))
    model.fix(lambda x, y, z: x < 1e-9)
    how = {"friction": 0.1, "augmented": True, "points": 3}
    if below:
        model.sheet_contact("upper of below", "lower of above", name="stack", **how | {"friction": 0.15})
    roll = uf.Cylinder((17.0, 0.0, 4.45), "y", 4.0)
    stroke = model.drive(
        model.contact("upper of above" if below else "upper", roll, name="roll", **how), "-z", "stroke"
    )
    return model, [uf.Move(stroke, 1.5, steps=down), uf.Move(stroke, -0.5, steps=up)]


@pytest.mark.parametrize(
    "options",
    [{}, {"down": 3, "up": 3, "cells": 7, "below": 5}, {"cells": 8, "below": 10}],
    ids=["pass of the reference", "pass of a shadow", "start of the reference"],
)
def test_multipliers_in_increments_that_need_a_line_search(options):
    found = solve_with_shadows(pressed(**options), pressed(**options), {"more": pressed(300.03, **options)}, frames=0)
    assert not found.missing and not found.kept["more"].lost
    more, as_it_is = (solve(*pressed(one, **options), options=TIGHT, frames=0)["stroke_force"] for one in (300.03, 300))
    own = found.shadows["more"]["stroke_force"] - found.reference["stroke_force"]
    np.testing.assert_allclose(own, more - as_it_is, rtol=0, atol=1e-3 * np.abs(own).max())


def test_multipliers_that_stay_in_the_run_stay_in_its_shadows(monkeypatch):
    """A pass fails in the run: it goes on with the penalty."""

    def failing(model, newton, converged):
        if model.state.time > 0.4:
            raise Failed("no convergence", [])
        return augmented(model, newton, converged)

    monkeypatch.setattr(increment, "augmented", failing)
    found = solve_with_shadows(pressed(), pressed(), {"more": pressed(300.03)}, frames=0)
    assert found.run["roll_multipliers_stay"].any()
    for result in (found.reference, found.shadows["more"]):
        np.testing.assert_allclose(result["roll_penetration"], found.run["roll_penetration"], rtol=0, atol=1e-5)


# Lost shadows ---------------------------------------------------------------------------------------------------


def refusing(stretch, limit):
    """A law that has no answer beyond a strain."""

    def law(E, state):
        if np.abs(E[:, 0]).max() > limit:
            return np.full_like(E, np.nan), np.zeros((len(E), 6, 6)), state
        C = 1e3 * stretch * np.eye(6)
        return E @ C, np.tile(C, (len(E), 1, 1)), state

    return uf.UserLaw(law)


def pulled(stretch, limit):
    model = uf.Model(uf.mesh.strip(1.0, 0.5, 0.4, (1, 1)), "EAS3DEAS", material=refusing(stretch, limit))
    for face, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(face, normal=normal)
    return model, uf.Move(model.prescribe("x1", "x", "pull"), 0.1, steps=10)


def test_a_lost_shadow_is_marked_and_the_others_go_on():
    shadows = {"fine": pulled(1.001, 1.0), "lost": pulled(1.001, 0.05)}
    found = solve_with_shadows(pulled(1.0, 1.0), pulled(1.0, 1.0), shadows, frames=0)
    assert len(found.run) == len(found.shadows["fine"]) == 11
    kept = found.kept["lost"]
    assert kept.lost
    assert kept.from_row == len(found.shadows["lost"]) == 5
    assert not found.kept["fine"].lost and not found.missing


def test_derivatives_by_a_lost_shadow_are_unknown():
    def build(stretch, limit):
        return pulled(stretch, 1.0 if limit == 1.0 else 0.05)

    found = uf.derivatives(build, by={"stretch": 1.0, "limit": 1.0}, of=["pull_force:last"], progress=False)
    assert found["pull_force:last", "stretch"].relative == pytest.approx(1.0, rel=1e-6)
    lost = found["pull_force:last", "limit"]
    assert lost.value is None and lost.relative is None and lost.why
    column = found.column("pull_force", "limit")
    assert len(column) == len(found.run)
    assert np.isfinite(column[:5]).all() and np.isnan(column[5:]).all()
    assert np.isnan(found.displacement("limit")).all()
    assert np.isfinite(found.displacement("stretch")).all()
    assert found.warnings and found.warnings[0].startswith("derivatives by limit are unknown from row 6 on")


def test_a_lost_reference_loses_all_and_not_the_run(monkeypatch, tmp_path):
    increment = Shadow.increment

    def failing(self, values, controls, time, guess, factors, passes):
        if factors is None and len(self.run.result) == 4:
            raise Failed("it does not converge", [])
        return increment(self, values, controls, time, guess, factors, passes)

    monkeypatch.setattr(Shadow, "increment", failing)
    found = uf.derivatives(bending, by={"Y": 160.0, "R": 20.0}, of=["punch_force:peak"], progress=False)
    model, steps = bending()
    assert len(found.run) == len(solve(model, steps, frames=0))
    for one in found:
        assert one.value is None and "no solution to round-off" in one.why
    assert np.isnan(found.column("punch", "R")[4:]).all()
    found.write(tmp_path)  # with unknown numbers


def test_a_shadow_that_the_factors_of_the_run_do_not_solve_takes_its_own():
    """A tenth more yield stress is no small change: points switch, and the factors of the run do not suffice."""
    model, steps = bending(176.0)
    expected = solve(model, steps[:1], options=TIGHT, frames=0)
    builds = [(model, steps[:1]) for model, steps in (bending(), bending(), bending(176.0))]
    found = solve_with_shadows(*builds[:2], {"Y": builds[2]}, frames=0)
    assert found.kept["Y"].own > 0
    assert max(found.kept["Y"].switched) > 0
    np.testing.assert_allclose(found.shadows["Y"]["punch_force"], expected["punch_force"], rtol=1e-7, atol=1e-7)


def sprung(press):
    """A strip is bent over a roll, released, and pressed by a bar on a spring; friction."""
    model = uf.Model(uf.mesh.strip(30.0, 4.0, 1.0, (30, 2)), material=uf.sheet_metals.get("DC04").law)
    model.fix("x0")
    roll, bar = uf.Cylinder((8.0, 0.0, -10.55), "y", 10.0), uf.Cylinder((20.0, 0.0, 6.5), "y", 4.0)
    model.contact("lower", roll, penalty=3e4, points=3, friction=0.1, name="roll")
    above = model.contact("upper", bar, penalty=2e4, points=3, friction=0.15, name="bar")
    spring = model.spring(above, "-z", 50.0, name="press")
    tip = model.prescribe("x1_upper", "z", name="tip")
    return model, [uf.Move(tip, -6.0, steps=20), uf.Release(tip), uf.Move(spring, press, steps=12)]


def test_a_shadow_that_no_line_search_solves_takes_the_attempts_of_a_run():
    found = solve_with_shadows(sprung(300.0), sprung(300.0), {"more": sprung(300.03)}, frames=0)
    assert not found.kept["more"].lost
    more, as_it_is = (solve(*sprung(one), options=TIGHT, frames=0)["press_way"][-1] for one in (300.03, 300.0))
    own = found.shadows["more"]["press_way"][-1] - found.reference["press_way"][-1]
    assert own == pytest.approx(more - as_it_is, rel=1e-3)


# Refusals -------------------------------------------------------------------------------------------------------


def test_shadows_of_another_structure_are_refused_by_name():
    with pytest.raises(InvalidValue, match=r"3 steps in place of 2") as caught:
        model, steps = bending()
        solve_with_shadows(bending(), bending(), {"Y": (model, [*steps, steps[0]])})
    assert "shadow Y" in str(caught.value)
    model, steps = bending()
    with pytest.raises(InvalidValue, match="one model for several runs"):
        solve_with_shadows((model, steps), (model, steps), {})
    with pytest.raises(InvalidValue, match="7 elements in place of 8"):
        solve_with_shadows(bending(), bending(), {"cells": bending(cells=7)})


def test_ranks_are_refused_by_name():
    with pytest.raises(InvalidValue, match="shadows run in one process"):
        solve_with_shadows(*group(), solver="petsc")


# Stops ----------------------------------------------------------------------------------------------------------


class Stop(Exception):
    """Of a function of the user."""


def test_a_stop_between_two_increments(whole, tmp_path):
    path, seen = tmp_path / "run.h5", []

    def progress(name, fraction, detail):
        seen.append(name)
        if len(seen) == 5:
            raise Stop

    with pytest.raises(Stop):
        solve_with_shadows(*group(), frames=3, checkpoint=path, progress=progress)
    assert_the_same(resume_with_shadows(path, *group(), frames=3), whole)


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError])
def test_a_stop_within_the_shadows_keeps_the_checkpoint_before(whole, tmp_path, monkeypatch, error):
    """The run is at a row that its second shadow has not reached: such a state is not written."""
    path, increment, count = tmp_path / "run.h5", Shadow.increment, []

    def stopped(self, *arguments):
        count.append(self)
        if len(count) == 3 * 4 + 3:
            raise error("stop")
        return increment(self, *arguments)

    with monkeypatch.context() as patch:
        patch.setattr(Shadow, "increment", stopped)
        with pytest.raises(error):
            solve_with_shadows(*group(), frames=3, checkpoint=path, every=0)
    follow, repeated = Shadows.follow, []

    def counted(self, lead, *, frame):
        repeated.append(len(lead.result))
        follow(self, lead, frame=frame)

    monkeypatch.setattr(Shadows, "follow", counted)
    assert_the_same(resume_with_shadows(path, *group(), frames=3), whole)
    assert repeated[0] == 6  # the increment of the stop is made again


def test_another_run_does_not_go_on(tmp_path):
    path = tmp_path / "run.h5"
    solve_with_shadows(*group(), frames=0, checkpoint=path)
    model, steps = bending()
    with pytest.raises(FileProblem, match="different: shadows"):
        resume(path, model, steps, frames=0)
    with pytest.raises(FileProblem, match="different: shadows"):
        resume_with_shadows(path, *group(2e-4), frames=0)
    alone = tmp_path / "alone.h5"
    model, steps = bending()
    solve(model, steps, frames=0, checkpoint=alone)
    with pytest.raises(FileProblem, match="different: shadows"):
        resume_with_shadows(alone, *group(), frames=0)
