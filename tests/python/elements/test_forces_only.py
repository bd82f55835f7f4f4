"""An evaluation without a tangent: the same residual to the last bit, and nothing else is touched."""

from __future__ import annotations

import numpy as np
import pytest

LAWS = ["svk", "neo-hooke", "j2"]
ELEMENTS = ["DISP3D", "ANS3DEAS", "EAS3DEAS", "MI9K3DEAS", "BEND8", "BEND18"]


@pytest.fixture(params=[(name, law) for name in ELEMENTS for law in LAWS], ids="-".join)
def one(request, build, materials):
    """An element in a state of large strain, with its displacement."""
    name, law = request.param
    one = build.one_element(name, materials[law])
    u = one.displacement()
    one.harden(u)
    return one, u + one.displacement(0.2)


def evaluate(one, u, tangent):
    f, values = np.zeros(u.size), np.zeros(one.pattern.indices.size)
    outcome = one.block.evaluate(u, one.scatter, f, values if tangent else None, None, None)
    return outcome, f, values


def test_residual_scale_and_flow_are_those_of_the_full_evaluation(one):
    element, u = one
    full, f, _ = evaluate(element, u, tangent=True)
    flowing = element.block.flowing
    element.block.revert()
    only, forces, values = evaluate(element, u, tangent=False)
    assert only == full
    assert only[0] == -1
    np.testing.assert_array_equal(forces, f)
    np.testing.assert_array_equal(element.block.flowing, flowing)
    assert not values.any()


def test_recover_takes_the_blocks_of_the_last_tangent(one):
    """Forces elsewhere, on a line search for instance, leave the condensed blocks as they are."""
    element, u = one
    du = element.displacement(0.1)

    def recovered(elsewhere):
        element.block.revert()
        evaluate(element, u, tangent=True)
        if elsewhere:
            evaluate(element, u + du, tangent=False)
        element.block.recover(du)
        _, f, _ = evaluate(element, u, tangent=False)
        element.block.shorten(0.0)
        return f

    np.testing.assert_array_equal(recovered(elsewhere=True), recovered(elsewhere=False))
    if element.block.modes:
        element.block.revert()
        assert not np.array_equal(recovered(elsewhere=False), evaluate(element, u, tangent=False)[1])


def test_product_needs_no_matrix(one):
    """K du without the entries of K."""
    element, u = one
    du, products = element.displacement(), []
    for values in (np.zeros(element.pattern.indices.size), None):
        f, Kdu = np.zeros(u.size), np.zeros(u.size)
        element.block.evaluate(u, element.scatter, f, values, du, Kdu)
        products.append(Kdu)
    assert products[0].any()
    np.testing.assert_array_equal(*products)


def test_an_element_outside_of_its_domain_is_found_without_a_tangent(build, materials):
    element = build.one_element("DISP3D", materials["j2"])
    flat = np.zeros((element.nodes, 3))
    flat[:, 2] = -element.X[:, 2]
    (failed, scale, _), f, _ = evaluate(element, flat.ravel(), tangent=False)
    assert (failed, scale) == (0, 0.0)
    assert not f.any()


def test_history_reverts_with_its_trial_state(build, materials):
    """A commit straight after a revert leaves the converged history as it is."""
    element = build.one_element("BEND8", materials["j2"])
    u = element.displacement()
    element.harden(u)
    before = element.block.state
    evaluate(element, 2.0 * u, tangent=True)
    assert element.block.flowing.any()
    element.block.revert()
    assert not element.block.flowing.any()
    element.block.commit()
    np.testing.assert_array_equal(element.block.state, before)
