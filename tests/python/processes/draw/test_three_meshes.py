"""A U-bend on three meshes: limits of springback and their errors, the penalty that follows the mesh, the command."""

import itertools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

import umform as uf
from umform.cli import app
from umform.errors import InvalidValue
from umform.processes.draw import Drawn, UBend, draw, extrapolated
from umform.processes.draw.endings import Ending
from umform.processes.draw.files import record
from umform.processes.draw.pictures import sections
from umform.processes.draw.three_meshes import estimates_of
from umform.processes.limit import Limit, allowed_penetration

STEEL = uf.J2(E=206e3, nu=0.3, hardening=uf.Swift(565.3, 0.0071, 0.259))
U = UBend(
    thickness=0.78,
    length=240.0,
    width=35.0,
    material=STEEL,
    punch_width=50.0,
    punch_edge=5.0,
    opening=52.0,
    die_edge=5.0,
    holder_force=2450.0,
    stroke=30.0,
    turn=15.0,
)
EXACT = {"theta1": 100.0, "theta2": 80.0, "largest punch force": 2.0, "draw-in, mean": 60.0, "largest springback": 5.0}


def measured(turn, squares=1e-3):
    """Measures whose error falls with the square of the element size; of the wall it is that of the curvature."""
    error = squares * turn**2
    rows = {name: value * (1.0 + error) for name, value in EXACT.items()}
    return rows | {"radius of the wall": 1.0 / (0.01 * (1.0 - error))}


def test_limits_of_errors_that_fall_with_the_square_are_exact():
    turns = [20.0, 20.0 / 2.0**0.5, 10.0]
    found = estimates_of([SimpleNamespace(values=measured(turn)) for turn in turns])
    for name, value in EXACT.items():
        assert found[name].value == pytest.approx(value, rel=1e-12)
        assert found[name].error == pytest.approx(0.1 * value, rel=1e-9)  # what was extrapolated
    radius = found["radius of the wall"]
    assert radius.value == pytest.approx(100.0, rel=1e-12)
    assert radius.error == pytest.approx(100.0**2 * 0.1 * 0.01, rel=1e-9)
    assert radius.off == pytest.approx(1.0 / 0.9 - 1.0, rel=1e-9)  # the finest mesh, over the limit
    assert Limit(4.0, 0.0).inverse == Limit(0.25, 0.0)


class Measured(Drawn):
    """A drawn part with measures of a known error."""

    @property
    def quantities(self):
        known = measured(self.case.turn)
        return [replace(one, value=known.get(one.name, one.value)) for one in super().quantities]


@pytest.fixture(scope="module")
def drawn():
    coarse = replace(U, element="BEND8", turn=30.0, thickness_points=5, contact_points=3)
    found = draw(coarse, frames=0, progress=False)
    assert found.ending is None and found.angles is not None
    return found


@pytest.fixture
def runs(drawn, monkeypatch):
    """The cases that are run; instead of a run, the part with measures of their meshes."""
    cases = []

    def instead(case, *, frames, **how):
        cases.append((case, frames))
        return Measured(case, drawn.limit, drawn.result, drawn.u, drawn.released, drawn.ending)

    monkeypatch.setattr("umform.processes.draw.three_meshes.draw", instead)
    return cases


def test_three_meshes_are_run_and_the_finest_is_kept(runs):
    found = extrapolated(U, frames=7)
    assert [case.turn for case, _ in runs] == pytest.approx([30.0, 30.0 / 2.0**0.5, 15.0])
    assert [frames for _, frames in runs] == [0, 0, 7]
    assert found.case.turn == 15.0 and [one.case.turn for one in found.coarser] == pytest.approx([30.0, 21.2132])
    assert found.estimates["theta1"].value == pytest.approx(100.0)
    columns, *rows = found.tables["Measures"]
    assert columns == ["quantity", "value", "error", "finest mesh", "unit"]
    assert ["theta1", "100", "± 22", "122.5", "degrees"] in rows
    assert next(row for row in rows if row[0] == "largest thinning")[2:4] == ["unknown", ""]
    assert len(found.tables["Meshes"]) == 4
    assert "theta1 100 ± 22°" in sections(found).axes[0].get_title(loc="left")
    assert record(found)["estimates"]["theta1"]["error"] == pytest.approx(22.5)
    assert record(found)["errors"]["theta1"] == pytest.approx(22.5)
    assert record(found)["errors"]["largest thinning"] is None and record(found)["about_errors"] == ""


