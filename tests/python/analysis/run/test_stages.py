"""A run in stages: one stage is a plain run, two of them go on where the first has ended."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.run.stages import Stage, continued, solve_stages
from umform.analysis.steps import Move
from umform.errors import InvalidValue
from umform.mesh import strip

STEEL = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(yield_stress=160.0, modulus=500.0))


def model():
    made = uf.Model(strip(20.0, 2.0, 1.0, (10, 1)), material=STEEL)
    made.fix("x0")
    return made


def bend(before):
    made = model()
    load = made.force("x1", (0.0, 0.0, -1.0), "load")
    return made, Move(load, 1.2, steps=6)


def unload(before):
    made = continued(model(), before)
    load = made.force("x1", (0.0, 0.0, -1.0), "load")
    load.value = 1.2
    return made, Move(load, 0.0, steps=3)


def test_one_stage_is_a_plain_run():
    made, steps = bend(None)
    plain = uf.solve(made, steps, frames=0)
    staged = solve_stages([Stage("bend", bend)], frames=0)
    for column in plain.columns():
        np.testing.assert_array_equal(staged["bend"][column], plain[column])


def test_the_second_stage_begins_where_the_first_has_ended():
    made, first = bend(None)
    whole = uf.solve(made, [first, Move(first.control, 0.0, steps=3)], frames=0)
    staged = solve_stages([Stage("bend", bend), Stage("unload", unload)], frames=0)
    last = staged["unload"].model
    np.testing.assert_allclose(last.u, whole.model.u, atol=1e-9 * np.abs(last.u).max())
    assert np.abs(last.u).max() > 1e-2  # springback leaves something
    table = staged.table()
    assert list(dict.fromkeys(table["stage"])) == ["bend", "unload"]
    first_rows = len(staged["bend"])
    assert len(table["load"]) == first_rows + len(staged["unload"])
    assert table["plastic_work"][first_rows] == pytest.approx(table["plastic_work"][first_rows - 1], rel=1e-12)


def test_stages_are_taken_up_from_their_checkpoints(tmp_path, monkeypatch, same_state):
    stages = [Stage("bend", bend), Stage("unload", unload)]
    expected = solve_stages(stages, frames=0)

    def stopped(before):
        made, step = unload(before)
        done = []

        def stop(fraction):
            if fraction > 0.5 and not done:
                done.append(True)
                raise KeyboardInterrupt
            return 1.2 * (1.0 - fraction)

        return made, Move(step.control, stop, steps=3)

    with pytest.raises(KeyboardInterrupt) as caught:
        solve_stages([stages[0], Stage("unload", stopped)], frames=0, checkpoints=tmp_path, every=0.0)
    assert list(caught.value.stages) == ["bend"]
    assert (tmp_path / "1-bend.h5").exists()
    (tmp_path / "2-unload.h5").unlink(missing_ok=True)
    again = solve_stages(stages, frames=0, checkpoints=tmp_path, every=0.0)
    assert same_state(again["unload"].model.system.snapshot(), expected["unload"].model.system.snapshot())
    np.testing.assert_array_equal(again["bend"]["load"], expected["bend"]["load"])


def test_what_does_not_fit_is_refused():
    result = solve_stages([Stage("bend", bend)], frames=0)
    with pytest.raises(InvalidValue, match="no such stage"):
        result["draw"]
    with pytest.raises(InvalidValue, match="different names"):
        solve_stages([Stage("a", bend), Stage("a", bend)])
    with pytest.raises(InvalidValue, match="letters"):
        Stage("a/b", bend)
    with pytest.raises(InvalidValue, match=r"stage a[\s\S]*NoneType[\s\S]*return model"):
        solve_stages([Stage("a", lambda before: None)])
    for wrong in (3, lambda: None):
        with pytest.raises(TypeError) as caught:
            solve_stages([Stage("a", wrong)])
        assert "in the function of stage a, called as build" in caught.value.__notes__[0]
    other = uf.Model(strip(20.0, 2.0, 1.0, (8, 1)), material=STEEL)
    with pytest.raises(InvalidValue, match="mesh and the bodies"):
        continued(other, result["bend"])
