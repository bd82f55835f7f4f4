"""The penalty of a metal that depends on the rate is that of its forming, not of a sheet that is elastic."""

from __future__ import annotations

import pytest

import umform as uf


def penalty(law: uf.Metal) -> float:
    """Penalty of a sheet on a cylinder."""
    model = uf.Model(uf.mesh.strip(20.0, 1.0, 1.0, (10, 1)), material=law)
    return model.contact("lower", uf.Cylinder((10.0, 0.0, -5.5), "y", 5.0), name="post").penalty


def test_the_rate_changes_the_penalty_as_it_changes_the_stress():
    curve = uf.Swift(565.32, 0.007117, 0.2589)
    slow = penalty(uf.Metal(206e3, 0.3, hardening=curve))
    for reference in (40.0, 1e6):
        fast = penalty(uf.Metal(206e3, 0.3, hardening=curve, rate=uf.CowperSymonds(reference, 5.0)))
        assert 1.0 < fast / slow < 2.0
    assert fast == pytest.approx(slow, rel=0.1)
