"""Metals put together from parts: J2 as a special case, tangents, return maps, work, closed forms, axes."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import umform as uf
from umform import materials as mt
from umform.errors import InvalidValue
from umform_book.newton_order import measure

STEEL = {"E": 210e3, "nu": 0.3}
ALUMINIUM = {"E": 70e3, "nu": 0.33}
PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]
SHEAR = np.array([1, 1, 1, 2, 2, 2])

#: Barlat et al. (2005), table 2, whose shears c44, c55, c66 are 23, 13, 12.
AA2090 = mt.Yld2004(
    mt.Transformation(-0.069888, 0.936408, 0.079143, 1.003060, 0.524741, 1.363180, 0.954322, 1.023770, 1.069060),
    mt.Transformation(0.981171, 0.476741, 0.575316, 0.866827, 1.145010, -0.079294, 1.404620, 1.051660, 1.147100),
)
AA6111 = mt.Yld2004(
    mt.Transformation(1.241024, 1.078271, 1.216463, 1.223867, 1.093105, 0.889161, 1.349094, 0.501909, 0.557173),
    mt.Transformation(0.775366, 0.922743, 0.765487, 0.793356, 0.918689, 1.027625, 0.589787, 1.115833, 1.112273),
)
FUNCTIONS = {
    "mises": mt.Mises(),
    "hill48": mt.Hill48(1.8, 1.5, 2.2),
    "hill48-stresses": mt.Hill48.from_stresses(1.0, 1.04, 0.97, 1.05),
    "hosford": mt.Hosford(6),
    "hosford-20": mt.Hosford(20),
    "yld91": mt.Yld91(1.05, 0.97, 1.1, 1.0, 0.9, 1.08),
    "aa2090": AA2090,
    "aa6111": AA6111,
}
CURVES = {
    "perfect": mt.Perfect(160.0),
    "voce": mt.Voce(130.0, 300.0, 12.0),
    "swift": mt.Swift(500.0, 0.004, 0.21),
    "table": mt.Table((0.0, 0.02, 0.1, 0.5), (160.0, 220.0, 250.0, 400.0)),
}
BACK = {
    "fixed": None,
    "prager": mt.Chaboche([(2000.0, 0.0)]),
    "two": mt.Chaboche([(9000.0, 120.0), (800.0, 8.0)]),
    "four": mt.Chaboche([(30000.0, 600.0), (5000.0, 60.0), (900.0, 5.0), (100.0, 0.0)]),
}
FALLING = mt.FallingModulus(saturated=55e3, rate=40.0)
SPCC = mt.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=9.0, m=12.0, h=0.5)  # Yoshida and Uemori (2002), table 1
CARDS = {
    f"{f}, {c}, {b}{', falling' if m else ''}": mt.Metal(
        **ALUMINIUM, hardening=CURVES[c], yield_function=FUNCTIONS[f], back_stress=BACK[b], modulus=m
    )
    for f, c, b, m in [
        *((f, "voce", "fixed", None) for f in FUNCTIONS),
        *(("hill48", c, "two", FALLING) for c in CURVES),
        *(("aa2090", c, b, None) for c, b in zip(CURVES, BACK, strict=True)),
        ("aa2090", "swift", "four", FALLING),
        ("mises", "perfect", "prager", None),
        ("mises", "voce", "fixed", FALLING),
    ]
}


CARDS |= {
    f"{f}, two surfaces{', falling' if m else ''}": mt.Metal(
        **ALUMINIUM, hardening=mt.Perfect(124.0), yield_function=FUNCTIONS[f], back_stress=SPCC, modulus=m
    )
    for f, m in (("mises", None), ("hill48", None), ("hill48", FALLING), ("aa2090", None))
}


def voigt(A, shear=1.0):
    return np.array([A[i, j] * (1.0 if i == j else shear) for i, j in PAIRS])


def tensor(v, shear=1.0):
    return np.asarray(v)[[[0, 3, 5], [3, 1, 4], [5, 4, 2]]] * (np.eye(3) + shear * (1 - np.eye(3)))


def green_lagrange(F):
    return voigt(0.5 * (F.T @ F - np.eye(3)), 2.0)


def increments(count, size, seed=0):
    steps = np.random.default_rng(seed).normal(size=(count, 6))
    return size * steps / np.linalg.norm(steps, axis=1)[:, None]


def differences(law, E, state, step):
    """Tangent by differences of fourth order."""
    columns = []
    for e in np.eye(6):
        one, two = (law.respond(E + k * step * e, state)[0] - law.respond(E - k * step * e, state)[0] for k in (1, 2))
        columns.append((8 * one - two) / (12 * step))
    return np.stack(columns, axis=2)


# Logarithmic space -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("size", [1e-6, 1e-3, 0.02, 0.3])
def test_without_turning_axes_mises_in_logarithmic_space_is_the_multiplicative_j2(size):
    rng = np.random.default_rng(3)
    curve = CURVES["swift"]
    j2, law = mt.J2(**STEEL, hardening=curve).law(), mt.Metal(**STEEL, hardening=curve).law()
    Q = Rotation.random(random_state=1).as_matrix()
    states = [j2.initial()[None], law.initial()[None]]
    for _ in range(5):  # a path whose principal axes stay
        stretch = Q @ np.diag(np.exp(size * rng.normal(size=3))) @ Q.T
        E = green_lagrange(stretch)[None]
        (S, CC, states[0]), (S_log, CC_log, states[1]) = j2.respond(E, states[0]), law.respond(E, states[1])
        assert np.abs(S_log - S).max() < 1e-11 * np.abs(S).max()
        assert states[1][0, 6] == pytest.approx(states[0][0, 6], rel=1e-12, abs=1e-18)
        assert law.energy(E, states[1])[0] == pytest.approx(j2.energy(E, states[0])[0], rel=1e-9)
    E = green_lagrange(Q @ np.diag(np.exp(size * rng.normal(size=3))) @ Q.T)[None]
    CC, CC_log = j2.respond(E, j2.initial()[None])[1], law.respond(E, law.initial()[None])[1]
    assert np.abs(CC_log - CC).max() < 1e-12 * np.abs(CC).max()


def test_in_simple_shear_the_two_depart():
    j2, law = mt.J2(**STEEL, hardening=mt.Perfect(160.0)).law(), mt.Metal(**STEEL, hardening=mt.Perfect(160.0)).law()
    far = []
    for shear in (0.05, 2.0):
        states, S = [j2.initial()[None], law.initial()[None]], [None, None]
        for k in range(1, 101):
            F = np.eye(3)
            F[0, 1] = shear * k / 100
            for which, one in enumerate((j2, law)):
                S[which], _, states[which] = one.respond(green_lagrange(F)[None], states[which])
        F_T = [F @ tensor(s[0]) @ F.T for s in S]
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
    law = mt.Metal(**STEEL, hardening=CURVES["voce"], yield_function=FUNCTIONS["hill48"]).law()
    start = np.random.default_rng(1).normal(size=(1, 7)) * 0.02
    start[:, 6] = 0.1
    start[:, 2] = -start[:, 0] - start[:, 1]
    E = np.atleast_2d(np.asarray(E, dtype=float))
    _, CC, _ = law.respond(E, start)
    assert np.abs(differences(law, E, start, 2e-5) - CC).max() < 1e-8 * np.abs(CC).max()


def test_hencky_from_linear_elasticity():
    """SVK of logarithmic strains: T = lambda tr(h) + 2 mu h, here in a rotated frame and with its energy."""
    law = mt.LogarithmicSpace(mt.SVK(**STEEL)).law()
    Q = Rotation.random(random_state=4).as_matrix()
    h = np.array([0.4, -0.3, 0.05])
    E = green_lagrange(Q @ np.diag(np.exp(h)) @ Q.T)
    svk = mt.SVK(**STEEL)
    T = svk.lambda_ * h.sum() + 2 * svk.mu * h
    S, _, _ = law.respond(E[None], np.empty((1, 0)))
    assert np.abs(tensor(S[0]) - Q @ np.diag(T / np.exp(2 * h)) @ Q.T).max() < 1e-12 * np.abs(T).max()
    energy, _ = law.energy(E[None], np.empty((1, 0)))
    assert energy[0] == pytest.approx(0.5 * T @ h, rel=1e-13)


def test_a_law_of_your_own_in_logarithmic_space():
    svk = mt.SVK(**STEEL)
    stiffness = svk.law().respond(np.zeros((1, 6)), np.empty((1, 0)))[1][0]

    def hooke(h, state):
        return h @ stiffness, np.tile(stiffness, (len(h), 1, 1)), state

    E = increments(9, 0.3)
    own, built = (mt.LogarithmicSpace(law).law() for law in (mt.UserLaw(hooke, name="hooke"), svk))
    for mine, theirs in zip(own.respond(E, np.empty((9, 0))), built.respond(E, np.empty((9, 0))), strict=True):
        assert np.allclose(mine, theirs, rtol=1e-12, atol=1e-9)


def test_no_answer_where_c_is_not_positive_definite():
    law = mt.Metal(**STEEL, hardening=CURVES["voce"]).law()
    with pytest.raises(ValueError, match="point 1"):
        law.respond(np.array([[0.1, 0, 0, 0, 0, 0], [-0.6, 0, 0, 0, 0, 0]]), np.zeros((2, 7)))


# Yield functions ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("stress", "equivalent"),
    [
        ([100, 0, 0, 0, 0, 0], 99.932153929799531134),
        ([0, 100, 0, 0, 0, 0], 110.32696825195229388),
        ([50, 50, 0, 50, 0, 0], 122.30436942533559492),
        ([120.5, -35.25, 60.75, 42.5, -28.0, 33.25], 187.28212180970985109),
    ],
)
def test_yld2004_at_states_known_to_20_digits(stress, equivalent):
    """M. Pacheco-Alarcon, tests of MUSCLE, in 90 digits; shears there and here 12, 23, 13."""
    assert AA2090.function()(np.array(stress, dtype=float))[0] == pytest.approx(equivalent, rel=1e-14)


def test_gradient_of_yld2004():
    """The same source; shears there are of the tensor, half of those here."""
    stress = np.array([120.5, -35.25, 60.75, 42.5, -28.0, 33.25])
    known = [0.46131648419506466702, -0.81171119189451749695, 0.35039470769945102992]
    known += [2 * g for g in (0.31754139064342331668, -0.45754809859404116078, 0.43880414633419044754)]
    assert AA2090.function()(stress)[1] == pytest.approx(known, rel=1e-12)


def by_eigenvalues(function, stress):
    """sum |S'_i - S''_j|^a = 4 phi^a from eigenvalues."""
    s = tensor(stress) - np.trace(tensor(stress)) / 3 * np.eye(3)
    roots = []
    for c in (function.first, function.second):
        normal = np.array([[0, c.c12, c.c13], [c.c21, 0, c.c23], [c.c31, c.c32, 0]])
        S = np.diag(-normal @ np.diag(s))
        for (i, j), factor in (((0, 1), c.shear12), ((1, 2), c.shear23), ((0, 2), c.shear13)):
            S[i, j] = S[j, i] = factor * s[i, j]
        roots.append(np.linalg.eigvalsh(S))
    differences = np.abs(np.subtract.outer(*roots))
    return (np.sum(differences**function.exponent) / 4) ** (1 / function.exponent)


