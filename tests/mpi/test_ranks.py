"""The same results on 1, 2 and 3 ranks as in one process: displacements to 1e-8, iterations to the last one."""

from __future__ import annotations

import json

import numpy as np
import pytest

NAMES = ["free_bending", "air_bending", "hinged_strip", "blown_strip", "held_by_multipliers", "cut"]
NAMES += ["pressed", "closed", "sprung_back", "beaded", "foundation", "two_bodies", "metals"]
#: The last states are released: what is left of pressures and balances there is round-off.
RESIDUES = ("imbalance", "point contact_pressure", "pressure")
#: Smallest sizes to compare with, where a release leaves next to nothing: forces, and tractions of a holder's friction.
LEAST = {"point reaction": 1.0, "friction_traction": 0.01, " friction": 0.01}


def compare(one, other, tolerance=1e-8):
    assert sorted(one.files) == sorted(other.files)
    np.testing.assert_array_equal(one["iterations"], other["iterations"])
    for name in one.files:
        if name == "events":
            assert [event.rpartition("=")[0] for event in one[name]] == [
                event.rpartition("=")[0] for event in other[name]
            ]
        elif not name.endswith(RESIDUES):
            a, b = one[name], other[name]
            np.testing.assert_array_equal(np.isnan(a), np.isnan(b), err_msg=name)
            least = max((size for end, size in LEAST.items() if name.endswith(end)), default=0.0)
            largest = max(np.nanmax(np.abs(a)), least)
            np.testing.assert_allclose(b, a, rtol=0, atol=tolerance * max(largest, 1e-300), err_msg=name)


@pytest.mark.parametrize("ranks", [1, 2, 3])
@pytest.mark.parametrize("case", NAMES)
def test_ranks_give_what_one_process_gives(case, ranks, found):
    compare(found(0, case), found(ranks, case))


def test_the_cases_are_not_easy(found):
    """Cuts, lift-off, contact at the end of the loading, multipliers, a pressure that bends the strip, crushed foam."""
    assert len(found(0, "cut")["iterations"]) > 2 * 3 + 5
    assert found(0, "held_by_multipliers")["history ram_active"].max() > 5
    assert found(0, "air_bending")["history die_active"].max() > 5
    assert np.abs(found(0, "blown_strip")["point displacement"]).max() > 0.5
    assert found(0, "pressed")["history press_way"][-3] < -0.3
    assert found(0, "pressed")["history gas_way"][-3] < -0.3
    assert found(0, "closed")["history holder_fz"].max() > 150.0
    assert found(0, "closed")["history hold_stop"].max() > 5.0
    assert found(0, "closed")["history rest_acts"][[0, -1]].tolist() == [1.0, 0.0]
    assert found(0, "foundation")["history foam_crush"][-1] > 0.1
    assert found(0, "two_bodies")["cell plastic_strain_max"].max() > 0.01
    assert found(0, "metals")["cell stagnation_radius"].max() > 1.0
    assert 0.0 < found(0, "metals")["cell modulus"].max() < 206e3
    assert found(0, "sprung_back")["history punch_fz"].max() > 30.0
    assert np.abs(found(0, "sprung_back")["point reaction"]).max() < 1e-6  # free of stress on the gauge
    for case in NAMES:
        for ranks in (0, 3):
            one = found(ranks, case)
            held = one["history rest_acts"][1:] == 0.0 if case == "closed" else slice(None)  # else forces of 1e-8
            assert one["imbalance"][1:][held].max() < 1e-9


@pytest.mark.parametrize(
    "case", ["cut", "held_by_multipliers", "pressed", "closed", "sprung_back", "foundation", "metals"]
)
@pytest.mark.parametrize(("first", "second"), [(2, 3), (2, 0), (0, 2)])
def test_a_run_stopped_on_some_ranks_goes_on_on_others(case, first, second, found, tmp_path, mpi):
    solver = {True: "petsc", False: "superlu"}
    mpi.run(first, mpi.cases, "stop", solver[first > 0], tmp_path, case)
    stopped = np.load(tmp_path / f"{case}.npz")["iterations"]
    assert 2 < len(stopped) < len(found(0, case)["iterations"])
    mpi.run(second, mpi.cases, "resume", solver[second > 0], tmp_path, case)
    compare(found(0, case), np.load(tmp_path / f"{case}.npz"))


@pytest.mark.parametrize("ranks", [1, 3])
def test_what_one_rank_meets_all_ranks_know(ranks, mpi):
    """Inertia and singular matrices as SuperLU tells them; failed cells, tools that are not finite, wrong runs."""
    answer = json.loads(mpi.run(ranks, mpi.cases.with_name("algebra.py")).stdout)
    assert answer["negative"] == answer["serial"]
    assert answer["negative"][0] == 0 < answer["negative"][1] < answer["negative"][2]
    np.testing.assert_allclose(answer["largest"], 0.0, atol=1e-13)
    assert max(answer["error"]) < 1e-8
    assert answer["nan"] == "NotFinite"  # on one rank only, and refused on all
    assert answer["failed"] == [5, 5]
    assert answer["tool"] == 2 * ["g of a surface function is not finite"]
    twice, fields, other, nameless, last, step, term, unknown = answer["runs"]
    assert twice == fields == "the history of the elements is not here"
    assert other == ("done" if ranks == 1 else "the ranks have built different models")
    assert nameless == ("done" if ranks == 1 else "the first rank has a model that cannot be sent to the others")
    assert last == (twice if ranks == 1 else "the first rank has no model")
    assert step == "a step moves a control that the model does not have"
    assert term == unknown == "a term cannot be shared with the solver petsc"
    assert answer["loose"] == "SingularMatrix"


def test_no_rank_but_the_first_knows_how_large_the_model_is(mpi):
    """The same part in sheets of 300 and 3000 cells: what a rank allocates in a whole run stays the same."""
    small, large = json.loads(mpi.run(3, mpi.cases.with_name("memory.py")).stdout)
    assert small["cells"] == large["cells"]
    assert small["whole"] * 10 == large["whole"]
    for name in ("kept", "peak"):
        np.testing.assert_allclose(large[name][1:], small[name][1:], rtol=0.02)
        assert large[name][0] > 5 * small[name][0]
