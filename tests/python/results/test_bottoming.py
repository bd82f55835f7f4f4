"""A punch that bottoms: its force jumps, and the run ends with what it has and says so."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.errors import NoConvergence
from umform.results.bottoming import bottoming, squeezed

STEEL = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(strength=567.0, offset=0.0071, exponent=0.264))


def coined(beyond, steps, **options):
    """A strip that is bent into a die and squeezed on its bottom by so much."""
    die = uf.UDie(opening=16.0, depth=4.0, shoulder_radius=2.0, bottom_radius=2.0)
    sheet = uf.mesh.strip(16.0, 1.0, 1.0, (12, 1)).moved((0.0, 0.0, 0.5))
    model = uf.Model(sheet, material=STEEL)
    for side, normal in (("x0", "x"), ("y0", "y"), ("y1", "y")):
        model.symmetry(side, normal)
    model.contact("lower", die, penetration=0.02, points=2, name="die")
    pair = model.contact("upper", die.counterpart(1.0).moved((0, 0, 4.0)), penetration=0.02, points=2, name="punch")
    way = model.drive(pair, "-z", name="way")
    return uf.solve(model, uf.Move(way, 4.0 + beyond, steps=steps, **options), frames=0, progress=False)


def test_a_punch_that_squeezes_the_sheet_on_the_bottom_of_the_die_is_named():
    result = coined(0.1, 26)
    said = [text for text in result.warnings if "bottoms" in text]
    assert len(said) == 1 and "the tool punch bottoms at way = 3." in said[0]
    found = bottoming(result["way"], result["way_force"])
    assert 3.5 < found.at < 4.05 and found.largest == pytest.approx(result["way_force"].max())
    model = result.model
    punch = next(tool for tool in model.tools if tool.name == "punch")
    assert squeezed(model, punch, {pair: pair.found for pair in model.contacts}) > 0.8


def test_a_run_that_cannot_go_on_keeps_what_it_has_and_says_which_tool_bottoms():
    with pytest.raises(NoConvergence) as caught:
        coined(1.2, 26, cuts=0)
    reached = caught.value.result
    assert 4.0 < reached["way"][-1] < 5.2
    assert any("the tool punch bottoms" in text for text in reached.warnings)


def test_a_punch_that_bends_freely_does_not_bottom():
    assert not any("bottoms" in text for text in coined(-1.0, 15).warnings)


def test_a_punch_that_bends_a_strip_lightly_until_it_meets_a_support_beside_it_does_not_bottom():
    model = uf.Model(uf.mesh.strip(16.0, 1.0, 0.5, (32, 1)), material=uf.SVK(E=1e4, nu=0.0))
    model.fix("x0")
    model.symmetry("y0", "y")
    model.symmetry("y1", "y")
    roll = [uf.Cylinder((15, 0, 1.25), "y", 1.0), uf.Cylinder((12.5, 0, -2.05), "y", 1.0)]
    punch = model.contact("upper", roll[0], penetration=0.02, name="punch")
    model.contact("lower", roll[1], penetration=0.02, name="support")
    way = model.drive(punch, "-z", name="way")
    result = uf.solve(model, uf.Move(way, 2.0, steps=40), frames=0, progress=False)
    assert bottoming(result["way"], result["way_force"]) is not None  # by the force alone
    assert not any("bottoms" in text for text in result.warnings)


def test_a_tool_that_is_closed_by_a_force_does_not_bottom():
    model = uf.Model(uf.mesh.strip(20.0, 1.0, 1.0, (20, 1)), material=uf.SVK(E=1e4, nu=0.0))
    model.fix("x0")
    model.symmetry("y0", "y")
    model.symmetry("y1", "y")
    model.contact("lower", uf.Plane((0.0, 0.0, -0.8)), penetration=0.002, name="bed")
    roll = model.contact("upper", uf.Cylinder((19.0, 0.0, 1.5), "y", 1.0), penetration=0.002, name="roll")
    close = uf.Close(model.press(roll, "z", "press"), force=-50.0, increment=0.015)
    result = uf.solve(model, close, frames=0, progress=False)
    assert bottoming(result["press_way"], result["press_way_force"]) is not None  # by the force alone
    assert not any("bottoms" in text for text in result.warnings)


@pytest.mark.parametrize(
    ("force", "at"),
    [
        (lambda s: s, None),  # a spring
        (lambda s: np.where(s < 0.5, 0.0, 1e3 * (s - 0.5)), None),  # first touch half-way
        (lambda s: np.where(s < 0.9, 1.0, 1.0 + 1e3 * (s - 0.9)), 0.9),
        (lambda s: np.where(s < 0.5, 1.0, np.minimum(1.0 + 1e3 * (s - 0.5), 20.0)), 0.5),  # it yields then
        (lambda s: np.where((s > 0.5) & (s < 0.6), 50.0, 1.0), None),  # a snap-through comes back
        (lambda s: 0.0 * s, None),
    ],
)
def test_where_a_force_jumps(force, at):
    way = np.linspace(0.0, 2.0, 101)
    found = bottoming(-way, force(way / 2.0))
    if at is None:
        assert found is None
    else:
        assert -found.at == pytest.approx(2.0 * at, abs=0.11) and found.before < 0.3 * found.largest


@pytest.mark.parametrize("way", [np.zeros(40), np.concatenate([np.linspace(0.0, 1.0, 20), np.linspace(1.0, 0.5, 20)])])
def test_a_tool_that_stands_or_comes_back_does_not_bottom(way):
    assert bottoming(way, np.where(np.arange(40) < 25, 1.0, 50.0)) is None


def test_a_tool_that_stands_while_another_one_moves_is_not_said_to_bottom():
    model = uf.Model(uf.mesh.strip(2.0, 1.0, 1.0, (2, 1)), material=uf.SVK(E=1e3, nu=0.0))
    model.symmetry("x0", "x")
    model.fix(np.arange(len(model.mesh.points)), "y")
    below = model.contact("lower", uf.Plane((0.0, 0.0, -0.5), (0.0, 0.0, 1.0)), penalty=1e4, name="below")
    above = model.contact("upper", uf.Plane((0.0, 0.0, 0.5), (0.0, 0.0, -1.0)), penalty=1e4, name="above")
    stands, moves = model.drive(below, "z", name="stands"), model.drive(above, "-z", name="moves")
    model.rest()
    result = uf.solve(model, [uf.Move(stands, 1e-3), uf.Move(moves, 0.02, steps=30)], frames=0, progress=False)
    assert abs(result["stands_force"][-1]) > 10.0 * abs(result["stands_force"][1])
    assert not any("stands" in text and "bottoms" in text for text in result.warnings)
