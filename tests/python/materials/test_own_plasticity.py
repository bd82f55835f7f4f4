"""Plasticity written in Python: radial return with a history, on paths, in checks and in messages."""

import numpy as np
import pytest

import umform as uf
from umform.errors import InvalidValue, NoConvergence
from umform.history_variables import named

E, NU, YIELD, HARDENING = 206e3, 0.3, 200.0, 2000.0
MU, KAPPA = E / (2 * (1 + NU)), E / (3 * (1 - 2 * NU))
ONE = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
DEVIATOR = np.diag([1.0, 1.0, 1.0, 0.5, 0.5, 0.5]) - np.outer(ONE, ONE) / 3.0
ENGINEERING = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])


STATE = {"plastic_strain": 6, "eqps": 1}


def radial_return(strain, history):
    plastic, eqps = named(history, STATE).values()
    eqps = eqps[:, 0]
    trial = 2.0 * MU * (strain - plastic) @ DEVIATOR
    mises = np.sqrt(1.5 * np.einsum("qi,i,qi->q", trial, ENGINEERING, trial))
    step = np.maximum(mises - YIELD - HARDENING * eqps, 0.0) / (3.0 * MU + HARDENING)
    size = np.maximum(mises, 1e-300)[:, None]
    normal = 1.5 * trial / size
    pressure = KAPPA * (strain - plastic)[:, :3].sum(axis=1)
    stress = trial - 2.0 * MU * step[:, None] * normal + pressure[:, None] * ONE
    fall = 6.0 * MU**2 * (step[:, None] / size)[:, :, None]
    more = np.where(step > 0.0, 4.0 * MU**2 * (step / size[:, 0] - 1.0 / (3.0 * MU + HARDENING)), 0.0)
    tangent = KAPPA * np.outer(ONE, ONE) + (2.0 * MU - fall) * DEVIATOR
    tangent = tangent + more[:, None, None] * np.einsum("qi,qj->qij", normal, normal)
    new = plastic + step[:, None] * normal * ENGINEERING
    return stress, tangent, np.column_stack([new, eqps + step])


SMALL = uf.UserLaw(radial_return, state=STATE, name="own J2")
METAL = uf.Metal(E, NU, hardening=uf.Linear(YIELD, HARDENING))


@pytest.mark.parametrize("law", [SMALL, uf.LogarithmicSpace(SMALL)])
@pytest.mark.parametrize("component", [0, 3])
def test_a_bar_of_ones_own_law_is_that_of_the_metal(law, component):
    strains = np.linspace(0.002, 0.05, 6)
    for own, house in zip(
        uf.materials.tension(law, strains, component=component),
        uf.materials.tension(METAL, strains, component=component),
        strict=True,
    ):
        np.testing.assert_allclose(own, house, rtol=1e-8, atol=1e-10)


def test_a_law_without_a_plastic_strain_has_none_on_its_path():
    C = E * np.eye(6)
    law = uf.UserLaw(lambda strain, history: (strain @ C, np.broadcast_to(C, (len(strain), 6, 6)), history))
    strain, stress, plastic = uf.materials.tension(law, [0.001])
    assert strain.shape == stress.shape == (1,)
    assert stress[0] == pytest.approx(206.0)
    assert np.isnan(plastic).all()


@pytest.mark.parametrize("law", [uf.J2, "DC04"])
def test_what_is_no_law_has_no_path(law):
    with pytest.raises(InvalidValue, match="a path needs a law") as caught:
        uf.materials.tension(law, [0.01])
    assert "Metal" in caught.value.remedy


def test_check_law_names_the_shapes_of_the_history():
    strains = np.full((3, 6), 1e-3)
    assert uf.check_law(uf.LogarithmicSpace(SMALL), strains, np.zeros((3, 7))) < 1e-5
    with pytest.raises(InvalidValue, match=r"must have shape \(3, 7\)") as caught:
        uf.check_law(SMALL, strains, np.zeros((3, 3)))
    assert caught.value.value == (3, 3)
    assert "'plastic_strain': 6" in caught.value.remedy


def test_no_convergence_with_a_law_of_ones_own_names_its_check():
    C = 1000.0 * np.eye(6)
    sheet = uf.mesh.strip(4.0, 1.0, 0.5, (1, 1))

    def no_answer(strain, history):
        stress = np.where(strain > 0.01, np.nan, strain @ C)
        return stress, np.broadcast_to(C, (len(strain), 6, 6)), history

    model = uf.Model(sheet, "DISP3D", material=uf.LogarithmicSpace(uf.UserLaw(no_answer)))
    model.fix("x0")
    pull = model.prescribe("x1", "x")
    with pytest.raises(NoConvergence) as caught:
        uf.solve(model, uf.Move(pull, to=1.0, steps=1), progress=False)
    assert "check_law" in caught.value.remedy
    assert "check_surface" not in caught.value.remedy