@pytest.mark.parametrize("name", ["hosford", "hosford-20", "yld91", "aa2090", "aa6111"])
def test_polynomial_is_the_sum_over_eigenvalues(name):
    function = FUNCTIONS[name].function()
    for stress in np.random.default_rng(5).normal(size=(300, 6)):
        assert function(stress)[0] == pytest.approx(by_eigenvalues(FUNCTIONS[name], stress), rel=2e-13)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_yield_functions_are_of_degree_one_and_convex(name):
    function = FUNCTIONS[name].function()
    rng = np.random.default_rng(2)
    for a, b in rng.normal(size=(200, 2, 6)):
        (phi, gradient), (other, _) = function(a), function(b)
        assert function(7.0 * a)[0] == pytest.approx(7.0 * phi, rel=1e-13)
        assert gradient @ a == pytest.approx(phi, rel=1e-12)  # Euler
        assert gradient[:3].sum() == pytest.approx(0.0, abs=1e-12)
        assert function(0.5 * (a + b))[0] <= 0.5 * (phi + other) * (1 + 1e-13)
        assert gradient @ b <= other * (1 + 1e-12)  # the surface lies on one side of its tangent planes


def test_special_cases():
    rng = np.random.default_rng(8)
    mises, hosford = mt.Mises().function(), mt.Hosford(8).function()
    for stress in rng.normal(size=(50, 6)):
        roots = np.linalg.eigvalsh(tensor(stress))
        eighth = sum(abs(a - b) ** 8 for a, b in itertools.combinations(roots, 2)) / 2
        assert hosford(stress)[0] == pytest.approx(eighth**0.125, rel=1e-13)
        assert mt.Hosford(2).function()(stress)[0] == pytest.approx(mises(stress)[0], rel=1e-14)
        assert mt.Hill48(1, 1, 1).function()(stress)[0] == pytest.approx(mises(stress)[0], rel=1e-14)
        assert mt.Yld91(1, 1, 1).function()(stress)[0] == pytest.approx(hosford(stress)[0], rel=1e-14)


