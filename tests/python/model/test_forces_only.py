"""Contact and pressure without a tangent: the same forces to the last bit."""

from __future__ import annotations

import numpy as np
import pytest

from umform import _core
from umform.mesh import strip


def pressure(build, cell):
    mesh = build.jittered(strip(10.0, 4.0, 0.5, (5, 2), cell=cell), 0.1)
    block = _core.pressure_block(mesh.facets("lower"), mesh.points)
    block.pressure = 1.7
    return block, len(mesh.points)


def contact(build, cell, rng):
    case = build.free_bending((24, 4), "MI9K3DEAS" if cell == "hex18" else "ANS3DEAS")
    block = case.contact.block
    block.multipliers = np.maximum(rng.normal(size=block.points), 0.0)
    return block, len(case.model.mesh.points)


@pytest.mark.parametrize("cell", ["hex8", "hex18"])
@pytest.mark.parametrize("kind", ["contact", "pressure"])
def test_forces_scale_and_product_are_those_of_the_full_evaluation(build, rng, kind, cell):
    block, nodes = contact(build, cell, rng) if kind == "contact" else pressure(build, cell)
    full = build.full_tangent(block, nodes)
    u, du = 0.02 * rng.normal(size=(2, 3 * nodes))
    u[2::3] -= 0.1  # into the tool
    answers = []
    for values, with_product in ((np.zeros(full.pattern.indices.size), True), (None, False), (None, True)):
        f, Kdu = np.zeros(full.size), np.zeros(full.size)
        product = (du, Kdu) if with_product else (None, None)
        _, scale, _ = block.evaluate(u, full.scatter, f, values, *product)
        answers.append((f, scale, Kdu))
    (f, scale, Kdu), (forces, scale_again, none), (forces_too, _, product_alone) = answers
    assert f.any()
    assert Kdu.any()
    assert not none.any()
    assert scale_again == scale
    np.testing.assert_array_equal(forces, f)
    np.testing.assert_array_equal(forces_too, f)
    np.testing.assert_array_equal(product_alone, Kdu)
