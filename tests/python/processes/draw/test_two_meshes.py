"""A U-bend on two meshes: limits of springback and their errors, the penalty that follows the mesh, the command."""

import itertools
import math
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
from umform.processes.draw.two_meshes import coarser, estimates_of
from umform.processes.early_end import what_was_reached
from umform.processes.extrapolation import Limit, allowed_penetration

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


def measured(turn, cubes=1e-5):
    """Measures whose error falls with the cube of the element size."""
    return {name: value * (1.0 + cubes * turn**3) for name, value in EXACT.items()}


def test_limits_of_errors_that_fall_with_the_cube_are_exact():
    """The error is a third of the difference of both meshes: the shift at order 2."""
    found = estimates_of(*(SimpleNamespace(values=measured(turn)) for turn in (20.0, 10.0)))
    for name, value in EXACT.items():
        assert found[name].value == pytest.approx(value, rel=1e-12)
        assert found[name].error == pytest.approx(0.07 / 3.0 * value, rel=1e-9)


def test_orders_from_17_on_lie_in_the_error_of_two_meshes():
    for order in (1.7, 2.0, 4.0, 20.0):
        found = Limit.of_two(1.0 + 2.0**order, 2.0, 2.0)  # the error of the finer mesh is 1, the limit 1
        assert abs(found.value - 1.0) <= found.error
    assert abs(Limit.of_two(3.0, 2.0, 2.0).value - 1.0) > Limit.of_two(3.0, 2.0, 2.0).error  # order 1


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

    monkeypatch.setattr("umform.processes.draw.two_meshes.draw", instead)
    return cases


def test_two_meshes_are_run_and_the_finer_one_is_kept(runs):
    found = extrapolated(U, frames=7)
    assert [case.turn for case, _ in runs] == [30.0, 15.0]
    assert (runs[0][0].thickness_points, runs[0][0].contact_points) == (7, 3)
    assert [frames for _, frames in runs] == [0, 7]
    assert found.case.turn == 15.0 and found.coarser.case.turn == 30.0
    assert found.estimates["theta1"].value == pytest.approx(100.0)
    columns, *rows = found.tables["Measures"]
    assert columns == ["quantity", "value", "error", "finest mesh", "unit"]
    theta1 = next(row for row in rows if row[0] == "theta1")
    assert theta1 == ["theta1", "100.0", found["theta1"].error_text, "103.4", "degrees"]
    thinning = next(row for row in rows if row[0] == "largest thinning")
    assert thinning[2].startswith("± ") and thinning[3] == ""
    assert len(found.tables["Meshes"]) == 3
    assert "theta1 100.0 ± " in sections(found).axes[0].get_title(loc="left")
    assert record(found)["estimates"]["theta1"]["error"] == pytest.approx(7.875)
    assert record(found)["errors"]["theta1"] == pytest.approx(7.875, abs=0.5)
    assert found["theta1"].band.sources["mesh"] == pytest.approx(7.875)
    assert record(found)["errors"]["largest thinning"] > 0.0 and record(found)["about_errors"] == ""
    assert "not from this run" in found["largest thinning"].band.source
    assert "extrapolation" in found["theta1"].band.source


def test_a_run_that_is_stopped_on_the_coarser_mesh_keeps_its_history(drawn, monkeypatch, tmp_path):
    def instead(case, **how):
        stop = KeyboardInterrupt()
        stop.result = drawn.result
        raise stop

    monkeypatch.setattr("umform.processes.draw.two_meshes.draw", instead)
    with pytest.raises(KeyboardInterrupt) as stopped, what_was_reached(tmp_path, "draw.vtkhdf"):
        extrapolated(U)
    assert [path.name for path in tmp_path.iterdir()] == ["history.csv"]
    assert [note.strip() for note in stopped.value.__notes__] == [
        "on mesh 1 of 2, the coarsest first",
        f"results so far are in {tmp_path}: history.csv",
    ]