# Directions --------------------------------------------------------------------------------------------------


def bar(function, angle):
    """Yield stress over that of the curve and r-value of a bar at an angle to the rolling direction."""
    stiff = mt.Metal(E=1e6, nu=0.3, hardening=mt.Perfect(1.0), yield_function=function)
    _, stress, plastic = mt.tension(stiff, np.linspace(1e-6, 1e-5, 10), angle)
    return stress[-1], plastic[-1, 1] / plastic[-1, 2]


@pytest.mark.parametrize(
    ("function", "values"),
    [
        (
            AA2090,
            "0 1.00068 0.24506, 15 0.95405 0.27035, 30 0.90447 0.74288, 45 0.81763 1.54452, "
            "60 0.82011 1.06516, 75 0.89149 0.55735, 90 0.90640 0.68495",
        ),
        (
            AA6111,
            "0 0.99021 0.89828, 15 0.98965 0.87599, 30 0.98037 0.74740, 45 0.96191 0.61565, "
            "60 0.94814 0.59574, 75 0.94460 0.63648, 90 0.94510 0.66041",
        ),
    ],
    ids=["AA2090-T3", "AA6111-T4"],
)
def test_yield_stress_and_r_over_the_angle(function, values):
    """Computed from the coefficients of Barlat et al. (2005) by an independent program, five digits."""
    for row in values.split(", "):
        angle, stress, r = map(float, row.split())
        assert bar(function, angle) == pytest.approx((stress, r), abs=1.2e-5)


