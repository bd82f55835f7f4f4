"""Warning of a mesh that gains or loses volume."""

from __future__ import annotations

import pytest

import umform as uf


@pytest.mark.parametrize(("cells", "warned"), [(1, False), (4, True)])
def test_a_mesh_that_gains_volume_is_a_warning(cells, warned):
    """A block is sheared by its height; with four elements one of them nearly turns inside out."""
    steel = uf.J2(E=210e3, nu=0.3, hardening=uf.Linear(200.0, 1000.0))
    model = uf.Model(uf.mesh.strip(3.0, 1.0, 1.0, (cells, 1)), material=steel)
    model.fix("x0")
    for side in ("y0", "y1"):
        model.symmetry(side, "y")
    lift = model.prescribe("x1", "z", "lift")
    result = uf.solve(model, uf.Move(lift, 3.0, steps=20), progress=False)
    volume = result.volume_change()
    assert (abs(volume.mesh - volume.elastic) > 0.03) == warned
    found = [text for text in result.warnings if "of its volume" in text]
    assert len(found) == warned
    assert all(f"gained {100.0 * (volume.mesh - volume.elastic):.2g} %" in text for text in found)