def test_what_gives_errors_of_a_part_of_one_mesh(drawn):
    """Two meshes do not where the part has ended early."""
    assert drawn.about_errors.endswith("two meshes give errors of this part: umform draw u --extrapolate")
    torn = replace(drawn, ending=Ending("torn", "it tears", early=True))
    assert torn.about_errors.endswith("repeat with elements that turn half as far to see errors of this part")


def test_the_coarser_mesh_keeps_fewer_points_that_are_given():
    found = coarser(replace(U, thickness_points=5, contact_points=2))
    assert (found.thickness_points, found.contact_points) == (5, 2)


def test_one_bar_tells_the_progress_of_all_meshes(drawn, monkeypatch):
    """Each mesh takes its share of the time, of its moves; closing and opening the tools do not move the bar."""

    def instead(case, *, progress, **how):
        for name, fraction in (("step 1: close", 1.0), ("step 2", 0.5), ("step 2", 1.0), ("step 1", 0.5)):
            progress(name, fraction, "punch 1")
        return replace(drawn, case=case)

    monkeypatch.setattr("umform.processes.draw.two_meshes.draw", instead)
    told = []
    extrapolated(U, progress=lambda name, fraction, detail="": told.append((name, fraction, detail)))
    assert {name for name, _, _ in told} == {"2 meshes"}
    ends = np.cumsum([0.0, 1.0, 2.0]) / 3.0
    reached = [(a, 0.5 * (a + b), b, b) for a, b in itertools.pairwise(ends)]
    assert [fraction for _, fraction, _ in told] == pytest.approx(list(itertools.chain(*reached)))
    assert told[5][2] == "2 of 2, step 2: punch 1"


def test_without_angles_on_a_coarse_mesh_there_is_no_estimate(drawn, monkeypatch):
    turns = []

    def instead(case, **how):
        turns.append(case.turn)
        return replace(drawn, case=case, ending=Ending("torn", "the sheet tears") if case.turn > 15.0 else None)

    monkeypatch.setattr("umform.processes.draw.two_meshes.draw", instead)
    found = extrapolated(U)
    assert turns == pytest.approx([30.0, 15.0]) and not found.estimates and found.coarser is None
    assert found.tables["Measures"][0] == ["quantity", "value", "error", "unit"]
    assert "not from this run" in found["theta1"].band.source


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
    assert pairs["under_holder"].allowed == math.inf
    assert pairs["under_holder"].penalty < 0.2 * pairs["on_die"].penalty
    given = {pair.name: pair.penalty for pair in replace(U, penalty=500.0).build()[0].contacts}
    assert given == {"on_die": 500.0, "under_holder": 30.0, "under_punch": 500.0}


@pytest.mark.parametrize(("options", "runs_two"), [([], True), (["--coarse"], False), (["--no-extrapolate"], False)])
def test_the_command_runs_two_meshes_unless_told_otherwise(drawn, monkeypatch, tmp_path, options, runs_two):
    called = []

    def instead(name):
        def run(case, **how):
            called.append(name)
            found = replace(drawn, case=case)
            return replace(found, estimates={"theta1": Limit(100.0, 0.0, 0.25)}) if name == "extrapolated" else found

        return run

    monkeypatch.setattr("umform.processes.draw.two_meshes.extrapolated", instead("extrapolated"))
    monkeypatch.setattr("umform.processes.draw.case.draw", instead("draw"))
    monkeypatch.setattr("umform.processes.draw.files.write_files", lambda *given: called.append(given[-1]) or [])
    monkeypatch.setattr("umform.processes.draw.files.draw_blank", lambda *_: ("blank.png", "picture"))
    out = CliRunner().invoke(app, ["draw", "u", "--material", "DC04", "--out", str(tmp_path / "u"), *options])
    assert out.exit_code == 0, out.output
    assert called == ["extrapolated" if runs_two else "draw", "picture"]  # the blank is drawn once
    assert ("extrapolation to zero element size" in out.output) is runs_two
    assert ("values of one mesh" in out.output) is not runs_two