def test_hill48_returns_what_it_was_made_from():
    function = mt.Hill48(r0=1.79, r45=1.51, r90=2.27)
    assert [bar(function, angle)[1] for angle in (0, 45, 90)] == pytest.approx([1.79, 1.51, 2.27], rel=1e-8)
    assert bar(function, 0)[0] == pytest.approx(1.0, rel=1e-10)
    function = mt.Hill48.from_stresses(1.0, 1.04, 0.97, 1.05)
    assert [bar(function, angle)[0] for angle in (0, 45, 90)] == pytest.approx([1.0, 1.04, 0.97], rel=1e-8)
    assert function.function()(np.array([1.05, 1.05, 0, 0, 0, 0]))[0] == pytest.approx(1.0, rel=1e-13)


# Return maps -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("card", CARDS)
def test_tangent_against_differences_and_its_symmetry(card):
    law = CARDS[card].law()
    state = np.tile(law.initial(), (6, 1))
    E = np.zeros((6, 6))
    for step in range(3):  # paths that turn
        E = E + increments(6, 0.03, seed=step)
        _, CC, after = law.respond(E, state)
        assert (after[:, 6] > state[:, 6]).all()
        assert np.abs(differences(law, E, state, 1e-6) - CC).max() < 3e-8 * np.abs(CC).max(), step
        if law.symmetric:
            assert np.array_equal(CC, CC.transpose(0, 2, 1))
        state = after


