"""Warnings at the end of a run: deep penetration, tools that never touch the sheet."""

from __future__ import annotations

import pytest

import umform as uf


def pressed(to, *, above=0.0, push=0.0, steps=2, **contact):
    """An elastic plate on a plane, and a punch above it that moves down, or is pressed down by a force."""
    model = uf.Model(uf.mesh.strip(4.0, 4.0, 1.0, (2, 2)), material=uf.SVK(E=2e5, nu=0.3))
    for side, normal in (("x0", "x"), ("y0", "y")):
        model.symmetry(side, normal)
    model.fix("lower", "z")
    pair = model.contact("upper", uf.Plane((0.0, 0.0, 0.5 + above), "-z"), name="punch", **contact)
    way = model.press(pair, "z", "force") if push else model.drive(pair, "-z", "way")
    move = uf.Close(way, force=-push) if push else uf.Move(way, to, steps=steps)
    return uf.solve(model, move, frames=0, progress=False)


def about(result, word):
    return [text for text in result.warnings if word in text]


def test_a_deep_penetration_is_named_without_an_allowed_one():
    (text,) = about(pressed(0.0, push=240.0, penalty=100.0), "the penetration of")
    assert "contact punch" in text and "% of the thickness 1" in text
    stiffer = float(text.split("a penalty of ")[1].split()[0])
    assert about(pressed(0.0, push=240.0, penalty=stiffer), "penetration") == []


@pytest.mark.parametrize(("to", "above"), [(-2.0, 0.5), (0.3, 0.5)])
def test_a_tool_that_never_touches_is_named(to, above):
    (text,) = about(pressed(to, above=above), "never touched")
    assert "contact punch never touched the sheet" in text and "way moved the tool" in text


def test_a_tool_that_touches_is_not_named():
    assert about(pressed(0.52, above=0.5), "never touched") == []
    assert about(pressed(-1.0, above=-1e-4), "never touched") == []  # it opens


def test_a_fixed_tool_that_never_touches_is_noted_without_a_warning():
    model = uf.Model(uf.mesh.strip(4.0, 4.0, 1.0, (2, 2)), material=uf.SVK(E=2e5, nu=0.3))
    model.fix("x0")
    model.contact("lower", uf.Plane((0.0, 0.0, -3.0), "z"), name="stop")
    result = uf.solve(model, uf.Move(model.prescribe("x1", "x", "pull"), 0.01, steps=1), frames=0, progress=False)
    assert about(result, "never touched") == []
    (note,) = [text for text in result.events if "never touched" in text]
    assert "contact stop" in note and "the tool stop is fixed" in note
    assert not any("never touched" in text for text in pressed(0.52, above=0.5).events)


def test_a_tool_that_rests_on_its_stops_above_the_sheet_is_noted_without_a_warning():
    model = uf.Model(uf.mesh.strip(4.0, 4.0, 1.0, (2, 2)), material=uf.SVK(E=2e5, nu=0.3))
    model.fix("lower", "z")
    model.fix("x0")
    pair = model.contact("upper", uf.Plane((0.0, 0.0, 0.8), "-z"), name="holder")
    hold = model.press(pair, "z", "hold")
    model.stop(hold, at=1e-5, stiffness=1e6, below=True)
    result = uf.solve(model, uf.Move(hold, -10.0), frames=0, progress=False)
    assert about(result, "never touched") == []
    (note,) = [text for text in result.events if "never touched" in text]
    assert "the tool holder is on its stops" in note


def test_the_penetration_of_a_run_before_is_not_named_again():
    result = pressed(0.2, penalty=100.0)
    again = uf.solve(result.model, uf.Move(result.model.controls[0], 0.0, steps=2), frames=0, progress=False)
    assert about(result, "penetration") and about(again, "penetration") == []
