"""Models and results are sent to other processes as problems with their states."""

import multiprocessing
import pickle
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue
from umform.processes.air_bending import AirBending
from umform.processes.problems import problem_of

BEND = problem_of(AirBending(stroke=0.5, layers=1, elements_per_thickness=1.0))


def run(problem):
    return problem.build().solve(progress=False)


def test_a_result_comes_back_from_a_pool_of_the_user(tmp_path):
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        there = pool.submit(run, BEND).result()
    here = run(BEND)
    assert {name: column.tolist() for name, column in there.table().items()} == {
        name: column.tolist() for name, column in here.table().items()
    }
    assert there.model.u.tolist() == here.model.u.tolist()
    assert uf.fields.point_fields(there.model).eqps.tolist() == uf.fields.point_fields(here.model).eqps.tolist()
    assert there.balance().drift.tolist() == here.balance().drift.tolist()
    assert there.write(tmp_path / "bend.vtkhdf").stat().st_size == here.write(tmp_path / "here.vtkhdf").stat().st_size


def test_a_sent_model_goes_on_from_its_state():
    first = BEND.with_({"steps": BEND.source.data["steps"][:1]})
    prepared = first.build()
    prepared.solve(progress=False)
    sent = pickle.loads(pickle.dumps(prepared.model))
    assert sent.u.tolist() == prepared.model.u.tolist() and np.abs(sent.u).max() > 0.0
    assert (
        sent.evaluate(sent.state).residual.tolist() == prepared.model.evaluate(prepared.model.state).residual.tolist()
    )


def test_a_model_built_by_hand_says_what_can_be_sent():
    model = uf.Model(uf.mesh.strip(10.0, 1.0, 0.2, (2, 1)), material=uf.SVK(E=1.0, nu=0.3))
    with pytest.raises(InvalidValue, match="built by hand cannot be sent"):
        pickle.dumps(model)