def test_who_is_symmetric():
    """Where no back stress is recalled and the modulus stays."""
    symmetric = {name for name, card in CARDS.items() if card.law().symmetric}
    assert symmetric == {
        name
        for name, card in CARDS.items()
        if card.modulus is None and not {"two", "four"} & set(name.replace(",", "").split())
    }


@pytest.mark.parametrize("card", CARDS)
def test_no_increment_up_to_ten_per_cent_fails(card):
    law = CARDS[card].law()
    count, state = 4000, np.tile(law.initial(), (4000, 1))
    E = np.zeros((count, 6))
    sizes = np.exp(np.random.default_rng(1).uniform(math.log(1e-4), math.log(0.1), size=(2, count)))
    for step, size in enumerate(sizes):
        E = E + size[:, None] * increments(count, 1.0, seed=step)
        _, _, state = law.respond(E, state)  # raises where a point has no answer
        assert np.isfinite(state).all()
    E = E + increments(count, 0.1, seed=9)
    law.respond(E, state)


@pytest.mark.parametrize("card", CARDS)
def test_stress_lies_on_the_yield_surface(card):
    metal = CARDS[card]
    law, function, curve = metal.small_strain_law(), metal.yield_function.function(), metal.hardening.curve()
    h = increments(20, 0.05, seed=4)
    T, _, state = law.respond(h, np.tile(law.initial(), (20, 1)))
    for stress, row in zip(T, state, strict=True):
        ends = np.cumsum([0, *law.state.values()])
        parts = zip(law.state, ends, ends[1:], strict=False)
        back = sum((row[a:b] for name, a, b in parts if "back_stress" in name), np.zeros(6))
        assert function(stress - back)[0] == pytest.approx(curve(row[6])[0], rel=1e-11)
        assert row[:3].sum() == pytest.approx(0.0, abs=1e-14)


@pytest.mark.parametrize("card", CARDS)
def test_answers_do_not_depend_on_the_neighbours(card):
    law = CARDS[card].law()
    E = np.concatenate([increments(6, 1e-4, seed=1), increments(7, 0.08, seed=2), increments(5, 0.004, seed=3)])
    E = E[np.random.default_rng(0).permutation(len(E))]
    together = law.respond(E, np.tile(law.initial(), (len(E), 1)))
    for k, strain in enumerate(E):
        for one, all_ in zip(law.respond(strain[None], law.initial()[None]), together, strict=True):
            assert np.array_equal(one[0], all_[k])


@pytest.mark.parametrize("card", CARDS)
def test_work_is_what_the_energies_say(card):
    """Trapezoidal work along a path that turns against elastic energy and plastic work: second order in the step."""
    law = CARDS[card].small_strain_law()
    corners = np.concatenate([np.zeros((1, 6)), np.cumsum(increments(3, 0.02, seed=6), axis=0)])
    drift = []
    for steps in (100, 200):
        path = np.concatenate([np.linspace(a, b, steps + 1)[1:] for a, b in itertools.pairwise(corners)])
        state, before, T_before, work = law.initial(), np.zeros(6), np.zeros(6), 0.0
        for h in path:
            T, _, new = law.respond(h[None], state[None])
            work += 0.5 * (T[0] + T_before) @ (h - before)
            state, before, T_before = new[0], h, T[0]
        drift.append(abs(float(sum(law.energy(h[None], state[None]))[0]) / work - 1))
    assert drift[1] < 2e-3 and drift[1] < 0.7 * drift[0]


#: Strain and stress where the reference has both; it turns at 5 % without a stress.
CYCLES = [
    (0.010123, 178.5434),
    (0.030156, 220.0028),
    (0.05, 250.9086),
    (0.045291, -171.6909),
    (0.03527, -244.1090),
    (0.015239, -252.7580),
    (-0.048878, -312.3143),
    (-0.05, math.nan),
    (-0.044786, 196.0257),
    (-0.034764, 298.6798),
    (-0.030756, 304.7781),
]


