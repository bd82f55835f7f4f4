"""Laws whose tangent is not symmetric: used in full if they say so, refused by name if they do not."""

from __future__ import annotations

import numpy as np
import pytest

from umform.analysis.run import solve
from umform.analysis.steps import Move
from umform.errors import InvalidValue
from umform.materials import SVK, UserLaw, check_law
from umform.mesh import strip
from umform.model import Model

C = np.diag([800.0] * 3 + [400.0] * 3)
C[:3, :3] += 600.0
SCALE = 0.05
ELEMENTS = ["DISP3D", "ANS3DEAS", "EAS3DEAS", "MI9K3DEAS", "BEND8"]


def damage(E, state):
    """Damage by the size of the strain, not by its energy: the tangent holds the product of C E and E."""
    size = np.sqrt((E * E).sum(axis=1))
    before = state.ravel()  # its only number
    largest = np.maximum(size, before)
    left = 0.4 + 0.6 * np.exp(-largest / SCALE)
    slope = np.where(size > before, -0.6 / SCALE * np.exp(-largest / SCALE), 0.0)
    S = E @ C
    direction = E / np.maximum(size, 1e-300)[:, None]
    CC = left[:, None, None] * C + slope[:, None, None] * S[:, :, None] * direction[:, None, :]
    return left[:, None] * S, CC, largest[:, None]


def symmetrised(E, state):
    S, CC, new = damage(E, state)
    return S, 0.5 * (CC + CC.transpose(0, 2, 1)), new


LAW = UserLaw(damage, state={"largest": 1}, symmetric=False, name="damage")


@pytest.mark.parametrize("thickness_points", [2, 5])
@pytest.mark.parametrize("element", ELEMENTS)
def test_tangent_is_the_derivative_of_the_force(build, element, thickness_points):
    one = build.one_element(element, LAW, thickness_points=max(thickness_points, 2 if element != "BEND8" else 5))
    u = one.displacement()
    K, _ = one(u)
    for _ in range(3):
        du = one.rng.normal(size=u.size)
        assert build.relative_error(K @ du, build.central_difference(lambda v: one(v)[1], u, du)) < 1e-7
    assert np.abs(K - K.T).max() > 1e-3 * np.abs(K).max()


@pytest.mark.parametrize("element", ELEMENTS)
def test_scattered_tangent_is_that_of_the_element(build, element):
    one = build.one_element(element, LAW)
    u = one.displacement()
    K, f = one(u)
    assert not one.pattern.symmetric
    force, values = np.zeros(u.size), np.zeros(one.pattern.indices.size)
    du, Kdu = one.rng.normal(size=u.size), np.zeros(u.size)
    one.block.evaluate(u, one.scatter, force, values, du, Kdu)
    np.testing.assert_allclose(force, f, atol=1e-12 * np.abs(f).max())
    np.testing.assert_array_equal(build.dense(one.pattern, values), K)
    np.testing.assert_allclose(Kdu, K @ du, atol=1e-12 * np.abs(Kdu).max())


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_symmetric_law_on_the_full_path_is_what_it_was(build, element):
    """SVK by way of all blocks: the same K and f up to round-off, and the same update of the enhanced parameters."""
    law = SVK(E=900.0, nu=0.2)
    native = law.law()
    full = UserLaw(lambda E, state: native.respond(E, state), symmetric=False)
    one, other = build.one_element(element, law), build.one_element(element, full)
    u = one.displacement()
    du = one.displacement(0.3)
    for element_ in (one, other):
        element_.block.evaluate(
            u, element_.scatter, np.zeros(u.size), np.zeros(element_.pattern.indices.size), None, None
        )
        element_.block.recover(0.5 * du)
    (K, f), (L, g) = (element_.block.element(0, u + 0.5 * du) for element_ in (one, other))
    np.testing.assert_allclose(L, K, atol=1e-11 * np.abs(K).max())
    np.testing.assert_allclose(g, f, atol=1e-11 * np.abs(f).max())


@pytest.mark.parametrize("element", ["DISP3D", "ANS3DEAS"])
def test_newton_converges_quadratically_with_the_whole_tangent_only(element):
    iterations = {}
    for law in (LAW, UserLaw(symmetrised, state={"largest": 1}, name="symmetrised")):
        model = Model(strip(4.0, 2.0, 0.5, (4, 2)), element, material=law)
        model.fix("x0")
        pull = model.prescribe("x1", "x", "pull")
        result = solve(model, Move(pull, 0.2, steps=2), frames=0, progress=False)
        iterations[law.name] = result["iterations"].max()
    assert iterations["damage"] <= 5
    assert iterations["symmetrised"] >= 7


def test_what_is_not_symmetric_without_saying_so_is_refused_by_name():
    model = Model(strip(4.0, 2.0, 0.5, (4, 2)), "ANS3DEAS", material=UserLaw(damage, initial=(0.0,), name="damage"))
    model.fix("x0")
    u = np.zeros_like(model.mesh.points)
    u[:, 0] = 0.05 * model.mesh.points[:, 0]
    with pytest.raises(InvalidValue, match="not symmetric") as caught:
        model.evaluate(u.ravel())
    assert caught.value.where.startswith("damage, cell ")
    assert "symmetric=False" in caught.value.remedy


def test_round_off_is_no_asymmetry(rng):
    noise = 1e-13 * rng.normal(size=(6, 6))

    def law(E, state):
        return E @ C, np.tile(C * (1 + noise), (len(E), 1, 1)), state

    UserLaw(law).law().respond(np.ones((3, 6)), np.zeros((3, 0)))


def test_check_law_measures_the_asymmetry(rng):
    E = 0.1 * rng.normal(size=(10, 6))
    for symmetric in (False, True):
        check = check_law(UserLaw(damage, initial=(0.0,), symmetric=symmetric), E)
        assert check < 1e-7
        assert check.asymmetry > 0.02
        assert "asymmetry" in str(check)
    assert check_law(SVK(E=900.0, nu=0.2), E).asymmetry == 0.0
    assert check_law(UserLaw(symmetrised, initial=(0.0,)), E).asymmetry < 1e-15


def test_a_matrix_of_one_triangle_is_refused(build):
    """The block itself says so, whoever has made the pattern."""
    from umform import _core

    one = build.one_element("DISP3D", LAW)
    pattern = _core.Pattern(np.arange(24, dtype=np.int32), [one.block.connectivity], True)
    with pytest.raises(ValueError, match="not symmetric"):
        one.block.evaluate(
            np.zeros(24),
            pattern.scatter(one.block.connectivity),
            np.zeros(24),
            np.zeros(pattern.indices.size),
            None,
            None,
        )
