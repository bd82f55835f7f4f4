"""Orders that make the band of a strip narrow."""

from __future__ import annotations

import numpy as np
import pytest

import umform as uf
from umform.solvers import Pattern
from umform.solvers.band_order import bandwidth, orders


def pattern_of(along, across, cell="hex8"):
    mesh = uf.mesh.strip(float(along), float(across), 0.5, (along, across), cell=cell)
    model = uf.Model(mesh, "ANS3DEAS" if cell == "hex8" else "MI9K3DEAS", material=uf.SVK(E=1.0, nu=0.3))
    model.fix("x0")
    return model.system.pattern


def shuffled(pattern, seed=0):
    """The same matrix with its equations in a random order."""
    places = np.random.default_rng(seed).permutation(pattern.n)
    i, j = places[pattern.rows], places[pattern.indices]
    i, j = np.minimum(i, j), np.maximum(i, j)
    order = np.lexsort((j, i))
    indptr = np.searchsorted(i[order], np.arange(pattern.n + 1)).astype(np.int32)
    return Pattern(pattern.n, indptr, j[order].astype(np.int32), True)


@pytest.mark.parametrize("seed", range(3))
def test_the_band_of_a_shuffled_strip_is_as_narrow(seed):
    strip = pattern_of(40, 1)
    mixed = shuffled(strip, seed)
    widths = [min(bandwidth(p, of.rows, of.indices) for p in orders(of)) for of in (strip, mixed)]
    assert widths[0] == widths[1] == 23  # two columns of 4 nodes


def test_parts_that_nothing_connects_are_walked_over_one_after_the_other():
    """Three chains, of 5, 1 and 4 equations, shuffled: every equation has a place, and the band of a chain."""
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 4], [6, 7], [7, 8], [8, 9]])
    places = np.random.default_rng(1).permutation(10)
    present = np.eye(10, dtype=bool)
    present[tuple(np.sort(places[ends], axis=1).T)] = True
    rows, columns = np.nonzero(present)
    indptr = np.searchsorted(rows, np.arange(11)).astype(np.int32)
    pattern = Pattern(10, indptr, columns.astype(np.int32), True)
    for order in orders(pattern):
        np.testing.assert_array_equal(np.sort(order), np.arange(10))
    assert bandwidth(next(orders(pattern)), pattern.rows, pattern.indices) == 1