# Closed forms ------------------------------------------------------------------------------------------------


def tension_shear(metal, stresses, steps):
    """Strains 11 and 12 (of the tensor) and eqps behind each corner of a path in s11 and s12."""
    corners = np.array([[0.0, 0.0], *stresses])
    rows = np.concatenate([np.linspace(a, b, steps + 1)[1:] for a, b in itertools.pairwise(corners)])
    stress = np.zeros((len(rows), 6))
    stress[:, 0], stress[:, 3] = rows.T
    found = mt.point_path(metal, np.full_like(stress, np.nan), stress)
    ends = slice(steps - 1, None, steps)
    return np.stack([found.strain[ends, 0], 0.5 * found.strain[ends, 3], found.state[ends, 6]], axis=1)


def test_tension_and_shear_with_isotropic_hardening():
    """Test SSNP15 of Code_Aster in closed form: the second part in the limit of small steps, by extrapolation."""
    metal = mt.Metal(E=195e3, nu=0.3, hardening=mt.Linear(181.0, 1930.0 * 195e3 / (195e3 - 1930.0)))
    first, second = tension_shear(metal, [(151.2, 93.1), (257.2, 33.1)], 200)
    assert first == pytest.approx([0.014829713606886, 0.013601401082429, 0.020547265463595], rel=1e-9)
    finer = tension_shear(metal, [(151.2, 93.1), (257.2, 33.1)], 400)[1]
    assert 2 * finer - second == pytest.approx([0.035265, 0.020471, 0.042329286420819], rel=2.5e-5)


def test_tension_and_shear_with_prager():
    """Test SSNP14 of Code_Aster: the second part is that of other programs, five digits, at their 30 steps."""
    metal = mt.Metal(
        E=195e3, nu=0.3, hardening=mt.Perfect(181.0), back_stress=mt.Chaboche([(1930.0 * 195e3 / (195e3 - 1930.0), 0)])
    )
    one, two, three = tension_shear(metal, [(151.2, 93.1), (257.2, 33.1), (259.3, 0.0)], 30)[:, :2]
    assert one == pytest.approx([0.014829713606886, 0.013601401082429], rel=1e-9)
    assert two == pytest.approx([0.0406612, 0.01978], rel=5e-5)
    assert three == pytest.approx([0.044151, 0.0190853], rel=1e-3)


def test_tension_and_shear_with_two_back_stresses():
    """Test SSNV101 of Code_Aster: moduli that grow with p; integrated along the proportional path p = 0.19198873."""
    metal = mt.Metal(
        E=145200.0,
        nu=0.3,
        hardening=mt.Voce(87.0, 151.0, 2.3),
        back_stress=mt.Chaboche([(187 * 341.0, 341.0), (29 * 17184.0, 17184.0)], first=0.43, rate=6.09),
    )
    known = np.array([0.09698266, 0.14527633, 0.19198873])
    coarse, fine = (tension_shear(metal, [(143.5, 143.5)], steps)[0] for steps in (1000, 2000))
    assert 2 * fine - coarse == pytest.approx(known, rel=1e-5)


def test_back_stress_saturates_in_a_cycle():
    """Tension, then compression: alpha goes from C/gamma (1 - exp(-gamma p)) to -C/gamma in closed form."""
    metal = mt.Metal(**STEEL, hardening=mt.Perfect(200.0), back_stress=mt.Chaboche([(10000.0, 100.0)]))
    strain, stress, plastic = mt.tension(
        metal, np.concatenate([np.linspace(0, 0.1, 2001)[1:], np.linspace(0.1, 0.06, 2001)[1:]])
    )
    assert stress[1999] == pytest.approx(200.0 + 100.0 * (1 - math.exp(-100.0 * plastic[1999, 0])), rel=1e-5)
    back = plastic[1999, 0] - plastic[-1, 0]
    assert stress[-1] == pytest.approx(-200.0 - 100.0 * (1 - 2 * math.exp(-100.0 * back)), rel=2e-3)
    assert strain[-1] == pytest.approx(0.06)


