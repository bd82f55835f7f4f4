"""Jobs of all kinds balance; a quantity that is out of balance is a miss, unless it is known."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import umform as uf

#: How many jobs the sample has.
SAMPLE = 12


@pytest.fixture
def balances(script):
    return script("balances")


@pytest.mark.parametrize("which", range(SAMPLE))
def test_the_sample_balances(balances, which):
    (job,) = [job for job in balances.JOBS if job.name == balances.SAMPLE[which]]
    found = balances.watch(job)
    assert (found["misses"], found["error"]) == ([], "")
    assert {"forces", "moments", "energies", "volume of the law", "penetration", "work of tools"} - {
        *found["found"]
    } <= {"volume of the law"}


def test_names_of_jobs_are_theirs_alone(balances):
    names = [job.name for job in balances.JOBS]
    assert len(set(names)) == len(names) >= 60
    assert len(balances.SAMPLE) == SAMPLE
    assert {known.job for known in balances.KNOWN} <= set(names)


def pressed(**more):
    """A block that a plate compresses by a tenth, beyond yield."""
    law = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(200.0, 1000.0))
    model = uf.Model(uf.mesh.strip(2.0, 1.0, 1.0, (2, 1)), material=law)
    for nodes, normal in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(nodes, normal)
    plate = model.tool("plate", uf.Plane((0.0, 0.0, 0.5), (0.0, 0.0, -1.0)))
    model.contact("upper", plate, name="on_plate", **more)
    way = model.drive(plate, "-z", name="way")
    return uf.solve(model, uf.Move(way, 0.1, steps=4), progress=False)


def test_work_of_a_tool_is_that_of_its_control(balances, monkeypatch):
    result = pressed(penalty=1e6)
    balance = result.balance()
    assert balance.works["plate"][-1] == pytest.approx(balance.external_work[-1], rel=1e-12)
    assert balance.works["loads and supports"][-1] == 0.0
    assert balances.works(result) < 1e-9
    rows = [row | {"way_force": 1.01 * row["way_force"]} for row in result.rows]
    monkeypatch.setattr(result, "rows", rows)
    assert balances.works(result) == pytest.approx(0.01, rel=1e-3)


def test_penetration_counts_where_something_is_promised(balances):
    result = pressed(penalty=1e6)
    assert balances.penetration(result) == 0.0
    deepest = result["on_plate_penetration"].max()
    result.model.contacts[0].allowed = 0.25 * deepest
    assert balances.penetration(result) == pytest.approx(4.0)


def test_an_answer_is_unlike_its_image_by_what_moves(balances):
    from corpus import answers  # the fixture has put the folder on the path

    model = pressed(penalty=1e6).model
    assert answers.unlike(model, model, np.eye(3)) == 0.0
    shifted = SimpleNamespace(mesh=model.mesh, u=model.u + 1e-3 * (np.arange(model.u.size) == 0))
    assert answers.unlike(model, shifted, np.eye(3)) == pytest.approx(1e-3 / np.abs(model.u).max())
    with pytest.raises(ValueError, match="no image"):
        answers.unlike(model, model, answers.LEFT_RIGHT)


def test_a_drift_above_its_limit_must_fall_with_the_square(balances, monkeypatch):
    job = next(job for job in balances.JOBS if job.finer is not None)
    drifts = iter((0.0034, 0.0036))
    monkeypatch.setattr(balances, "largest_drift", lambda results: next(drifts))
    finer = balances.Watched(job.kind, job.special, job.run, lambda: SimpleNamespace(results=[]))
    assert balances._kept(finer, "energies", 0.01)
    assert not balances._kept(finer, "energies", 0.01)
    assert not balances._kept(balances.Watched("a", "b", job.run), "energies", 0.01)


def test_known_misses_have_a_bound(balances):
    known = balances.KNOWN[0]
    (job,) = [job for job in balances.JOBS if job.name == known.job]
    assert balances._kept(job, known.quantity, known.most)
    assert not balances._kept(job, known.quantity, 1.01 * known.most)
    assert not balances._kept(job, "forces", known.most)


def test_the_page_has_the_largest_and_the_misses(balances):
    def one(name, energies, misses):
        found = {"energies": energies, "penetration": 1.0}
        return {"name": name, "CPU s": 1.0, "increments": 3, "found": found, "misses": misses, "error": ""}

    text = balances.page([one("a", 0.02, ["energies"]), one("b", 1e-4, [])], balances.LIMITS, ())
    assert "1 of 2 jobs miss a limit." in text
    assert "| energies | 0.005 | **0.02** | a | 2 | 1 |" in text
    assert "* **energies** above 0.005: a 0.02" in text
    assert "| b |  |  | 1.0e-04 |" in text
