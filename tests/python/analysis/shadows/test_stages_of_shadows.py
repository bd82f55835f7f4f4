"""Stages with shadows: each shadow goes on from its own result, through springback and a trim."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.newton.options import NewtonOptions
from umform.analysis.run.stages import Stage, continued, solve_stages
from umform.analysis.shadows import Shadowed, of_all, solve_stages_with_shadows
from umform.analysis.shadows.shadow import Shadow
from umform.errors import InvalidValue, NoConvergence
from umform.results.records import Failed

TIGHT = NewtonOptions(residual=1e-12, increment=1e-9, max_iterations=60)
BEYOND_13 = [(13.0, -1.0), (13.0, 3.0)]
VALUES = {"Y": 160.0, "t": 1.0}


def stages(Y=160.0, t=1.0, cells=10):
    """A cantilever that is bent beyond yielding, let go, and cut."""

    def model():
        material = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(Y, 500.0))
        made = uf.Model(uf.mesh.strip(20.0, 2.0, t, (cells, 1)), material=material)
        made.fix("x0")
        return made

    def bend(before):
        made = model()
        return made, uf.Move(made.force("x1", (0.0, 0.0, -1.0), "load"), 1.1, steps=4)

    def unload(before):
        made = continued(model(), before)
        load = made.force("x1", (0.0, 0.0, -1.0), "load")
        load.value = 1.1
        return made, uf.Move(load, 0.0, steps=2)

    def trim(before):
        part = uf.Trim(BEYOND_13, formed=False).of(before)
        part.model.fix("x0", here=True)
        return part.model, uf.Move(part.model.unbalanced("cut"), 0.0, steps=2)

    return [Stage("bend", bend), Stage("unload", unload), Stage("trim", trim)]


def changed(size):
    return {name: stages(**{**VALUES, name: value * (1.0 + size)}) for name, value in VALUES.items()}


@pytest.fixture(scope="module")
def whole():
    return solve_stages_with_shadows(stages(), changed(3e-5), frames=0)


def test_through_springback_and_a_trim_beside_differences(whole):
    """Displacements, energies and plastic work after each stage."""
    assert list(whole) == ["bend", "unload", "trim"]
    for name, value in VALUES.items():
        ends = [
            solve_stages(stages(**{**VALUES, name: value * (1.0 + size)}), options=TIGHT, frames=0)
            for size in (1e-4, -1e-4)
        ]
        for stage, found in whole.items():
            own = (found.shadows[name].model.u - found.reference.model.u) / 3e-5
            wanted = (ends[0][stage].model.u - ends[1][stage].model.u) / 2e-4
            assert np.abs(own - wanted).max() < 1e-3 * np.abs(wanted).max(), (name, stage)
            for column in ("plastic_work", "elastic_energy"):
                derivative = (found.shadows[name][column] - found.reference[column]) / 3e-5
                slope = (ends[0][stage][column] - ends[1][stage][column]) / 2e-4
                scale = max(np.abs(slope).max(), 1e-3 * np.abs(found.run[column]).max())
                assert np.abs(derivative - slope).max() < 1e-3 * scale, (name, stage, column)


def test_a_loose_run_has_the_same_derivatives(whole):
    """The reference goes on from its own result, which is solved to round-off whatever the run is."""
    loose = NewtonOptions(residual=1e-3, increment=0.1)
    found = solve_stages_with_shadows(stages(), changed(3e-5), options=loose, frames=0)
    assert np.abs(found["trim"].run.model.u - found["trim"].reference.model.u).max() > 1e-8
    for name in VALUES:
        own, wanted = (each["trim"].shadows[name].model.u - each["trim"].reference.model.u for each in (found, whole))
        assert np.abs(own - wanted).max() < 1e-4 * np.abs(wanted).max(), name


def test_the_run_is_that_of_stages_without_shadows(whole, same_state):
    alone = solve_stages(stages(), frames=0)
    for stage in alone:
        assert same_state(alone[stage].model.system.snapshot(), whole[stage].run.model.system.snapshot())


def test_stages_go_on_from_their_checkpoints(whole, tmp_path, same_state):
    """Stopped in the second stage, and again when all is done."""

    def stop(name, fraction, detail):
        count.append(name)
        if len(count) == 6:
            raise KeyboardInterrupt

    count = []
    with pytest.raises(KeyboardInterrupt):
        solve_stages_with_shadows(stages(), changed(3e-5), frames=0, checkpoints=tmp_path, progress=stop)
    assert [path.name for path in sorted(tmp_path.iterdir())] == ["1-bend.h5", "2-unload.h5"]
    for increments in (2, 0):  # those of the trim, and none
        left = []
        again = solve_stages_with_shadows(
            stages(), changed(3e-5), frames=0, checkpoints=tmp_path, on_increment=left.append
        )
        assert len(left) == increments
        for stage, found in whole.items():
            for one, other in zip(results(again[stage]), results(found), strict=True):
                assert same_state(one.model.system.snapshot(), other.model.system.snapshot())
                for column in other.columns():
                    np.testing.assert_array_equal(one[column], other[column])
            assert again[stage].kept == found.kept


def test_what_was_kept_is_that_of_all_stages(whole):
    each = [stage.kept["Y"] for stage in whole.values()]
    kept = of_all(whole).kept["Y"]
    assert kept.residual == max(one.residual for one in each)
    assert len(kept.switched) == sum(len(stage.run) for stage in whole.values())


def results(found: Shadowed):
    return [found.run, found.reference, *found.shadows.values()]


def test_a_lost_shadow_is_lost_in_all_stages_after(monkeypatch):
    increment = Shadow.increment

    def failing(self, values, controls, time, guess, factors, passes):
        if factors is not None and self.run.model.bodies.only.material.hardening.yield_stress == 160.0:
            raise Failed("too thick", [])
        return increment(self, values, controls, time, guess, factors, passes)

    monkeypatch.setattr(Shadow, "increment", failing)
    found = solve_stages_with_shadows(stages(), changed(3e-5), frames=0)
    assert found["bend"].kept["t"].lost == "too thick"
    for stage in ("unload", "trim"):
        assert found[stage].kept["t"].lost == "stage bend: too thick"
        assert found[stage].kept["t"].from_row == 0
        assert list(found[stage].shadows) == ["Y"]
        assert not found[stage].kept["Y"].lost


def test_no_stage_goes_on_from_a_lost_reference(monkeypatch):
    increment = Shadow.increment

    def failing(self, values, controls, time, guess, factors, passes):
        if factors is None:
            raise Failed("it is too soft", [])
        return increment(self, values, controls, time, guess, factors, passes)

    monkeypatch.setattr(Shadow, "increment", failing)
    with pytest.raises(NoConvergence, match="stage bend") as caught:
        solve_stages_with_shadows(stages(), changed(3e-5), frames=0)
    assert "it is too soft" in str(caught.value)


def test_a_stage_of_other_elements_is_refused_by_name():
    with pytest.raises(InvalidValue, match="11 elements in place of 10") as caught:
        solve_stages_with_shadows(stages(), {"cells": stages(cells=11)}, frames=0)
    assert "shadow cells" in str(caught.value)
