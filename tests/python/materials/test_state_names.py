"""The history of a law has names, and fields go by them."""

from __future__ import annotations

import numpy as np
import pytest

from umform import materials as mt
from umform.errors import InvalidValue
from umform.materials import UserLaw
from umform.mesh import strip
from umform.model import Model
from umform.results.fields import named_history, point_fields


def grown(E, state):
    """Its history: six numbers that keep the strain, and its size."""
    size = np.sqrt((E * E).sum(axis=1))
    return E, np.tile(np.eye(6), (len(E), 1, 1)), np.concatenate([E, size[:, None]], axis=1)


def columns_of(model, first, end):
    """The history by its places: what the names must find."""
    return model.bodies.only.block.state[..., first:end]


def stretched(law):
    model = Model(strip(2.0, 1.0, 0.2, (2, 1)), "DISP3D", material=law)
    model.fix("x0")
    u = (0.02 * model.mesh.points * (1, 0, 0)).ravel()
    model.system.commit(model.evaluate(u))
    return model


@pytest.mark.parametrize(
    ("law", "names"),
    [
        (mt.SVK(E=1.0, nu=0.3), {}),
        (mt.NeoHooke(E=1.0, nu=0.3), {}),
        (mt.NeoHookePower(E=1.0, nu=0.3), {}),
        (mt.J2(E=210e3, nu=0.3, hardening=mt.Perfect(160.0)), {"Cp_inv": 6, "eqps": 1}),
        (UserLaw(grown, state={"strain": 6, "eqps": 1}), {"strain": 6, "eqps": 1}),
        (UserLaw(grown, initial=(0.0,) * 7), {"history": 7}),
        (UserLaw(grown), {}),
    ],
)
def test_each_law_names_its_history_in_order(law, names):
    native = law.law()
    assert list(native.history_variables.items()) == list(names.items())
    assert native.state_size == sum(names.values()) == len(native.initial())


def test_named_history_of_a_users_law():
    model = stretched(UserLaw(grown, state={"strain": 6, "eqps": 1}))
    at = point_fields(model)
    np.testing.assert_array_equal(at.history["strain"], columns_of(model, 0, 6))
    np.testing.assert_allclose(at.history["strain"], at.E, atol=1e-15)
    np.testing.assert_array_equal(at.eqps, columns_of(model, 6, 7)[..., 0])
    assert at.eqps.min() > 0.01


def test_the_plastic_strain_goes_by_its_name_not_by_its_place():
    def first(E, state):
        S, CC, new = grown(E, state)
        return S, CC, np.roll(new, 1, axis=1)

    model = stretched(UserLaw(first, state={"eqps": 1, "strain": 6}))
    np.testing.assert_array_equal(point_fields(model).eqps, columns_of(model, 0, 1)[..., 0])
    assert point_fields(stretched(UserLaw(first, state={"size": 1, "strain": 6}))).eqps is None


def test_j2_has_its_metric_and_its_plastic_strain():
    model = stretched(mt.J2(E=210e3, nu=0.3, hardening=mt.Linear(160.0, 500.0)))
    parts = named_history(model.bodies.only)
    assert list(parts) == ["Cp_inv", "eqps"]
    assert parts["Cp_inv"].shape == (2, model.bodies.only.block.points, 6)
    assert parts["eqps"].min() > 0.01
    assert model.bodies.only.block.history_variables == {"Cp_inv": 6, "eqps": 1}


def test_initial_values_go_with_the_names():
    law = UserLaw(grown, initial=(1.0,) * 6 + (0.5,), state={"strain": 6, "eqps": 1})
    np.testing.assert_array_equal(law.law().initial(), (1.0,) * 6 + (0.5,))
    assert UserLaw(grown, state={"strain": 6, "eqps": 1}).initial == (0.0,) * 7


@pytest.mark.parametrize(
    ("initial", "state"), [((0.0,) * 6, {"strain": 6, "eqps": 1}), ((), {"strain": 0}), ((), {"strain": 1.5})]
)
def test_names_of_another_size_are_refused(initial, state):
    with pytest.raises(InvalidValue):
        UserLaw(grown, initial=initial, state=state)


def test_a_law_with_names_can_be_hashed_and_compared():
    laws = [UserLaw(grown, state={"strain": 6, "eqps": 1}) for _ in range(2)]
    assert laws[0] == laws[1]
    assert hash(laws[0]) == hash(laws[1])
    assert laws[0] != UserLaw(grown, state={"strain": 7})
