"""A tool that pushes a loose sheet beside what carries it is refused before the run. eq. (4.261)"""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.analysis.run.tipping import tipping
from umform.analysis.steps import Step
from umform.problem.errors import DeckError
from umform.problem.findings import accept
from umform.problem.plausible import of_model


def sheet(
    push: float, *, friction: float | None = None, pressed: tuple[str, float] | None = None, **more: float
) -> tuple[uf.Model, list[Step]]:
    """A sheet from x = 0 to 20, of thickness 1, on a block up to x = 10; a round punch goes down at ``push``, or is
    ``pressed`` along an axis by a force.

    ``more``: the gap of a pad above the block, the travel of that pad, a force on it; the gap of the punch, and the
    travel of the punch before the pad comes.
    """
    model = uf.Model(uf.mesh.strip(20.0, 1.0, 1.0, (20, 1)), material=uf.SVK(E=1000.0, nu=0.0))
    model.fix(np.arange(len(model.mesh.points)), "y")
    if friction is None:
        model.fix("x0_lower", "x")
    model.contact("lower", uf.Box((0.0, 0.0, -5.5), (20.0, 50.0, 10.0), 0.5), name="block", friction=friction)
    punch = model.tool("punch", uf.Cylinder((push, 0.0, 2.52 + more.get("gap", 0.0)), "y", 2.0))
    model.contact("upper", punch, name="on_punch", friction=friction)
    steps = list[Step]()
    if "before" in more:
        steps.append(uf.Move(model.drive(punch, "-z", name="stroke"), more["before"]))
    if "pad" in more:
        pad = model.tool("pad", uf.Box((0.0, 0.0, 5.5 + more["pad"]), (16.0, 50.0, 10.0), 0.5))
        model.contact("upper", pad, name="on_pad", friction=friction)
        if "travel" in more:
            steps.append(uf.Move(model.drive(pad, "-z", name="down"), more["travel"]))
        if "force" in more:
            steps.append(uf.Move(model.press(pad, "z", name="hold"), more["force"]))
    if pressed is not None:
        return model, [uf.Move(model.press(punch, pressed[0], name="hold"), pressed[1])]
    stroke = steps[0].control if "before" in more else model.drive(punch, "-z", name="stroke")
    return model, [*steps, uf.Move(stroke, 1.0)]


class Upwards(uf.model.NodalTerm):
    """A constant force."""

    def respond(self, u, history, at):
        """Forces on the ground, their derivatives, and the history."""
        return np.tile([0.0, 0.0, -1.0], (len(u), 1)), np.zeros((len(u), 3, 3)), history


def test_a_push_over_the_block_is_carried():
    assert tipping(*sheet(6.0)) is None


@pytest.mark.parametrize("friction", [None, 0.1])
def test_a_push_beside_the_block_tips(friction):
    found = tipping(*sheet(15.0, friction=friction))
    assert found.step == 1 and found.tool == "punch" and set(found.carriers) == {"block"}
    assert found.place[0] == pytest.approx(15.0, abs=0.3) and found.carriers["block"][0] == pytest.approx(9.8, abs=0.5)


@pytest.mark.parametrize(
    "more", [{"pad": 0.0}, {"pad": 0.4}, {"pad": 3.0, "travel": 3.0}, {"pad": 3.0, "force": -10.0}]
)
def test_a_pad_that_is_near_or_comes_carries(more):
    assert tipping(*sheet(15.0, **more)) is None


def test_a_punch_that_ends_its_step_above_the_sheet_pushes_nothing():
    assert tipping(*sheet(15.0, gap=5.0)) is None
    assert tipping(*sheet(15.0, gap=0.9)).tool == "punch"
    assert tipping(*sheet(15.0, gap=0.9, before=0.8, pad=3.0, travel=3.0)) is None


def test_a_pad_that_stays_away_does_not():
    assert set(tipping(*sheet(15.0, pad=0.6)).carriers) == {"block"}


def test_forces_push_like_travels_and_only_along_normals():
    assert tipping(*sheet(15.0, pressed=("z", -1.0))).tool == "punch"
    assert tipping(*sheet(15.0, pressed=("z", 1.0))) is None
    assert tipping(*sheet(15.0, pressed=("x", 1.0))) is None


@pytest.mark.parametrize("what", ["support", "clamp", "springs", "load", "forces of the user", "away", "release first"])
def test_what_may_balance_the_push_is_no_tipping(what):
    model, steps = sheet(15.0)
    if what == "support":
        model.fix("x1", "z")
    elif what == "clamp":
        model.fix("x0", "x")
    elif what == "springs":
        model.rest(1.0)
    elif what == "load":
        model.pressure("lower")
    elif what == "forces of the user":
        model.add(Upwards("upwards", model.mesh.nodes("x1_upper")))
    elif what == "away":
        steps = [uf.Move(steps[0].control, -1.0)]
    else:
        steps = [uf.Release(steps[0].control), *steps]
    assert tipping(model, steps) is None


def test_the_check_refuses_it_with_place_reason_and_remedy():
    with pytest.raises(DeckError) as refused:
        accept(of_model(*sheet(15.0)))
    text = " ".join(str(refused.value).split())
    assert "tool punch" in text and "only block at (" in text and "tips over" in text
    assert "lies loosely" in text and "a pad, a holder or a support" in text
    assert accept(of_model(*sheet(6.0))) == []
