"""Small-strain laws in logarithmic strains: J2 as a special case, tangents where stretches meet, Hencky, own laws."""

from __future__ import annotations

import cards
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from umform import materials as mt
from umform.history_variables import named


@pytest.mark.parametrize("size", [1e-6, 1e-3, 0.02, 0.3])
def test_without_turning_axes_mises_in_logarithmic_space_is_the_multiplicative_j2(size):
    rng = np.random.default_rng(3)
    curve = cards.CURVES["swift"]
    j2, law = mt.J2(**cards.STEEL, hardening=curve).law(), mt.Metal(**cards.STEEL, hardening=curve).law()
    Q = Rotation.random(random_state=1).as_matrix()
    states = [j2.initial()[None], law.initial()[None]]
    for _ in range(5):  # a path whose principal axes stay
        stretch = Q @ np.diag(np.exp(size * rng.normal(size=3))) @ Q.T
        E = cards.green_lagrange(stretch)[None]
        (S, CC, states[0]), (S_log, CC_log, states[1]) = j2.respond(E, states[0]), law.respond(E, states[1])
        assert np.abs(S_log - S).max() < 1e-11 * np.abs(S).max()
        assert states[1][0, 6] == pytest.approx(states[0][0, 6], rel=1e-12, abs=1e-18)
        assert law.energy(E, states[1])[0] == pytest.approx(j2.energy(E, states[0])[0], rel=1e-9)
    E = cards.green_lagrange(Q @ np.diag(np.exp(size * rng.normal(size=3))) @ Q.T)[None]
    CC, CC_log = j2.respond(E, j2.initial()[None])[1], law.respond(E, law.initial()[None])[1]
    assert np.abs(CC_log - CC).max() < 1e-12 * np.abs(CC).max()


def test_in_simple_shear_the_two_depart():
    j2, law = (
        mt.J2(**cards.STEEL, hardening=mt.Perfect(160.0)).law(),
        mt.Metal(**cards.STEEL, hardening=mt.Perfect(160.0)).law(),
    )
    far = []
    for shear in (0.05, 2.0):
        states, S = [j2.initial()[None], law.initial()[None]], [None, None]
        for k in range(1, 101):
            F = np.eye(3)
            F[0, 1] = shear * k / 100
            for which, one in enumerate((j2, law)):
                S[which], _, states[which] = one.respond(cards.green_lagrange(F)[None], states[which])
        F_T = [F @ cards.tensor(s[0]) @ F.T for s in S]
        far.append(abs(F_T[1][0, 1] / F_T[0][0, 1] - 1))
    assert far[0] < 1e-3 < 0.05 < far[1]


@pytest.mark.parametrize(
    "E",
    [
        np.zeros(6),
        [0.2, 0.2, -0.1, 0, 0, 0],
        [0.2, 0.2, 0.2, 0, 0, 0],
        [0.2, 0.2 + 1e-9, -0.1, 1e-9, 0, 0],
        [0.1, 0.1 + 1e-4, 0.1 - 2e-4, 1e-4, 2e-4, -1e-4],
        [1.5, -0.3, 0.4, 0.5, -0.2, 0.1],
    ],
)
def test_tangent_where_principal_stretches_meet(E):
    """Shears of T in the principal axes ask for all second divided differences."""
    law = mt.Metal(**cards.STEEL, hardening=cards.CURVES["voce"], yield_function=cards.FUNCTIONS["hill48"]).law()
    start = np.random.default_rng(1).normal(size=(1, law.state_size)) * 0.02
    plastic, eqps = named(start, law.history_variables).values()
    plastic[:, 2] = -plastic[:, 0] - plastic[:, 1]
    eqps[:] = 0.1
    E = np.atleast_2d(np.asarray(E, dtype=float))
    _, CC, _ = law.respond(E, start)
    assert np.abs(cards.differences(law, E, start, 2e-5) - CC).max() < 1e-8 * np.abs(CC).max()


def test_hencky_from_linear_elasticity():
    """SVK of logarithmic strains: T = lambda tr(h) + 2 mu h, here in a rotated frame and with its energy."""
    law = mt.LogarithmicSpace(mt.SVK(**cards.STEEL)).law()
    Q = Rotation.random(random_state=4).as_matrix()
    h = np.array([0.4, -0.3, 0.05])
    E = cards.green_lagrange(Q @ np.diag(np.exp(h)) @ Q.T)
    svk = mt.SVK(**cards.STEEL)
    T = svk.lambda_ * h.sum() + 2 * svk.mu * h
    S, _, _ = law.respond(E[None], np.empty((1, 0)))
    assert np.abs(cards.tensor(S[0]) - Q @ np.diag(T / np.exp(2 * h)) @ Q.T).max() < 1e-12 * np.abs(T).max()
    energy, _ = law.energy(E[None], np.empty((1, 0)))
    assert energy[0] == pytest.approx(0.5 * T @ h, rel=1e-13)


def test_a_law_of_your_own_in_logarithmic_space():
    svk = mt.SVK(**cards.STEEL)
    stiffness = svk.law().respond(np.zeros((1, 6)), np.empty((1, 0)))[1][0]

    def hooke(h, state):
        return h @ stiffness, np.tile(stiffness, (len(h), 1, 1)), state

    E = cards.increments(9, 0.3)
    own, built = (mt.LogarithmicSpace(law).law() for law in (mt.UserLaw(hooke, name="hooke"), svk))
    for mine, theirs in zip(own.respond(E, np.empty((9, 0))), built.respond(E, np.empty((9, 0))), strict=True):
        assert np.allclose(mine, theirs, rtol=1e-12, atol=1e-9)


def test_no_answer_where_c_is_not_positive_definite():
    law = mt.Metal(**cards.STEEL, hardening=cards.CURVES["voce"]).law()
    with pytest.raises(ValueError, match="point 1"):
        law.respond(np.array([[0.1, 0, 0, 0, 0, 0], [-0.6, 0, 0, 0, 0, 0]]), np.zeros((2, 7)))