def test_one_bar_tells_the_progress_of_all_meshes(drawn, monkeypatch):
    """Each mesh takes its share of the time, of its moves; closing and opening the tools do not move the bar."""

    def instead(case, *, progress, **how):
        for name, fraction in (("step 1: close", 1.0), ("step 2", 0.5), ("step 2", 1.0), ("step 1", 0.5)):
            progress(name, fraction, "punch 1")
        return replace(drawn, case=case)

    monkeypatch.setattr("umform.processes.draw.three_meshes.draw", instead)
    told = []
    extrapolated(U, progress=lambda name, fraction, detail="": told.append((name, fraction, detail)))
    assert {name for name, _, _ in told} == {"3 meshes"}
    ends = np.cumsum([0.0, 1.0, 2.0**0.5, 2.0]) / (3.0 + 2.0**0.5)
    reached = [(a, 0.5 * (a + b), b, b) for a, b in itertools.pairwise(ends)]
    assert [fraction for _, fraction, _ in told] == pytest.approx(list(itertools.chain(*reached)))
    assert told[5][2] == "2 of 3, step 2: punch 1"


def test_without_angles_on_a_coarse_mesh_there_is_no_estimate(drawn, monkeypatch):
    turns = []

    def instead(case, **how):
        turns.append(case.turn)
        return replace(drawn, case=case, ending=Ending("torn", "the sheet tears") if case.turn > 15.0 else None)

    monkeypatch.setattr("umform.processes.draw.three_meshes.draw", instead)
    found = extrapolated(U)
    assert turns == pytest.approx([30.0, 15.0]) and not found.estimates and not found.coarser
    assert found.tables["Measures"][0] == ["quantity", "value", "unit"]


def test_meshes_that_would_be_too_coarse_are_refused():
    with pytest.raises(InvalidValue, match="too large elements"):
        extrapolated(replace(U, turn=23.0))


def test_the_allowed_penetration_falls_with_the_square_of_the_mesh():
    """A cell of 18 nodes has two chords; the penalty follows, unless it is given."""
    length = np.radians(15.0) * 5.39
    assert replace(U, element="BEND8").allowed == pytest.approx(length**2 / 80.0)
    assert U.allowed == pytest.approx(max(length**2 / 320.0, 0.78 / 200.0))
    assert replace(U, turn=2.0).allowed == allowed_penetration(0.1, 5.0, 0.78) == 0.78 / 200.0
    pairs = {pair.name: pair for pair in U.build()[0].contacts}
    assert pairs["on_die"].allowed == pairs["under_punch"].allowed == U.allowed
    assert pairs["under_holder"].allowed is None
    assert pairs["under_holder"].penalty < 0.2 * pairs["on_die"].penalty
    given = {pair.name: pair.penalty for pair in replace(U, penalty=500.0).build()[0].contacts}
    assert given == {"on_die": 500.0, "under_holder": 30.0, "under_punch": 500.0}


@pytest.mark.parametrize(("options", "runs_three"), [([], True), (["--coarse"], False), (["--no-extrapolate"], False)])
def test_the_command_runs_three_meshes_unless_told_otherwise(drawn, monkeypatch, tmp_path, options, runs_three):
    called = []

    def instead(name):
        def run(case, **how):
            called.append(name)
            found = replace(drawn, case=case)
            return replace(found, estimates={"theta1": Limit(100.0, 0.0, 0.25)}) if name == "extrapolated" else found

        return run

    monkeypatch.setattr("umform.processes.draw.three_meshes.extrapolated", instead("extrapolated"))
    monkeypatch.setattr("umform.processes.draw.case.draw", instead("draw"))
    monkeypatch.setattr("umform.processes.draw.files.write_files", lambda *given: called.append(given[-1]) or [])
    monkeypatch.setattr("umform.processes.draw.files.draw_blank", lambda *_: ("blank.png", "picture"))
    out = CliRunner().invoke(app, ["draw", "u", "--material", "DC04", "--out", str(tmp_path / "u"), *options])
    assert out.exit_code == 0, out.output
    assert called == ["extrapolated" if runs_three else "draw", "picture"]  # the blank is drawn once
    assert ("± 0.25" in out.output) is runs_three
    assert ("errors are unknown" in out.output) is not runs_three