def test_two_surfaces_in_cycles_of_spcc():
    """Yoshida and Uemori (2002), table 1: an explicit integration with steps of 2e-6 against the limit of ours.

    Its strains have six digits and overshoot where the bar turns: 2e-6 times the slope. Stresses have four.
    """
    metal = mt.Metal(206e3, 0.3, hardening=mt.Perfect(124.0), back_stress=SPCC)
    known = np.array(CYCLES)
    stresses = []
    for size in (1e-4, 5e-5):
        corners = np.concatenate([[0.0], known[:, 0]])
        path, ends = [], []
        for a, b in itertools.pairwise(corners):
            path += list(np.linspace(a, b, math.ceil(abs(b - a) / size) + 1)[1:])
            ends.append(len(path) - 1)
        strain, stress, _ = mt.tension(metal, path)
        stresses.append(stress)
    fine = stresses[1][ends]
    slope = np.gradient(stresses[1], strain)[ends]
    coarse_ends = np.cumsum([math.ceil(abs(b - a) / 1e-4) for a, b in itertools.pairwise(corners)]) - 1
    limit = 2 * fine - stresses[0][coarse_ends]
    wanted = ~np.isnan(known[:, 1])
    assert (np.abs(limit - known[:, 1]) <= 0.05 + 2e-6 * np.abs(slope))[wanted].all()


def test_modulus_falls():
    metal = mt.Metal(**STEEL, hardening=mt.Linear(200.0, 1000.0), modulus=mt.FallingModulus(150e3, 30.0))
    strain, stress, plastic = mt.tension(metal, [0.01, 0.02, 0.0199])
    E = (stress[1] - stress[2]) / (strain[1] - strain[2])
    assert pytest.approx(150e3 + 60e3 * math.exp(-30.0 * plastic[1, 0]), rel=1e-9) == E
    assert stress[1] == pytest.approx(200.0 + 1000.0 * plastic[1, 0], rel=1e-10)


# In elements -------------------------------------------------------------------------------------------------


def pulled(metal, rolling=(1, 0, 0), **options):
    cube = uf.mesh.strip(length=1.0, width=1.0, thickness=1.0, cells=(1, 1))
    model = uf.Model(cube, "ANS3DEAS", material=metal, rolling=rolling)
    for name, axis in (("x0", "x"), ("y0", "y"), ("lower", "z")):
        model.symmetry(name, axis)
    pull = model.prescribe("x1", "x", "pull")
    return model, uf.solve(model, uf.Move(pull, to=0.05, steps=5), progress=False, **options)


@pytest.mark.parametrize("name", ["hill48", "aa2090"])
def test_r_value_from_one_element(name):
    """Pulled along and across the rolling direction, which is all that turns."""
    metal = mt.Metal(**ALUMINIUM, hardening=mt.Voce(130.0, 300.0, 12.0), yield_function=FUNCTIONS[name])
    for rolling, angle in (((1, 0, 0), 0.0), ((0, 1, 0), 90.0)):
        model, _ = pulled(metal, rolling)
        history = uf.fields.point_fields(model).history["plastic_strain"][0, 0]
        across = history[1 if angle == 0.0 else 0]
        assert across / history[2] == pytest.approx(bar(metal.yield_function, angle)[1], rel=1e-5)


@pytest.mark.parametrize("card", ["hill48, voce, fixed", "aa2090, swift, two", "hill48, swift, two, falling"])
def test_newton_is_quadratic_and_the_balance_closes(card):
    """A strip that is bent and pulled, at 30 degrees to the rolling direction."""
    strip = uf.mesh.strip(length=8.0, width=4.0, thickness=1.0, cells=(4, 2))
    model = uf.Model(strip, "ANS3DEAS", material=CARDS[card], rolling=(math.cos(0.5), math.sin(0.5), 0))
    model.fix("x0")
    pulls = [model.prescribe("x1", axis, f"pull_{axis}") for axis in "xz"]
    result = uf.solve(model, [uf.Move(pulls[1], to=1.0, steps=5), uf.Move(pulls[0], to=0.3, steps=5)], progress=False)
    assert measure(result.iterations).order > 1.7
    assert len(result.rows) == 11  # no increment was cut
    assert uf.fields.point_fields(model).eqps.max() > 0.05
    assert np.abs(result.balance().drift).max() < 0.02
    assert set(CARDS[card].law().state) == set(uf.fields.point_fields(model).history)


