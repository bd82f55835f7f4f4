"""A tool deep in the sheet is named as the cause of a failed increment."""

import pytest

import umform as uf
from umform.analysis.steps import increment
from umform.errors import NoConvergence

STEEL = uf.J2(E=206e3, nu=0.3, hardening=uf.Linear(300, 900))


def failing(*steps):
    """A plate on a plane under a soft punch, moved by some steps, and then at once by 80 times the thickness."""
    model = uf.Model(uf.mesh.strip(4.0, 4.0, 1.0, (2, 2)), material=STEEL)
    for side, normal in (("x0", "x"), ("y0", "y")):
        model.symmetry(side, normal)
    model.fix("lower", "z")
    pair = model.contact("upper", uf.Plane((0.0, 0.0, 0.5), "-z"), name="holder", penalty=500.0)
    way = model.drive(pair, "-z", "way")
    moves = [uf.Move(way, to, steps=2) for to in steps]
    with pytest.raises(NoConvergence) as caught:
        uf.solve(model, [*moves, uf.Move(way, 80.0, steps=1, cuts=0)], frames=0, progress=False)
    return caught.value


def test_a_tool_that_crushes_the_sheet_is_the_cause():
    error = failing(0.4)
    assert "contact holder is" in error.cause and "times the yield stress 300" in error.cause
    assert "another unit" in error.remedy and "softer penalty" not in error.remedy
    share = float(error.cause.split("deep, ")[1].split()[0])
    pressure = float(error.cause.split("mean pressure of ")[1].split(",")[0])
    assert error.result["holder_penetration"][-1] == pytest.approx(share / 100.0, rel=1e-2)
    assert pressure == pytest.approx(5.0 * share, rel=1e-2)  # penalty 500


def test_a_burst_sheet_keeps_its_remedy_though_a_tool_is_deep_in_it(monkeypatch):
    monkeypatch.setattr(increment, "thinned", lambda run: ("it would have burst before", "end the step earlier"))
    error = failing(0.4)
    assert "it would have burst before" in error.cause and "deep" not in error.cause
    assert error.remedy == "end the step earlier"


def test_other_failures_keep_their_remedy():
    error = failing(0.05)
    assert "thickness" not in error.cause and "softer penalty" in error.remedy
