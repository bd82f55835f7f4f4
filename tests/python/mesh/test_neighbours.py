"""Parts of a mesh that are connected."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from umform.mesh.neighbours import connected


@pytest.mark.parametrize("links", [0, 1, 10, 30, 60, 300])
def test_connected_parts_are_those_of_scipy(links):
    count, random = 60, np.random.default_rng(links)
    pairs = random.integers(0, count, (links, 2))
    graph = coo_array((np.ones(links), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    np.testing.assert_array_equal(connected(count, pairs), connected_components(graph, directed=False)[1])


def test_a_long_chain_in_any_order_is_one_part():
    order = np.random.default_rng(0).permutation(1000)
    chain = order[np.stack([np.arange(999), np.arange(1, 1000)], axis=1)]
    assert connected(1000, chain).max() == 0
    assert connected(1000, np.delete(chain, 500, axis=0)).max() == 1


def test_nothing_has_no_parts():
    assert connected(0, np.zeros((0, 2), dtype=int)).size == 0