def test_rotation_of_the_sheet_changes_nothing():
    """The rolling direction turns with the mesh: same strains, same plastic strain in the axes of the sheet."""
    metal, ends = CARDS["aa2090, swift, two"], []
    Q = Rotation.from_rotvec([0.3, -0.5, 0.7]).as_matrix()
    for turn in (np.eye(3), Q):
        mesh = uf.mesh.strip(length=1.0, width=1.0, thickness=0.2, cells=(1, 1))
        x = mesh.points.copy()
        F = np.array([[1.03, 0.02, 0.01], [0.0, 0.99, 0.0], [0.01, 0.0, 0.98]])
        mesh = uf.Mesh(x @ turn.T, mesh.cells)
        model = uf.Model(mesh, "ANS3DEAS", material=metal, rolling=turn @ np.array([0.8, 0.6, 0.0]))
        model.fix([0])
        forces = model.evaluate(((x @ F.T) @ turn.T - x @ turn.T).ravel())
        ends.append(forces.residual.reshape(-1, 3) @ turn)
    assert np.abs(ends[1] - ends[0]).max() < 1e-10 * np.abs(ends[0]).max()


# Bad input ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("make", "text"),
    [
        (lambda: mt.Hill48(r0=-0.5, r45=1, r90=1), "r0 must be positive"),
        (lambda: mt.Hill48.from_stresses(1, 1, 1.9, 2.4), "not convex"),
        (lambda: mt.Hill48.from_stresses(1, 2.5, 1, 1), "not convex"),
        (lambda: mt.Hosford(7), "even"),
        (lambda: mt.Hosford(6.57), "even"),
        (lambda: mt.Chaboche([(-3000.0, 30.0)]), "C must be positive"),
        (lambda: mt.Chaboche([]), "one to four"),
        (lambda: mt.Chaboche([(1.0, 1.0)] * 5), "one to four"),
        (lambda: mt.YoshidaUemori(C=500.0, B=168.0, growth=190.0, b=-9.0, m=12.0, h=0.5), "must be positive"),
        (lambda: mt.Metal(**STEEL, hardening=mt.Perfect(200.0), back_stress=SPCC), "larger than the yield surface"),
        (lambda: mt.Metal(**STEEL, hardening=mt.Linear(100.0, 1.0), back_stress=SPCC), "constant size"),
        (lambda: mt.FallingModulus(0.0, 30.0), "must be positive"),
        (lambda: mt.Metal(**STEEL, hardening=mt.Perfect(1.0), modulus=mt.FallingModulus(220e3, 3.0)), "must fall"),
        (lambda: mt.Metal(**STEEL, hardening=mt.Perfect(1.0), yield_function="Hill48"), "must be a yield function"),
        (lambda: mt.Yld2004(mt.Transformation(shear23=0.0), mt.Transformation(shear23=0.0)), "never flows"),
        (lambda: mt.Metal(**STEEL, hardening=160.0), "must be a hardening curve"),
    ],
)
def test_bad_input(make, text):
    with pytest.raises(InvalidValue, match=text):
        make()


def test_directions_ask_for_the_rolling_direction():
    mesh = uf.mesh.strip(length=1.0, width=1.0, thickness=1.0, cells=(1, 1))
    with pytest.raises(InvalidValue, match="rolling direction"):
        uf.Model(mesh, "ANS3DEAS", material=CARDS["hill48, voce, fixed"])
    uf.Model(mesh, "ANS3DEAS", material=CARDS["hosford, voce, fixed"])  # isotropic
